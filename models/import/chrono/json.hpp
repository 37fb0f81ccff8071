// JSON as Chrono reads it: with // and /* */ comments, else to the letter (RFC 8259). The same tree as of YAML, so that
// what reads it names file, line and field.
#pragma once

#include <string>
#include <string_view>

#include "models/reader/yaml.hpp"

namespace elastocheck::importer::chrono {

inline constexpr std::size_t largest_json = 1 << 20;  // [bytes]
inline constexpr int deepest_json = 32;

// Throws SceneError "file:line: ..." for what is no JSON, a key given twice, nesting deeper than any suspension's.
reader::Value parse_json(std::string_view text, const std::string& file);

}  // namespace elastocheck::importer::chrono
