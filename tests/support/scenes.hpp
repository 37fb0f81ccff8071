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

// Of these the ones that ask for no trim: closed forms and studies, small enough to be solved in every way there is.
std::vector<std::string> small_scene_names();
// And the ones that do: a suspension as it stands under a car. tests/compare/scenes_test.cpp solves them.
std::vector<std::string> family_names();

// Whether every load and formulation has an energy, so that the energy leg answers.
bool has_potential(const Scene& scene);

// models/scenes/NAME.yaml, which is in m and N, with its numbers rewritten and read in mm and kN.
Scene in_millimetres_and_kilonewtons(const std::string& name);

// A general axle corner: eight kinds of joints, bushings with full 6×6 rates and preload,
// preloaded springs, a static load, a load of force and moment together, body axes different
// from ground axes.
Scene rich_scene();

}  // namespace elastocheck::support
