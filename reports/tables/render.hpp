// Renders a study's table (compare/tables/table.hpp) as CSV, JSON and text, and reads it back from JSON. A
// missing number is an empty cell, null, and a dash.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/tables/table.hpp"
#include "reports/json/json_cursor.hpp"

namespace elastocheck::reports {

// First line "error [mm],..."; numbers with the fewest digits that read back exactly.
std::string csv(const compare::Table& table);

// {"columns": [{"name", "unit", "description"}, ...], "rows": [[1.5, "text", null], ...]}
nlohmann::ordered_json table_json(const compare::Table& table);

// Reads the columns of `like`, found by name, in its order; other columns are ignored. Throws
// ResultError with the place of a missing column, another unit, or a cell of the wrong kind.
compare::Table read_table(const JsonCursor& field, const compare::Table& like);

// Number format for readers.
enum class Digits {
    whole,    // 120
    given,    // 1e-06: as entered
    size,     // 2.6e-13: an error, of which the magnitude matters
    three,    // 0.137
    percent,  // 13.7 %, of a share
};

// A displayed column.
struct ShownColumn {
    std::string column;
    Digits digits = Digits::whole;
    std::string heading = {};  // instead of the column's name
};

std::string heading(const compare::Table& table, const ShownColumn& shown);  // "error [mm]"

// The columns that are not empty.
std::vector<ShownColumn> nonempty_columns(const compare::Table& table,
                                          const std::vector<ShownColumn>& shown);

// For a terminal: a line of headings and the rows, each column as wide as needed, words
// left-aligned, without empty columns.
std::string text(const compare::Table& table, const std::vector<ShownColumn>& shown);

}  // namespace elastocheck::reports
