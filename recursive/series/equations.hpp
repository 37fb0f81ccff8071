// Power series of the full nonlinear equations in the path parameter, computed order by order:
//
//   G(q, λ, a) = f_elast(q, a) + Φ_q(q, a)ᵀ λ - f_ext(q, a) = 0,   Φ(q, a) = 0,
//
// with power series q, λ, a in τ.
//
// A body rotates from its orientation at τ = 0 by the Gibbs vector g = tan(θ/2) n; its
// rotation is rational:
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

// start + rate · a, or · t
template <class T>
struct Driven {
    T start = Series<T>::zero();
    T rate = Series<T>::zero();
};

// A rotation by its Gibbs vector.
template <class Real>
struct TurnSeries {
    Vector3Series<Real> g, h;
    Series<Real> stretch, shrink;  // 1 + g·g, 1 / (1 + g·g)
    Matrix3Series<Real> hg, C;     // h gᵀ, C(g)
};
template <class Real>
struct BodySeries : TurnSeries<Real> {
    Vector3Series<Real> r;
};

// A vector fixed in a body.
template <class Real>
struct Arm {
    BodyId body = ground;
    Vector3<Real> local = Vector3<Real>::Zero();  // in body axes
    Vector3<Real> fixed = Vector3<Real>::Zero();  // at τ = 0
    Vector3Series<Real> s;                        // C fixed
};

// A curve on one piece: f = c_0 + ξ (c_1 + ξ (c_2 + ξ c_3)), ξ = x - about.
template <class Real>
struct CubicSeries {
    Real about = 0;
    std::array<Real, 4> c{0, 0, 0, 0};
    Series<Real> xi, inner, slope;  // ξ, c_2 + ξ c_3, c_1 + ξ (c_2 + ξ c_3)
};

template <class Real>
struct SpringSeries {
    AxialSpring kind;
    Real k = 0;  // of a linear law
    Driven<Real> free_length;
    Arm<Real> i, j;
    Vector3Series<Real> D, F;
    // ℓ², ℓ, 1/ℓ, ℓ - ℓ₀, U'(ℓ - ℓ₀), U'/ℓ
    Series<Real> length_squared, length, inverse, stretch, force, tension;
    CubicSeries<Real> cubic;  // if the law is a curve
};

// One deformation of a bushing with a law per axis.
template <class Real>
struct AxisSeries {
    Real k = 0;               // of a linear law
    Series<Real> x, force;    // a component of e - e₀, U'(x)
    CubicSeries<Real> cubic;  // if the law is a curve
};

// d in axes half way between those of i and j (Formulation::Frame::middle): B^½ has the Gibbs
// vector tan(|θ|/4) θ/|θ| = V / (|p| + W), p = (W, V) the relative quaternion.
template <class Real>
struct MiddleSeries {
    Series<Real> squared, size, sum, inverse;  // p·p, |p|, |p| + W, 1 / (|p| + W)
    TurnSeries<Real> half;                     // B^½
    // d_i in axes of i, d = B^-½ d_i; F_i = B^½ F', F_i × d_i
    Vector3Series<Real> d_i, d, F_local, F_i, m, g_m;
};

// One of the three Cardan or projected angles of B: the polar angle of a vector in a plane, with
// its row of H, δθ = H ω, ω the rotation of j relative to i in axes of i:
// row = axis + z/r · along.
template <class Real>
struct PlaneAngleSeries {
    Vector2Series<Real> xy, unit;  // r (cos, sin), (cos, sin)
    Series<Real> squared, r, inverse, angle, z, factor, moment;
    Vector3Series<Real> along, row, share;
};
template <class Real>
struct AnglesSeries {
    Matrix3Series<Real> B;  // times p·p
    std::array<PlaneAngleSeries<Real>, 3> axis;
};

