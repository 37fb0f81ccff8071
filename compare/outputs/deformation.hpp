// Deformation and force of the elastic elements in a state, evaluated apart from the legs: for outputs,
// scales and ranges, never for a solution.
#pragma once

#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

// Deformation of an element: of a spring ℓ - ℓ₀ [m] in the first entry and zero in the others, of a bushing
// e - e₀ [m, rad]. Drivers of the branch change ℓ₀ and e₀ with state.load. `element` is the position in
// Model::elastics.
Vector6 deformation(const ElasticKind& kind, std::size_t element, const Branch& branch,
                    const Equilibrium& state);
// Generalised force ∂u/∂e at a deformation, u the energy, without a preload [N, N·m].
Vector6 force(const ElasticKind& kind, const Vector6& deformation);
// The generalised force with the constant preload and the preload that the branch drives at state.load
// [N, N·m].
Vector6 force_with_preload(const ElasticKind& kind, std::size_t element, const Branch& branch,
                           const Equilibrium& state, const Vector6& deformation);

// e - e₀ = (d, θ) - e₀ [m, rad], in the frame and angles of the bushing's formulation, frame on i
// or in the middle. Pre: frame not on j; compile() exchanges the markers of such a bushing.
Vector6 deformation(const Bushing& bushing, const Equilibrium& state);

// Force f(x) = u'(x) of a law [N, N·m].
double force(const ScalarLaw& law, double x);
// Largest |f'| over all pieces of a curve; the rate k, with its sign, of a linear law.
double max_slope(const ScalarLaw& law);

// Elements whose deformation is, to 1e-9 m or rad, at a knot where the slope of its law jumps: the
// tangent stiffness of the model then differs between the two sides.
struct Corner {
    std::size_t element, axis, knot;  // in Model::elastics, of its deformations, in Curve::knots
};
std::vector<Corner> corners(const Model& model, const Branch& branch, const Equilibrium& state);
bool at_corner(const Model& model, const Branch& branch, const Equilibrium& state);

// First element that is deformed beyond the end of a curve that is not extrapolated
// (Curve::known_outside), with its axis and value: "spring 'coil' is deformed by 61.2 mm, and its
// curve ends at 60 mm". Empty where there is none.
std::string outside_table(const Model& model, const Branch& branch, const Equilibrium& state);

// The same message with the position on the branch: the detail of a path that ends
// before this state.
std::string ends_at_table(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::compare
