#include "reports/files/csv_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/tables/sheet.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

void fail_at(const std::string& file, int line, const std::string& what) {
    throw SheetError(line > 0 ? fmt::format("{}:{}: {}", file, line, what)
                              : fmt::format("{}: {}", file, what));
}

double number_in(std::string_view cell, const std::string& file, int line,
                 const std::string& column) {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (const auto value = finite_number(cell)) return *value;
    fail_at(
        file, line,
        fmt::format("{}: {} is not a number; allowed: a number with a decimal point, or nothing",
                    column, reader::quote(cell)));
}

double number_or_infinity(std::string_view cell, const std::string& file, int line,
                          const std::string& column) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc{} && end == cell.data() + cell.size() && !std::isfinite(value))
        return std::numeric_limits<double>::infinity();
    return number_in(cell, file, line, column);
}

void read_csv_table(std::string_view csv, const std::string& file, std::size_t max_rows,
                    const std::function<void(const Cells&, int)>& head,
                    const std::function<void(const Cells&, int)>& row) {
    if (file.ends_with(".yaml") || file.ends_with(".yml"))
        fail_at(file, 0, "is YAML; expected a table, CSV with the names of its columns first");
    const reader::Sheet sheet = [&] {
        try {
            return reader::read_sheet(csv, file, 2);
        } catch (const SceneError& error) {
            throw SheetError(error.what());
        }
    }();
    if (sheet.rows.empty()) fail_at(file, 0, "empty; the first line names the columns");
    const std::size_t columns = sheet.rows.front().cells.size();
    head(sheet.rows.front().cells, sheet.rows.front().line);
    if (sheet.rows.size() == 1) fail_at(file, 0, "no point in it");
    if (sheet.rows.size() > max_rows + 1)
        fail_at(file, sheet.rows[max_rows + 1].line,
                fmt::format("more points than {}, the most that are read", max_rows));
    for (const reader::SheetRow& read : std::span(sheet.rows).subspan(1)) {
        if (read.cells.size() != columns)
            fail_at(file, read.line,
                    fmt::format("{} cells, but {} columns are named in the first line",
                                read.cells.size(), columns));
        row(read.cells, read.line);
    }
}

}  // namespace elastocheck::reports
