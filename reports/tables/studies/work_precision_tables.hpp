// Work-precision comparison as terminal text and as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/studies/work_precision.hpp"

namespace elastocheck::reports {

std::string trade_text(const Model& model, const compare::Trade& trade);

// {tolerance, output_points, rounds, reference_uncertainty, time_noise, points, recommendation,
// not_confirmed, inconclusive}: `points` is of compare::TradeRow, `position` in the recommendation
// is a row of it.
nlohmann::ordered_json trade_json(const compare::Trade& trade);

}  // namespace elastocheck::reports
