// Coefficient k of every element, constraint and load, from the lower ones.
//
// Each evaluate() is a straight-line program for one term. Order o says which coefficient k it computes
// in which pass (taylor.hpp): in pass `known` x_k counts as zero, and coefficient k of G and Φ is added;
// in pass `change` the contribution of x_k is added to the term's own series, which is all that the
// next orders need. Its instructions are
//
//   linear(o, c, f)          c = f(of), where of(s) stands for the series s, in a linear expression
//   product(o, a, b, c, ×)   c = a × b, any bilinear product: a convolution of the coefficients
//
// and reciprocal(), square_root(), ... of taylor.hpp. A constant is added at k = 0 only.
#pragma once

#include "recursive/series/term_values.hpp"

namespace elastocheck::recursive::series {
// In an unnamed namespace for the reason given in term_values.hpp.
namespace detail {
namespace {

// ---- Rotations, arms and forces of the bodies.

// C(g) = (1 - h·g) I + h̃ + h gᵀ,  h = 2 g / (1 + g·g), where h·g is the trace of h gᵀ.
template <class Real>
void rotation_coefficients(Order o, TurnSeries<Real>& b) {
    product(o, b.g, b.g, b.stretch, dot);
    if (o.k == 0) b.stretch.c[0] += 1;
    reciprocal(o, b.stretch, b.shrink);
    product(o, b.shrink, b.g, b.h,
            [](const Real& x, const Vector3<Real>& g) -> Vector3<Real> { return 2 * x * g; });
    product(o, b.h, b.g, b.hg, outer);
    linear(o, b.C, [&](auto of) -> Matrix3<Real> {
        return of(b.hg) + tilde<Real>(of(b.h)) - of(b.hg).trace() * Matrix3<Real>::Identity();
    });
    if (o.k == 0) b.C.c[0] += Matrix3<Real>::Identity();
}
// s = C fixed
template <class Real>
void rotate_arm(Order o, const Equations<Real>& e, Arm<Real>& arm) {
    if (o.k > 0 && arm.body == ground) return;
    linear(o, arm.s, [&](auto of) -> Vector3<Real> { return of(e[arm.body].C) * arm.fixed; });
}

// Adds `sign` times a force, with its moment lever × F, to coefficient k of G. G is f_elast + Φ_qᵀ λ
// - f_ext: forces that resist a motion of the body count as positive.
template <class Real>
void add_force(Equations<Real>& e, int k, BodyId b, int sign, const Vector3Series<Real>& lever,
               const Vector3Series<Real>& F) {
    if (b == ground) return;
    e.G.template segment<3>(6 * b) += Real(sign) * at(F, k);
    e.G.template segment<3>(6 * b + 3) += Real(sign) * convolution(k, lever, F, cross);
}
// Adds `sign` times a moment likewise.
template <class Real>
void add_moment(Equations<Real>& e, int k, BodyId b, int sign, const Vector3Series<Real>& M) {
    if (b != ground) e.G.template segment<3>(6 * b + 3) += Real(sign) * at(M, k);
}

// D = p_j - p_i
template <class Real>
void separation(Order o, const Equations<Real>& e, const Arm<Real>& i, const Arm<Real>& j,
                Vector3Series<Real>& D) {
    const Vector3Series<Real>&r_i = e[i.body].r, &r_j = e[j.body].r;
    linear(o, D, [&](auto of) -> Vector3<Real> { return of(r_j) + of(j.s) - of(r_i) - of(i.s); });
}

// s = start + rate · a
template <class Real, class T>
void driven_value(Order o, const Equations<Real>& e, const Driven<T>& driven, Series<T>& s) {
    linear(o, s, [&](auto of) -> T { return driven.rate * of(e.a); });
    if (o.k == 0) s.c[0] += driven.start;
}
// Its coefficient k, for an input that needs no series.
template <class Real, class T>
T coefficient(const Equations<Real>& e, const Driven<T>& driven, int k) {
    const T change = driven.rate * at(e.a, k);
    return k == 0 ? T(change + driven.start) : change;
}

// ---- Laws: ∂U/∂x of a deformation x, ∂U/∂e of the deformations e, U the energy of the element.

template <class Real>
void law_gradient(Order o, const LinearRate&, const Real& rate, CubicSeries<Real>&,
                  const Series<Real>& x, Series<Real>& f) {
    linear(o, f, [&](auto of) -> Real { return rate * of(x); });
}
// The cubic piece in Horner's form, with the steps of CubicSeries:
// f = c_0 + ξ slope,  slope = c_1 + ξ inner,  inner = c_2 + ξ c_3;  f = c_0 + c_1 ξ on a straight piece.
template <class Real>
void law_gradient(Order o, const Curve&, const Real&, CubicSeries<Real>& t, const Series<Real>& x,
                  Series<Real>& f) {
    const auto& c = t.c;
    linear(o, t.xi, [&](auto of) -> Real { return of(x); });
    if (o.k == 0) t.xi.c[0] -= t.about;
    if (is_zero(c[2]) && is_zero(c[3])) {
        linear(o, f, [&](auto of) -> Real { return c[1] * of(t.xi); });
    } else {
        linear(o, t.inner, [&](auto of) -> Real { return c[3] * of(t.xi); });
        if (o.k == 0) t.inner.c[0] += c[2];
        product(o, t.inner, t.xi, t.slope, std::multiplies<>());
        if (o.k == 0) t.slope.c[0] += c[1];
        product(o, t.slope, t.xi, f, std::multiplies<>());
    }
    if (o.k == 0) f.c[0] += c[0];
}
template <class Real>
void law_gradient(Order o, const ScalarLaw& law, const Real& rate, CubicSeries<Real>& cubic,
                  const Series<Real>& x, Series<Real>& f) {
    std::visit([&](const auto& kind) { law_gradient(o, kind, rate, cubic, x, f); }, law);
}
template <class Real>
void law_gradient(Order o, const LinearStiffness&, BushingSeries<Real>& t) {
    linear(o, t.gradient, [&](auto of) -> Vector6<Real> { return t.K * of(t.e); });
}
template <class Real>
void law_gradient(Order o, const PerAxis& law, BushingSeries<Real>& t) {
    for (std::size_t k = 0; k < 6; ++k) {
        AxisSeries<Real>& axis = t.axis[k];
        linear(o, axis.x, [&](auto of) -> Real { return of(t.e)[static_cast<Eigen::Index>(k)]; });
        law_gradient(o, law.axis[k], axis.k, axis.cubic, axis.x, axis.force);
    }
    linear(o, t.gradient, [&](auto of) {
        Vector6<Real> f;
        for (int k = 0; k < 6; ++k) f[k] = of(t.axis[k].force);
        return f;
    });
}

// ---- Elements, by geometry.

// F = U'(ℓ - ℓ₀) D / ℓ
template <class Real>
void evaluate(Equations<Real>& e, SpringSeries<Real>& t, Order o) {
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.j);
    separation(o, e, t.i, t.j, t.D);
    product(o, t.D, t.D, t.length_squared, dot);
    square_root(o, t.length_squared, t.length);
    reciprocal(o, t.length, t.inverse);
    linear(o, t.stretch,
           [&](auto of) -> Real { return of(t.length) - t.free_length.rate * of(e.a); });
    if (o.k == 0) t.stretch.c[0] -= t.free_length.start;
    law_gradient(o, t.kind.law, t.k, t.cubic, t.stretch, t.force);
    product(o, t.force, t.inverse, t.tension, std::multiplies<>());
    product(o, t.tension, t.D, t.F, scale);
    if (o.pass == Pass::change) return;
    add_force(e, o.k, t.j.body, +1, t.j.s, t.F);
    add_force(e, o.k, t.i.body, -1, t.i.s, t.F);
}

// p = (W, V), the quaternion of B = A_iᵀ A_j of any length.
template <class Real>
void evaluate_relative(Equations<Real>& e, BushingSeries<Real>& t, Order o) {
    const BodySeries<Real>&b_i = e[t.i.body], &b_j = e[t.j.body];
    product(o, b_i.g, b_j.g, t.dot_g, dot);
    if (o.k == 0) t.dot_g.c[0] += 1;
    product(o, b_i.g, b_j.g, t.cross_g, cross);
    linear(o, t.relative, [&](auto of) -> Vector4<Real> {
        Vector4<Real> p;
        p << of(t.dot_g), of(b_j.g) - of(b_i.g) - of(t.cross_g);
        return t.to_relative * p;
    });
    linear(o, t.W, [&](auto of) -> Real { return of(t.relative)[0]; });
    linear(o, t.V, [&](auto of) -> Vector3<Real> { return of(t.relative).template tail<3>(); });
}

// ---- Measures of rotation: θ, then M = Hᵀ M' where δθ = H ω, both in axes of i.

// u = V / W = tan(|θ|/2) θ/|θ|,  θ = 2 F_1(u·u) u,  F_1(t²) = atan(t) / t (taylor.hpp)
template <class Real>
void rotation_vector(BushingSeries<Real>& t, Order o) {
    reciprocal(o, t.W, t.inverse);
    product(o, t.inverse, t.V, t.u, scale);
    product(o, t.u, t.u, t.s, dot);
    if (o.k == 0) {
        taylor_of_F(1, t.s.c[0], t.phi.b);
        taylor_of_F(3, t.s.c[0], t.psi.b);
    }
    compose(o, t.s, t.phi);
    compose(o, t.s, t.psi);
    product(o, t.phi.f, t.u, t.theta,
            [](const Real& phi, const Vector3<Real>& u) -> Vector3<Real> { return 2 * phi * u; });
}
// M = J(θ)⁻ᵀ M' = M' + F_1 u × M' + F_3 u × (u × M'),  F_3(t²) = (1 - F_1(t²)) / t²
template <class Real>
void moment_of_rotation_vector(BushingSeries<Real>& t, Order o) {
    product(o, t.u, t.moment_local, t.u_M, cross);
    product(o, t.u, t.u_M, t.u_u_M, cross);
    product(o, t.phi.f, t.u_M, t.spread_1, scale);
    product(o, t.psi.f, t.u_u_M, t.spread_2, scale);
    linear(o, t.moment_i, [&](auto of) -> Vector3<Real> {
        return t.E_i * (of(t.moment_local) + of(t.spread_1) + of(t.spread_2));
    });
}

// p·p B(p) = (W² - V·V) I + 2 V Vᵀ + 2 W Ṽ as a bilinear map of p = (W, V) with itself.
template <class Real>
Matrix3<Real> scaled_rotation(const Vector4<Real>& a, const Vector4<Real>& b) {
    const Vector3<Real> v = a.template tail<3>(), w = b.template tail<3>();
    return (a[0] * b[0] - v.dot(w)) * Matrix3<Real>::Identity() + 2 * v * w.transpose() +
           2 * a[0] * tilde<Real>(w);
}
// Polar angle of xy, with r and (cos, sin).
template <class Real>
void polar_angle(Order o, PlaneAngleSeries<Real>& t) {
    product(o, t.xy, t.xy, t.squared,
            [](const Vector2<Real>& a, const Vector2<Real>& b) -> Real { return a.dot(b); });
    square_root(o, t.squared, t.r);
    reciprocal(o, t.r, t.inverse);
    product(o, t.inverse, t.xy, t.unit,
            [](const Real& a, const Vector2<Real>& b) -> Vector2<Real> { return a * b; });
    arc(o, t.unit, t.angle);
}
// Row of H for one polar angle: row = axis + z/r (cos · cosine_axis + sin · sine_axis)
template <class Real>
void angle_row(Order o, PlaneAngleSeries<Real>& t, const Vector3<std::type_identity_t<Real>>& axis,
               const Vector3<std::type_identity_t<Real>>& cosine_axis,
               const Vector3<std::type_identity_t<Real>>& sine_axis) {
    product(o, t.z, t.inverse, t.factor, std::multiplies<>());
    linear(o, t.along, [&](auto of) -> Vector3<Real> {
        return of(t.unit).x() * cosine_axis + of(t.unit).y() * sine_axis;
    });
    product(o, t.factor, t.along, t.row, scale);
    if (o.k == 0) t.row.c[0] += axis;
}
// B = R_x R_y R_z. With c, s of the first angle:
//   ω = θ_x' (1, 0, 0) + θ_y' (0, c, s) + θ_z' (sin θ_y, -s cos θ_y, c cos θ_y)
//   H = (1, s tan θ_y, -c tan θ_y;  0, c, s;  0, -s / cos θ_y, c / cos θ_y)
template <class Real>
void cardan(BushingSeries<Real>& t, Order o) {
    auto& axis = t.angles->axis;
    PlaneAngleSeries<Real>&x = axis[0], &y = axis[1], &z = axis[2];
    const Matrix3Series<Real>& B = t.angles->B;
    linear(o, x.xy, [&](auto of) -> Vector2<Real> { return {of(B)(2, 2), -of(B)(1, 2)}; });
    linear(o, x.z, [&](auto of) -> Real { return of(B)(0, 2); });
    polar_angle(o, x);  // r = p·p cos θ_y
    linear(o, y.xy, [&](auto of) -> Vector2<Real> { return {of(x.r), of(B)(0, 2)}; });
    polar_angle(o, y);  // r = p·p
    linear(o, z.xy, [&](auto of) -> Vector2<Real> { return {of(B)(0, 0), -of(B)(0, 1)}; });
    polar_angle(o, z);
    angle_row(o, x, Vector3<Real>::UnitX(), -Vector3<Real>::UnitZ(), Vector3<Real>::UnitY());
    linear(o, y.row, [&](auto of) -> Vector3<Real> { return {0, of(x.unit).x(), of(x.unit).y()}; });
    product(o, y.r, x.inverse, z.factor, std::multiplies<>());
    linear(o, z.along, [&](auto of) -> Vector3<Real> {
        return {0, -of(x.unit).y(), of(x.unit).x()};
    });
    product(o, z.factor, z.along, z.row, scale);
}
// H = (1, s_x B_02/r_x, -c_x B_02/r_x;  -s_y B_12/r_y, 1, -c_y B_12/r_y;
//      -c_z B_20/r_z, -s_z B_20/r_z, 1)
// from δB = ω̃ B, r the length of the two entries that define the angle.
template <class Real>
void projected(BushingSeries<Real>& t, Order o) {
    auto& axis = t.angles->axis;
    PlaneAngleSeries<Real>&x = axis[0], &y = axis[1], &z = axis[2];
    const Matrix3Series<Real>& B = t.angles->B;
    linear(o, x.xy, [&](auto of) -> Vector2<Real> { return {of(B)(2, 2), -of(B)(1, 2)}; });
    linear(o, y.xy, [&](auto of) -> Vector2<Real> { return {of(B)(2, 2), of(B)(0, 2)}; });
    linear(o, z.xy, [&](auto of) -> Vector2<Real> { return {of(B)(0, 0), of(B)(1, 0)}; });
    linear(o, x.z, [&](auto of) -> Real { return of(B)(0, 2); });
    linear(o, y.z, [&](auto of) -> Real { return of(B)(1, 2); });
    linear(o, z.z, [&](auto of) -> Real { return of(B)(2, 0); });
    for (auto* each : {&x, &y, &z}) polar_angle(o, *each);
    angle_row(o, x, Vector3<Real>::UnitX(), -Vector3<Real>::UnitZ(), Vector3<Real>::UnitY());
    angle_row(o, y, Vector3<Real>::UnitY(), -Vector3<Real>::UnitZ(), -Vector3<Real>::UnitX());
    angle_row(o, z, Vector3<Real>::UnitZ(), -Vector3<Real>::UnitX(), -Vector3<Real>::UnitY());
}
template <class Real>
void plane_angles(BushingSeries<Real>& t, Order o) {
    product(o, t.relative, t.relative, t.angles->B, scaled_rotation<Real>);
    if (t.kind.formulation.angles == Formulation::Angles::cardan)
        cardan(t, o);
    else
        projected(t, o);
    const auto& axis = t.angles->axis;
    const PlaneAngleSeries<Real>&x = axis[0], &y = axis[1], &z = axis[2];
    linear(o, t.theta, [&](auto of) -> Vector3<Real> {
        return {of(x.angle), of(y.angle), of(z.angle)};
    });
}
// Σ row_n M'_n
template <class Real>
void moment_of_plane_angles(BushingSeries<Real>& t, Order o) {
    for (std::size_t n = 0; n < 3; ++n) {
        PlaneAngleSeries<Real>& each = t.angles->axis[n];
        linear(o, each.moment,
               [&](auto of) -> Real { return of(t.moment_local)[static_cast<Eigen::Index>(n)]; });
        product(o, each.moment, each.row, each.share, scale);
    }
    const auto& axis = t.angles->axis;
    const PlaneAngleSeries<Real>&x = axis[0], &y = axis[1], &z = axis[2];
    linear(o, t.moment_i, [&](auto of) -> Vector3<Real> {
        return t.E_i * (of(x.share) + of(y.share) + of(z.share));
    });
}

// ---- The frame on i: d = d_i.

template <class Real>
void deformation_on_i(BushingSeries<Real>& t, Order o) {
    linear(o, t.e, [&](auto of) -> Vector6<Real> {
        Vector6<Real> deformation;
        deformation << t.E_i.transpose() * of(t.strain), of(t.theta);
        return deformation;
    });
}
template <class Real>
void force_on_i(BushingSeries<Real>& t, Order o) {
    linear(o, t.force_i, [&](auto of) -> Vector3<Real> {
        return t.E_i * of(t.element_force).template head<3>();
    });
}

// ---- The frame in the middle: d = B^-½ d_i.

template <class Real>
void middle_deformation(BushingSeries<Real>& t, Order o) {
    MiddleSeries<Real>& s = *t.middle;
    product(o, t.relative, t.relative, s.squared,
            [](const Vector4<Real>& a, const Vector4<Real>& b) -> Real { return a.dot(b); });
    square_root(o, s.squared, s.size);
    linear(o, s.sum, [&](auto of) -> Real { return of(s.size) + of(t.W); });
    reciprocal(o, s.sum, s.inverse);
    product(o, s.inverse, t.V, s.half.g, scale);
    rotation_coefficients(o, s.half);
    linear(o, s.d_i, [&](auto of) -> Vector3<Real> { return t.E_i.transpose() * of(t.strain); });
    product(o, s.half.C, s.d_i, s.d, apply_transposed);
    linear(o, t.e, [&](auto of) -> Vector6<Real> {
        Vector6<Real> deformation;
        deformation << of(s.d), of(t.theta);
        return deformation;
    });
}
// B^½ rotates by ω_½ = (I + B^½)⁻¹ ω = ½ (I - g̃) ω while B rotates by ω, so that with F_i = B^½ F'
//   F'·δd = F_i·(δd_i + d_i × ω_½) = F_i·δd_i + ½ (m + g × m)·ω,   m = F_i × d_i
// The moment ½ (m + g × m) acts on j, its opposite on i. A formulation without offset_moment has
// neither.
template <class Real>
void middle_force(BushingSeries<Real>& t, Order o) {
    MiddleSeries<Real>& s = *t.middle;
    linear(o, s.F_local,
           [&](auto of) -> Vector3<Real> { return of(t.element_force).template head<3>(); });
    product(o, s.half.C, s.F_local, s.F_i, apply);
    product(o, s.F_i, s.d_i, s.m, cross);
    product(o, s.half.g, s.m, s.g_m, cross);
    linear(o, t.force_i, [&](auto of) -> Vector3<Real> { return t.E_i * of(s.F_i); });
}

// M on j, its opposite on i: conjugate to θ, and to d where the frame rotates with j.
template <class Real>
void evaluate_moment(Equations<Real>& e, BushingSeries<Real>& t, Order o) {
    linear(o, t.moment_local,
           [&](auto of) -> Vector3<Real> { return of(t.element_force).template tail<3>(); });
    if (!t.rotational || !t.kind.formulation.conjugate)
        linear(o, t.moment_i, [&](auto of) -> Vector3<Real> { return t.E_i * of(t.moment_local); });
    else
        t.angles != nullptr ? moment_of_plane_angles(t, o) : moment_of_rotation_vector(t, o);
    if (t.middle != nullptr && t.kind.formulation.offset_moment)
        add_linear(o, t.moment_i, [&](auto of) -> Vector3<Real> {
            return t.E_i * (of(t.middle->m) + of(t.middle->g_m)) / 2;
        });
    product(o, e[t.i.body].C, t.moment_i, t.M, apply);
}

// F = A_f F',  (F', M') = ∂U/∂e(e - e₀) + preload,  e = (d, θ), A_f the axes of the formulation's frame
template <class Real>
void evaluate(Equations<Real>& e, BushingSeries<Real>& t, Order o) {
    const BodySeries<Real>&b_i = e[t.i.body], &b_j = e[t.j.body];
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.j);
    linear(o, t.rho, [&](auto of) -> Vector3<Real> { return of(b_j.r) + of(t.j.s) - of(b_i.r); });
    linear(o, t.D, [&](auto of) -> Vector3<Real> { return of(t.rho) - of(t.i.s); });
    product(o, b_i.C, t.D, t.strain, apply_transposed);
    if (t.twists()) evaluate_relative(e, t, o);
    if (t.rotational) t.angles != nullptr ? plane_angles(t, o) : rotation_vector(t, o);
    t.middle != nullptr ? middle_deformation(t, o) : deformation_on_i(t, o);
    if (o.k == 0) t.e.c[0] -= t.undeformed;
    if (t.is_rising) {
        add_linear(o, t.e, [&](auto of) -> Vector6<Real> {
            return Vector6<Real>::Unit(2) * (-t.rise.rate * of(e.a));
        });
        if (o.k == 0) t.e.c[0][2] -= t.rise.start;
    }
    std::visit([&](const auto& law) { law_gradient(o, law, t); }, t.kind.law);
    linear(o, t.element_force,
           [&](auto of) -> Vector6<Real> { return of(t.gradient) + of(e.a) * t.preload.rate; });
    if (o.k == 0) t.element_force.c[0] += t.preload.start;
    t.middle != nullptr ? middle_force(t, o) : force_on_i(t, o);
    product(o, b_i.C, t.force_i, t.F, apply);
    if (t.twists()) evaluate_moment(e, t, o);
    if (o.pass == Pass::change) return;
    add_force(e, o.k, t.j.body, +1, t.j.s, t.F);
    add_force(e, o.k, t.i.body, -1, t.kind.formulation.offset_moment ? t.rho : t.i.s, t.F);
    if (!t.twists()) return;
    add_moment(e, o.k, t.j.body, +1, t.M);
    add_moment(e, o.k, t.i.body, -1, t.M);
}

// ---- Constraints: each adds its Φ_qᵀ λ to G and sets its rows of Φ.

// Φ = p_i - p_j

template <class Real>
void evaluate(Equations<Real>& e, CoincidentSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.j);
    linear(o, t.F, [&](auto of) -> Vector3<Real> {
        return {of(lambda[0]), of(lambda[1]), of(lambda[2])};
    });
    if (o.pass == Pass::change) return;
    add_force(e, o.k, t.i.body, +1, t.i.s, t.F);
    add_force(e, o.k, t.j.body, -1, t.j.s, t.F);
    Eigen::Map<Vector3<Real>> value(Phi);
    value = at(e[t.i.body].r, o.k) + at(t.i.s, o.k) - at(e[t.j.body].r, o.k) - at(t.j.s, o.k);
}

