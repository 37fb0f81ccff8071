// One expansion of the branch in a power series, its range of validity and nearest singularity.
#pragma once

#include <limits>

#include "recursive/series/equations.hpp"
#include "recursive/series/path.hpp"
#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive::series {

// Coefficients of the present expansion; allocated once.
template <class Real>
struct Coefficients {
    Matrix<Real> x;     // (r_k, 2 g_k; λ_k) [(n+m) × (p+1)]
    Vector<Real> load;  // a_k
    Vector<Real> unit;  // x̂, the solution for a unit of a
    Vector<Real> none;  // zero, for pass `known`
    int order;          // the highest that is computed, at most p; beyond it x and load are zero

    auto polynomial() const { return x.leftCols(order + 1); }
};

template <class Real>
Coefficients<Real> reserve_coefficients(int unknowns, int order) {
    return {Matrix<Real>::Zero(unknowns, order + 1), Vector<Real>::Zero(order + 1),
            Vector<Real>::Zero(unknowns), Vector<Real>::Zero(unknowns), order};
}

// The steps of compute_orders() that differ between its callers.
template <class Solve, class Straighten, class Loses, class Keep, class Suffices>
struct OrderSteps {
    Solve solve;            // (): sets x to the solution for the right-hand side (-G, -Φ)
    Straighten straighten;  // (k): makes x_k, in x, orthogonal to x_1 by a_k, for arc length
    // (correct): whether x_1 loses digits, so that all orders are corrected; correct() sets x to
    // the correction of x_1
    Loses loses;
    Keep keep;          // (): sets to zero the corrections in x that are not needed
    Suffices suffices;  // (k): whether the orders up to k are enough
};
template <class Solve, class Straighten, class Loses, class Keep, class Suffices>
OrderSteps(Solve, Straighten, Loses, Keep, Suffices)
    -> OrderSteps<Solve, Straighten, Loses, Keep, Suffices>;

// Computes the orders 1 ... p, or those that suffice, after begin() and pass `known` of order 0.
// x_1 = a_1 x̂ is in c.x and in `x`, a workspace.
//
// Residual correction of x_k: coefficient k of (G, Φ) evaluated element by element with x_k, and
// solved with the same factors. It removes the rounding of the assembled matrix.
template <class Real, class... Steps>
void compute_orders(Equations<Real>& e, Coefficients<Real>& c, Vector<Real>& x,
                    const OrderSteps<Steps...>& steps) {
    const auto correct = [&](int k) {
        assign(e, k, x, c.load[k]);
        evaluate(e, {k, Pass::known});
        steps.solve();
    };
    const bool corrected = steps.loses([&] { correct(1); });
    if (corrected) {
        steps.keep();
        c.x.col(1) += x;
    }
    x = c.x.col(1);
    for (int k = 1; k <= e.order(); ++k) {
        assign(e, k, c.none, 0);
        evaluate(e, {k, Pass::known});
        if (k > 1) {
            steps.solve();
            steps.straighten(k);
            c.x.col(k) = x;
            if (corrected) {
                correct(k);
                steps.keep();
                c.x.col(k) += x;
                x = c.x.col(k);
                assign(e, k, c.none, 0);
                evaluate(e, {k, Pass::known});
            }
        }
        c.order = k;
        const bool last = k == e.order() || steps.suffices(k);
        // a curved law needs its last deformation coefficient for knots
        if (last && !e.curved) break;
        assign(e, k, x, c.load[k]);
        evaluate(e, {k, Pass::change});
        if (last) break;
    }
}

// Limit on the relative correction of the first coefficient. Above it coefficients are refined:
// along hundreds of stiff links the rounded matrix solves to 1e-12 only, and shorter expansions do
// not help.
inline constexpr double loses_digits = 1e-13;

// What an expansion is computed for. With arc length only the sign of a_1 counts, or, where
// previous_direction [n] is not zero, the direction of that motion.
struct Extent {
    double a_1 = 0;
    int order = 0;  // p
    // A lower or higher order is taken where its range of truncation reaches τ = `rest` by it.
    double rest = std::numeric_limits<double>::infinity();
    double tolerance = 0;        // [m]
    double metres_per_unit = 0;  // as in reach()
    bool arc_length = false;
};

// Computes the polynomial x(τ) about (s.q, s.lambda, s.a), with the factors in s.system. Allocates
// nothing.
void expand(SteppingState& s, Equations<double>& e, Coefficients<double>& c, const Extent& extent,
            const Vector<double>& previous_direction);

// The present parameter of the equations: a, or t while settling.
double parameter(const SteppingState& s, Drive drive);

// Range of τ in which the truncation error is below `tolerance` [m]: (ε / |x_p|)^(1/p),
// |x| = √(|Δr|² + L²|Δπ|² + |λ|²/k² + (metres_per_unit a_k)²) with k the largest stiffness of (24)
// and `metres_per_unit` the length that counts as much as a unit of a. The range is shorter where the radius of convergence R is less
// than twice that: the terms fall as (τ/R)^k and sum to |x_p| τ^p (τ/R) / (1 - τ/R). An x_p that
// vanishes by symmetry is replaced by |x_{p-1}| / R. NaN if a coefficient is not finite.
double reach(const SteppingState& s, const Coefficients<double>& c, double tolerance,
             double metres_per_unit, double radius);

// Singularity nearest to τ = 0. Near a limit point, and near most branch points, x ~ (1 - τ/τ_s)^½:
// the coefficients divided by the binomial coefficients (½ over k) form a geometric series, and two
// of them for a complex pair, y_k = b_1 y_{k-1} + b_2 y_{k-2}. b follows from the last orders by
// least squares, τ_s from the roots.
Singularity nearest_singularity(const SteppingState& s, const Coefficients<double>& c);

// Evaluates Σ c_k τ^k, c_k the columns of c.
void horner(const Eigen::Ref<const Eigen::MatrixXd>& c, double tau, Vector<double>& value);

// Moves the configuration `from` by x = (r, 2 g; ...).
void displace(const State<double>& from, const Eigen::Ref<const Vector<double>>& x,
              State<double>& q);

}  // namespace elastocheck::recursive::series
