#include "models/import/property/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "models/import/import.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

const std::vector<std::string> axis_names{"x", "y", "z"};
const std::vector<std::string> keys = {"name",   "x",      "y",       "z",       "side",   "left.x",
                                       "left.y", "left.z", "right.x", "right.y", "right.z"};

bool is_number(std::string_view cell) { return coordinate(cell, true) || coordinate(cell, false); }

// ---- The value of --columns, which maps properties of a point to columns: "name=Punkt,x=X_mm,y=4,z=E".

struct Assignment {
    std::string key, column;
};
using ColumnChoice = std::vector<Assignment>;

constexpr const char* expected_choice =
    "expected name=COLUMN,x=COLUMN,y=COLUMN,z=COLUMN, each a heading, a number from 1 or letters; "
    "a heading with a comma by its number";

bool has(const ColumnChoice& choice, const std::string& key) {
    return std::ranges::find(choice, key, &Assignment::key) != choice.end();
}

ColumnChoice read_choice(const std::string& text, const std::string& file) {
    ColumnChoice choice;
    for (const std::string& piece : split(text, ",")) {
        const auto equals = piece.find('=');
        if (equals == piece.npos)
            fail(file, 0, "--columns", "{} has no '='; {}", reader::quote(piece), expected_choice);
        const Assignment chosen{reader::small_letters(reader::trimmed(piece.substr(0, equals))),
                                std::string(reader::trimmed(piece.substr(equals + 1)))};
        if (std::ranges::find(keys, chosen.key) == keys.end())
            fail(file, 0, "--columns", "{} is not a property of a point{}",
                 reader::quote(chosen.key), reader::did_you_mean(chosen.key, keys, "allowed"));
        if (has(choice, chosen.key)) fail(file, 0, "--columns", "{} is given twice", chosen.key);
        if (chosen.column.empty()) fail(file, 0, "--columns", "no column for {}", chosen.key);
        choice.push_back(chosen);
    }
    const bool sides = std::ranges::any_of(
        choice, [](const Assignment& c) { return c.key.find('.') != c.key.npos; });
    std::vector<std::string> needed{"name"};
    for (const char* prefix : {"left.", "right."})
        for (const std::string& axis : axis_names) {
            if (sides) needed.push_back(prefix + axis);
            if (sides && (has(choice, axis) || has(choice, "side")))
                fail(file, 0, "--columns", "left.x ... right.z are instead of x, y, z and side");
        }
    if (!sides) needed.insert(needed.end(), axis_names.begin(), axis_names.end());
    for (const auto& key : needed)
        if (!has(choice, key))
            fail(file, 0, "--columns", "no {} in {}; {}", key, reader::quote(text),
                 expected_choice);
    return choice;
}

// Position of a column given by its number from 1 or by its letters, in a table of `width` columns.
std::optional<std::size_t> position(const std::string& column, std::size_t width) {
    std::size_t number = 0;  // from 1
    if (std::ranges::all_of(column, reader::is_digit)) {
        const auto [end, error] =
            std::from_chars(column.data(), column.data() + column.size(), number);
        if (error != std::errc{}) return std::nullopt;
    } else if (column.size() <= 3 && std::ranges::all_of(column, reader::is_letter)) {
        for (const char letter : reader::capitals(column))
            number = 26 * number + (letter - 'A' + 1);
    }
    if (number < 1 || number > width) return std::nullopt;
    return number - 1;
}

// Columns with this heading in a row.
std::vector<std::size_t> columns_with_heading(const SheetRow& row, const std::string& heading) {
    const std::string word = reader::small_letters(heading);
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < row.cells.size(); ++c)
        if (reader::small_letters(row.cells[c]) == word) columns.push_back(c);
    return columns;
}

// ---- Headings.

// The first row with three numbers; the number of rows if there is none.
std::size_t first_row_with_numbers(const Sheet& sheet) {
    const auto first = std::ranges::find_if(sheet.rows, [](const SheetRow& row) {
        return std::ranges::count_if(row.cells, is_number) >= 3;
    });
    return static_cast<std::size_t>(first - sheet.rows.begin());
}

