// The lexical rules of an ADAMS/Solver dataset (.adm):
//
//   file         := title-line item* [END]         line 1 is the title; text after END is ignored
//   item         := blank | "!" comment | statement
//   statement    := KEYWORD "/" [id] ["," argument]* (continuation)*
//   continuation := a line whose first non-blank character is ",", or the line after one that ends
//                   with "&"
//   argument     := FLAG | NAME "=" value ("," value)* | NAME "=" value ":" value ...
//                   | FNAME "=" expression
//
// The comma at the start of a continuation separates values if the line before did not end with one
// (or with "="), and is not part of an expression. So the kind of an argument must be known before
// lines are joined. Keywords, names and flags are case-insensitive and may be abbreviated if
// unambiguous. Any bytes are allowed; NUL counts as a blank except in the title, where it marks a
// binary file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "models/import/draft.hpp"
#include "models/reader/document/characters.hpp"

namespace elastocheck::importer::adm {

inline constexpr std::size_t largest_dataset = 16 << 20;  // [bytes]
inline constexpr std::size_t most_statements = 200'000;

struct Statement {
    std::string keyword;  // in full: "SPRINGDAMPER"
    int id = 0;           // 0: none
    std::string rest;     // text after the id; '\n' replaces the comma of a continuation
    std::string name;     // from the comment adams_view_name='...' above it; or empty
    int line = 0;
    // The arguments found by Arguments, and whether each has been read.
    mutable std::vector<std::pair<std::string_view, bool>> arguments = {};

    SourceLocation place() const;  // "JOINT/1 'knuckle'"
};

struct Dataset {
    std::string file, title;
    std::vector<Statement> statements;
    int last_line = 0;
    bool has_end = false;
};

// Throws SceneError if the text is not a dataset.
Dataset read_statements(std::string_view text, const std::string& file);

[[noreturn]] void fail(const std::string& file, const Statement& at, const std::string& what);

// ---- Arguments.

struct Argument {
    std::string name;      // as written, in capitals
    bool is_flag = false;  // no "="
    // of an assignment; an expression has one text, with lines joined
    std::vector<std::string> values;
};

// Arguments that a statement may have: flags, names with values, names with an expression.
struct Shape {
    std::vector<std::string_view> flags, values, expressions;
};

// The arguments of a statement by their full names. Throws SceneError for an argument that the
// shape does not have, and for a duplicate. `has` and `flags` count as reading a flag, the
// functions that return a value as reading it; Statement::arguments records which arguments were
// read.
class Arguments {
  public:
    Arguments(const std::string& file, const Statement& statement, const Shape& shape);

    bool has(std::string_view name) const;
    std::vector<std::string> flags() const;
    void mark_read(std::string_view name) const;    // for an argument used in another way
    std::string word(std::string_view name) const;  // one value, in capitals
    // one value, the id of another statement; 0 if missing
    int id(std::string_view name) const;
    std::vector<int> ids(std::string_view name) const;
    double number(std::string_view name, double missing) const;
    double angle(std::string_view name, double missing) const;  // [rad]; the suffix D means degrees
    std::vector<double> numbers(std::string_view name, std::size_t least, std::size_t most) const;
    std::vector<double> angles(std::string_view name, std::size_t count) const;
    const std::string* expression(std::string_view name) const;
    [[noreturn]] void fail(const std::string& what) const;

  private:
    const Argument* find(std::string_view name) const;
    const Argument* taken(std::string_view name) const;  // find(), marked as read
    double read(const Argument& argument, const std::string& text, bool is_angle) const;
    std::vector<double> list(std::string_view name, std::size_t least, std::size_t most,
                             bool angles) const;

    const std::string* file_;
    const Statement* statement_;
    std::vector<Argument> arguments_;
};

// Reads "1", "-.4", "1.0E+05", "5.0D-02" or "90D" (degrees: sets the flag). Returns the length; 0
// if none.
std::size_t number_at(std::string_view text, double& value, bool& is_in_degrees);

using reader::capitals;

}  // namespace elastocheck::importer::adm
