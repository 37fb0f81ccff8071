// The energy about a pose to second order, on the constraints to first, sparse:
//
//   ½ xᵀH x + bᵀx → min,   J x = -Φ
//
// The augmented Lagrangian (Hestenes, Powell 1969) makes it a minimum without constraints, whose
// Hessian S = H + ρ JᵀJ + μ is factorised as L D Lᵀ:
//
//   x ← x + Δx,  Δx = S⁻¹ (r + ρ Jᵀc),   r = -(b + K x + Jᵀλ)
//   λ ← λ + ρ (J Δx - c),                c = -(Φ + J x)
//
// Where K = H, a step leaves r = μ Δx and c = -Δλ/ρ: it converges fast where μ is far below the
// stiffnesses that count and ρ far above them. The unsymmetric stiffness A of loads without
// potential, K = H + A, stays outside S. Redundant rows need no care: λ stays in the range of J.
// By Sylvester's law D has as many negative entries as there are motions along the constraints
// on which the energy falls.
#pragma once

#include <Eigen/SparseCholesky>

#include "reference/energy/constraints/balance.hpp"

namespace elastocheck::reference::energy {

// Models with more coordinates are solved sparsely (descent.hpp); all built-in scenes have fewer.
inline constexpr int dense_coordinates = 60;
bool is_large(const Model& model);

class Quadratic {
  public:
    // All scaled: H and A [n × n], J [m × n].
    Quadratic(const Blocks& H, const Blocks& A, const Jacobian& J);

    // The minimum, without the idle motions, which are near the columns of `idle` [n × k]. Empty Φ:
    // zero.
    struct Minimum {
        Eigen::VectorXd x, lambda;
    };
    Minimum minimum(const Eigen::VectorXd& b, const Eigen::VectorXd& Phi,
                    const Eigen::MatrixXd& idle) const;

    // The softest modes, at least one of them resisting, by inverse iteration of a subspace that
    // starts with those of `near`.
    Modes softest(const Modes& near) const;

    Eigen::VectorXd gradient(const Eigen::VectorXd& x) const { return H_ * x + A_ * x; }  // K x
    Eigen::VectorXd opening(const Eigen::VectorXd& x) const { return J_ * x; }
    // Σ |H| by rows: by how much a rounding of the coordinates changes the gradient.
    const Eigen::VectorXd& stiffness() const { return stiffness_; }

  private:
    Eigen::MatrixXd onto_constraints(Eigen::MatrixXd X) const;

    Sparse H_, A_, J_;
    Eigen::VectorXd stiffness_;
    double rho_, mu_;  // μ is the limit of idle motions
    Eigen::SimplicialLDLT<Sparse> factor_;
};

}  // namespace elastocheck::reference::energy