// Φ = n_j·(p_i - p_j) - offset, whose force λ n_j acts at p_i: rho is the lever of p_i on j
template <class Real>
void evaluate(Equations<Real>& e, PlaneSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.j);
    rotate_arm(o, e, t.normal);
    separation(o, e, t.j, t.i, t.d);
    const Vector3Series<Real>&r_i = e[t.i.body].r, &r_j = e[t.j.body].r;
    linear(o, t.rho, [&](auto of) -> Vector3<Real> { return of(r_i) + of(t.i.s) - of(r_j); });
    product(o, *lambda, t.normal.s, t.F, scale);
    if (o.pass == Pass::change) return;
    add_force(e, o.k, t.i.body, +1, t.i.s, t.F);
    add_force(e, o.k, t.j.body, -1, t.rho, t.F);
    *Phi = convolution(o.k, t.normal.s, t.d, dot) - coefficient(e, t.offset, o.k);
}

// Φ = u_i·u_j, whose moment is λ u_i × u_j
template <class Real>
void evaluate(Equations<Real>& e, PerpendicularSeries<Real>& t, const Series<Real>* lambda,
              Real* Phi, Order o) {
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.j);
    product(o, t.i.s, t.j.s, t.M, cross);
    if (o.pass == Pass::change) return;
    const Vector3<Real> M = convolution(o.k, *lambda, t.M, scale);
    if (t.i.body != ground) e.G.template segment<3>(6 * t.i.body + 3) += M;
    if (t.j.body != ground) e.G.template segment<3>(6 * t.j.body + 3) -= M;
    *Phi = convolution(o.k, t.i.s, t.j.s, dot);
}

