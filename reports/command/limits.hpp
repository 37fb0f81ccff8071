// How much is taken on: said before the work, instead of running out of memory in it.
#pragma once

#include "models/model.hpp"

namespace elastocheck::reports {

// Of a branch, as in a scene. A million points of the paper's McPherson strut are 1.7 GB a leg and branch.
inline constexpr int most_steps = 1'000'000;
// What the points of a run may take together [bytes]: what an ordinary desk or CI machine has to spare.
inline constexpr double most_memory = 4e9;

// Bytes that one point of one leg takes: load, pose of every body, wrench of every joint, value of every
// channel; `written`: also as numbers and text of a result document.
double bytes_per_point(const Model& model, bool written);

// Throws std::invalid_argument when the points of `legs` legs over all branches take more than `most_memory`,
// and says how many steps would not. `steps` 0: as the branches say.
void check_memory(const Model& model, int steps, int legs, bool written);

}  // namespace elastocheck::reports
