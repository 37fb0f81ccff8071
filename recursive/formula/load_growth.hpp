// Second homotopy of settling: forces that grow from zero.
//
// The first homotopy (settle.hpp) releases the imbalance of the design position as dead forces and
// moments. Its path may turn back or end at an unstable equilibrium. In the second homotopy no load
// acts at t = 0 and the elements have no force at the design position; both grow with t, the forces
// in the axes of the elements. They are further drivers of the branch, so that every method can
// follow it. Where several equilibria exist, the two homotopies may reach different ones; points
// that are reached by the second one have no error bound.
#pragma once

#include <optional>

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

struct GrowingForces {
    Model model;    // no static loads; springs and bushings have no force at the design position
    Branch branch;  // the removed loads and forces as further drivers, with a start and no rate
};

// The same equations as (model, branch) at t = 1, for every a; none where the model has no such
// force, since both homotopies are then the same.
std::optional<GrowingForces> with_growing_forces(const Model& model, const Branch& branch);

}  // namespace elastocheck::recursive