template <class Real>
struct BushingSeries {
    Bushing kind;
    Matrix6<Real> K = Matrix6<Real>::Zero();           // of a linear law
    Vector6<Real> undeformed = Vector6<Real>::Zero();  // e₀
    Vector4<Real> A_i_local = Vector4<Real>::Zero(),   // quaternions of the markers (x, y, z, w)
        A_j_local = Vector4<Real>::Zero();
    Driven<Vector6<Real>> preload;
    Driven<Real> rise;  // of e₀ along z
    bool is_rising = false;
    bool rotational = false;  // whether there is a moment M' = ∂U/∂θ; else θ is not computed
    Arm<Real> i, j;
    Matrix3<Real> E_i;  // axes of marker i at τ = 0
    // (1 + g_i·g_j, g_j - g_i - g_i × g_j) → quaternion p of B = A_iᵀ A_j, any length
    Eigen::Matrix<Real, 4, 4> to_relative;
    Vector3Series<Real> rho, D, strain, cross_g, V, u, theta, moment_local, u_M, u_u_M, spread_1,
        spread_2, force_i, moment_i, F, M;
    Series<Vector4<Real>> relative;
    Vector6Series<Real> e, gradient, element_force;  // (d, θ) - e₀, ∂U/∂e, ∂U/∂e + preload
    Series<Real> dot_g, W, inverse, s;
    Composition<Real> phi, psi;
    // Allocated only if the law or the formulation needs them.
    AxisSeries<Real>* axis = nullptr;  // [6]
    MiddleSeries<Real>* middle = nullptr;
    AnglesSeries<Real>* angles = nullptr;

    bool twists() const { return rotational || middle != nullptr; }  // whether M is computed
};

template <class Real>
struct CoincidentSeries {
    static constexpr std::size_t rows = 3;
    CoincidentPoints kind;
    Arm<Real> i, j;
    Vector3Series<Real> F;
};
template <class Real>
struct PlaneSeries {
    static constexpr std::size_t rows = 1;
    PointInPlane kind;
    Driven<Real> offset;
    Arm<Real> i, j, normal;
    Vector3Series<Real> d, rho, F;
};
template <class Real>
struct PerpendicularSeries {
    static constexpr std::size_t rows = 1;
    PerpendicularDirections kind;
    Arm<Real> i, j;
    Vector3Series<Real> M;
};
template <class Real>
struct DistanceSeries {
    static constexpr std::size_t rows = 1;
    DistanceBetween kind;
    Driven<Real> length;
    Arm<Real> i, j;
    Series<Real> ell, inverse, share;  // ℓ, 1/ℓ, λ/ℓ
    Vector3Series<Real> d, F;
};
template <class Real>
struct AngleSeries {
    static constexpr std::size_t rows = 1;
    DirectionAtAngle kind;
    Driven<Real> angle;
    Arm<Real> i, x, y;
    Series<Real> alpha, cosine, sine;
    // cos α y_j, sin α x_j, w = cos α y_j - sin α x_j, u_i × w
    Vector3Series<Real> along, across, w, M;
};

template <class Real>
struct ForceSeries {
    DeadForce kind;
    Vector3<Real> f = Vector3<Real>::Zero();
    Driven<Real> factor;
    Series<Real> size;
    Arm<Real> at;
};
template <class Real>
struct BrakeSeries {
    BrakeForce kind;
    Vector3<Real> f = Vector3<Real>::Zero();
    Driven<Real> factor;
    Series<Real> size;
    Arm<Real> patch;
    Vector3Series<Real> lever;  // from the carrier's origin to the patch
};
template <class Real>
struct MomentSeries {
    DeadMoment kind;
    Vector3<Real> m = Vector3<Real>::Zero();
    Driven<Real> factor;
};
// A follower rotates with its body, and so does its moment about the origin, s × f or m.
template <class Real>
struct FollowerSeries {
    Driven<Real> factor;
    Series<Real> size;
    Arm<Real> f, m;
};

