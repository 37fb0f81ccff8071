// Gradients of a scene file, its trim included.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compare/sensitivity/sensitivity.hpp"
#include "reports/command/options/load_scene.hpp"

namespace elastocheck::reports {

// Derivatives of groups of outputs by numbers of the file with these settings, through its trim.
std::vector<compare::Gradients> gradients_of(const std::string& file, const Settings& settings,
                                             const LoadedScene& loaded,
                                             const compare::VaryingScene& varying,
                                             std::span<const compare::GradientGroup> groups);

// Options of `sensitivity`, as on its command line.
struct GradientsRequest {
    std::vector<std::string> of, to, branches;  // names or patterns with *; none: the defaults
    std::vector<std::string> at;                // BRANCH:VALUE
    int points = 4;                             // stations of a branch without one in `at`
    int threads = 1;
};
// Throws std::invalid_argument for a name without a match, with the nearest, and for a station that
// is not on its branch.
compare::Gradients gradients_of(const std::string& file, const Settings& settings,
                                const LoadedScene& loaded, const GradientsRequest& request,
                                const std::function<void(const std::string&)>& progress);

}  // namespace elastocheck::reports