// The row above the numbers with most words, probably that of the headings; null if there is none.
const SheetRow* likely_heading_row(const Sheet& sheet) {
    const SheetRow* heading_row = nullptr;
    std::ptrdiff_t most_words = 0;
    for (std::size_t r = 0, end = first_row_with_numbers(sheet); r < end; ++r) {
        const auto words = std::ranges::count_if(sheet.rows[r].cells, [](const std::string& cell) {
            return !cell.empty() && !is_number(cell);
        });
        if (words > most_words) {
            most_words = words;
            heading_row = &sheet.rows[r];
        }
    }
    return heading_row;
}

// "'Name' (A), 'X' (B), none (C)"
std::string with_letters(const SheetRow& heading_row) {
    std::vector<std::string> words;
    for (std::size_t c = 0; c < heading_row.cells.size(); ++c)
        words.push_back(
            heading_row.cells[c].empty()
                ? fmt::format("none ({})", letters_of(c))
                : fmt::format("{} ({})", reader::quote(heading_row.cells[c]), letters_of(c)));
    return reader::listed(words);
}

// Whether a heading has the word: "Koord. X", "X-Wert", "x_mm".
bool has_word(const std::string& heading, std::string_view word) {
    const std::string text = reader::small_letters(heading);
    for (std::size_t start = text.find(word); start != text.npos;
         start = text.find(word, start + 1)) {
        const std::size_t end = start + word.size();
        if ((start == 0 || !reader::is_letter(text[start - 1])) &&
            (end == text.size() || !reader::is_letter(text[end])))
            return true;
    }
    return false;
}

// "--columns name=Punkt,x=X-Wert,y=Y-Wert,z=HEADING": the option as far as the headings suggest it.
std::string proposal(const Sheet& sheet, const SheetRow& heading_row) {
    std::string choice;
    const std::size_t first_point = first_row_with_numbers(sheet);
    for (const std::string key : {"name", "x", "y", "z"}) {
        const auto fits = [&](std::size_t c) {
            if (key != "name") return has_word(heading_row.cells[c], key);
            const std::string_view cell =
                first_point < sheet.rows.size() ? sheet.rows[first_point].at(c) : "";
            return !cell.empty() && !is_number(cell);
        };
        std::size_t c = 0;
        while (c < heading_row.cells.size() && !fits(c)) ++c;
        std::string column = "HEADING";
        if (c < heading_row.cells.size()) {
            const std::string& word = heading_row.cells[c];
            const bool plain = !word.empty() && std::ranges::all_of(word, [](char ch) {
                return reader::is_word(ch) || ch == '-' || ch == '.';
            });
            column =
                plain && columns_with_heading(heading_row, word).size() == 1 ? word : letters_of(c);
        }
        choice += fmt::format("{}{}={}", choice.empty() ? "" : ",", key, column);
    }
    return "--columns " + choice;
}

[[noreturn]] void refuse(const Sheet& sheet, const std::string& file, const std::string& what) {
    const SheetRow* heading_row = likely_heading_row(sheet);
    if (sheet.rows.empty()) fail(file, 0, "", "no point in this file");
    if (heading_row == nullptr)
        fail(file, sheet.rows.front().line, "",
             "{}; no headings above the numbers; choose columns by their numbers or letters: "
             "--columns name=A,x=B,y=C,z=D",
             what);
    fail(file, heading_row->line, "",
         "{}; headings: {}; choose with {} (by heading, number or letters)", what,
         with_letters(*heading_row), proposal(sheet, *heading_row));
}

// Columns of name, x, y, z by the first words of their headings in a row: "Point Name", "X [mm]", "y_m".
std::array<std::vector<std::size_t>, 4> recognised(const SheetRow& row) {
    std::array<std::vector<std::size_t>, 4> found;
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
        const std::string title = reader::small_letters(row.cells[c]);
        const std::string word = title.substr(0, title.find_first_of(" [(_/"));
        if (word == "name" || word == "point" || word == "hardpoint") found[0].push_back(c);
        for (std::size_t k = 0; k < 3; ++k)
            if (word == axis_names[k]) found[1 + k].push_back(c);
    }
    return found;
}

constexpr std::size_t no_row = static_cast<std::size_t>(-1);

struct ChosenColumns {
    PointColumns columns;
    std::size_t heading_row = no_row;  // no_row: the columns are chosen by position alone
};

