// First-order conditions of a constrained minimum: Lagrange multipliers, projected gradient, and
// modes of motion.
//
// All in scaled coordinates ξ (x = S ξ), scaled constraints D Φ, and energies in units of F·L.
#pragma once

#include <Eigen/QR>

#include "reference/energy/constraints/constraints.hpp"
#include "reference/energy/constraints/scales.hpp"
#include "reference/energy/potential/potential.hpp"

namespace elastocheck::reference::energy {

// Stationarity of V + λᵀΦ. The multipliers are the least-squares ones, of minimum norm where not
// unique. A sparse one has only λ, the projected gradient and Φ.
struct Balance {
    Eigen::VectorXd lambda;              // [m], of D Φ
    Eigen::VectorXd projected_gradient;  // ∂V/∂ξ + (∂DΦ/∂ξ)ᵀ λ [6nb]
    Eigen::VectorXd Phi;                 // D Φ [m]
    Eigen::MatrixXd J_t;                 // (∂DΦ/∂ξ)ᵀ [6nb × m]
    // of ∂DΦ/∂ξ, an orthonormal basis: the motions that the constraints allow [6nb × f]
    Eigen::MatrixXd null_space;
    // linearly independent rows of Φ, by column-pivoted QR of (∂DΦ/∂ξ)ᵀ [rank]
    std::vector<int> independent;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr;  // of J_t
};
Balance balance(const Model& model, const Scales& scales, const Eigen::VectorXd& gradient,
                const ConstraintValues& values);
Balance balance(const Model& model, const Prescribed& prescribed, const Scales& scales,
                const Chart& chart);
// The sparse one, with the given multipliers at the cost of a product; with the least-squares ones
// if `lambda` is empty.
Balance sparse_balance(const Model& model, const Prescribed& prescribed, const Scales& scales,
                       const Chart& chart, const Eigen::VectorXd& lambda = {});
// Orthonormal basis of the row space of ∂DΦ/∂ξ [6nb × rank].
Eigen::MatrixXd row_space(const Balance& conditions);
// Shortest least-squares solution ξ of ∂DΦ/∂ξ ξ = Φ.
Eigen::VectorXd shortest(const Balance& conditions, const Eigen::VectorXd& Phi);

// S H S in units of F·L.
Blocks scaled(Blocks H, const Scales& scales);

// Hessian of V + λᵀΦ at the centre [6nb × 6nb]: Σ Eᵀ K E, and the curvature of deformations, forces
// and constraints at constant stress, force and λ.
Eigen::MatrixXd hessian(const Model& model, const Prescribed& prescribed, const Scales& scales,
                        const std::vector<Pose>& centre, const Eigen::VectorXd& lambda);

// Unsymmetric stiffness A of the loads without potential: by how much more than the gradient of the
// chart's potential the balance changes about its centre. In ξ [6nb × 6nb].
Eigen::MatrixXd load_stiffness(const Prescribed& prescribed, const Scales& scales,
                               const std::vector<Pose>& centre);

// hessian() and load_stiffness() as sums of blocks, not scaled (SI).
Blocks hessian_blocks(const Model& model, const Prescribed& prescribed, const Scales& scales,
                      const std::vector<Pose>& centre, const Eigen::VectorXd& lambda);
Blocks load_blocks(const Prescribed& prescribed, const std::vector<Pose>& centre);

// Modes of motion that the constraints allow: eigenvectors of the Hessian reduced to `null_space`.
struct Modes {
    Eigen::MatrixXd Z;          // orthonormal [6nb × f]
    Eigen::VectorXd stiffness;  // ascending [f]
    double idle_limit = 0;      // a stiffness up to this is indistinguishable from zero

    // where only the softest modes are known: number of the others along which the energy falls
    int other_falling_modes = 0;

    int count() const { return static_cast<int>(stiffness.size()); }
    bool idle(int mode) const { return std::abs(stiffness[mode]) <= idle_limit; }
    std::vector<int> resisting() const;    // the modes that are not idle
    Eigen::MatrixXd idle_motions() const;  // [6nb × idle modes]
    bool unstable() const;
};
double idle_limit(double stiffest);  // for modes of which the stiffest is given
Modes modes_of(const Balance& conditions, const Eigen::MatrixXd& H);

// Acceptance measure, to be ≤ tolerance: the largest of the constraints and of the projected
// gradient in each mode. In a stiff mode the rounding of a position is allowed for:
// |Zᵀg| ≤ tolerance + roundoff · stiffness.
double excess(const Eigen::VectorXd& gradient, const Eigen::VectorXd& Phi, const Modes& modes,
              const Scales& scales, double tolerance);

// The same where only the softest modes are known: coordinate by coordinate, with `stiffness` of
// each.
double excess(const Balance& conditions, const Eigen::VectorXd& stiffness, const Scales& scales,
              double tolerance);

// Largest absolute entry; NaN if any entry is NaN, 0 if there is none.
double largest(const Eigen::Ref<const Eigen::VectorXd>& v);

}  // namespace elastocheck::reference::energy
