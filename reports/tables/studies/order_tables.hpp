// Study of the series over its order as terminal text.
#pragma once

#include <string>
#include <vector>

#include "compare/tables/rows.hpp"

namespace elastocheck::reports {

std::string order_text(const std::vector<compare::OrderRow>& orders);

}  // namespace elastocheck::reports
