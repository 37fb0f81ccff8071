// Structure of a model: the kinds of its parts and what they connect, without its numbers.
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck {

// Replaces `list` by integers for kinds, bodies, laws, formulations, branches, their sides and drivers:
// models with equal lists differ in their numbers only.
void structure(const Model& model, std::vector<int>& list);

}  // namespace elastocheck
