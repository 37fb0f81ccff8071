// How far the elements of a model are deformed in a state, and what their laws say of it: compare/'s own evaluation,
// for scales and ranges, never for a solution.
#pragma once

#include <span>
#include <string>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::compare {

// ℓ - ℓ₀ [m], ℓ₀ with what the branch adds to it at state.load; `element` is the spring's position in
// Model::elastics.
double deformation(const AxialSpring& spring, std::size_t element, const Branch& branch,
                   const Equilibrium& state);

// e - e₀ = (d, θ) - e₀ [m, rad], in the frame and angles of the bushing's formulation, frame on i or in the middle.
// Pre: not with its frame on j, which compile() turns round.
Vector6 deformation(const Bushing& bushing, const Equilibrium& state);

// f(x) = u'(x), and the largest |f'| that the law has anywhere.
double force(const ScalarLaw& law, double x);
double steepest(const ScalarLaw& law);

// The first element that is deformed beyond the end of a curve that says nothing there (Curve::known_outside), with
// its axis and value: "spring 'coil' is deformed by 61.2 mm, and its curve ends at 60 mm". Empty where none is.
std::string outside_table(const Model& model, const Branch& branch, const Equilibrium& state);

// The same with where on the branch that is: what a path says that ends before this state.
std::string ends_at_table(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::compare
