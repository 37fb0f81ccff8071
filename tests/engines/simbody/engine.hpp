// A branch by Simbody, a multibody engine that nobody here wrote: what a solver from outside does with a model.
#pragma once

#include <span>
#include <stdexcept>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::engines {

// What the engine has nothing for: "bushing 'mount': Simbody's has no preload".
struct NotRepresented : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The equilibria at `values` of the branch's parameter, poses alone, each from the one before it; the first from the
// design position. They have settled when Newton's step is below 1e-11 m and rad; else iteration_limit or not_finite.
//
// Bushings are Simbody's own, whose law is U = ½ dᵀ K_T d + ½ θᵀ K_R θ as in include/elastocheck/mechanism.hpp, with Cardan angles θ
// (Formulation::Angles::cardan) also where the model has rotation vectors: the known difference.
//
// Pre: fits_branch(model, branch). Throws NotRepresented.
EquilibriumPath simbody(const Model& model, const Branch& branch, std::span<const double> values);

}  // namespace elastocheck::engines
