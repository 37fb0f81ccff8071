#include "reports/tables/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::Cell;
using compare::Column;
using compare::Table;
using json = nlohmann::ordered_json;

std::string with_unit(const std::string& name, const std::string& unit) {
    return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

bool empty(const Cell& cell) {
    if (const auto* value = std::get_if<double>(&cell)) return !std::isfinite(*value);
    return std::get<std::string>(cell).empty();
}

std::string written(double value, Digits digits) {
    if (!std::isfinite(value)) return "-";
    switch (digits) {
        case Digits::whole: return fmt::format("{:.0f}", value);
        case Digits::given: return fmt::format("{:g}", value);
        case Digits::size: return value == 0 ? "0" : fmt::format("{:.1e}", value);
        case Digits::three: return fmt::format("{:.3g}", value);
        case Digits::percent: return fmt::format("{:.1f} %", 100 * value);
        case Digits::hidden:
        case Digits::words: break;
    }
    return {};
}

// Characters, not bytes: most characters allowed in names are one column wide.
std::size_t width(std::string_view text) {
    return static_cast<std::size_t>(std::ranges::count_if(
        text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string csv(const Table& table) {
    std::string lines;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        lines += fmt::format("{}{}", c > 0 ? "," : "",
                             for_csv(with_unit(table.columns[c].name, table.columns[c].unit)));
    lines += "\n";
    for (const auto& row : table.rows) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            const auto* value = std::get_if<double>(&row[c]);
            lines += fmt::format(
                "{}{}", c > 0 ? "," : "",
                value != nullptr ? exact(*value) : for_csv(std::get<std::string>(row[c])));
        }
        lines += "\n";
    }
    return lines;
}

json table_json(const Table& table) {
    json columns = json::array(), rows = json::array();
    for (const auto& column : table.columns)
        columns.push_back(
            {{"name", column.name}, {"unit", column.unit}, {"description", column.description}});
    for (const auto& row : table.rows) {
        json cells = json::array();
        for (const auto& cell : row)
            std::visit([&](const auto& value) { cells.push_back(value); }, cell);
        rows.push_back(std::move(cells));
    }
    return {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

Table read_table(const JsonCursor& field, const Table& like) {
    Table table{like.columns, {}};
    std::vector<std::string> names, units;
    for (const auto& column : field["columns"].items()) {
        names.push_back(column["name"].text());
        units.push_back(column["unit"].text());
    }
    std::vector<std::size_t> places;
    for (const auto& column : like.columns) {
        const auto found = std::ranges::find(names, column.name);
        if (found == names.end()) field["columns"].fail(fmt::format("no column '{}'", column.name));
        places.push_back(static_cast<std::size_t>(found - names.begin()));
        if (units[places.back()] != column.unit)
            field["columns"].fail(fmt::format("column '{}' is in '{}', not in '{}'", column.name,
                                              units[places.back()], column.unit));
    }
    for (const auto& row : field["rows"].items()) {
        const auto cells = row.items();
        if (cells.size() != names.size()) row.fail("not as many cells as columns");
        auto& read = table.rows.emplace_back();
        for (std::size_t c = 0; c < places.size(); ++c)
            read.push_back(like.columns[c].words ? Cell(cells[places[c]].text())
                                                 : Cell(cells[places[c]].number()));
    }
    return table;
}

std::vector<ShownColumn> shown_columns(const Table& table, std::string (*written)(double, Digits)) {
    const auto place = [&](std::size_t c) {
        return table.columns[c].place < 0 ? static_cast<int>(c) : table.columns[c].place;
    };
    std::vector<std::size_t> order(table.columns.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, place);
    std::vector<ShownColumn> shown;
    for (const std::size_t c : order) {
        const Column& of = table.columns[c];
        if (of.digits == Digits::hidden ||
            std::ranges::all_of(table.rows, [&](const auto& row) { return empty(row[c]); }))
            continue;
        shown.push_back(
            {with_unit(of.heading.empty() ? of.name : of.heading, of.unit), of.words, {}});
        for (const auto& row : table.rows) {
            const auto* value = std::get_if<double>(&row[c]);
            shown.back().cells.push_back(value != nullptr ? written(*value, of.digits)
                                                          : std::get<std::string>(row[c]));
        }
    }
    return shown;
}

namespace {

// Lengths in mm, as everywhere on a terminal; tables of studies have tolerances and |Φ| in m.
Table in_mm(Table table) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        if (table.columns[c].unit != "m") continue;
        table.columns[c].unit = "mm";
        for (auto& row : table.rows) row[c] = 1e3 * std::get<double>(row[c]);
    }
    return table;
}

}  // namespace

std::string text(const Table& table) {
    std::vector<std::string> lines(table.rows.size() + 1);
    for (const auto& column : shown_columns(in_mm(table), written)) {
        std::size_t widest = width(column.heading);
        for (const auto& cell : column.cells) widest = std::max(widest, width(cell));
        for (std::size_t r = 0; r < lines.size(); ++r) {
            const std::string& cell = r == 0 ? column.heading : column.cells[r - 1];
            const std::string gap(widest - width(cell), ' ');
            lines[r] += column.words ? "  " + cell + gap : "  " + gap + cell;
        }
    }
    std::string all;
    for (auto& line : lines) all += line.erase(line.find_last_not_of(' ') + 1) + "\n";
    return all;
}

}  // namespace elastocheck::reports