template <class Real>
using ElasticSeries = std::variant<SpringSeries<Real>, BushingSeries<Real>>;
template <class Real>
using ConstraintSeries =
    std::variant<CoincidentSeries<Real>, PlaneSeries<Real>, PerpendicularSeries<Real>,
                 DistanceSeries<Real>, AngleSeries<Real>>;
template <class Real>
using LoadSeries =
    std::variant<ForceSeries<Real>, MomentSeries<Real>, FollowerSeries<Real>, BrakeSeries<Real>>;

// All series of a model on a branch; allocated once.
template <class Real>
struct Equations {
    Arena room;
    Drive drive = Drive::rate;            // rate: the parameter is a; start: t
    std::vector<BodySeries<Real>> slots;  // ground, fixed, in slot 0
    std::vector<Series<Real>> lambda;     // one per row of Φ
    Series<Real> a;                       // the parameter
    std::vector<ElasticSeries<Real>> elastics;
    std::vector<ConstraintSeries<Real>> constraints;
    std::vector<LoadSeries<Real>> loads;  // static, then driven
    Vector<Real> G, Phi;                  // coefficient k after pass `known` [6nb], [m]
    // While settling, G - (1 - t) G_d and Φ - (1 - t) Φ_d replace G and Φ; d: at
    // the design position.
    Vector<Real> G_d, Phi_d;  // [6nb], [m]
    bool curved = false;      // whether any law is a curve

    int order() const { return room.order; }
    const BodySeries<Real>& operator[](BodyId b) const {
        return slots[static_cast<std::size_t>(b + 1)];
    }
    BodySeries<Real>& operator[](BodyId b) { return slots[static_cast<std::size_t>(b + 1)]; }
};

// The equations of a model on a branch. Each lane of Real may have a variant with other numbers, of
// the same kinds between the same bodies (`take`); a double has the one lane 0.
template <class Real>
Equations<Real> equations(const Model& model, const Branch& branch, int order,
                          Drive drive = Drive::rate);

// Sets the numbers of a lane: of the model's elements, constraints and loads, and of the drivers.
// settle_on_constants() follows the last lane.
template <class Real>
void take(Equations<Real>& e, const Model& model, const Branch& branch, int lane);
template <class Real>
void settle_on_constants(Equations<Real>& e);

// The cubic of a deformation x_axis with a curve (a spring has axis 0 only), and coefficient k of
// that deformation.
template <class Real>
CubicSeries<Real>& cubic_of(Equations<Real>& e, std::size_t elastic, int axis);
template <class Real>
const Real& deformation(const Equations<Real>& e, std::size_t elastic, int axis, int k);

// Sets τ = 0 at (q, λ, a) in a lane: coefficients 0 of the unknowns, and the vectors fixed
// in the bodies.
template <class Real>
void begin(Equations<Real>& e, const State<double>& q, const Vector<double>& lambda, double a,
           int lane = 0);

// Computes coefficient k of all series; in pass `known` also of G and Φ.
template <class Real>
void evaluate(Equations<Real>& e, Order o);

// Sets coefficient k of the unknowns to x_k = (r_k, 2 g_k; λ_k) and a_k.
template <class Real>
void assign(Equations<Real>& e, int k, const Vector<std::type_identity_t<Real>>& x,
            const std::type_identity_t<Real>& a);

// Instantiated in equations.cpp; terms.hpp defines them.
extern template struct Equations<double>;
extern template Equations<double> equations<double>(const Model&, const Branch&, int, Drive);
extern template void take<double>(Equations<double>&, const Model&, const Branch&, int);
extern template void settle_on_constants<double>(Equations<double>&);
extern template CubicSeries<double>& cubic_of<double>(Equations<double>&, std::size_t, int);
extern template const double& deformation<double>(const Equations<double>&, std::size_t, int, int);
extern template void begin<double>(Equations<double>&, const State<double>&, const Vector<double>&,
                                   double, int);
extern template void evaluate<double>(Equations<double>&, Order);
extern template void assign<double>(Equations<double>&, int, const Vector<double>&, const double&);

}  // namespace elastocheck::recursive::series
