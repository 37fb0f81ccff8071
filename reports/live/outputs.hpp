// The outputs of a live page: those that solve() returns.
#pragma once

#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::live {

// Motions, drives, reactions; forces and deformations of elements; characteristics, which are last.
std::vector<compare::Channel> channels_of(const Model& model);

}  // namespace elastocheck::live
