// The series over its order: as people read it, as CSV, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/order_study.hpp"

namespace elastocheck::reports {

std::string order_table(const std::vector<compare::BranchOrders>& orders);
std::string orders_csv(const std::vector<compare::BranchOrders>& orders);
nlohmann::ordered_json orders_json(const std::vector<compare::BranchOrders>& orders);

}  // namespace elastocheck::reports
