// The page of `elastocheck live` and of `report --live`.
#pragma once

#include <string>

#include "reports/command/options/load_scene.hpp"

namespace elastocheck::reports {

// The page that `./dev live` builds, with the scene of a file, settings and the tables that it refers
// to in it. Throws std::invalid_argument where the page is not built, SceneError for a scene that is
// not valid.
std::string live_page(const std::string& scene, const Settings& settings);

}  // namespace elastocheck::reports
