// Section and curves of an external solver.
#pragma once

#include <string>
#include <vector>

#include "reports/json/json_cursor.hpp"
#include "reports/page/common.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Points of every candidate on these branches for one main channel, drawn over its curves; over the
// abscissa of the sweep if `travel`. A change is relative to the start of the curves.
std::vector<Series> candidate_series(const JsonCursor& scene, const Sweep& sweep,
                                     const std::string& channel, bool change, bool travel);

}  // namespace elastocheck::reports
