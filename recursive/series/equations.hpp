// Power series of the full nonlinear equations in the path parameter, computed order by order:
//
//   G(q, λ, a) = f_elast(q, a) + Φ_q(q, a)ᵀ λ - f_ext(q, a) = 0,   Φ(q, a) = 0,
//
// with power series q, λ, a in τ.
//
// A body rotates from its orientation at τ = 0 by the Gibbs vector g = tan(θ/2) n; its rotation is
// rational:
//
//   C(g) = (1 - h·g) I + h̃ + h gᵀ,   h = 2 g / (1 + g·g)
//
// C is computed once per body; every vector fixed in the body is a linear map of its coefficients.
// 2 g is Δπ to first order, so that ∂(G, Φ)/∂x at τ = 0, x = (r, 2 g, λ), is the consistent tangent
// of tangent.hpp. The derivation is in derivation.md.
//
// A curve is a polynomial on each of its pieces. The equations use one piece at a time, continued
// beyond its ends (pieces.hpp selects the piece and its range of validity).
//
// The inputs that a branch drives (loads, offsets, free lengths, preloads) are linear in the
// parameter: coefficient k is a rate times a_k. While the start settles, the parameter is t, and
// the starts of the drivers replace their rates (inputs.hpp). A term holds a copy of its element or
// constraint, so that the model is not needed in the evaluation.
#pragma once

#include <array>
#include <variant>

#include "recursive/formula/drive.hpp"
#include "recursive/series/taylor.hpp"

namespace elastocheck::recursive::series {

using V3 = Vector3<double>;

// start + rate · a, or · t
template <class T>
struct Driven {
    T start = Series<T>::zero();
    T rate = Series<T>::zero();
};

// A rotation by its Gibbs vector.
struct TurnSeries {
    Vector3Series g, h;
    Scalar stretch, shrink;  // 1 + g·g, 1 / (1 + g·g)
    Matrix3Series hg, C;     // h gᵀ, C(g)
};
struct BodySeries : TurnSeries {
    Vector3Series r;
};

// A vector fixed in a body.
struct Arm {
    BodyId body = ground;
    V3 fixed = V3::Zero();  // at τ = 0
    Vector3Series s;        // C fixed
};

// A curve on one piece: f = c_0 + ξ (c_1 + ξ (c_2 + ξ c_3)), ξ = x - about.
struct CubicSeries {
    double about = 0;
    std::array<double, 4> c{};
    Scalar xi, inner, slope;  // ξ, c_2 + ξ c_3, c_1 + ξ (c_2 + ξ c_3)
};

struct SpringSeries {
    AxialSpring kind;
    Driven<double> free_length;
    Arm i, j;
    Vector3Series D, F;
    Scalar length_squared, length, inverse, stretch, force, tension;  // ℓ - ℓ₀, u'(ℓ - ℓ₀), F / D
    CubicSeries cubic;                                                // if the law is a curve
};

// One deformation of a bushing with a law per axis.
struct AxisSeries {
    Scalar x, force;    // a component of e - e₀, u'(x)
    CubicSeries cubic;  // if the law is a curve
};

// d in axes half way between those of i and j (Formulation::Frame::middle): B^½ has the Gibbs
// vector tan(|θ|/4) θ/|θ| = V / (|p| + W), p = (W, V) the relative quaternion.
struct MiddleSeries {
    Scalar squared, size, sum, inverse;  // p·p, |p|, |p| + W, 1 / (|p| + W)
    TurnSeries half;                     // B^½
    Vector3Series d_i, d, F_local, F_i, m,
        g_m;  // d_i in axes of i, d = B^-½ d_i; F_i = B^½ F', F_i × d_i
};

// One of the three Cardan or projected angles of B: the polar angle of a vector in a plane, with
// its row of H, δθ = H ω, ω the rotation of j relative to i in axes of i:
// row = fixed + z/r · along.
struct PlaneAngleSeries {
    Vector2Series xy, unit;  // r (cos, sin), (cos, sin)
    Scalar squared, r, inverse, angle, z, factor, moment;
    Vector3Series along, row, share;
};
struct AnglesSeries {
    Matrix3Series B;  // times p·p
    std::array<PlaneAngleSeries, 3> axis;
};

struct BushingSeries {
    Bushing kind;
    Driven<Vector6<double>> preload;
    bool rotational = true;  // whether there is a moment M' = ∂U/∂θ; else θ is not computed
    Arm i, j;
    Matrix3<double> E_i;  // axes of marker i at τ = 0
    Eigen::Matrix4d
        to_relative;  // (1 + g_i·g_j, g_j - g_i - g_i × g_j) → quaternion p of B = A_iᵀ A_j, any length
    Vector3Series rho, D, strain, cross_g, V, u, theta, moment_local, u_M, u_u_M, spread_1,
        spread_2, force_i, moment_i, F, M;
    Series<Eigen::Vector4d> relative;
    Vector6Series e, gradient, stress;  // (d, θ) - e₀, ∂u/∂e, ∂u/∂e + preload
    Scalar dot_g, W, inverse, s;
    Composition phi, psi;
    // Allocated only if the law or the formulation needs them.
    AxisSeries* axis = nullptr;  // [6]
    MiddleSeries* middle = nullptr;
    AnglesSeries* angles = nullptr;