// Columns with an empty heading in the row `heading_row` whose cell is text in every row below it that
// has three numbers.
std::vector<std::size_t> unnamed_columns(const Sheet& sheet, std::size_t heading_row) {
    std::vector<std::size_t> text_columns;
    for (std::size_t c = 0; c < SheetRow::max_cells; ++c) {
        std::size_t width = 0;
        bool all_text = true;
        for (std::size_t r = heading_row + 1; r < sheet.rows.size(); ++r) {
            const SheetRow& row = sheet.rows[r];
            if (std::ranges::count_if(row.cells, is_number) < 3) continue;
            width = std::max(width, row.cells.size());
            if (row.at(c).empty() || is_number(row.at(c))) all_text = false;
        }
        if (c >= width) break;
        if (all_text && sheet.rows[heading_row].at(c).empty()) text_columns.push_back(c);
    }
    return text_columns;
}

// "LF_", "left_" of a heading above several columns: "Front left", "LEFT".
std::string prefix_of(const std::string& heading) {
    const auto has = [&](const char* word) { return has_word(heading, word); };
    const bool left = has("left") || has("l") || has("lh"),
               right = has("right") || has("r") || has("rh");
    if (left == right) return heading + "_";
    if (has("front") == has("rear")) return left ? "left_" : "right_";
    return fmt::format("{}{}_", left ? 'L' : 'R', has("front") ? 'F' : 'R');
}

// The coordinate columns of several groups, whose names are in the row above the headings; empty if the
// columns do not form such groups.
std::vector<Triple> grouped(const Sheet& sheet, std::size_t heading_row,
                            const std::array<std::vector<std::size_t>, 4>& columns) {
    std::vector<Triple> triples;
    if (heading_row == 0 || columns[1].size() != columns[2].size() ||
        columns[1].size() != columns[3].size())
        return {};
    const SheetRow& name_row = sheet.rows[heading_row - 1];
    for (std::size_t n = 0; n < columns[1].size(); ++n) {
        // A merged heading stands in its first cell: search from x to the left, not beyond the z of the
        // previous group.
        const auto x = columns[1][n], begin = n == 0 ? 0 : columns[3][n - 1] + 1;
        std::size_t end = x + 1;
        while (end > begin && name_row.at(end - 1).empty()) --end;
        if (end == begin) return {};
        const std::string prefix = prefix_of(std::string(name_row.at(end - 1)));
        if (std::ranges::find(triples, prefix, &Triple::prefix) != triples.end()) return {};
        triples.push_back({prefix, {x, columns[2][n], columns[3][n]}});
    }
    return triples;
}

ChosenColumns by_headings(const Sheet& sheet, const std::string& file) {
    std::vector<std::string> missing{"name", "x", "y", "z"};
    for (std::size_t r = 0; r < sheet.rows.size(); ++r) {
        auto columns = recognised(sheet.rows[r]);
        const bool has_coordinates =
            !columns[1].empty() && !columns[2].empty() && !columns[3].empty();
        // The heading of the names may stand one row higher, or be empty.
        if (columns[0].empty() && has_coordinates && r > 0)
            columns[0] = recognised(sheet.rows[r - 1])[0];
        if (columns[0].empty() && has_coordinates) {
            columns[0] = unnamed_columns(sheet, r);
            if (columns[0].size() > 1) columns[0].clear();
        }
        std::vector<std::string> missing_here;
        for (std::size_t k = 0; k < 4; ++k)
            if (columns[k].empty()) missing_here.emplace_back(k == 0 ? "name" : axis_names[k - 1]);
        if (!missing_here.empty()) {
            if (missing_here.size() < missing.size()) missing = missing_here;
            continue;
        }
        ChosenColumns result;
        if (columns[1].size() > 1) result.columns.triples = grouped(sheet, r, columns);
        for (std::size_t k = 0; k < 4; ++k)
            if (columns[k].size() > 1 && (k == 0 || result.columns.triples.empty()))
                refuse(sheet, file,
                       fmt::format("two columns of {}", std::array{"names", "x", "y", "z"}[k]));
        result.columns.name = columns[0][0];
        if (result.columns.triples.empty())
            result.columns.triples = {{"", {columns[1][0], columns[2][0], columns[3][0]}}};
        result.heading_row = r;
        return result;
    }
    refuse(sheet, file, fmt::format("no column {}", fmt::join(missing, ", ")));
}

