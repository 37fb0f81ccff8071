// The price of accuracy as people and machines read it: terminal, CSV, JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/trade.hpp"

namespace elastocheck::reports {

std::string trade_table(const Model& model, const compare::Trade& trade);
std::string trade_csv(const compare::Trade& trade);  // one row per configuration, 17 significant digits
nlohmann::ordered_json trade_json(const compare::Trade& trade);  // a number that is not finite is null

}  // namespace elastocheck::reports
