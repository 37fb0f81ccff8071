// The page of `elastocheck live` and of `report --live`.
#pragma once

#include <string>

#include "reports/command/options/load_scene.hpp"

namespace elastocheck::reports {

// The page that `./dev live` builds, with a scene file embedded: its text with the settings, and the
// tables that it refers to. Throws std::invalid_argument where the page is not built, SceneError for a
// scene that is not valid.
std::string live_page(const std::string& scene, const Settings& settings);

}  // namespace elastocheck::reports
