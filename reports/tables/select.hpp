// Rows and cells of a study's table (compare/table.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/table.hpp"

namespace elastocheck::reports {

// Position of a column. Throws std::logic_error where the table has none of that name.
std::size_t column(const compare::Table& table, std::string_view name);

double number(const compare::Table& table, std::size_t row, std::string_view name);
const std::string& words(const compare::Table& table, std::size_t row, std::string_view name);

// What a column of words says, each once, in the order of the rows.
std::vector<std::string> distinct(const compare::Table& table, std::string_view name);

// The rows in which it says `value`.
compare::Table where(const compare::Table& table, std::string_view name, const std::string& value);

// These columns, in this order.
compare::Table only(const compare::Table& table, const std::vector<std::string>& names);

// Side by side what stands one below the other: columns `values` once for each word or number of column `across`, named
// "float: error", and one row for those that agree in all other columns. What is not there is NaN or empty.
compare::Table spread(const compare::Table& table, std::string_view across,
                      const std::vector<std::string>& values);

}  // namespace elastocheck::reports