    bool twists() const { return rotational || middle != nullptr; }  // whether M is computed
};

struct CoincidentSeries {
    static constexpr std::size_t rows = 3;
    CoincidentPoints kind;
    Arm i, j;
    Vector3Series F;
};
struct PlaneSeries {
    static constexpr std::size_t rows = 1;
    PointInPlane kind;
    Driven<double> offset;
    Arm i, j, normal;
    Vector3Series d, rho, F;
};
struct PerpendicularSeries {
    static constexpr std::size_t rows = 1;
    PerpendicularDirections kind;
    Arm i, j;
    Vector3Series M;
};
struct DistanceSeries {
    static constexpr std::size_t rows = 1;
    DistanceBetween kind;
    Driven<double> length;
    Arm i, j;
    Scalar ell, inverse, share;  // ℓ, 1/ℓ, λ/ℓ
    Vector3Series d, F;
};
struct AngleSeries {
    static constexpr std::size_t rows = 1;
    DirectionAtAngle kind;
    Driven<double> angle;
    Arm i, x, y;
    Scalar alpha, cosine, sine;
    Vector3Series along, across, w, M;  // cos α y_j, sin α x_j, w = cos α y_j - sin α x_j, u_i × w
};

struct ForceSeries {
    DeadForce kind;
    Driven<double> factor;
    Scalar size;
    Arm at;
};
struct MomentSeries {
    DeadMoment kind;
    Driven<double> factor;
};
// A follower rotates with its body, and so does its moment about the origin, s × f or m.
struct FollowerSeries {
    V3 f_local, m_local;
    Driven<double> factor;
    Scalar size;
    Arm f, m;
};

using ElasticSeries = std::variant<SpringSeries, BushingSeries>;
using ConstraintSeries =
    std::variant<CoincidentSeries, PlaneSeries, PerpendicularSeries, DistanceSeries, AngleSeries>;
using LoadSeries = std::variant<ForceSeries, MomentSeries, FollowerSeries>;

// All series of a model on a branch; allocated once.
struct Equations {
    Arena room;
    Drive drive = Drive::rate;      // rate: the parameter is a; start: t
    std::vector<BodySeries> slots;  // ground, fixed, in slot 0
    std::vector<Scalar> lambda;     // one per row of Φ
    Scalar a;                       // the parameter
    std::vector<ElasticSeries> elastics;
    std::vector<ConstraintSeries> constraints;
    std::vector<LoadSeries> loads;  // static, then driven
    Vector<double> G, Phi;          // coefficient k after pass `known` [6nb], [m]
    // While settling, G - (1 - t) G_d and Φ - (1 - t) Φ_d replace G and Φ; d: at the design
    // position.
    Vector<double> G_d, Phi_d;  // [6nb], [m]
    bool curved = false;        // whether any law is a curve

    int order() const { return room.order; }
    const BodySeries& operator[](BodyId b) const { return slots[static_cast<std::size_t>(b + 1)]; }
    BodySeries& operator[](BodyId b) { return slots[static_cast<std::size_t>(b + 1)]; }
};

Equations equations(const Model& model, const Branch& branch, int order, Drive drive = Drive::rate);

// The cubic of a deformation x_axis with a curve (a spring has axis 0 only), and coefficient k of
// that deformation.
CubicSeries& cubic_of(Equations& e, std::size_t elastic, int axis);
double deformation(const Equations& e, std::size_t elastic, int axis, int k);

// Sets τ = 0 at (q, λ, a): coefficients 0 of the unknowns, and the vectors fixed in the bodies.
void begin(Equations& e, const State<double>& q, const Vector<double>& lambda, double a);

// Computes coefficient k of all series; in pass `known` also of G and Φ.
void evaluate(Equations& e, Order o);

// Sets coefficient k of the unknowns to x_k = (r_k, 2 g_k; λ_k) and a_k.
void assign(Equations& e, int k, const Vector<double>& x, double a);

}  // namespace elastocheck::recursive::series
