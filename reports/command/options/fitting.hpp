// Fit of a scene's numbers to measured curves: what `fit` and the Python module share.
#pragma once

#include <string>
#include <vector>

#include "compare/design/results.hpp"
#include "reports/command/options/design_options.hpp"

namespace elastocheck::reports {

struct FitInput {
    std::string scene;
    Settings settings;
    std::vector<std::string> vary;
    std::string measured, map;  // files; no map: empty
    bool robust = false;
    int threads = 1;
};

// Where there is no fit, the reason is in Fitted::why_not. Throws SheetError, SceneError, FileError, and
// std::invalid_argument as parse_varied().
compare::FittedScene fitted(const FitInput& input, const LoadedScene& loaded);

}  // namespace elastocheck::reports
