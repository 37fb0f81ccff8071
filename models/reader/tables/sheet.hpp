// Rows and cells of a table as spreadsheets export it (CSV of any separator).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reader {

struct SheetRow {
    static constexpr std::size_t max_cells = 10'000;
    int line = 0;                    // in the file, of its beginning, from 1
    std::vector<std::string> cells;  // trimmed, without quotes; line ends within a cell are blanks

    // The cell, empty beyond the end of the row.
    std::string_view at(std::size_t column) const {
        return column < cells.size() ? std::string_view(cells[column]) : std::string_view();
    }
};

struct Sheet {
    char separator = ',';
    std::vector<SheetRow> rows;  // those with content
};

// The separator is that of a first line "sep=;", otherwise that of semicolon, tab and comma which gives most
// rows of at least `columns` cells, the earlier one of equals. Quotes count at the beginning of a cell.
// Throws SceneError for a quote that does not end, for UTF-16, and for rows of more than 10 000 cells.
Sheet read_sheet(std::string_view text, const std::string& file, std::size_t columns);

// "A", "B", ..., "Z", "AA", ... as spreadsheets name the column.
std::string letters_of(std::size_t column);

}  // namespace elastocheck::reader
