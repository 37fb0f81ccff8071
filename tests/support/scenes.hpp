// The scenes of models/scenes, a rich one built in code, and invariance transforms.
#pragma once

#include <string>
#include <vector>

#include "elastocheck/scene.hpp"
#include "tests/support/transforms.hpp"

namespace elastocheck::support {

// models/scenes/NAME.yaml
Scene scene(const std::string& name);
std::vector<std::string> scene_names();

// The scenes without a trim: closed forms and studies, small enough for every leg and method.
std::vector<std::string> small_scene_names();
// The scenes with a trim: suspensions under the weight of a car, which tests/compare/scenes_test.cpp solves.
std::vector<std::string> trimmed_scene_names();

// Whether every load and bushing formulation has an energy, so that the energy leg can solve the scene.
bool has_potential(const Scene& scene);

// models/scenes/NAME.yaml with its units changed from m and N to mm and kN and its numbers converted.
Scene in_millimetres_and_kilonewtons(const std::string& name);

// A general axle corner: eight kinds of joints, bushings with full 6×6 rates and preload,
// preloaded springs, a static load, a load of force and moment together, body axes different
// from ground axes.
Scene rich_scene();

}  // namespace elastocheck::support
