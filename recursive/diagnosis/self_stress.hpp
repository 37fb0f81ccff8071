// Wrenches that redundant joints exert on each other without a load.
#pragma once

#include <span>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// Rows of Φ_q at the design position that depend on the rows before them, ascending.
std::vector<int> dependent_rows(const Model& model);

// Wrenches of all joints that are in balance without a load, a solution of yᵀ Φ_q = 0, scaled so
// that the largest force is 1 N or the largest moment 1 N times the characteristic length. A
// reaction that is zero in all self-stresses is determined by the loads.
struct SelfStress {
    std::vector<Wrench> wrenches;  // as Equilibrium::reactions
    double remainder = 0;          // of the dependent row, from the constraint error of the state
};
// A basis of the self-stresses in a state, one for each of the `dependent` rows (dependent_rows()).
std::vector<SelfStress> self_stresses(const Model& model, const Branch& branch,
                                      std::span<const int> dependent, const Equilibrium& state);

}  // namespace elastocheck::recursive
