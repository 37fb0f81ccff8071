// What another solver found, beside the recursion.
#pragma once

#include <string>
#include <vector>

#include "reports/document/field.hpp"
#include "reports/page/page.hpp"
#include "reports/page/sections/common.hpp"

namespace elastocheck::reports {

// The points of every candidate on these branches, of a main channel, to be drawn over its curves; over the abscissa of the
// sweep where `travel`. A change counts from where the curves begin.
std::vector<Series> candidate_series(const Field& scene, const Sweep& sweep, const std::string& channel,
                                     bool change, bool travel);

}  // namespace elastocheck::reports
