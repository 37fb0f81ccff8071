// A table: what text, CSV, JSON and page are made from, so that all formats agree. Its rows are structs;
// a list of ColumnOf says once which columns they have.
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

struct Column {
    std::string name, unit{}, description{};
    bool words = false;  // its cells are texts, not numbers
    Digits digits = Digits::hidden;
    std::string heading{};
    int place = -1;  // for readers: beside the column at this place of the table; -1: its own
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
    template <std::same_as<bool> Truth>
    AnyCell(Truth truth) : cell(std::string(truth ? "yes" : "")) {}
    AnyCell(std::string text) : cell(std::move(text)) {}
    AnyCell(const char* text) : cell(std::string(text)) {}
    Cell cell;
};

// A column of a table whose rows are made from structs S, and its cell: a member of S or a function of
// it. No unit where it differs from row to row (given in a column `unit`). `heading`: for readers,
// instead of the name. Those for programs alone are Digits::hidden.
template <class S>
struct ColumnOf {
    std::string name;
    Digits digits = Digits::hidden;
    std::function<AnyCell(const S&)> cell;
    std::string description{}, unit{}, heading{};
    int place = -1;
};

// The table of a range of S, of these columns; `head` has its id, caption and notes.
template <class S>
Table table(Table head, const std::vector<ColumnOf<S>>& columns, const auto& range) {
    for (const auto& c : columns)
        head.columns.push_back({.name = c.name,
                                .unit = c.unit,
                                .description = c.description,
                                .words = c.digits == Digits::words || c.digits == Digits::note,
                                .digits = c.digits,
                                .heading = c.heading,
                                .place = c.place});
    for (const S& s : range) {
        auto& row = head.rows.emplace_back();
        for (const auto& c : columns) row.push_back(c.cell(s).cell);
    }
    return head;
}

// The table with only these columns, in this order, all shown to readers; a hidden one must be of texts.
// A name that the table lacks is left out.
Table with_columns(const Table& table, const std::vector<std::string>& names);

// The table of rows that say their columns themselves, in a function Row::columns().
template <class Row>
Table table_of(const std::vector<Row>& rows) {
    return table({}, Row::columns(), rows);
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
