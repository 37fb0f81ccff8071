// One expansion: all coefficients of the branch about the present equilibrium, and what they tell.
#pragma once

#include "recursive/march.hpp"
#include "recursive/series/equations.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::recursive::series {

// Allocated once; the coefficients of the present expansion.
struct Coefficients {
    Matrix<double> x;     // (r_k, 2 g_k; λ_k) [(n+m) × (p+1)]
    Vector<double> load;  // a_k
    Vector<double> unit;  // x̂, the answer to one unit of a
    Vector<double> none;  // zero
};

Coefficients reserve_coefficients(const March<double>& s, int order);

// The polynomial x(τ) about (s.q, s.lambda, s.a), with the factors now in s.system. `first` is a_1 with a
// itself as parameter; with arc length only its sign counts, or, where `ahead` [n] is not zero, the direction
// of the motion before. Nothing is allocated.
void expand(March<double>& s, Equations& e, Coefficients& c, double first, bool arc_length,
            const Vector<double>& ahead);

// The parameter of the equations where the march is: a, or t while settling.
double parameter(const March<double>& s, Drive drive);

// Up to which τ the orders left out are worth less than `tolerance` [m]: (ε / |x_p|)^(1/p), |x| = √(|Δr|² +
// L²|Δπ|² + |λ|²/k² + (per_load a_k)²) with k the stiffest of (24) and `per_load` metres for a unit of a;
// nearer where the radius of convergence R is less than twice that, since they fall as (τ/R)^k and sum to
// |x_p| τ^p (τ/R) / (1 - τ/R). An x_p that vanishes by symmetry is taken for |x_{p-1}| / R. NaN if a
// coefficient is not finite.
double reach(const March<double>& s, const Coefficients& c, double tolerance, double per_load, double radius);

// The singularity nearest to τ = 0. Near a limit point, as near most branch points,
// x ~ (1 - τ/τ_s)^½: divided by the binomial coefficients (½ over k) the coefficients
// are those of a geometric series, two of them for a complex pair, y_k = b_1 y_{k-1} + b_2 y_{k-2};
// b from the last orders by least squares, τ_s from its roots.
Singularity nearest_singularity(const March<double>& s, const Coefficients& c);

// Σ c_k τ^k of the columns c_k.
void horner(const Eigen::MatrixXd& c, double tau, Vector<double>& value);

// The configuration a step x = (r, 2 g; ...) away from q.
void displace(const State<double>& from, const Eigen::Ref<const Vector<double>>& x, State<double>& q);

}  // namespace elastocheck::recursive::series
