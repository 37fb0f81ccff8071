// Reader of external CSV tables, line by line.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// "FILE:line: column: what is wrong, what is allowed".
struct SheetError : std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] void fail_at(const std::string& file, int line,
                          const std::string& what);  // line 0: the file as a whole

using Cells = std::vector<std::string>;  // of a line, trimmed and without their quotes
// Calls `head` for the first line with content, which names the columns, and `row` for every
// further one; any separator that `reader::read_sheet` finds. Throws SheetError for a line with another
// number of cells, more than `max_rows` lines or 10 000 columns, UTF-16, or an empty table.
void read_csv_table(std::string_view csv, const std::string& file, std::size_t max_rows,
                    const std::function<void(const Cells&, int line)>& head,
                    const std::function<void(const Cells&, int line)>& row);

// Number in a cell, with a decimal point; NaN for an empty cell. Throws SheetError.
double number_in(std::string_view cell, const std::string& file, int line,
                 const std::string& column);
// Likewise; infinite for a cell such as nan or inf: a result that is given, but not finite.
double number_or_infinity(std::string_view cell, const std::string& file, int line,
                          const std::string& column);

}  // namespace elastocheck::reports
