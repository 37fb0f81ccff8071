// Wrenches that redundant joints exert on each other without a load.
#pragma once

#include <span>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// Rows of Φ_q at the design position that depend on the rows before them, ascending.
std::vector<int> dependent_rows(const Model& model);

// Wrenches of all joints that are in balance without a load, a solution of yᵀ Φ_q = 0: the largest
// is 1 N, or 1 N times the characteristic length. What reads zero from all of them is determined by
// the loads.
struct SelfStress {
    std::vector<Wrench> wrenches;  // as Equilibrium::reactions
    double left = 0;               // remainder of Φ_q, by the constraint error of the state
};
// A basis of the self-stresses in a state. `dependent`: of dependent_rows().
std::vector<SelfStress> self_stresses(const Model& model, const Branch& branch,
                                      std::span<const int> dependent, const Equilibrium& state);

}  // namespace elastocheck::recursive
