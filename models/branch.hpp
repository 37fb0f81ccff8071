// A branch and the model it is walked on.
#pragma once

#include <vector>

#include "models/model.hpp"

namespace elastocheck {

// The one-way branches that a branch is walked as, each from a = 0: to `from` where there is one, then to
// `to`. The steps are shared out by length, at least one each, and are as many as before where there are two or more.
std::vector<Branch> ways(const Branch& branch);

// The model as it stands on the branch: joints that stand only where they are driven, and are not driven
// here, hold nothing, and such elements have no law (both stay in their lists, so that reactions and elements keep
// their places). Only this branch is left.
Model on_branch(const Model& model, const Branch& branch);

// Whether every constraint and element of the model stands on the branch, as every leg requires, and the branch is
// one-way.
bool stands_on(const Model& model, const Branch& branch);

}  // namespace elastocheck
