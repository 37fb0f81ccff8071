// A table in a CSV file of somebody else's, line by line.
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

using Cells = std::vector<std::string_view>;  // trimmed, without the quotes around one
// Tells of the first line that has something in it, which names the columns, and of every further one. Throws SheetError: a
// line that has not as many cells as columns are named, more than `most` lines or 10 000 columns, what is UTF-16, or empty.
void read_sheet(std::string_view csv, const std::string& file, std::size_t most,
                const std::function<void(const Cells&, int line)>& head,
                const std::function<void(const Cells&, int line)>& row);

// Of a cell, a number with a decimal point: NaN where it is empty. Throws SheetError.
double number_in(std::string_view cell, const std::string& file, int line, const std::string& column);

}  // namespace elastocheck::reports
