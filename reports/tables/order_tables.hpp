// The series over its order, as people read it on a terminal.
#pragma once

#include <string>
#include <vector>

#include "reports/tables/render.hpp"

namespace elastocheck::reports {

extern const std::vector<Shown> order_columns;  // of compare::order_table, on the terminal and the page

std::string order_text(const compare::Table& orders);

}  // namespace elastocheck::reports
