#include "reports/tables/select.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace elastocheck::reports {
namespace {

using compare::Cell;
using compare::Table;

// NaN equals NaN here: both are missing.
bool same(const Cell& a, const Cell& b) {
    const auto *x = std::get_if<double>(&a), *y = std::get_if<double>(&b);
    return x != nullptr && y != nullptr ? *x == *y || (*x != *x && *y != *y) : a == b;
}

std::string said(const Cell& cell) {
    const auto* value = std::get_if<double>(&cell);
    return value != nullptr ? fmt::format("{:g}", *value) : std::get<std::string>(cell);
}

}  // namespace

std::size_t column(const Table& table, std::string_view name) {
    const auto found = std::ranges::find(table.columns, name, &compare::Column::name);
    if (found == table.columns.end())
        throw std::logic_error(fmt::format("table '{}' has no column '{}'", table.name, name));
    return static_cast<std::size_t>(found - table.columns.begin());
}

double number(const Table& table, std::size_t row, std::string_view name) {
    return std::get<double>(table.rows[row][column(table, name)]);
}

const std::string& words(const Table& table, std::size_t row, std::string_view name) {
    return std::get<std::string>(table.rows[row][column(table, name)]);
}

std::vector<std::string> distinct(const Table& table, std::string_view name) {
    std::vector<std::string> all;
    for (std::size_t r = 0; r < table.rows.size(); ++r)
        if (const auto& word = words(table, r, name); std::ranges::find(all, word) == all.end())
            all.push_back(word);
    return all;
}

Table where(const Table& table, std::string_view name, const std::string& value) {
    Table some{table.name, table.columns, {}};
    for (std::size_t r = 0; r < table.rows.size(); ++r)
        if (words(table, r, name) == value) some.rows.push_back(table.rows[r]);
    return some;
}

Table only(const Table& table, const std::vector<std::string>& names) {
    Table some{table.name, {}, std::vector<std::vector<Cell>>(table.rows.size())};
    for (const auto& name : names) {
        const std::size_t c = column(table, name);
        some.columns.push_back(table.columns[c]);
        for (std::size_t r = 0; r < table.rows.size(); ++r)
            some.rows[r].push_back(table.rows[r][c]);
    }
    return some;
}

Table spread(const Table& table, std::string_view across, const std::vector<std::string>& values) {
    std::vector<std::size_t> keys, moved;
    for (const auto& value : values) moved.push_back(column(table, value));
    const std::size_t by = column(table, across);
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (c != by && std::ranges::find(moved, c) == moved.end()) keys.push_back(c);

    Table wide{table.name, {}, {}};
    for (const std::size_t c : keys) wide.columns.push_back(table.columns[c]);
    std::vector<std::string> blocks;
    for (const auto& row : table.rows)
        if (const auto block = said(row[by]); std::ranges::find(blocks, block) == blocks.end())
            blocks.push_back(block);
    for (const auto& block : blocks)
        for (const std::size_t c : moved) {
            wide.columns.push_back(table.columns[c]);
            wide.columns.back().name = fmt::format("{}: {}", block, table.columns[c].name);
        }
    for (const auto& row : table.rows) {
        auto into = std::ranges::find_if(wide.rows, [&](const auto& other) {
            for (std::size_t k = 0; k < keys.size(); ++k)
                if (!same(other[k], row[keys[k]])) return false;
            return true;
        });
        if (into == wide.rows.end()) {
            std::vector<Cell> fresh;
            for (const std::size_t c : keys) fresh.push_back(row[c]);
            for (std::size_t c = keys.size(); c < wide.columns.size(); ++c)
                fresh.push_back(wide.columns[c].words
                                    ? Cell(std::string())
                                    : Cell(std::numeric_limits<double>::quiet_NaN()));
            wide.rows.push_back(std::move(fresh));
            into = wide.rows.end() - 1;
        }
        const auto block =
            static_cast<std::size_t>(std::ranges::find(blocks, said(row[by])) - blocks.begin());
        for (std::size_t k = 0; k < moved.size(); ++k)
            (*into)[keys.size() + block * moved.size() + k] = row[moved[k]];
    }
    return wide;
}

}  // namespace elastocheck::reports
