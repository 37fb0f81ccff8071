#include "reports/tables/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reports/tables/select.hpp"
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
    Table table{like.name, like.columns, {}};
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

std::string heading(const Table& table, const ShownColumn& shown) {
    const Column& of = table.columns[column(table, shown.column)];
    return with_unit(shown.heading.empty() ? of.name : shown.heading, of.unit);
}

std::vector<ShownColumn> nonempty_columns(const Table& table,
                                          const std::vector<ShownColumn>& shown) {
    std::vector<ShownColumn> some;
    for (const auto& s : shown) {
        const std::size_t c = column(table, s.column);
        if (!std::ranges::all_of(table.rows, [&](const auto& row) { return empty(row[c]); }))
            some.push_back(s);
    }
    return some;
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

std::string text(const Table& given, const std::vector<ShownColumn>& shown) {
    const Table table = in_mm(given);
    const auto columns = nonempty_columns(table, shown);
    std::vector<std::vector<std::string>> lines(table.rows.size() + 1);
    std::vector<std::size_t> places, widths;
    for (const auto& s : columns) {
        const std::size_t c = column(table, s.column);
        lines[0].push_back(heading(table, s));
        for (std::size_t r = 0; r < table.rows.size(); ++r) {
            const Cell& cell = table.rows[r][c];
            const auto* value = std::get_if<double>(&cell);
            lines[r + 1].push_back(value != nullptr ? written(*value, s.digits)
                                                    : std::get<std::string>(cell));
        }
        std::size_t widest = 0;
        for (const auto& line : lines) widest = std::max(widest, width(line.back()));
        places.push_back(c);
        widths.push_back(widest);
    }
    std::string all;
    for (const auto& line : lines) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            const std::string gap(widths[c] - width(line[c]), ' ');
            all += table.columns[places[c]].words ? "  " + line[c] + gap : "  " + gap + line[c];
        }
        all.erase(all.find_last_not_of(' ') + 1);
        all += "\n";
    }
    return all;
}

}  // namespace elastocheck::reports
