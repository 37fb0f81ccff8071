// Total potential energy V(x) and its hand-derived gradient.
//
//   V(x; a) = Σ U(e(x); a) - Σ f(a)·p(x) - Σ m(a)·φ,   U(e; a) = s(a) u(e - e₀(a)) + b(a)ᵀ e
//
// Dead moments and brake forces have no potential: m·φ holds to first order at the centre of a chart
// (chart.hpp), and a brake force is replaced there by a dead force at the point of the carrier that
// coincides with the patch (dead_force below).
//
// e(x) is an element's deformation: ℓ of a spring, (d, θ) of a bushing; u its law (laws.hpp), e₀
// the spring's free length or the bushing's undeformed offset, b the preload. s = 1, except for
// auxiliary elements while a model settles (settle.cpp). No forces are assembled: a gradient is
// Eᵀ ∂U/∂e with E = ∂e/∂x.
#pragma once

#include "reference/energy/potential/chart.hpp"
#include "reference/energy/potential/curvature.hpp"
#include "reference/energy/potential/prescribed.hpp"

namespace elastocheck::reference::energy {

// The value is V(x) - V(0), summed from changes to keep its relative accuracy near the centre of
// the chart.
struct Potential {
    double change = 0;         // [J]
    Eigen::VectorXd gradient;  // ∂V/∂x [6nb], N and N·m
};
Potential potential(const Model& model, const Prescribed& prescribed, const Chart& chart);

// [6nb], with `rate` the derivatives of `prescribed` with respect to a:
//
//   ∂²V/∂x∂a = Σ Eᵀ (b' + s' ∂u/∂e - s ∂²u/∂e² e₀') - Σ (∂p/∂x)ᵀ f' - Σ m'
Eigen::VectorXd gradient_rate(const Model& model, const Prescribed& prescribed,
                              const Prescribed& rate, const Chart& chart);

// The dead force on the carrier with the same wrench at the centre of the chart.
DeadForce dead_force(const BrakeForce& brake, const Chart& chart);

// Adds to H [6nb × 6nb] the second derivatives, at the centre, of an element's deformation at a
// constant stress σ (row 0 of springs), Σ σ ∂²e/∂x², and those of a force's -f·p. With
// σ = ∂U/∂e they are the geometric part of the Hessian; the rest is `stiffness`.
void add_curvature(const ElasticKind& element, const Vector6& stress, const Chart& chart,
                   Blocks& H);
void add_curvature(const DeadForce& force, const Chart& chart, Blocks& H);

// Σ Eᵀ K E at the centre [6nb × 6nb], K = s ∂²u/∂e².
Blocks stiffness(const Model& model, const Prescribed& prescribed, const Chart& chart);

// ∂U/∂e of every element at the centre, row 0 of springs [6 × elements].
Eigen::Matrix<double, 6, Eigen::Dynamic> stresses(const Model& model, const Prescribed& prescribed,
                                                  const Chart& chart);

// Size of the elastic forces at the centre [N]: Σ |forces| + |moments| / length.
double stress_size(const Model& model, const Prescribed& prescribed, const Chart& chart,
                   double length);

// The bushings whose energy depends on their rotation somewhere along the branch.
std::vector<int> turning_bushings(const Model& model, const Course& course);

// Rotations of these bushings, principal values: the angles, and the rotation vector for a frame in
// the middle (zero for the others) [3 × twice their number].
Eigen::Matrix3Xd rotations(const Model& model, const std::vector<int>& bushings,
                           const std::vector<Pose>& poses);

// Whether all bushings are within the range where their formulation is differentiable
// (distance_to_singularity in relative_rotation.hpp).
bool within_laws(const Model& model, const std::vector<int>& bushings,
                 const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::energy