// Column of an assignment: by a heading in row `heading_row`, else in another row above the numbers, else by number
// or letters.
std::size_t resolved_column(const Sheet& sheet, const std::string& file, const Assignment& chosen,
                            std::size_t heading_row) {
    const auto& [key, column] = chosen;
    std::vector<std::size_t> rows;
    if (heading_row != no_row) rows.push_back(heading_row);
    for (std::size_t r = 0, end = first_row_with_numbers(sheet); r < end; ++r) rows.push_back(r);
    for (const std::size_t r : rows) {
        const auto columns = columns_with_heading(sheet.rows[r], column);
        if (columns.size() > 1)
            fail(file, sheet.rows[r].line, "--columns",
                 "{}: columns {} and {} have the heading {}; choose one by its letter", key,
                 letters_of(columns[0]), letters_of(columns[1]), reader::quote(column));
        if (!columns.empty()) return columns[0];
    }
    std::size_t width = 0;
    for (const auto& row : sheet.rows) width = std::max(width, row.cells.size());
    if (const auto index = position(column, width)) return *index;
    const SheetRow* row =
        heading_row != no_row ? &sheet.rows[heading_row] : likely_heading_row(sheet);
    std::vector<std::string> words;
    if (row != nullptr)
        std::ranges::copy_if(row->cells, std::back_inserter(words),
                             [](const std::string& cell) { return !cell.empty(); });
    fail(file, row != nullptr ? row->line : 0, "--columns",
         "{}: {} is neither a heading nor a number or letter of the {} columns{}", key,
         reader::quote(column), width, reader::did_you_mean(column, words, "headings"));
}

ChosenColumns by_choice(const Sheet& sheet, const std::string& file, const ColumnChoice& choice) {
    ChosenColumns result;
    std::ptrdiff_t most_matches = 0;
    for (std::size_t r = 0, end = first_row_with_numbers(sheet); r < end; ++r) {
        const auto matches = std::ranges::count_if(choice, [&](const Assignment& c) {
            return !columns_with_heading(sheet.rows[r], c.column).empty();
        });
        if (matches > most_matches) {
            most_matches = matches;
            result.heading_row = r;
        }
    }
    std::map<std::size_t, std::string> used;
    std::map<std::string, Triple> triples;  // by the prefix of their names
    for (const auto& chosen : choice) {
        const std::size_t column = resolved_column(sheet, file, chosen, result.heading_row);
        if (const auto [other, is_new] = used.emplace(column, chosen.key); !is_new)
            fail(file, 0, "--columns", "{} and {} are the same column {}", other->second,
                 chosen.key, letters_of(column));
        const auto dot = chosen.key.find('.');
        const std::string prefix = dot == chosen.key.npos ? "" : chosen.key.substr(0, dot) + "_";
        if (chosen.key == "name")
            result.columns.name = column;
        else if (chosen.key == "side")
            result.columns.side = column;
        else
            triples[prefix].at[static_cast<std::size_t>(chosen.key.back() - 'x')] = column;
    }
    for (auto& [prefix, triple] : triples) result.columns.triples.push_back({prefix, triple.at});
    return result;
}

// ---- Units.

// "[mm]" and "inches" as "mm" and "in".
std::string without_brackets(std::string_view text) {
    std::string word = reader::small_letters(reader::trimmed(text));
    std::erase_if(word,
                  [](char c) { return std::string_view(" []()").find(c) != std::string::npos; });
    return word == "inch" || word == "inches" ? "in" : word;
}
bool is_unit(const std::string& word) {
    return std::ranges::find(length_units, word) != std::end(length_units);
}

// The unit in a heading: "X [mm]", "X_mm", "X/mm", "X in mm". Text in brackets is returned even if it is not
// a unit.
std::string unit_in_heading(std::string_view heading) {
    const auto open = heading.find_last_of("[("), end = heading.find_last_of(" _/");
    if (open != heading.npos) return without_brackets(heading.substr(open));
    if (end == heading.npos) return "";
    std::string word = without_brackets(heading.substr(end + 1));
    return is_unit(word) ? word : "";
}

struct DeclaredUnit {
    std::string unit, from;  // "mm", "by the heading 'X_mm' in line 1"; empty if there is none
    int line = 0;
};

