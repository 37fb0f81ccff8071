// How far a pose is from being a constrained minimum: multipliers, what they leave over, and the modes of
// motion.
//
// All in scaled coordinates ξ (x = S ξ), scaled constraints D Φ, and energies in units of F·L.
#pragma once

#include "reference/energy/constraints.hpp"
#include "reference/energy/potential.hpp"
#include "reference/energy/scales.hpp"

namespace elastocheck::reference::energy {

// The stationarity of V + λᵀΦ. The multipliers are least squares, of smallest norm where they are not unique.
struct Balance {
    Eigen::VectorXd lambda;  // [m], of D Φ
    Eigen::VectorXd left;    // ∂V/∂ξ + (∂DΦ/∂ξ)ᵀ λ, what the best multipliers leave over [6nb]
    Eigen::VectorXd Phi;     // D Φ [m]
    Eigen::MatrixXd J_t;     // (∂DΦ/∂ξ)ᵀ [6nb × m]
    Eigen::MatrixXd across;  // orthonormal basis of the row space of ∂DΦ/∂ξ [6nb × rank]
    Eigen::MatrixXd along;   // and of its null space: the motions the constraints allow [6nb × f]
    std::vector<int> independent;  // linearly independent rows of Φ, by column-pivoted QR of (∂DΦ/∂ξ)ᵀ [rank]
};
Balance balance(const Model& model, const Scales& scales, const Eigen::VectorXd& gradient,
                const ConstraintValues& values);
Balance balance(const Model& model, const Prescribed& prescribed, const Scales& scales, const Chart& chart);

// Hessian of V + λᵀΦ at the centre [6nb × 6nb]: Σ Eᵀ K E exactly, the rest by differences of hand-derived
// gradients at constant stress and λ. It steers (metric, prediction, stability); no result depends on its
// last digits.
Eigen::MatrixXd hessian(const Model& model, const Prescribed& prescribed, const Scales& scales,
                        const std::vector<Pose>& centre, const Eigen::VectorXd& lambda);
int hessian_evaluations(const Model& model);  // of a gradient, for one Hessian

// A dead moment has no symmetric stiffness: with a small rotation φ of its body, the balance of moments
// changes by ½ φ × m more than the gradient of the chart's potential does. In ξ [6nb × 6nb].
Eigen::MatrixXd moment_stiffness(const Prescribed& prescribed, const Scales& scales, int n);

// The modes of motion that the constraints allow: eigenvectors of the Hessian reduced to `along`.
struct Modes {
    Eigen::MatrixXd Z;          // orthonormal [6nb × f]
    Eigen::VectorXd stiffness;  // ascending [f]
    double idle_limit = 0;      // a stiffness up to this cannot be told from zero

    int count() const { return static_cast<int>(stiffness.size()); }
    bool idle(int mode) const { return std::abs(stiffness[mode]) <= idle_limit; }
    std::vector<int> resisting() const;    // the modes that are not idle
    Eigen::MatrixXd idle_motions() const;  // [6nb × idle modes]
    bool unstable() const { return count() > 0 && !(stiffness[0] >= -idle_limit); }
};
Modes modes_of(const Balance& at, const Eigen::MatrixXd& H);

// The measure of acceptance, to be ≤ tolerance: the largest of the constraints and of the gradient left over
// along each mode. A stiff mode is given what the last bit of a position means to it: |Zᵀg| ≤ tolerance +
// roundoff · stiffness.
double excess(const Eigen::VectorXd& left, const Eigen::VectorXd& Phi, const Modes& modes,
              const Scales& scales, double tolerance);

// Largest absolute entry; NaN if any entry is NaN, 0 if there is none.
double largest(const Eigen::Ref<const Eigen::VectorXd>& v);

}  // namespace elastocheck::reference::energy
