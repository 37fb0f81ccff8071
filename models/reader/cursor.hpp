// A place in a scene file: one value, with the path and the line that messages about it name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/reader/yaml.hpp"
#include "models/scene.hpp"

namespace elastocheck::reader {

// Every function throws SceneError when the value is not what it asks for. The tree, the file's name and the
// list of numbers outlive the cursor.
struct Cursor {
    const Value* value;
    std::string path;  // "joints.ball_joint.type", empty for the whole file
    const std::string* file;
    std::vector<Number>* numbers;  // every number that is read is noted here
    std::string item{};            // place in a list, ".y" or ".4.2": part of a number's path only

    [[noreturn]] void fail(const std::string& what) const;

    // ---- of a map
    void only_keys(const std::vector<std::string>& allowed) const;
    Cursor require(const std::string& key) const;
    std::optional<Cursor> optional(const std::string& key) const;

    // The entries of a section, each under a name chosen by the user. A section left empty has none.
    struct Named;
    std::vector<Named> entries() const;

    // ---- of a list; `what` completes "expected a list of 3 ..."
    std::vector<Cursor> list(std::size_t size, const std::string& what) const;
    bool is_list() const { return value->kind == Value::Kind::list; }
    std::vector<Cursor> items() const;

    // ---- of a scalar; `what` completes "expected ..." and "'text' is not ..."
    const std::string& text(const std::string& what) const;  // one line, not empty
    double number(const std::string& unit = "") const;       // 0, or 1e-30 to 1e30 in size; any locale
    bool yes_or_no() const;                                  // true, false
    int whole_number(int least, int most) const;
    std::size_t one_of(const std::string& what, const std::vector<std::string>& allowed) const;  // position

    Cursor at(const Value& value, const std::string& path) const;  // the same file at another place
    std::string found() const;  // "'text'", "a list of 3", "a map", "nothing"
};

struct Cursor::Named {
    std::string name;
    Cursor at;
};

}  // namespace elastocheck::reader
