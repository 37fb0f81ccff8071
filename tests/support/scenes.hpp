// The shipped scenes, and the same scene told differently: what must not matter to any solver.
#pragma once

#include <string>
#include <vector>

#include "models/scene.hpp"

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

// Everything turned by R and moved by t: ground frame, bodies, loads.
Scene moved(const Scene& scene, const Eigen::Quaterniond& R, const Eigen::Vector3d& t);

// The same bodies described in other body axes: body b's axes are turned by turns[b % size].
Scene with_body_axes(const Scene& scene, const std::vector<Eigen::Quaterniond>& turns);

// y → -y: the other side of the vehicle.
Scene mirrored(const Scene& scene);

// Bodies, joints and elements in reverse order.
Scene reversed(const Scene& scene);

}  // namespace elastocheck::support
