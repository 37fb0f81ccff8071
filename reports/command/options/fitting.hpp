// Fit of a scene's numbers to measured curves: what `fit` and the Python module share.
#pragma once

#include <string>

#include "reports/command/options/design_options.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/tables/studies/design_tables.hpp"

namespace elastocheck::reports {

struct FitInput {
    std::string scene;
    Settings settings;
    std::string measured, map;  // files; no map: empty
    bool robust = false;
    int threads = 1;
};

// Where there is no fit, the reason is in Fitted::why_not. Throws SheetError, SceneError, FileError.
FittedScene fitted(const FitInput& input, const LoadedScene& loaded, const Varied& varied);

}  // namespace elastocheck::reports