// Φ = (d·d / ℓ - ℓ) / 2, whose force is λ d / ℓ
template <class Real>
void evaluate(Equations<Real>& e, DistanceSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.j);
    separation(o, e, t.j, t.i, t.d);
    if (o.k <= t.ell.last) {
        driven_value(o, e, t.length, t.ell);
        reciprocal(o, t.ell, t.inverse);
    }
    product(o, *lambda, t.inverse, t.share, std::multiplies<>());
    product(o, t.share, t.d, t.F, scale);
    if (o.pass == Pass::change) return;
    add_force(e, o.k, t.i.body, +1, t.i.s, t.F);
    add_force(e, o.k, t.j.body, -1, t.j.s, t.F);
    Real squared_over_length = 0;
    for (int l = 0; l <= std::min(o.k, t.inverse.last); ++l)
        squared_over_length += at(t.inverse, l) * convolution(o.k - l, t.d, t.d, dot);
    *Phi = (squared_over_length - at(t.ell, o.k)) / 2;
}

// Φ = u_i·w,  w = cos α y_j - sin α x_j, whose moment is λ u_i × w
template <class Real>
void evaluate(Equations<Real>& e, AngleSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    rotate_arm(o, e, t.i);
    rotate_arm(o, e, t.x);
    rotate_arm(o, e, t.y);
    if (o.k <= t.alpha.last) {
        driven_value(o, e, t.angle, t.alpha);
        cosine_sine(o, t.alpha, t.cosine, t.sine);
    }
    product(o, t.cosine, t.y.s, t.along, scale);
    product(o, t.sine, t.x.s, t.across, scale);
    linear(o, t.w, [&](auto of) -> Vector3<Real> { return of(t.along) - of(t.across); });
    product(o, t.i.s, t.w, t.M, cross);
    if (o.pass == Pass::change) return;
    const Vector3<Real> M = convolution(o.k, *lambda, t.M, scale);
    if (t.i.body != ground) e.G.template segment<3>(6 * t.i.body + 3) += M;
    if (t.x.body != ground) e.G.template segment<3>(6 * t.x.body + 3) -= M;
    *Phi = convolution(o.k, t.i.s, t.w, dot);
}

