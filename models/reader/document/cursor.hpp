// Cursor: one value of a scene file, with its path and line for error messages.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/scene.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {

// Record of the accesses to a tree: the scalars that were read, and the fields that were looked up
// in each map, present or not.
struct Accesses {
    std::set<const Value*> read;
    std::map<const Value*, std::set<std::string>> looked_for;
};

// Every function throws SceneError if the value is not of the expected kind. The tree, the file's
// name and the list of numbers must outlive the cursor.
struct Cursor {
    const Value* value;
    std::string path;  // "joints.ball_joint.type", empty for the whole file
    const std::string* file;
    std::vector<Number>* numbers;  // records every number that is read
    std::string item{};            // place in a list, ".y" or ".4.2": part of a number's path only
    Accesses* accesses = nullptr;  // if not null, records every access
    // False where the same tree was read before with other numbers: what does not depend on them is not
    // checked again, numbers are not recorded, and errors lack their paths.
    bool first_reading = true;

    [[noreturn]] void fail(const std::string& what) const;

    // ---- maps
    using Words = std::initializer_list<std::string_view>;
    void only_keys(Words allowed) const;
    void only_keys(const std::vector<std::string>& allowed) const;
    Cursor require(std::string_view key) const;
    std::optional<Cursor> optional(std::string_view key) const;

    // The entries of a section by their keys; an empty section has none. Keys are user-defined names, or
    // paths of numbers, to which "@left" or "@right" may be appended.
    struct Named;
    enum class Keys { names, numbers };
    std::vector<Named> entries(Keys keys = Keys::names) const;

    // ---- lists; `what` completes "expected a list of 3 ..."
    std::vector<Cursor> list(std::size_t size, std::string_view what) const;
    bool is_list() const { return value->kind == Value::Kind::list; }
    std::vector<Cursor> items() const;

    // ---- scalars; `what` completes "expected ..." and "'text' is not ..."
    const std::string& text(std::string_view what,
                            std::string_view kind = {}) const;  // one line, not empty
    // 0, or 1e-30 to 1e30 in size; locale-independent
    double number(const std::string& unit = "") const;
    bool yes_or_no() const;  // true, false
    int whole_number(int min, int max) const;
    // position in `allowed`
    std::size_t one_of(std::string_view what, Words allowed) const;
    std::size_t one_of(std::string_view what, const std::vector<std::string>& allowed) const;

    Cursor at(const Value& value, const std::string& path) const;  // the same file at another place
    std::string found() const;                        // "'text'", "a list of 3", "a map", "nothing"
    std::string path_of(std::string_view key) const;  // of a field
};

struct Cursor::Named {
    std::string name;
    Cursor at;
};

}  // namespace elastocheck::reader
