// The page of `elastocheck live` and of `report --live`.
#pragma once

#include <string>

#include "reports/command/grammar/command.hpp"

namespace elastocheck::reports {

// The page that `./dev live` builds, with the scene of a file and settings in it. Throws
// std::invalid_argument where the page is not built, SceneError for a scene that it could not open:
// one that is not valid, or refers to table files.
std::string live_page(const std::string& scene, const Settings& settings);

}  // namespace elastocheck::reports
