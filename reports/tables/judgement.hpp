// Pass or fail in one sentence, the same on the terminal, on the page and in result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/judgement.hpp"

namespace elastocheck::reports {

std::string sentence(const compare::Assessment& judgement);

//   verdict         "pass", "fail", "not judged"
//   sentence        as above
//   method          of the recursion
//   tolerance       mm, deg, and whether it was asked for or is the default
//   position, angle and position_across, angle_across (at equal abscissa): channel, branch, unit, max
//   wheel_rate      branch, wheel, to, unit, off
//   reasons         why not judged
nlohmann::ordered_json judgement_json(const compare::Assessment& judgement);

}  // namespace elastocheck::reports
