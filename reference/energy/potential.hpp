// The total potential V(x) and its gradient, by hand.
//
//   V(x; a) = Σ U(e(x); a) - Σ f(a)·p(x) - Σ m(a)·φ,   U(e; a) = u(e - e₀(a)) + b(a)ᵀ e
//
// e(x) is an element's deformation: ℓ of a spring, (d, θ) of a bushing; u its law (laws.hpp), e₀ the spring's
// free length or the bushing's undeformed offset, b the preload. Nothing is assembled from forces: a gradient is Eᵀ ∂U/∂e with E = ∂e/∂x.
#pragma once

#include "reference/energy/chart.hpp"
#include "reference/energy/prescribed.hpp"

namespace elastocheck::reference::energy {

// The value is V(x) - V(0), summed from changes so that it
// keeps its relative accuracy near the centre of the chart.
struct Potential {
    double change = 0;         // [J]
    Eigen::VectorXd gradient;  // ∂V/∂x [6nb], N and N·m
};
Potential potential(const Model& model, const Prescribed& prescribed, const Chart& chart);

// ∂²V/∂x∂a = Σ Eᵀ (b' - ∂²u/∂e² e₀') - Σ (∂p/∂x)ᵀ f' - Σ m' where `prescribed` moves with `rate` [6nb]
Eigen::VectorXd gradient_rate(const Model& model, const Prescribed& prescribed, const Prescribed& rate,
                              const Chart& chart);

// The gradient with every ∂U/∂e kept as it is at the centre: Σ E(x)ᵀ (∂U/∂e)_c - ... Its derivative at the
// centre is the part of the Hessian that is due to the elements' being loaded; the rest is `stiffness`.
Eigen::VectorXd gradient_at_centre_stress(const Model& model, const Prescribed& prescribed,
                                          const Chart& chart);

// Σ Eᵀ K E at the centre [6nb × 6nb], K = ∂²u/∂e².
Eigen::MatrixXd stiffness(const Model& model, const Prescribed& prescribed, const Chart& chart);

// ∂U/∂e of every element at the centre, row 0 of springs [6 × elements].
Eigen::Matrix<double, 6, Eigen::Dynamic> stresses(const Model& model, const Prescribed& prescribed,
                                                  const Chart& chart);

// What the elements hold at the centre, as a force [N]: Σ |forces| + |moments| / length.
double stress_size(const Model& model, const Prescribed& prescribed, const Chart& chart, double length);

// The bushings whose energy depends on their rotation somewhere along the branch.
std::vector<int> turning_bushings(const Model& model, const Course& course);

// Their rotations at these poses, principal values: the angles, and the rotation vector of those with the frame in the
// middle (others: zero) [3 × twice their number].
Eigen::Matrix3Xd rotations(const Model& model, const std::vector<int>& bushings,
                           const std::vector<Pose>& poses);

// Whether all of these are short of where their formulation stops being differentiable (way_to_the_end in
// relative_rotation.hpp).
bool within_laws(const Model& model, const std::vector<int>& bushings, const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::energy
