#include "reports/files/csv_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reports {
namespace {

constexpr std::size_t most_columns = 10'000;

std::string_view trimmed(std::string_view word) {
    while (!word.empty() && (word.front() == ' ' || word.front() == '\t')) word.remove_prefix(1);
    while (!word.empty() && (word.back() == ' ' || word.back() == '\t' || word.back() == '\r'))
        word.remove_suffix(1);
    if (word.size() >= 2 && word.front() == '"' && word.back() == '"')
        word = word.substr(1, word.size() - 2);
    return word;
}

// End of the first cell of a line; commas between quotes do not count.
std::size_t end_of_cell(std::string_view line) {
    const auto begin = line.find_first_not_of(" \t");
    if (begin == line.npos || line[begin] != '"') return line.find(',');
    const auto close = line.find('"', begin + 1);
    return line.find(',', close == line.npos ? 0 : close);
}

Cells cells_of(std::string_view line, const std::string& file, int number) {
    Cells cells;
    for (;;) {
        const auto comma = end_of_cell(line);
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == line.npos) return cells;
        if (cells.size() == most_columns)
            fail_at(file, number,
                    fmt::format("more columns than {}, the most that are read", most_columns));
        line.remove_prefix(comma + 1);
    }
}

}  // namespace

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

void read_sheet(std::string_view csv, const std::string& file, std::size_t most,
                const std::function<void(const Cells&, int)>& head,
                const std::function<void(const Cells&, int)>& row) {
    // byte-order mark written by spreadsheets
    if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);
    if (csv.starts_with("\xFF\xFE") || csv.starts_with("\xFE\xFF"))
        fail_at(file, 0, "is UTF-16; save it as CSV in UTF-8");
    int number = 0;
    std::size_t columns = 0, rows = 0;
    for (std::string_view rest = csv; !rest.empty();) {
        ++number;
        const auto end = rest.find('\n');
        const std::string_view line = rest.substr(0, end);
        rest = end == rest.npos ? std::string_view{} : rest.substr(end + 1);
        if (trimmed(line).empty()) continue;
        const Cells cells = cells_of(line, file, number);
        if (columns == 0) {
            columns = cells.size();
            head(cells, number);
            continue;
        }
        if (cells.size() != columns)
            fail_at(file, number,
                    fmt::format("{} cells, but {} columns are named in the first line",
                                cells.size(), columns));
        if (rows == most)
            fail_at(file, number, fmt::format("more points than {}, the most that are read", most));
        ++rows;
        row(cells, number);
    }
    if (columns == 0) fail_at(file, 0, "empty; the first line names the columns");
    if (rows == 0) fail_at(file, 0, "no point in it");
}

}  // namespace elastocheck::reports
