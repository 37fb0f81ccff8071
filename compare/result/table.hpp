// A table: what text, CSV, JSON and page are made from, so that all formats agree. Rows of a study
// are structs, and describe() says once which columns their fields are.
#pragma once

#include <algorithm>
#include <concepts>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {

using Cell = std::variant<double, std::string>;  // a missing number is NaN

// How the cells of a column are shown to readers.
enum class Digits {
    hidden,
    words,
    note,       // words that explain the row: below it where the page is narrow
    whole,      // 120
    place,      // 21.33, -80: a parameter, a coordinate
    given,      // 1e-06: as entered
    size,       // 2.6e-13: an error, of which the magnitude matters
    three,      // 0.137
    four,       // 27.35; rounding is 0
    deviation,  // +0.137; rounding is 0: less than 1e-9 mm, deg, N, N·m
    rounded,    // 0.14, 14; likewise
    shaded,     // 0.14; on a page the darker the larger it is in its column
    percent,    // 14 %, of a share
};

// Description of a field of a row besides its name.
struct About {
    // "" without a unit, or where it differs from row to row (given in a column `unit`)
    const char* unit = "";
    const char* description = "";
    Digits digits = Digits::hidden;
    const char* heading = "";  // for readers, instead of the name
    int place = -1;  // for readers: beside the column at this place of the table; -1: its own
};

struct Column {
    std::string name, unit{}, description{};
    bool words = false;  // its cells are texts, not numbers
    Digits digits = Digits::hidden;
    std::string heading{};
    int place = -1;
};

struct Table {
    std::vector<Column> columns{};
    // one cell per column, of the column's kind; where a number has none, also words
    std::vector<std::vector<Cell>> rows{};
    // "sides": name of its file and in a document; empty: for readers alone. Tables of one id have the
    // same columns and are one table there, of which readers see the parts apart, each with its
    // caption and notes.
    std::string id{};
    std::string caption{};             // above it
    std::vector<std::string> notes{};  // below it
    bool detail = false;               // readers see it when they ask for it: not on a terminal
};

// A cell from a number of any kind or a text.
struct AnyCell {
    template <class Number>
    requires std::is_arithmetic_v<Number> &&(!std::same_as<Number, bool>)AnyCell(Number number)
        : cell(finite_or_nan(static_cast<double>(number))) {}
    AnyCell(std::string text) : cell(std::move(text)) {}
    AnyCell(const char* text) : cell(std::string(text)) {}
    Cell cell;
};

// A column of a table whose rows are made from structs S: its cell as a function of S. Columns that only
// programs read are Digits::hidden.
template <class S>
struct ColumnOf {
    std::string name;
    Digits digits = Digits::hidden;
    std::function<AnyCell(const S&)> cell;
    std::string description{}, unit{}, heading{};
};

// The table of a range of S; of std::vector<ColumnOf<S>>.
template <class S>
Table table(std::string id, const std::vector<ColumnOf<S>>& columns, const auto& range) {
    Table result{.id = std::move(id)};
    for (const auto& c : columns)
        result.columns.push_back({.name = c.name,
                                  .unit = c.unit,
                                  .description = c.description,
                                  .words = c.digits == Digits::words || c.digits == Digits::note,
                                  .digits = c.digits,
                                  .heading = c.heading});
    for (const S& s : range) {
        auto& row = result.rows.emplace_back();
        for (const auto& c : columns) row.push_back(c.cell(s).cell);
    }
    return result;
}

// The table with only these columns, in this order, all shown to readers, hidden ones as words. A name
// that the table lacks is left out.
Table with_columns(const Table& table, const std::vector<std::string>& names);

// The description of a struct S is a function
//     void describe(auto& field, Described<S> auto& s)
// that calls field(name, member, About) for every field, in order.
template <class T, class S>
concept Described = std::same_as<std::remove_const_t<T>, S>;

inline Cell cell_of(double value) { return value; }
inline Cell cell_of(const std::string& value) { return value; }
inline Cell cell_of(bool value) { return std::string(value ? "yes" : ""); }

template <class Row>
Table table_of(const std::vector<Row>& rows) {
    Table table;
    const auto column = [&](const char* name, const auto& value, const About& about = {}) {
        table.columns.push_back({name, about.unit, about.description,
                                 !std::is_same_v<decltype(value), const double&>, about.digits,
                                 about.heading, about.place});
    };
    const Row none{};
    describe(column, none);
    for (const auto& row : rows) {
        auto& cells = table.rows.emplace_back();
        const auto cell = [&](const char*, const auto& value, const About& = {}) {
            cells.push_back(cell_of(value));
        };
        describe(cell, row);
    }
    return table;
}

// Distinct values of a field, in the order of the rows.
template <class Row, class Field>
std::vector<Field> distinct(const std::vector<Row>& rows, Field Row::*field) {
    std::vector<Field> all;
    for (const auto& row : rows)
        if (std::ranges::find(all, row.*field) == all.end()) all.push_back(row.*field);
    return all;
}

// The rows with this value.
template <class Row, class Field>
std::vector<Row> where(std::vector<Row> rows, Field Row::*field,
                       const std::type_identity_t<Field>& value) {
    std::erase_if(rows, [&](const Row& row) { return row.*field != value; });
    return rows;
}

}  // namespace elastocheck::compare
