// First-order conditions of a constrained minimum: Lagrange multipliers, projected gradient, and
// modes of motion.
//
// All in scaled coordinates ξ (x = S ξ), scaled constraints D Φ, and energies in units of F·L.
#pragma once

#include <span>

#include "reference/energy/constraints/constraints.hpp"
#include "reference/energy/constraints/scales.hpp"
#include "reference/energy/potential/potential.hpp"

namespace elastocheck::reference::energy {

// Stationarity of V + λᵀΦ. The multipliers are the least-squares ones, of minimum norm where not
// unique.
struct Balance {
    Eigen::VectorXd lambda;  // [m], of D Φ
    Eigen::VectorXd left;    // ∂V/∂ξ + (∂DΦ/∂ξ)ᵀ λ, the projected gradient [6nb]
    Eigen::VectorXd Phi;     // D Φ [m]
    Eigen::MatrixXd J_t;     // (∂DΦ/∂ξ)ᵀ [6nb × m]
    Eigen::MatrixXd across;  // orthonormal basis of the row space of ∂DΦ/∂ξ [6nb × rank]
    // orthonormal basis of its null space: the motions that the constraints allow [6nb × f]
    Eigen::MatrixXd along;
    // linearly independent rows of Φ, by column-pivoted QR of (∂DΦ/∂ξ)ᵀ [rank]
    std::vector<int> independent;
};
Balance balance(const Model& model, const Scales& scales, const Eigen::VectorXd& gradient,
                const ConstraintValues& values);
Balance balance(const Model& model, const Prescribed& prescribed, const Scales& scales,
                const Chart& chart);

// Central differences of a gradient g: g' = Σ_k w_k (g(k h) - g(-k h)) / h, k from 1.
struct Differences {
    double step;  // h, of ξ
    std::span<const double> weights;
};

// Second order, error 1e-10.
inline constexpr double second_order[] = {0.5};
inline constexpr Differences quick_differences{1e-5, second_order};

// Eighth order: for a function that varies over a tenth of L as much as over L, the truncation
// error of this step is 1e-13, and so is the rounding error.
inline constexpr double eighth_order[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
inline constexpr Differences fine_differences{0.005, eighth_order};

// Hessian of V + λᵀΦ at the centre [6nb × 6nb]: Σ Eᵀ K E exactly, the rest by differences of
// hand-derived gradients at constant stress and λ, one element or constraint after the other. By
// quick differences it serves as the metric, the predictor and for stability; no result depends on
// its last digits.
Eigen::MatrixXd hessian(const Model& model, const Prescribed& prescribed, const Scales& scales,
                        const std::vector<Pose>& centre, const Eigen::VectorXd& lambda,
                        const Differences& by = quick_differences);
// The gradient that is differenced [6nb]: of elements at a constant `stress`, of the dead forces,
// and of λᵀΦ, `lambda` of Φ in SI.
Eigen::VectorXd geometric_gradient(const Model& model, const Prescribed& prescribed,
                                   const Eigen::Matrix<double, 6, Eigen::Dynamic>& stress,
                                   const Eigen::VectorXd& lambda, const Chart& chart);
// An element is evaluated at most this often for one Hessian.
inline constexpr int hessian_evaluations = 24;

// Unsymmetric stiffness A of a dead moment: with a small rotation φ of its body, the balance of
// moments changes by ½ φ × m more than the gradient of the chart's potential does. In ξ
// [6nb × 6nb].
Eigen::MatrixXd moment_stiffness(const Prescribed& prescribed, const Scales& scales, int n);

// Modes of motion that the constraints allow: eigenvectors of the reduced Hessian (reduced to
// `along`).
struct Modes {
    Eigen::MatrixXd Z;          // orthonormal [6nb × f]
    Eigen::VectorXd stiffness;  // ascending [f]
    double idle_limit = 0;      // a stiffness up to this is indistinguishable from zero

    int count() const { return static_cast<int>(stiffness.size()); }
    bool idle(int mode) const { return std::abs(stiffness[mode]) <= idle_limit; }
    std::vector<int> resisting() const;    // the modes that are not idle
    Eigen::MatrixXd idle_motions() const;  // [6nb × idle modes]
    bool unstable() const { return count() > 0 && !(stiffness[0] >= -idle_limit); }
};
Modes modes_of(const Balance& at, const Eigen::MatrixXd& H);

// Acceptance measure, to be ≤ tolerance: the largest of the constraints and of the projected
// gradient in each mode. In a stiff mode the rounding of a position is allowed for:
// |Zᵀg| ≤ tolerance + roundoff · stiffness.
double excess(const Eigen::VectorXd& left, const Eigen::VectorXd& Phi, const Modes& modes,
              const Scales& scales, double tolerance);

// Largest absolute entry; NaN if any entry is NaN, 0 if there is none.
double largest(const Eigen::Ref<const Eigen::VectorXd>& v);

}  // namespace elastocheck::reference::energy
