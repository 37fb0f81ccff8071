// The total potential V(x) and its gradient, by hand.
//
//   V(x) = Σ U(e(x)) - Σ f·p(x) - Σ m·φ,   less Σ relief · σ_designᵀ e(x) while settling (loading.hpp)
//
// e(x) is an element's deformation: ℓ of a spring, (d, θ) of a bushing. Nothing is assembled from forces: a
// gradient is Eᵀ ∂U/∂e with E = ∂e/∂x.
#pragma once

#include "reference/energy/chart.hpp"
#include "reference/energy/loading.hpp"

namespace elastocheck::reference::energy {

// The value is V(x) - V(0), summed from changes so that it
// keeps its relative accuracy near the centre of the chart.
struct Potential {
    double change = 0;         // [J]
    Eigen::VectorXd gradient;  // ∂V/∂x [6nb], N and N·m
};
Potential potential(const Model& model, const Loading& loading, const Chart& chart);

// The gradient with every ∂U/∂e kept as it is at the centre: Σ E(x)ᵀ (∂U/∂e)_c - ... Its derivative at the
// centre is the part of the Hessian that is due to the elements' being loaded; the rest is `stiffness`.
Eigen::VectorXd gradient_at_centre_stress(const Model& model, const Loading& loading, const Chart& chart);

// Σ Eᵀ K E at the centre [6nb × 6nb], positive semidefinite.
Eigen::MatrixXd stiffness(const Model& model, const Chart& chart);

// What the elements hold at the centre, as a force [N]: Σ |forces| + |moments| / length.
double stress_size(const Model& model, const Chart& chart, double length);

// The rotations, at these poses, of the bushings that resist one [3 × their number].
Eigen::Matrix3Xd bushing_rotations(const Model& model, const std::vector<Pose>& poses);

// Whether all of these are short of half a turn, where the law is no longer differentiable.
bool within_half_turn(const Model& model, const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::energy
