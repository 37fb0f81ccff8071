// One expansion of the branch in a power series, its range of validity and nearest singularity.
#pragma once

#include "recursive/series/equations.hpp"
#include "recursive/series/path.hpp"
#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive::series {

// Coefficients of the present expansion; allocated once.
struct Coefficients {
    Matrix<double> x;     // (r_k, 2 g_k; λ_k) [(n+m) × (p+1)]
    Vector<double> load;  // a_k
    Vector<double> unit;  // x̂, the solution for a unit of a
    Vector<double> none;  // zero
};

Coefficients reserve_coefficients(const SteppingState<double>& s, int order);

// Computes the polynomial x(τ) about (s.q, s.lambda, s.a), with the factors in s.system. `first` is
// a_1 with a as parameter. With arc length only the sign of `first` counts, or, where `ahead` [n]
// is not zero, the direction of the previous motion. Allocates nothing.
void expand(SteppingState<double>& s, Equations& e, Coefficients& c, double first, bool arc_length,
            const Vector<double>& ahead);

// The present parameter of the equations: a, or t while settling.
double parameter(const SteppingState<double>& s, Drive drive);

// Range of τ in which the truncation error is below `tolerance` [m]: (ε / |x_p|)^(1/p),
// |x| = √(|Δr|² + L²|Δπ|² + |λ|²/k² + (per_load a_k)²) with k the largest stiffness of (24) and
// `per_load` metres for a unit of a. The range is shorter where the radius of convergence R is less
// than twice that: the terms fall as (τ/R)^k and sum to |x_p| τ^p (τ/R) / (1 - τ/R). An x_p that
// vanishes by symmetry is replaced by |x_{p-1}| / R. NaN if a coefficient is not finite.
double reach(const SteppingState<double>& s, const Coefficients& c, double tolerance,
             double per_load, double radius);

// Singularity nearest to τ = 0. Near a limit point, and near most branch points, x ~ (1 - τ/τ_s)^½:
// the coefficients divided by the binomial coefficients (½ over k) form a geometric series, and two
// of them for a complex pair, y_k = b_1 y_{k-1} + b_2 y_{k-2}. b follows from the last orders by
// least squares, τ_s from the roots.
Singularity nearest_singularity(const SteppingState<double>& s, const Coefficients& c);

// Evaluates Σ c_k τ^k, c_k the columns of c.
void horner(const Eigen::MatrixXd& c, double tau, Vector<double>& value);

// Moves the configuration `from` by x = (r, 2 g; ...).
void displace(const State<double>& from, const Eigen::Ref<const Vector<double>>& x,
              State<double>& q);

}  // namespace elastocheck::recursive::series
