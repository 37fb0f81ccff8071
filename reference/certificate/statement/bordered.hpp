// Bordered system: regular where the mechanism has redundant constraints or idle motions:
//
//   E(z; a) + U μ = 0        redundant rows: U in the rows Φ, and μ is the remaining gap
//                            idle motions:   U in the balances, and μ is the wrench that holds them
//   gᵀ (z - z_g)  = 0        gauge: load sharing of redundant joints and idle motions as at z_g
//   tᵀ (y - y_t)  = 0        only where a is an unknown too
//
// Unknowns y = (z, μ, a).
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <string>

#include "reference/certificate/statement/system.hpp"

namespace elastocheck::reference::certificate {

using SparseMatrix = Eigen::SparseMatrix<double>;

struct Border {
    Eigen::MatrixXd U, g;  // [n × k]: redundant rows first, then idle motions
    int redundant = 0;
    // at z, beyond rounding
    bool redundant_row_gap = false, idle_motion_loaded = false;
    // the Jacobian may be singular and is too large for dense null spaces: nothing is known
    bool too_large = false;
    int count() const { return static_cast<int>(U.cols()); }
};

// Structural rank deficiency at z, independent of the stiffnesses:
//
//   redundant rows  y: yᵀ Φ_q = 0
//   idle motions    v: no constraint and no deformation with stiffness changes, G v = 0; and the
//                   acting forces rotate with the bodies so that the balance is kept,
//                   B v + Cᵀ δR = 0 for some change δR of the reactions
//                   (B: slopes of the balances at constant elastic forces, Cᵀ: those of reactions)
//
// G contains no stiffness, and B only that of loads and preloads: a soft motion is not idle,
// however stiff its neighbours are. Values count as zero below `zero_tolerance`, relative to a row
// of G of size one and to the acting forces on the moving bodies. At an equilibrium this is the
// rounding of stored coordinates (zero_tolerance_of_rounding), at a state near one it is larger
// (loose_zero_tolerance).
double zero_tolerance_of_rounding(const System& system);
constexpr double loose_zero_tolerance = 1e-5;
// The rounding of each equation [n]: relative to the forces on its body, to L or to a direction.
Eigen::VectorXd rounding_of_equations(const System& system, const Eigen::VectorXd& z, double a);
// `system_values`, if given, receives E and ∂E/∂z at z.
Border border_at(const System& system, const Eigen::VectorXd& z, double a, double zero_tolerance,
                 Values<double>* system_values = nullptr);

// Names of the bodies moved by the idle motions, and of the joints of the
// redundant rows: "'strut'".
std::string idle_bodies(const System& system, const Border& border);
std::string redundant_joints(const System& system, const Border& border);

struct Problem {
    const System& system;
    Border border;
    Eigen::VectorXd z_g;  // [n]
    bool a_is_unknown = false;
    Eigen::VectorXd t, y_t;  // [n + k + 1]
    int n() const { return system.n(); }
    int size() const { return n() + border.count() + (a_is_unknown ? 1 : 0); }
};

// The equations and their Jacobian [size × size]. A parameter that is no unknown is the given `a`.
template <class S>
Values<S> evaluate(const Problem& problem, const std::vector<S>& y, const S& a, Slopes slopes);
template <class S>
Values<S> evaluate_without_slopes(const Problem& problem, const std::vector<S>& y, const S& a);
template <class S>
Values<S> residual(const Problem& problem, const std::vector<S>& y, const S& a);

// The matrix, of intervals its middle.
template <class S>
SparseMatrix middle(const SparseRows<S>& J);
std::vector<double> doubles(const Eigen::VectorXd& x);
std::vector<Interval> box(const Eigen::VectorXd& middle, const Eigen::VectorXd& radius);
std::vector<Interval> thin(const Eigen::VectorXd& x);

// Floating-point LU factors of a Jacobian D_r⁻¹ A D_c⁻¹, A with rows and columns of size one.
struct Factors {
    Eigen::VectorXd D_r, D_c;
    // (b, transposed): A⁻¹ b or A⁻ᵀ b; none if A is singular
    std::function<Eigen::MatrixXd(const Eigen::MatrixXd&, bool)> solve_A;
    double norm = 0;  // ‖A‖₁
    Eigen::Index size() const { return D_r.size(); }
    Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
    // `count` rows of the inverse [count × n]; NaN without factors.
    Eigen::MatrixXd rows_of_inverse(Eigen::Index from, Eigen::Index count) const;
    double rcond() const;  // estimate for A in the 1-norm; 0 without factors
};
Factors factors(const SparseMatrix& J);
Eigen::MatrixXd inverse(const Factors& factors);

// Approximate solution by Newton's method: start of the proof. `system_values`, if given: the
// equations of the system at y, and their slopes.
struct Approximate {
    Eigen::VectorXd y;
    Factors J;             // at one of the last steps
    bool settled = false;  // the steps became rounding, near the start
    double since = 0;      // movement since J was computed, relative to the model's size
};
Approximate newton(const Problem& problem, const Eigen::VectorXd& y, double a,
                   const Values<double>* system_values = nullptr);

// Validity of a border at y. `sound`: as many motions and rows are structurally idle or redundant
// at y, no idle motion is loaded and no redundant row has a gap beyond rounding. Nothing is proved
// unless it is sound.
struct BorderCheck {
    bool sound = false, idle_motion_loaded = false, redundant_row_gap = false;
};
BorderCheck check_border(const Problem& problem, const Eigen::VectorXd& y, double a);

// Floating-point equilibrium near z, if one was found (`equilibrium.settled`), and the check of
// the border there.
struct NearEquilibrium {
    Problem problem;
    Approximate equilibrium;
    BorderCheck border_check;
};
NearEquilibrium equilibrium_near(const System& system, const Eigen::VectorXd& z, double a);

}  // namespace elastocheck::reference::certificate
