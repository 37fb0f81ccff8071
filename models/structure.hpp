// Whether two models differ in their numbers only: the kinds of their parts and what they connect.
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck {

// The structure of a model as a list of numbers: kinds, bodies, laws, formulations, branches, their
// sides and what they drive.
void structure(const Model& model, std::vector<int>& list);

}  // namespace elastocheck
