// The lexical rules of an ADAMS/Solver dataset (.adm):
//
//   file         := title-line item* [END]         line 1 is the title, whatever it says; what follows END is ignored
//   item         := blank | "!" comment | statement
//   statement    := KEYWORD "/" [id] ["," argument]* (continuation)*
//   continuation := a line whose first character that is no blank is ",", or the one after a line that ends with "&"
//   argument     := FLAG | NAME "=" value ("," value)* | NAME "=" value ":" value ... | FNAME "=" expression
//
// The comma that begins a continuation separates values where the line before did not end with one (or with "="), and
// is no part of an expression at all: so what an argument is must be known before lines are joined. Keywords, names and
// flags are of any case and may be cut off where what is left is unambiguous. Bytes may be any; NUL is a blank, but for
// the title, where it tells that this is no text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "models/import/draft.hpp"

namespace elastocheck::importer::adm {

inline constexpr std::size_t largest_dataset = 16 << 20;  // [bytes]
inline constexpr std::size_t most_statements = 200'000;

struct Statement {
    std::string keyword;  // in full: "SPRINGDAMPER"
    int id = 0;           // 0 where there is none
    std::string rest;     // behind the id; where a line is continued, '\n' stands for the comma
    std::string name;     // of the comment adams_view_name='...' above it; empty where there is none
    int line = 0;

    Place place() const;  // "JOINT/1 'knuckle'"
};

struct Dataset {
    std::string file, title;
    std::vector<Statement> statements;
    int last_line = 0;
};

// Throws SceneError for what is no dataset.
Dataset read_statements(std::string_view text, const std::string& file);

[[noreturn]] void fail(const std::string& file, const Statement& at, const std::string& what);

// ---- Arguments.

struct Argument {
    std::string name;                 // as written, in capitals
    bool is_flag = false;             // no "="
    std::vector<std::string> values;  // of an assignment; of an expression its one text, lines joined
};

// What a statement may have. A name is an expression, or values.
struct Shape {
    std::vector<std::string_view> flags, values, expressions;
};

// The arguments, their names in full. Throws SceneError for one that the shape does not have, or that is there twice.
class Arguments {
  public:
    Arguments(const std::string& file, const Statement& statement, const Shape& shape);

    bool has(std::string_view name) const { return find(name) != nullptr; }
    const std::vector<Argument>& all() const { return arguments_; }
    std::string word(std::string_view name) const;  // one value, in capitals
    int id(std::string_view name) const;            // one value, of another statement; 0 where there is none
    std::vector<int> ids(std::string_view name) const;
    double number(std::string_view name, double missing) const;
    double angle(std::string_view name, double missing) const;  // [rad]; the suffix D means degrees
    std::vector<double> numbers(std::string_view name, std::size_t least, std::size_t most) const;
    std::vector<double> angles(std::string_view name, std::size_t count) const;
    const std::string* expression(std::string_view name) const;
    [[noreturn]] void fail(const std::string& what) const;

  private:
    const Argument* find(std::string_view name) const;
    double read(const Argument& argument, const std::string& text, bool is_angle) const;
    std::vector<double> list(std::string_view name, std::size_t least, std::size_t most, bool angles) const;

    const std::string* file_;
    const Statement* statement_;
    std::vector<Argument> arguments_;
};

// "1", "-.4", "1.0E+05", "5.0D-02", "90D" (degrees: sets the flag), or not a number at all. Returns its length.
std::size_t number_at(std::string_view text, double& value, bool& is_in_degrees);

std::string capitals(std::string_view text);

}  // namespace elastocheck::importer::adm