// ---- Loads: each subtracts its force and moment about the body's origin from G.

template <class Real>
void evaluate(Equations<Real>& e, ForceSeries<Real>& t, Order o) {
    rotate_arm(o, e, t.at);
    driven_value(o, e, t.factor, t.size);
    if (o.pass == Pass::change) return;
    const BodyId b = t.at.body;
    e.G.template segment<3>(6 * b) -= at(t.size, o.k) * t.f;
    e.G.template segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.at.s, scale).cross(t.f);
}
template <class Real>
void evaluate(Equations<Real>& e, BrakeSeries<Real>& t, Order o) {
    rotate_arm(o, e, t.patch);
    driven_value(o, e, t.factor, t.size);
    const BodySeries<Real>&carrier = e[t.kind.body], &wheel = e[t.patch.body];
    linear(o, t.lever,
           [&](auto of) -> Vector3<Real> { return of(wheel.r) + of(t.patch.s) - of(carrier.r); });
    if (o.pass == Pass::change) return;
    const BodyId b = t.kind.body;
    e.G.template segment<3>(6 * b) -= at(t.size, o.k) * t.f;
    e.G.template segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.lever, scale).cross(t.f);
}
template <class Real>
void evaluate(Equations<Real>& e, MomentSeries<Real>& t, Order o) {
    if (o.pass == Pass::change) return;
    e.G.template segment<3>(6 * t.kind.body + 3) -= coefficient(e, t.factor, o.k) * t.m;
}
template <class Real>
void evaluate(Equations<Real>& e, FollowerSeries<Real>& t, Order o) {
    rotate_arm(o, e, t.f);
    rotate_arm(o, e, t.m);
    driven_value(o, e, t.factor, t.size);
    if (o.pass == Pass::change) return;
    const BodyId b = t.f.body;
    e.G.template segment<3>(6 * b) -= convolution(o.k, t.size, t.f.s, scale);
    e.G.template segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.m.s, scale);
}

}  // namespace
}  // namespace detail
}  // namespace elastocheck::recursive::series
