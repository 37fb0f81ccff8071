#include "reports/render/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace elastocheck::reports {
namespace {

using compare::Cell;
using compare::Column;
using compare::Table;

bool empty(const Cell& cell) {
    if (const auto* value = std::get_if<double>(&cell)) return !std::isfinite(*value);
    return std::get<std::string>(cell).empty();
}

bool below_rounding(double value) { return std::abs(value) < 1e-9; }

std::string share(double value) {
    const double percent = 100 * value;
    if (below_rounding(value)) return "0";
    if (percent > 1000) return ">1000 %";
    if (std::abs(percent) < 0.001) return "<0.001 %";
    return percent < 10 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string written(double value, Digits digits) {
    if (!std::isfinite(value)) return "-";
    switch (digits) {
        case Digits::whole: return fmt::format("{:.0f}", value);
        case Digits::given: return fmt::format("{:g}", value);
        case Digits::size: return value == 0 ? "0" : fmt::format("{:.1e}", value);
        case Digits::three: return fmt::format("{:.3g}", value);
        case Digits::place: return fmt::format("{:.4g}", value);
        case Digits::four: return below_rounding(value) ? "0" : fmt::format("{:.4g}", value);
        case Digits::deviation: return below_rounding(value) ? "0" : fmt::format("{:+.3g}", value);
        case Digits::rounded:
        case Digits::shaded:
            return below_rounding(value) ? "0"
                   : value < 10          ? fmt::format("{:.2g}", value)
                                         : fmt::format("{:.0f}", value);
        case Digits::percent: return share(value);
        case Digits::hidden:
        case Digits::note:
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

std::string with_unit(const std::string& name, const std::string& unit) {
    return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
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
        const Column& column = table.columns[c];
        if (column.digits == Digits::hidden ||
            std::ranges::all_of(table.rows, [&](const auto& row) { return empty(row[c]); }))
            continue;
        shown.push_back(
            {with_unit(column.heading.empty() ? column.name : column.heading, column.unit),
             column.words,
             column.digits == Digits::note,
             {},
             {}});
        double largest = 0;
        for (const auto& row : table.rows)
            if (const auto* value = std::get_if<double>(&row[c]); column.digits == Digits::shaded)
                largest = std::max(largest, value != nullptr ? *value : 0);
        for (const auto& row : table.rows) {
            const auto* value = std::get_if<double>(&row[c]);
            if (largest > 0)
                shown.back().shades.push_back(value != nullptr && *value > 0 ? *value / largest
                                                                             : 0);
            shown.back().cells.push_back(value != nullptr ? written(*value, column.digits)
                                                          : std::get<std::string>(row[c]));
        }
    }
    return shown;
}

std::vector<ShownColumn> shown_columns(const Table& table) { return shown_columns(table, written); }

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

std::string text(const compare::Result& result) {
    std::string written;
    const auto line = [&](const std::string& what) {
        if (!what.empty()) written += what + "\n";
    };
    const auto gap = [&] {
        if (!written.empty() && !written.ends_with("\n\n")) written += "\n";
    };
    for (const auto& paragraph : result.about) {
        line(paragraph);
        gap();
    }
    for (const auto& table : result.tables) {
        if (table.detail) continue;
        const std::string rows = table.rows.empty() ? "" : text(table);
        if (rows.find_first_not_of('\n') == std::string::npos && table.caption.empty() &&
            table.notes.empty())
            continue;
        line(table.caption);
        if (rows.find_first_not_of('\n') != std::string::npos) written += rows;
        for (const auto& note : table.notes) line("  " + note);
        gap();
    }
    for (const auto& note : result.notes) line(note);
    if (!result.notes.empty()) gap();
    for (const auto& reason : result.verdict.reasons) line("inconclusive: " + reason);
    line(result.verdict.sentence);
    while (written.ends_with("\n\n")) written.pop_back();
    return written;
}

}  // namespace elastocheck::reports
