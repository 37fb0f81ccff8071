// Study of the series over its order as terminal text.
#pragma once

#include <string>
#include <vector>

#include "reports/tables/render.hpp"

namespace elastocheck::reports {

// of compare::order_table, on the terminal and the page
extern const std::vector<ShownColumn> order_columns;

std::string order_text(const compare::Table& orders);

}  // namespace elastocheck::reports
