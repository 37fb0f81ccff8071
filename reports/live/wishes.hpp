// Wanted values of several figures by several numbers, for a live page: compare/design/solve_for by
// the series, with central differences for gradients.
#pragma once

#include <string_view>

#include "reports/live/engine.hpp"

namespace elastocheck::live {

// `request`: {"settings": [[path, value], ...],
//   "vary": [[path, low, high], ...]                    limits in the units of the file
//   "want": [[output, branch, parameter, value], ...]}  in the units of the branch and of the output
// Throws std::invalid_argument for another request, for a path or a figure that the scene has not, and
// as read_scene() for limits that it does not accept. The answer:
//   met, converged   as in Solution
//   numbers          path, from, to, at_limit: -1 the lower, 1 the upper, else 0
//   figures          name, branch, a, unit, target, before, after, still: no number moves it,
//                    conflict: share of this wish; values null where there is none
//   why_not          reason why a figure has no value at the start; else absent
nlohmann::ordered_json wish(Session& session, std::string_view request);

}  // namespace elastocheck::live
