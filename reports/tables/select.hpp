// Rows and cells of a study's table (compare/tables/table.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/tables/table.hpp"

namespace elastocheck::reports {

// Position of a column. Throws std::logic_error for an unknown name.
std::size_t column(const compare::Table& table, std::string_view name);

double number(const compare::Table& table, std::size_t row, std::string_view name);
const std::string& words(const compare::Table& table, std::size_t row, std::string_view name);

// Distinct values of a column of words, in the order of the rows.
std::vector<std::string> distinct(const compare::Table& table, std::string_view name);

// The rows with `value` in this column.
compare::Table where(const compare::Table& table, std::string_view name, const std::string& value);

// These columns, in this order.
compare::Table only(const compare::Table& table, const std::vector<std::string>& names);

// Pivot: the columns `values`, once per distinct value of column `across`, named "float: error",
// and one row per combination of the other columns. Missing entries are NaN or empty.
compare::Table spread(const compare::Table& table, std::string_view across,
                      const std::vector<std::string>& values);

}  // namespace elastocheck::reports
