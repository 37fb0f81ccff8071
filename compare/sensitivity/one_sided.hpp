// Models on one side of a corner of a law, where a derivative of the states has two values.
//
// The state at a corner is an equilibrium of both: of the model whose law continues as below the
// knot, and of the one whose law continues as above it.
#pragma once

#include "compare/outputs/deformation.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

// The piece on this side of the knot (-1: below, 1: above) continues across it, up to the next knot.
Model one_sided(Model model, const Corner& corner, int side);

// Deformation beyond the knot of the corner [m, rad].
double beyond_knot(const Model& model, const Branch& branch, const Equilibrium& state,
                   const Corner& corner);

}  // namespace elastocheck::compare
