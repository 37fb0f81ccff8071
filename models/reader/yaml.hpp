// YAML text -> a plain tree that remembers its lines. yaml-cpp does the parsing.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reader {

struct Value {
    enum class Kind { nothing, scalar, list, map };
    Kind kind = Kind::nothing;
    std::string text{};               // of a scalar, as written
    std::vector<Value> items{};       // of a list or a map, in file order
    std::vector<std::string> keys{};  // of a map: one per item, all different
    int line = 1;                     // where it begins; where its key stands, if it has one
    bool is_set = false;              // not as the file has it: a setting put it there
};

// Refuses, with the line: what is no YAML, duplicate keys, keys that are not plain text, aliases, tags, a
// second document, nesting deeper than any scene, control characters and bytes that are not UTF-8, more than
// 1 MiB. Throws SceneError.
Value parse_yaml(std::string_view text, const std::string& file);

bool is_utf8(std::string_view text);

// What tells an entry of a list in paths, "y" or "4": vectors have x, y, z, all other lists places from 1.
std::string place_in(const Value& list, std::size_t k);

// Throws SceneError "file:line: field: what"; without the line (0) or the field (empty) where there is none.
[[noreturn]] void fail(const std::string& file, int line, const std::string& field, const std::string& what);

}  // namespace elastocheck::reader