// The unit of a column: that in the last of the rows `rows` (first, end) above the points that has one.
DeclaredUnit unit_of(const Sheet& sheet, const std::string& file,
                     std::pair<std::size_t, std::size_t> rows, std::size_t column,
                     const std::string& axis, bool ignore_unknown) {
    DeclaredUnit declared;
    for (std::size_t r = rows.first; r < rows.second; ++r) {
        const std::string_view cell = sheet.rows[r].at(column);
        std::string word = without_brackets(cell);
        if (!is_unit(word)) word = unit_in_heading(cell);
        if (word.empty()) continue;
        declared.line = sheet.rows[r].line;
        if (is_unit(word)) {
            declared.unit = word;
            declared.from =
                fmt::format("by the heading {} in line {}", reader::quote(cell), declared.line);
        } else if (!ignore_unknown) {
            fail(file, declared.line, axis,
                 "{} is not a unit of a coordinate; allowed: {}; or say it with --unit",
                 reader::quote(word), fmt::join(length_units, ", "));
        }
    }
    return declared;
}

// Sets the unit of the coordinates: that of --unit, `option`, or that of the headings, which must agree
// in all columns.
void find_unit(const Sheet& sheet, const std::string& file, std::size_t heading_row,
               const std::string& option, PointColumns& columns) {
    std::string first_without_unit;  // the first column for which no row states a unit
    const std::pair rows{heading_row == no_row ? 0 : heading_row, columns.first};
    for (const Triple& triple : columns.triples)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [unit, from, line] =
                unit_of(sheet, file, rows, triple.at[k], axis_names[k], !option.empty());
            if (unit.empty()) {
                if (first_without_unit.empty()) first_without_unit = triple.prefix + axis_names[k];
                continue;
            }
            if (!columns.unit.empty() && columns.unit != unit)
                fail(file, line, axis_names[k], "the coordinates have different units, {} and {}",
                     columns.unit, unit);
            if (!option.empty() && option != unit)
                fail(file, line, axis_names[k], "in {} {}; --unit says {}", unit, from, option);
            columns.unit = unit;
            columns.unit_from = from;
        }
    if (!option.empty()) {
        columns.unit = option;
        columns.unit_from = "by --unit";
    } else if (!first_without_unit.empty())
        fail(file, sheet.rows[heading_row == no_row ? columns.first : heading_row].line,
             first_without_unit, "no unit in its heading or below it; say it with --unit: {}",
             fmt::join(length_units, ", "));
}

}  // namespace

double millimetres(const std::string& unit) {
    return unit == "mm" ? 1 : unit == "cm" ? 10 : unit == "m" ? 1000 : 25.4;
}

std::optional<double> coordinate(std::string_view cell, bool decimal_comma) {
    std::string text(cell);
    if (const auto minus = text.find("\xE2\x88\x92"); minus == 0) text.replace(0, 3, "-");
    if (decimal_comma)
        for (char& c : text) {
            if (c == '.') return std::nullopt;  // would separate thousands
            if (c == ',') c = '.';
        }
    std::string_view rest = text;
    if (rest.starts_with('+')) rest.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc{} || end != rest.data() + rest.size() || !std::isfinite(value) ||
        std::abs(value) > 1e30)
        return std::nullopt;
    return value;
}

PointColumns point_columns(const Sheet& sheet, const std::string& file, const std::string& choice,
                           const std::string& unit) {
    ChosenColumns chosen = choice.empty() ? by_headings(sheet, file)
                                          : by_choice(sheet, file, read_choice(choice, file));
    PointColumns& columns = chosen.columns;
    // without a line of headings, lines above the points may have numbers too
    const auto has_numbers = [&](const SheetRow& row) {
        return std::ranges::any_of(columns.triples, [&](const Triple& triple) {
            const auto count = std::ranges::count_if(
                triple.at, [&](std::size_t c) { return is_number(row.at(c)); });
            return count >= (chosen.heading_row == no_row ? 3 : 1);
        });
    };
    columns.first = chosen.heading_row == no_row ? 0 : chosen.heading_row + 1;
    while (columns.first < sheet.rows.size() && !has_numbers(sheet.rows[columns.first]))
        ++columns.first;
    if (columns.first == sheet.rows.size()) fail(file, 0, "", "no point in this file");
    find_unit(sheet, file, chosen.heading_row, unit, columns);
    return std::move(chosen.columns);
}

}  // namespace elastocheck::importer
