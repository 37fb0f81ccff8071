#include "reports/files/csv_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "models/reader/document/suggestions.hpp"
#include "models/reader/tables/csv.hpp"

namespace elastocheck::reports {

void fail_at(const std::string& file, int line, const std::string& what) {
    throw SheetError(line > 0 ? fmt::format("{}:{}: {}", file, line, what)
                              : fmt::format("{}: {}", file, what));
}

double number_in(std::string_view cell, const std::string& file, int line,
                 const std::string& column) {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
        fail_at(file, line,
                fmt::format(
                    "{}: {} is not a number; allowed: a number with a decimal point, or nothing",
                    column, reader::quote(cell)));
    return value;
}

double number_or_none(std::string_view cell, const std::string& file, int line,
                      const std::string& column) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc{} && end == cell.data() + cell.size() && !std::isfinite(value))
        return std::numeric_limits<double>::infinity();
    return number_in(cell, file, line, column);
}

void read_sheet(std::string_view csv, const std::string& file, std::size_t max_rows,
                const std::function<void(const Cells&, int)>& head,
                const std::function<void(const Cells&, int)>& row) {
    if (csv.starts_with("\xFF\xFE") || csv.starts_with("\xFE\xFF"))
        fail_at(file, 0, "is UTF-16; save it as CSV in UTF-8");
    if (file.ends_with(".yaml") || file.ends_with(".yml"))
        fail_at(file, 0, "is YAML; expected a table, CSV with the names of its columns first");
    std::size_t columns = 0, rows = 0;
    for (reader::CsvLines lines(csv); lines.next();) {
        const int number = lines.number();
        const Cells cells = lines.cells();
        if (cells.size() > lines.max_cells)
            fail_at(file, number,
                    fmt::format("more columns than {}, the most that are read", lines.max_cells));
        if (columns == 0) {
            columns = cells.size();
            head(cells, number);
            continue;
        }
        if (cells.size() != columns)
            fail_at(file, number,
                    fmt::format("{} cells, but {} columns are named in the first line",
                                cells.size(), columns));
        if (rows == max_rows)
            fail_at(file, number,
                    fmt::format("more points than {}, the most that are read", max_rows));
        ++rows;
        row(cells, number);
    }
    if (columns == 0) fail_at(file, 0, "empty; the first line names the columns");
    if (rows == 0) fail_at(file, 0, "no point in it");
}

}  // namespace elastocheck::reports
