// The full equations, order by order:
//
//   G(q, λ, a) = f_elast(q) + Φ_q(q)ᵀ λ - f_ext(q, a) = 0,   Φ(q) = 0,   q, λ, a power series in τ.
//
// A body turns from where it is at τ = 0 by the Gibbs vector g = tan(θ/2) n, in which rotation is rational:
//
//   C(g) = (1 - h·g) I + h̃ + h gᵀ,   h = 2 g / (1 + g·g)
//
// once a body: what is fixed in it turns by a linear map of these coefficients.
// 2 g is Δπ to first order, so that ∂(G, Φ)/∂x at τ = 0, x = (r, 2 g, λ),
// is the consistent tangent of tangent.hpp. derivation.md has it all.
#pragma once

#include <variant>

#include "models/model.hpp"
#include "recursive/series/taylor.hpp"

namespace elastocheck::recursive::series {

using V3 = Vector3<double>;

struct BodySeries {
    Vector3Series r, g, h;
    Scalar stretch, shrink;  // 1 + g·g, 1 / (1 + g·g)
    Matrix3Series hg, C;     // h gᵀ, C(g)
};

// A vector fixed in a body.
struct Arm {
    BodyId body = ground;
    V3 fixed = V3::Zero();  // as it is at τ = 0
    Vector3Series s;        // C fixed
};

struct SpringSeries {
    Arm i, j;
    Vector3Series D, F;
    Scalar length_squared, length, inverse, tension;  // tension: F / D
};

struct BushingSeries {
    Arm i, j;
    Matrix3<double> E_i;          // axes of marker i at τ = 0
    Eigen::Matrix4d to_relative;  // (1 + g_i·g_j, g_j - g_i - g_i × g_j) → quaternion of A_iᵀ A_j, any length
    Vector3Series rho, D, strain, cross_g, V, u, theta, moment_local, u_M, u_u_M, spread_1, spread_2, force_i,
        moment_i, F, M;
    Series<Eigen::Vector4d> relative;
    Series<Vector6<double>> stress;
    Scalar dot_g, W, inverse, s;
    Composition phi, psi;
};

struct CoincidentSeries {
    Arm i, j;
    Vector3Series F;
};
struct PlaneSeries {
    Arm i, j, normal;
    Vector3Series d, rho, F;
};
struct PerpendicularSeries {
    Arm i, j;
    Vector3Series M;
};
struct DistanceSeries {
    Arm i, j;
    Vector3Series d, F;
};
struct LoadSeries {
    Arm at;
};

using ElasticSeries = std::variant<SpringSeries, BushingSeries>;
using ConstraintSeries = std::variant<CoincidentSeries, PlaneSeries, PerpendicularSeries, DistanceSeries>;

// Everything that has coefficients, allocated once for a model.
struct Equations {
    int order = 0;
    std::vector<BodySeries> slots;  // ground, at rest, in slot 0
    std::vector<Scalar> lambda;     // one per row of Φ
    Scalar a, one;                  // load factor, and that of the static loads
    std::vector<ElasticSeries> elastics;
    std::vector<ConstraintSeries> constraints;
    std::vector<LoadSeries> static_loads, branch_loads;
    Vector<double> G, Phi;  // coefficient k after pass `known` [6nb], [m]

    const BodySeries& operator[](BodyId b) const { return slots[static_cast<std::size_t>(b + 1)]; }
    BodySeries& operator[](BodyId b) { return slots[static_cast<std::size_t>(b + 1)]; }
};

Equations equations(const Model& model, const Branch& branch, int order);

// Puts τ = 0 at (q, λ, a): coefficients 0 of the unknowns, and what is fixed in the bodies.
void begin(Equations& e, const Model& model, const Branch& branch, const State<double>& q,
           const Vector<double>& lambda, double a);

// Coefficient k of everything; in pass `known` also of G and Φ.
void evaluate(Equations& e, const Model& model, const Branch& branch, Order o);

// x_k = (r_k, 2 g_k; λ_k) and a_k take their place in the unknowns.
void assign(Equations& e, int k, const Vector<double>& x, double a);

}  // namespace elastocheck::recursive::series
