// The formats of a result (compare/result/result.hpp) and of its tables, and nothing else knows them:
// text.cpp for a terminal, csv.cpp, json.cpp, markdown.cpp, page.cpp. A missing number is a dash, an empty cell, null.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/result/result.hpp"

namespace elastocheck::reports {

using compare::Digits;

// First line "error [mm],..."; numbers with the fewest digits that read back exactly.
std::string csv(const compare::Table& table);

// {"columns": [{"name", "unit", "description"}, ...], "rows": [[1.5, "text", null], ...]}
nlohmann::ordered_json table_json(const compare::Table& table);

std::string with_unit(const std::string& name, const std::string& unit);  // "error [mm]"

// A column as readers see it.
struct ShownColumn {
    std::string heading;  // "error [mm]"
    bool words = false, note = false;
    std::vector<std::string> cells;
    std::vector<double> shades;  // shares of the largest; empty: not shaded
};

// The columns with digits that are not empty, in the order for readers. `written` formats a number.
std::vector<ShownColumn> shown_columns(const compare::Table& table,
                                       std::string (*written)(double, Digits));
std::vector<ShownColumn> shown_columns(const compare::Table& table);  // as on a terminal
std::vector<ShownColumn> page_columns(const compare::Table& table);   // as on a page

// For the templates of pages: {"caption", "columns", "rows", "remarks", "folded"}.
nlohmann::ordered_json page_table(const compare::Table& table);

// Markdown; a text or cell of more than `longest` bytes is cut.
std::string markdown(std::string_view text, std::size_t longest);
std::string markdown(const compare::Table& table, std::size_t longest);

// For a terminal: the paragraphs `about`, each table with its caption and its notes, the notes, the
// reasons and the sentence of the verdict. A part without content leaves no line.
std::string text(const compare::Result& result);

// {"analysis", "verdict": {"grade", "sentence", "reasons", "compared"}, "about", "tables": {id: table},
// "charts": [{"id", "title", "table", "x", "y", "by", "log_x", "log_y"}], "notes"}; a chart of another kind than curves
// also has "kind", "only", "axis", "marks".
nlohmann::ordered_json json_of(const compare::Result& result);

// For a terminal: a line of headings and the rows, each column as wide as needed, words
// left-aligned, lengths in mm.
std::string text(const compare::Table& table);

}  // namespace elastocheck::reports
