// Parses YAML text to a tree of values with line numbers, by yaml-cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reader {

struct Value {
    enum class Kind { empty, scalar, list, map };
    Kind kind = Kind::empty;
    std::string text{};               // of a scalar, as written
    std::vector<Value> items{};       // of a list or a map, in file order
    std::vector<std::string> keys{};  // of a map: one per item, all different
    int line = 1;                     // of its key, if it has one; else of its beginning
    bool is_set = false;              // the value comes from a setting, not from the file
    std::optional<double> number{};   // value to use instead of the text
    bool is_string = false;           // of JSON: in quotes, so that it is not a number
    // of a scalar: where its text begins in the file, from 0, in bytes; -1: not in the file
    int row = -1, column = -1;
};

// Rejects, with the line: text that is not YAML, duplicate keys, keys that are not plain text,
// aliases, tags, a second document, excessive nesting, control characters and bytes that are not
// UTF-8, more than 1 MiB. Throws SceneError.
// Syntax::json allows 32 levels of nesting, and treats quoted text as text, never as a number.
enum class Syntax { yaml, json };
Value parse_yaml(std::string_view text, const std::string& file, Syntax syntax = Syntax::yaml);

// The entry of a map with this key; null if there is none.
const Value* entry(const Value& map, std::string_view key);

// Name of a list entry in paths, "y" or "4": vectors have x, y, z, all other lists positions from 1.
std::string place_in(const Value& list, std::size_t k);

// Throws SceneError "file:line: field: what"; line 0 or an empty field are omitted.
[[noreturn]] void fail(const std::string& file, int line, const std::string& field,
                       const std::string& what);

}  // namespace elastocheck::reader
