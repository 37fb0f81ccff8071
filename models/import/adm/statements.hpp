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
// The comma at the start of a continuation separates values unless the line before ended with a comma or "=";
// it is not part of an expression. So the kind of an argument must be known before lines are joined. Keywords,
// names and flags are case-insensitive and may be abbreviated if unambiguous. Any bytes are allowed; NUL counts
// as a blank except in the title, where it marks a binary file.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/import/draft.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer::adm {

inline constexpr std::size_t max_statements = 200'000;

// Whether a list "A B= C=f" has the word.
bool has_word(std::string_view list, std::string_view word);

// The words that an abbreviation can mean: the exact match alone, else all that begin with it.
std::vector<std::string_view> matches(std::string_view beginning,
                                      const std::vector<std::string>& words);

struct Argument {
    std::string name;  // in full, in capitals
    enum class Kind { flag, values, expression } kind = Kind::flag;
    std::vector<std::string> values = {};  // an expression is one text, with lines joined
    mutable bool is_read = false;
};

// A statement and its arguments by their full names. A function that returns a value of an argument,
// and `has` for a flag, mark it as read. They throw SceneError for an argument that the statement does
// not have, for a duplicate, and for a value of another kind.
struct Statement {
    std::string_view file, keyword = {};  // in full: "SPRINGDAMPER"
    int id = 0;                           // 0: none
    std::string rest = {};  // text after the id; '\n' replaces the comma of a continuation
    std::string name = {};  // from the comment adams_view_name='...' above it; or empty
    int line = 0;
    mutable std::optional<std::vector<Argument>> arguments = {};  // parsed at the first look-up

    SourceLocation place() const;  // "JOINT/1 'knuckle'"
    [[noreturn]] void fail(const std::string& what) const;
    template <class... A>
    [[noreturn]] void fail(fmt::format_string<A...> what, A&&... a) const {
        fail(fmt::format(what, std::forward<A>(a)...));
    }
    bool is(std::string_view keywords) const { return has_word(keywords, keyword); }

    bool has(std::string_view argument) const;
    const Argument* mark_read(std::string_view argument) const;  // null if there is none
    std::vector<std::string> flags() const;
    std::string word(std::string_view argument) const;  // one value, in capitals
    int id_of(std::string_view argument) const;         // of another statement; 0 if missing
    std::vector<int> ids(std::string_view argument) const;
    enum class Unit { any, angle };  // an angle may have the suffix D for degrees
    double number(std::string_view argument, double missing, Unit unit = Unit::any) const;
    std::vector<double> numbers(std::string_view argument, std::size_t least, std::size_t most,
                                Unit unit = Unit::any) const;
    const std::string* expression(std::string_view argument) const;

  private:
    const Argument* find(std::string_view argument) const;
};

struct Dataset {
    std::string title;
    std::vector<Statement> statements;
    int last_line = 0;
    bool has_end = false;
};

// Throws SceneError if the text is not a dataset. `file` must outlive the statements.
Dataset read_statements(std::string_view text, const std::string& file);

const reader::Value& dataset_table(std::string_view table);

// The arguments of a statement, "FLAG NAME= NAME=f"; empty for one that is not read.
std::string form_of(std::string_view keyword);
// What becomes of a statement.
enum class Role { converted, without_effect, if_used, friction, missing };
Role role_of(std::string_view keyword);

// Reads "1", "-.4", "1.0E+05", "5.0D-02" or "90D" (degrees: sets the flag). Returns the length; 0 if none.
std::size_t number_at(std::string_view text, double& value, bool& is_in_degrees);

using reader::capitals;

}  // namespace elastocheck::importer::adm
