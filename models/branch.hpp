// Branch sides, and the model that is active on a branch.
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck {

// Splits a branch into its sides, each starting at a = 0: to `from` if that is not 0, then to `to`.
// The steps are divided by length, at least one each; the total is unchanged if it is two or more.
std::vector<Branch> branch_sides(const Branch& branch);

// The model that is active on the branch: joints that are active only where driven (jacks) and are not
// driven here lose their constraints, such elements (tyres) their law. Both stay in their lists, so
// that reactions and elements keep their positions. The result has only this branch.
Model on_branch(const Model& model, const Branch& branch);

// Whether every constraint and element of the model is active on the branch and the branch has one
// side, as every leg requires.
bool fits_branch(const Model& model, const Branch& branch);

}  // namespace elastocheck
