// JSON parser for Chrono files: RFC 8259 plus // and /* */ comments.
// The result is the same tree as for YAML, so that error messages name file, line and field.
#pragma once

#include <string>
#include <string_view>

#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer::chrono {

inline constexpr std::size_t largest_json = 1 << 20;  // [bytes]
inline constexpr int deepest_json = 32;

// Throws SceneError "file:line: ..." for invalid JSON, duplicate keys and excessive nesting.
reader::Value parse_json(std::string_view text, const std::string& file);

}  // namespace elastocheck::importer::chrono
