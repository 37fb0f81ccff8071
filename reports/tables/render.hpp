// A study's table (compare/table.hpp) in each format: CSV, JSON, read back from JSON, and as people read it.
// A number that is not there is an empty cell, null, and a dash.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/table.hpp"
#include "reports/document/field.hpp"

namespace elastocheck::reports {

// First line "error [mm],..."; numbers by the fewest digits that read back as the same.
std::string csv(const compare::Table& table);

// {"columns": [{"name", "unit", "description"}, ...], "rows": [[1.5, "text", null], ...]}
nlohmann::ordered_json table_json(const compare::Table& table);

// The columns of `like`, which are found by name, in its order; others are passed over. Throws ResultError
// with the place where a column is missing, has another unit, or a cell is not of its kind.
compare::Table read_table(const Field& field, const compare::Table& like);

// How a number is written for people.
enum class Digits {
    whole,    // 120
    given,    // 1e-06: as somebody gave it
    size,     // 2.6e-13: an error, whose size matters
    three,    // 0.137
    percent,  // 13.7 %, of a share
};

// A column that people are shown, of many.
struct Shown {
    std::string column;
    Digits digits = Digits::whole;
    std::string heading = {};  // instead of the column's name
};

std::string heading(const compare::Table& table, const Shown& shown);  // "error [mm]"

// Those in which something stands.
std::vector<Shown> filled(const compare::Table& table, const std::vector<Shown>& shown);

// For a terminal: a line of headings and the rows, each column as wide as it needs, words flush left. Columns in
// which nothing stands are left out.
std::string text(const compare::Table& table, const std::vector<Shown>& shown);

}  // namespace elastocheck::reports
