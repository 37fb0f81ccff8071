#include "recursive/series/equations.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace elastocheck::recursive::series {
namespace {

// ---- Memory.

void reserve_arm(Arena& room, Arm& arm, BodyId body) {
    arm.body = body;
    reserve(room, arm.s, body == ground);
}
void reserve(Arena& room, TurnSeries& t, bool constant = false) {
    const auto each = [&](auto&... all) { (reserve(room, all, constant), ...); };
    each(t.g, t.h, t.stretch, t.shrink, t.hg, t.C);
}
void reserve(Arena& room, CubicSeries& t) {
    for (auto* all : {&t.xi, &t.inner, &t.slope}) reserve(room, *all);
}
// A term between two bodies: memory for its two arms and for the listed series.
template <class Term, class Kind, class... Members>
Term between(Arena& room, const Kind& kind, Members... members) {
    Term t;
    t.kind = kind;
    reserve_arm(room, t.i, kind.i.body);
    reserve_arm(room, t.j, kind.j.body);
    (reserve(room, t.*members), ...);
    return t;
}

ElasticSeries term(Arena& room, const AxialSpring& e) {
    using T = SpringSeries;
    T t = between<T>(room, e, &T::D, &T::F, &T::length_squared, &T::length, &T::inverse,
                     &T::stretch, &T::force, &T::tension);
    t.free_length.start = e.free_length;
    if (std::holds_alternative<Curve>(e.law)) reserve(room, t.cubic);
    return t;
}

ElasticSeries term(Arena& room, const Bushing& e) {
    using T = BushingSeries;
    T t = between<T>(room, e, &T::rho, &T::D, &T::strain, &T::cross_g, &T::V, &T::u, &T::theta,
                     &T::relative, &T::e, &T::gradient, &T::stress, &T::moment_local, &T::u_M,
                     &T::u_u_M, &T::spread_1, &T::spread_2, &T::force_i, &T::moment_i, &T::F, &T::M,
                     &T::dot_g, &T::W, &T::inverse, &T::s);
    reserve(room, t.phi);
    reserve(room, t.psi, &t.phi);
    t.preload.start = e.preload;
    t.rotational = rotational(e.law) || !e.preload.tail<3>().isZero(0);
    if (const auto* law = std::get_if<PerAxis>(&e.law)) {
        t.axis = room.take<AxisSeries>(6, {});
        for (std::size_t k = 0; k < 6; ++k) {
            reserve(room, t.axis[k].x);
            reserve(room, t.axis[k].force);
            if (std::holds_alternative<Curve>(law->axis[k])) reserve(room, t.axis[k].cubic);
        }
    }
    if (e.formulation.frame == Formulation::Frame::middle) {
        t.middle = room.take<MiddleSeries>(1, {});
        MiddleSeries& s = *t.middle;
        reserve(room, s.half);
        for (auto* all : {&s.squared, &s.size, &s.sum, &s.inverse}) reserve(room, *all);
        for (auto* all : {&s.d_i, &s.d, &s.F_local, &s.F_i, &s.m, &s.g_m}) reserve(room, *all);
    }
    if (e.formulation.angles != Formulation::Angles::rotation_vector) {
        t.angles = room.take<AnglesSeries>(1, {});
        reserve(room, t.angles->B);
        for (auto& s : t.angles->axis) {
            for (auto* all : {&s.xy, &s.unit}) reserve(room, *all);
            for (auto* all : {&s.squared, &s.r, &s.inverse, &s.angle, &s.z, &s.factor, &s.moment})
                reserve(room, *all);
            for (auto* all : {&s.along, &s.row, &s.share}) reserve(room, *all);
        }
    }
    return t;
}

ConstraintSeries term(Arena& room, const CoincidentPoints& c) {
    return between<CoincidentSeries>(room, c, &CoincidentSeries::F);
}
ConstraintSeries term(Arena& room, const PointInPlane& c) {
    auto t = between<PlaneSeries>(room, c, &PlaneSeries::d, &PlaneSeries::rho, &PlaneSeries::F);
    reserve_arm(room, t.normal, c.normal_j.body);
    t.offset.start = c.offset;
    return t;
}
ConstraintSeries term(Arena& room, const PerpendicularDirections& c) {
    return between<PerpendicularSeries>(room, c, &PerpendicularSeries::M);
}
ConstraintSeries term(Arena& room, const DistanceBetween& c) {
    using T = DistanceSeries;
    T t = between<T>(room, c, &T::ell, &T::inverse, &T::share, &T::d, &T::F);
    t.length.start = c.length;
    return t;
}
ConstraintSeries term(Arena& room, const DirectionAtAngle& c) {
    AngleSeries t;
    t.kind = c;
    t.angle.start = c.angle;
    reserve_arm(room, t.i, c.i.body);
    reserve_arm(room, t.x, c.j.body);
    reserve_arm(room, t.y, c.y_j.body);
    for (auto* s : {&t.alpha, &t.cosine, &t.sine}) reserve(room, *s);
    for (auto* s : {&t.along, &t.across, &t.w, &t.M}) reserve(room, *s);
    return t;
}

LoadSeries term(Arena& room, const DeadForce& f) {
    ForceSeries t;
    t.kind = f;
    reserve(room, t.size);
    reserve_arm(room, t.at, f.at.body);
    return t;
}
LoadSeries term(Arena&, const DeadMoment& m) {
    MomentSeries t;
    t.kind = m;
    return t;
}
LoadSeries follower(Arena& room, BodyId body, const Eigen::Vector3d& f_local,
                    const Eigen::Vector3d& m_local) {
    FollowerSeries t;
    t.f_local = f_local;
    t.m_local = m_local;
    reserve(room, t.size);
    reserve_arm(room, t.f, body);
    reserve_arm(room, t.m, body);
    return t;
}
LoadSeries term(Arena& room, const FollowerForce& f) {
    return follower(room, f.at.body, f.f_local, f.at.s_local.cross(f.f_local));
}
LoadSeries term(Arena& room, const FollowerMoment& m) {
    return follower(room, m.body, V3::Zero(), m.m_local);
}
LoadSeries load(Arena& room, const Load& load, const Driven<double>& factor) {
    LoadSeries all = std::visit([&](const auto& kind) { return term(room, kind); }, load.kind);
    std::visit([&](auto& t) { t.factor = factor; }, all);
    return all;
}

// ---- Driven inputs. Constraints without an offset cannot be driven (models/lowering.hpp).

template <class T>
void add(Driven<T>& driven, Drive drive, const Driver& driver, const T& what) {
    if (drive == Drive::rate) driven.start += driver.start * what;
    driven.rate += speed<double>(driver, drive) * what;
}
void move(CoincidentSeries&, Drive, const Driver&) {
    throw std::invalid_argument("coincident points have no offset");
}
void move(PerpendicularSeries&, Drive, const Driver&) {
    throw std::invalid_argument("perpendicular directions have no offset");
}
void move(PlaneSeries& t, Drive drive, const Driver& driver) { add(t.offset, drive, driver, 1.0); }
void move(DistanceSeries& t, Drive drive, const Driver& driver) {
    add(t.length, drive, driver, 1.0);
}
void move(AngleSeries& t, Drive drive, const Driver& driver) { add(t.angle, drive, driver, 1.0); }

void drive(Equations& e, const Model&, const Driver& driver, const Load& what) {
    Driven<double> factor;
    add(factor, e.drive, driver, 1.0);
    e.loads.push_back(load(e.room, what, factor));
}
void drive(Equations& e, const Model& model, const Driver& driver, const Motion& what) {
    std::visit([&](auto& t) { move(t, e.drive, driver); },
               e.constraints[constraint_of(model, what)]);
}
void drive(Equations& e, const Model&, const Driver& driver, const FreeLength& what) {
    add(std::get<SpringSeries>(e.elastics[static_cast<std::size_t>(what.elastic)]).free_length,
        e.drive, driver, 1.0);
}
void drive(Equations& e, const Model&, const Driver& driver, const Preload& what) {
    auto& t = std::get<BushingSeries>(e.elastics[static_cast<std::size_t>(what.elastic)]);
    add(t.preload, e.drive, driver, what.direction);
    t.rotational = t.rotational || !what.direction.tail<3>().isZero(0);
}

// A series that does not change has only coefficient 0.
void settle_on_constants(CoincidentSeries&) {}
void settle_on_constants(PerpendicularSeries&) {}
void settle_on_constants(PlaneSeries&) {}
void settle_on_constants(DistanceSeries& t) {
    if (t.length.rate == 0) t.ell.last = t.inverse.last = 0;
}
void settle_on_constants(AngleSeries& t) {
    if (t.angle.rate == 0) t.alpha.last = t.cosine.last = t.sine.last = 0;
}

bool curved(const SpringSeries& t) { return std::holds_alternative<Curve>(t.kind.law); }
bool curved(const BushingSeries& t) {
    const auto* law = std::get_if<PerAxis>(&t.kind.law);
    return law != nullptr && std::ranges::any_of(law->axis, [](const ScalarLaw& axis) {
               return std::holds_alternative<Curve>(axis);
           });
}

// ---- Values at τ = 0.

void place(Arm& arm, const State<double>& q, const Eigen::Vector3d& local) {
    arm.fixed = q[arm.body].lever(local);
}
void place(SpringSeries& t, const State<double>& q) {
    place(t.i, q, t.kind.i.s_local);
    place(t.j, q, t.kind.j.s_local);
}
// p ↦ l p r of quaternions (w, x, y, z)
Eigen::Matrix4d sandwich(const Eigen::Quaterniond& l, const Eigen::Quaterniond& r) {
    Eigen::Matrix4d L;
    for (int c = 0; c < 4; ++c) {
        const Eigen::Quaterniond unit(c == 0, c == 1, c == 2, c == 3);
        const Eigen::Quaterniond p = l * unit * r;
        L.col(c) << p.w(), p.x(), p.y(), p.z();
    }
    return L;
}
void place(BushingSeries& t, const State<double>& q) {
    const Bushing& e = t.kind;
    place(t.i, q, e.i.s_local);
    place(t.j, q, e.j.s_local);
    const Eigen::Quaterniond p_i = q[e.i.body].p * e.i.A_local, p_j = q[e.j.body].p * e.j.A_local;
    t.E_i = p_i.toRotationMatrix();
    t.to_relative = sandwich(p_i.conjugate(), p_j);
    if (t.to_relative(0, 0) < 0) t.to_relative = -t.to_relative;  // rotation angle below π
}
void place(CoincidentSeries& t, const State<double>& q) {
    place(t.i, q, t.kind.i.s_local);
    place(t.j, q, t.kind.j.s_local);
}
void place(PlaneSeries& t, const State<double>& q) {
    place(t.i, q, t.kind.i.s_local);
    place(t.j, q, t.kind.j.s_local);
    place(t.normal, q, t.kind.normal_j.u_local);
}
void place(PerpendicularSeries& t, const State<double>& q) {
    place(t.i, q, t.kind.i.u_local);
    place(t.j, q, t.kind.j.u_local);
}
void place(DistanceSeries& t, const State<double>& q) {
    place(t.i, q, t.kind.i.s_local);
    place(t.j, q, t.kind.j.s_local);
}
void place(AngleSeries& t, const State<double>& q) {
    place(t.i, q, t.kind.i.u_local);
    place(t.x, q, t.kind.j.u_local);
    place(t.y, q, t.kind.y_j.u_local);
}
void place(ForceSeries& t, const State<double>& q) { place(t.at, q, t.kind.at.s_local); }
void place(MomentSeries&, const State<double>&) {}
void place(FollowerSeries& t, const State<double>& q) {
    place(t.f, q, t.f_local);
    place(t.m, q, t.m_local);
}

// ---- Coefficient k.

void move(Order o, TurnSeries& b) {
    product(o, b.g, b.g, b.stretch, dot);
    if (o.k == 0) b.stretch.c[0] += 1;
    reciprocal(o, b.stretch, b.shrink);
    product(o, b.shrink, b.g, b.h, [](double x, const V3& g) -> V3 { return 2 * x * g; });
    product(o, b.h, b.g, b.hg, outer);
    linear(o, b.C, [&](auto of) -> Matrix3<double> {
        return of(b.hg) + tilde<double>(of(b.h)) - of(b.hg).trace() * Matrix3<double>::Identity();
    });
    if (o.k == 0) b.C.c[0] += Matrix3<double>::Identity();
}
void turn(Order o, const Equations& e, Arm& arm) {
    if (o.k > 0 && arm.body == ground) return;
    linear(o, arm.s, [&](auto of) -> V3 { return of(e[arm.body].C) * arm.fixed; });
}

// Adds a force with its moment from the lever to coefficient k of G, times sign.
void push(Equations& e, int k, BodyId b, double sign, const Vector3Series& lever,
          const Vector3Series& F) {
    if (b == ground) return;
    e.G.segment<3>(6 * b) += sign * at(F, k);
    e.G.segment<3>(6 * b + 3) += sign * convolution(k, lever, F, cross);
}
void twist(Equations& e, int k, BodyId b, double sign, const Vector3Series& M) {
    if (b != ground) e.G.segment<3>(6 * b + 3) += sign * at(M, k);
}

void distance(Order o, const Equations& e, const Arm& i, const Arm& j,
              Vector3Series& D) {  // p_j - p_i
    const Vector3Series &r_i = e[i.body].r, &r_j = e[j.body].r;
    linear(o, D, [&](auto of) -> V3 { return of(r_j) + of(j.s) - of(r_i) - of(i.s); });
}

// Coefficient k of start + rate · a.
template <class T>
void follow(Order o, const Equations& e, const Driven<T>& driven, Series<T>& s) {
    linear(o, s, [&](auto of) -> T { return driven.rate * of(e.a); });
    if (o.k == 0) s.c[0] += driven.start;
}
template <class T>
T coefficient(const Equations& e, const Driven<T>& driven, int k) {
    const T moved = driven.rate * at(e.a, k);
    return k == 0 ? T(moved + driven.start) : moved;
}

// ---- Laws: ∂u/∂x of a deformation x, ∂u/∂e of the deformations e.

void law_gradient(Order o, const LinearRate& law, CubicSeries&, const Scalar& x, Scalar& f) {
    linear(o, f, [&](auto of) { return law.k * of(x); });
}
void law_gradient(Order o, const Curve&, CubicSeries& t, const Scalar& x, Scalar& f) {
    const auto& c = t.c;
    linear(o, t.xi, [&](auto of) { return of(x); });
    if (o.k == 0) t.xi.c[0] -= t.about;
    if (c[2] == 0 && c[3] == 0) {
        linear(o, f, [&](auto of) { return c[1] * of(t.xi); });
    } else {
        linear(o, t.inner, [&](auto of) { return c[3] * of(t.xi); });
        if (o.k == 0) t.inner.c[0] += c[2];
        product(o, t.inner, t.xi, t.slope, std::multiplies<>());
        if (o.k == 0) t.slope.c[0] += c[1];
        product(o, t.slope, t.xi, f, std::multiplies<>());
    }
    if (o.k == 0) f.c[0] += c[0];
}
void law_gradient(Order o, const ScalarLaw& law, CubicSeries& cubic, const Scalar& x, Scalar& f) {
    std::visit([&](const auto& kind) { law_gradient(o, kind, cubic, x, f); }, law);
}
void law_gradient(Order o, const LinearStiffness& law, BushingSeries& t) {
    linear(o, t.gradient, [&](auto of) -> Vector6<double> { return law.K * of(t.e); });
}
void law_gradient(Order o, const PerAxis& law, BushingSeries& t) {
    for (std::size_t k = 0; k < 6; ++k) {
        AxisSeries& axis = t.axis[k];
        linear(o, axis.x, [&](auto of) { return of(t.e)[static_cast<Eigen::Index>(k)]; });
        law_gradient(o, law.axis[k], axis.cubic, axis.x, axis.force);
    }
    linear(o, t.gradient, [&](auto of) {
        Vector6<double> f;
        for (int k = 0; k < 6; ++k) f[k] = of(t.axis[k].force);
        return f;
    });
}

// ---- Elements, by geometry.

// F = u'(ℓ - ℓ₀) D / ℓ
void evaluate(Equations& e, SpringSeries& t, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    distance(o, e, t.i, t.j, t.D);
    product(o, t.D, t.D, t.length_squared, dot);
    square_root(o, t.length_squared, t.length);
    reciprocal(o, t.length, t.inverse);
    linear(o, t.stretch, [&](auto of) { return of(t.length) - t.free_length.rate * of(e.a); });
    if (o.k == 0) t.stretch.c[0] -= t.free_length.start;
    law_gradient(o, t.kind.law, t.cubic, t.stretch, t.force);
    product(o, t.force, t.inverse, t.tension, std::multiplies<>());
    product(o, t.tension, t.D, t.F, scale);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.i.s, t.F);
}

// p = (W, V), the quaternion of B = A_iᵀ A_j of any length.
void evaluate_relative(Equations& e, BushingSeries& t, Order o) {
    const BodySeries &b_i = e[t.i.body], &b_j = e[t.j.body];
    product(o, b_i.g, b_j.g, t.dot_g, dot);
    if (o.k == 0) t.dot_g.c[0] += 1;
    product(o, b_i.g, b_j.g, t.cross_g, cross);
    linear(o, t.relative, [&](auto of) -> Eigen::Vector4d {
        Eigen::Vector4d p;
        p << of(t.dot_g), of(b_j.g) - of(b_i.g) - of(t.cross_g);
        return t.to_relative * p;
    });
    linear(o, t.W, [&](auto of) { return of(t.relative)[0]; });
    linear(o, t.V, [&](auto of) -> V3 { return of(t.relative).template tail<3>(); });
}

// ---- Measures of rotation: θ, then M = Hᵀ M' where δθ = H ω, both in axes of i.

// u = tan(|θ|/2) θ/|θ|,  θ = 2 F_1(u·u) u
void rotation_vector(BushingSeries& t, Order o) {
    reciprocal(o, t.W, t.inverse);
    product(o, t.inverse, t.V, t.u, scale);
    product(o, t.u, t.u, t.s, dot);
    if (o.k == 0) {
        taylor_of_F(1, t.s.c[0], t.phi.b);
        taylor_of_F(3, t.s.c[0], t.psi.b);
    }
    compose(o, t.s, t.phi);
    compose(o, t.s, t.psi);
    product(o, t.phi.f, t.u, t.theta, [](double phi, const V3& u) -> V3 { return 2 * phi * u; });
}
// J(θ)⁻ᵀ = I + F_1 ũ + F_3 ũ²
void moment_of_rotation_vector(BushingSeries& t, Order o) {
    product(o, t.u, t.moment_local, t.u_M, cross);
    product(o, t.u, t.u_M, t.u_u_M, cross);
    product(o, t.phi.f, t.u_M, t.spread_1, scale);
    product(o, t.psi.f, t.u_u_M, t.spread_2, scale);
    linear(o, t.moment_i, [&](auto of) -> V3 {
        return t.E_i * (of(t.moment_local) + of(t.spread_1) + of(t.spread_2));
    });
}

// p·p B(p), as a bilinear map of p with itself
Matrix3<double> rotation_of(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
    const V3 v = a.tail<3>(), w = b.tail<3>();
    return (a[0] * b[0] - v.dot(w)) * Matrix3<double>::Identity() + 2 * v * w.transpose() +
           2 * a[0] * tilde<double>(w);
}
void angle(Order o, PlaneAngleSeries& t) {
    product(o, t.xy, t.xy, t.squared,
            [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.dot(b); });
    square_root(o, t.squared, t.r);
    reciprocal(o, t.r, t.inverse);
    product(o, t.inverse, t.xy, t.unit,
            [](double a, const Eigen::Vector2d& b) -> Eigen::Vector2d { return a * b; });
    arc(o, t.unit, t.angle);
}
// row = fixed + z/r (cos · of_cosine + sin · of_sine)
void row_of(Order o, PlaneAngleSeries& t, const V3& fixed, const V3& of_cosine, const V3& of_sine) {
    product(o, t.z, t.inverse, t.factor, std::multiplies<>());
    linear(o, t.along,
           [&](auto of) -> V3 { return of(t.unit).x() * of_cosine + of(t.unit).y() * of_sine; });
    product(o, t.factor, t.along, t.row, scale);
    if (o.k == 0) t.row.c[0] += fixed;
}
// B = R_x R_y R_z. With c, s of the first angle:
//   ω = θ_x' (1, 0, 0) + θ_y' (0, c, s) + θ_z' (sin θ_y, -s cos θ_y, c cos θ_y)
//   H = (1, s tan θ_y, -c tan θ_y;  0, c, s;  0, -s / cos θ_y, c / cos θ_y)
void cardan(BushingSeries& t, Order o) {
    auto& axis = t.angles->axis;
    PlaneAngleSeries &x = axis[0], &y = axis[1], &z = axis[2];
    const Matrix3Series& B = t.angles->B;
    linear(o, x.xy, [&](auto of) -> Eigen::Vector2d { return {of(B)(2, 2), -of(B)(1, 2)}; });
    linear(o, x.z, [&](auto of) { return of(B)(0, 2); });
    angle(o, x);  // r = p·p cos θ_y
    linear(o, y.xy, [&](auto of) -> Eigen::Vector2d { return {of(x.r), of(B)(0, 2)}; });
    angle(o, y);  // r = p·p
    linear(o, z.xy, [&](auto of) -> Eigen::Vector2d { return {of(B)(0, 0), -of(B)(0, 1)}; });
    angle(o, z);
    row_of(o, x, V3::UnitX(), -V3::UnitZ(), V3::UnitY());
    linear(o, y.row, [&](auto of) -> V3 { return {0, of(x.unit).x(), of(x.unit).y()}; });
    product(o, y.r, x.inverse, z.factor, std::multiplies<>());
    linear(o, z.along, [&](auto of) -> V3 { return {0, -of(x.unit).y(), of(x.unit).x()}; });
    product(o, z.factor, z.along, z.row, scale);
}
// H = (1, s_x B_02/r_x, -c_x B_02/r_x;  -s_y B_12/r_y, 1, -c_y B_12/r_y;
//      -c_z B_20/r_z, -s_z B_20/r_z, 1)
// from δB = ω̃ B, r the length of the two entries that define the angle.
void projected(BushingSeries& t, Order o) {
    auto& axis = t.angles->axis;
    PlaneAngleSeries &x = axis[0], &y = axis[1], &z = axis[2];
    const Matrix3Series& B = t.angles->B;
    linear(o, x.xy, [&](auto of) -> Eigen::Vector2d { return {of(B)(2, 2), -of(B)(1, 2)}; });
    linear(o, y.xy, [&](auto of) -> Eigen::Vector2d { return {of(B)(2, 2), of(B)(0, 2)}; });
    linear(o, z.xy, [&](auto of) -> Eigen::Vector2d { return {of(B)(0, 0), of(B)(1, 0)}; });
    linear(o, x.z, [&](auto of) { return of(B)(0, 2); });
    linear(o, y.z, [&](auto of) { return of(B)(1, 2); });
    linear(o, z.z, [&](auto of) { return of(B)(2, 0); });
    for (auto* each : {&x, &y, &z}) angle(o, *each);
    row_of(o, x, V3::UnitX(), -V3::UnitZ(), V3::UnitY());
    row_of(o, y, V3::UnitY(), -V3::UnitZ(), -V3::UnitX());
    row_of(o, z, V3::UnitZ(), -V3::UnitX(), -V3::UnitY());
}
void plane_angles(BushingSeries& t, Order o) {
    product(o, t.relative, t.relative, t.angles->B, rotation_of);
    if (t.kind.formulation.angles == Formulation::Angles::cardan)
        cardan(t, o);
    else
        projected(t, o);
    const auto& axis = t.angles->axis;
    const PlaneAngleSeries &x = axis[0], &y = axis[1], &z = axis[2];
    linear(o, t.theta, [&](auto of) -> V3 { return {of(x.angle), of(y.angle), of(z.angle)}; });
}
// Σ row_n M'_n
void moment_of_plane_angles(BushingSeries& t, Order o) {
    for (std::size_t n = 0; n < 3; ++n) {
        PlaneAngleSeries& each = t.angles->axis[n];
        linear(o, each.moment,
               [&](auto of) { return of(t.moment_local)[static_cast<Eigen::Index>(n)]; });
        product(o, each.moment, each.row, each.share, scale);
    }
    const auto& axis = t.angles->axis;
    const PlaneAngleSeries &x = axis[0], &y = axis[1], &z = axis[2];
    linear(o, t.moment_i,
           [&](auto of) -> V3 { return t.E_i * (of(x.share) + of(y.share) + of(z.share)); });
}

// ---- The frame on i: d = d_i.

void deformation_on_i(BushingSeries& t, Order o) {
    linear(o, t.e, [&](auto of) -> Vector6<double> {
        Vector6<double> deformation;
        deformation << t.E_i.transpose() * of(t.strain), of(t.theta);
        return deformation;
    });
}
void force_on_i(BushingSeries& t, Order o) {
    linear(o, t.force_i, [&](auto of) -> V3 { return t.E_i * of(t.stress).template head<3>(); });
}

// ---- The frame in the middle: d = B^-½ d_i.

void middle_deformation(BushingSeries& t, Order o) {
    MiddleSeries& s = *t.middle;
    product(o, t.relative, t.relative, s.squared,
            [](const Eigen::Vector4d& a, const Eigen::Vector4d& b) { return a.dot(b); });
    square_root(o, s.squared, s.size);
    linear(o, s.sum, [&](auto of) { return of(s.size) + of(t.W); });
    reciprocal(o, s.sum, s.inverse);
    product(o, s.inverse, t.V, s.half.g, scale);
    move(o, s.half);
    linear(o, s.d_i, [&](auto of) -> V3 { return t.E_i.transpose() * of(t.strain); });
    product(o, s.half.C, s.d_i, s.d, apply_transposed);
    linear(o, t.e, [&](auto of) -> Vector6<double> {
        Vector6<double> deformation;
        deformation << of(s.d), of(t.theta);
        return deformation;
    });
}
// B^½ rotates by ω_½ = (I + B^½)⁻¹ ω = ½ (I - g̃) ω while B rotates by ω, so that with F_i = B^½ F'
//   F'·δd = F_i·(δd_i + d_i × ω_½) = F_i·δd_i + ½ (m + g × m)·ω,   m = F_i × d_i
// which is the part of the offset's moment that acts on j; left out where the moment is left out.
void middle_force(BushingSeries& t, Order o) {
    MiddleSeries& s = *t.middle;
    linear(o, s.F_local, [&](auto of) -> V3 { return of(t.stress).template head<3>(); });
    product(o, s.half.C, s.F_local, s.F_i, apply);
    product(o, s.F_i, s.d_i, s.m, cross);
    product(o, s.half.g, s.m, s.g_m, cross);
    linear(o, t.force_i, [&](auto of) -> V3 { return t.E_i * of(s.F_i); });
}

// M on j, its opposite on i: conjugate to θ, and to d where the frame rotates with j.
void evaluate_moment(Equations& e, BushingSeries& t, Order o) {
    linear(o, t.moment_local, [&](auto of) -> V3 { return of(t.stress).template tail<3>(); });
    if (!t.rotational || !t.kind.formulation.conjugate)
        linear(o, t.moment_i, [&](auto of) -> V3 { return t.E_i * of(t.moment_local); });
    else
        t.angles != nullptr ? moment_of_plane_angles(t, o) : moment_of_rotation_vector(t, o);
    if (t.middle != nullptr && t.kind.formulation.offset_moment)
        add_linear(o, t.moment_i, [&](auto of) -> V3 {
            return t.E_i * (of(t.middle->m) + of(t.middle->g_m)) / 2;
        });
    product(o, e[t.i.body].C, t.moment_i, t.M, apply);
}

// F = A_f F',  (F', M') = ∂u/∂e(e - e₀) + preload,  e = (d, θ)
void evaluate(Equations& e, BushingSeries& t, Order o) {
    const BodySeries &b_i = e[t.i.body], &b_j = e[t.j.body];
    turn(o, e, t.i);
    turn(o, e, t.j);
    linear(o, t.rho, [&](auto of) -> V3 { return of(b_j.r) + of(t.j.s) - of(b_i.r); });
    linear(o, t.D, [&](auto of) -> V3 { return of(t.rho) - of(t.i.s); });
    product(o, b_i.C, t.D, t.strain, apply_transposed);
    if (t.twists()) evaluate_relative(e, t, o);
    if (t.rotational) t.angles != nullptr ? plane_angles(t, o) : rotation_vector(t, o);
    t.middle != nullptr ? middle_deformation(t, o) : deformation_on_i(t, o);
    if (o.k == 0) t.e.c[0] -= t.kind.undeformed;
    std::visit([&](const auto& law) { law_gradient(o, law, t); }, t.kind.law);
    linear(o, t.stress,
           [&](auto of) -> Vector6<double> { return of(t.gradient) + of(e.a) * t.preload.rate; });
    if (o.k == 0) t.stress.c[0] += t.preload.start;
    t.middle != nullptr ? middle_force(t, o) : force_on_i(t, o);
    product(o, b_i.C, t.force_i, t.F, apply);
    if (t.twists()) evaluate_moment(e, t, o);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.kind.formulation.offset_moment ? t.rho : t.i.s, t.F);
    if (!t.twists()) return;
    twist(e, o.k, t.j.body, +1, t.M);
    twist(e, o.k, t.i.body, -1, t.M);
}

// ---- Constraints: adds Φ_qᵀ λ to G, and sets Φ.

void evaluate(Equations& e, CoincidentSeries& t, const Scalar* lambda, double* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    linear(o, t.F, [&](auto of) -> V3 { return {of(lambda[0]), of(lambda[1]), of(lambda[2])}; });
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.j.s, t.F);
    Eigen::Map<V3> value(Phi);
    value = at(e[t.i.body].r, o.k) + at(t.i.s, o.k) - at(e[t.j.body].r, o.k) - at(t.j.s, o.k);
}

void evaluate(Equations& e, PlaneSeries& t, const Scalar* lambda, double* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    turn(o, e, t.normal);
    distance(o, e, t.j, t.i, t.d);
    const Vector3Series &r_i = e[t.i.body].r, &r_j = e[t.j.body].r;
    linear(o, t.rho, [&](auto of) -> V3 { return of(r_i) + of(t.i.s) - of(r_j); });
    product(o, *lambda, t.normal.s, t.F, scale);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.rho, t.F);
    *Phi = convolution(o.k, t.normal.s, t.d, dot) - coefficient(e, t.offset, o.k);
}

void evaluate(Equations& e, PerpendicularSeries& t, const Scalar* lambda, double* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    product(o, t.i.s, t.j.s, t.M, cross);
    if (o.pass == Pass::change) return;
    const V3 M = convolution(o.k, *lambda, t.M, scale);
    if (t.i.body != ground) e.G.segment<3>(6 * t.i.body + 3) += M;
    if (t.j.body != ground) e.G.segment<3>(6 * t.j.body + 3) -= M;
    *Phi = convolution(o.k, t.i.s, t.j.s, dot);
}

// Φ = (d·d / ℓ - ℓ) / 2, whose force is λ d / ℓ
void evaluate(Equations& e, DistanceSeries& t, const Scalar* lambda, double* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    distance(o, e, t.j, t.i, t.d);
    if (o.k <= t.ell.last) {
        follow(o, e, t.length, t.ell);
        reciprocal(o, t.ell, t.inverse);
    }
    product(o, *lambda, t.inverse, t.share, std::multiplies<>());
    product(o, t.share, t.d, t.F, scale);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.j.s, t.F);
    double squared_over_length = 0;
    for (int l = 0; l <= std::min(o.k, t.inverse.last); ++l)
        squared_over_length += at(t.inverse, l) * convolution(o.k - l, t.d, t.d, dot);
    *Phi = (squared_over_length - at(t.ell, o.k)) / 2;
}

// Φ = u_i·w,  w = cos α y_j - sin α x_j
void evaluate(Equations& e, AngleSeries& t, const Scalar* lambda, double* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.x);
    turn(o, e, t.y);
    if (o.k <= t.alpha.last) {
        follow(o, e, t.angle, t.alpha);
        cosine_sine(o, t.alpha, t.cosine, t.sine);
    }
    product(o, t.cosine, t.y.s, t.along, scale);
    product(o, t.sine, t.x.s, t.across, scale);
    linear(o, t.w, [&](auto of) -> V3 { return of(t.along) - of(t.across); });
    product(o, t.i.s, t.w, t.M, cross);
    if (o.pass == Pass::change) return;
    const V3 M = convolution(o.k, *lambda, t.M, scale);
    if (t.i.body != ground) e.G.segment<3>(6 * t.i.body + 3) += M;
    if (t.x.body != ground) e.G.segment<3>(6 * t.x.body + 3) -= M;
    *Phi = convolution(o.k, t.i.s, t.w, dot);
}

void evaluate(Equations& e, ForceSeries& t, Order o) {
    turn(o, e, t.at);
    follow(o, e, t.factor, t.size);
    if (o.pass == Pass::change) return;
    const BodyId b = t.at.body;
    e.G.segment<3>(6 * b) -= at(t.size, o.k) * t.kind.f;
    e.G.segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.at.s, scale).cross(t.kind.f);
}
void evaluate(Equations& e, MomentSeries& t, Order o) {
    if (o.pass == Pass::change) return;
    e.G.segment<3>(6 * t.kind.body + 3) -= coefficient(e, t.factor, o.k) * t.kind.m;
}
void evaluate(Equations& e, FollowerSeries& t, Order o) {
    turn(o, e, t.f);
    turn(o, e, t.m);
    follow(o, e, t.factor, t.size);
    if (o.pass == Pass::change) return;
    const BodyId b = t.f.body;
    e.G.segment<3>(6 * b) -= convolution(o.k, t.size, t.f.s, scale);
    e.G.segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.m.s, scale);
}

}  // namespace

Equations equations(const Model& model, const Branch& branch, int order, Drive drive_) {
    Equations e{Arena(order), drive_, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, false};
    Arena& room = e.room;
    e.slots.resize(model.bodies.size() + 1);
    for (std::size_t b = 0; b < e.slots.size(); ++b) {
        reserve(room, e.slots[b].r, b == 0);
        reserve(room, e.slots[b], b == 0);
    }
    e.lambda.resize(static_cast<std::size_t>(constraint_rows(model)));
    for (auto& lambda : e.lambda) reserve(room, lambda);
    reserve(room, e.a);
    e.elastics.reserve(model.elastics.size());
    e.constraints.reserve(model.constraints.size());
    e.loads.reserve(model.static_loads.size() + branch.drivers.size());
    for (const auto& elastic : model.elastics)
        e.elastics.push_back(
            std::visit([&](const auto& kind) { return term(room, kind); }, elastic.kind));
    for (const auto& constraint : model.constraints)
        e.constraints.push_back(
            std::visit([&](const auto& kind) { return term(room, kind); }, constraint.kind));
    for (const auto& each : model.static_loads) e.loads.push_back(load(room, each, {1, 0}));
    for (const auto& driver : branch.drivers)
        std::visit([&](const auto& what) { drive(e, model, driver, what); }, driver.what);
    for (auto& constraint : e.constraints)
        std::visit([](auto& t) { settle_on_constants(t); }, constraint);
    e.curved = std::ranges::any_of(e.elastics, [](const ElasticSeries& elastic) {
        return std::visit([](const auto& t) { return curved(t); }, elastic);
    });
    e.G.setZero(coordinates(model));
    e.Phi.setZero(constraint_rows(model));
    e.G_d = e.G;
    e.Phi_d = e.Phi;
    return e;
}

CubicSeries& cubic_of(Equations& e, std::size_t elastic, int axis) {
    if (auto* spring = std::get_if<SpringSeries>(&e.elastics[elastic])) return spring->cubic;
    return std::get<BushingSeries>(e.elastics[elastic]).axis[axis].cubic;
}
double deformation(const Equations& e, std::size_t elastic, int axis, int k) {
    if (const auto* spring = std::get_if<SpringSeries>(&e.elastics[elastic]))
        return at(spring->stretch, k);
    return at(std::get<BushingSeries>(e.elastics[elastic]).axis[axis].x, k);
}

void begin(Equations& e, const State<double>& q, const Vector<double>& lambda, double a) {
    for (BodyId b = 0; b < q.bodies(); ++b) {
        e[b].r.c[0] = q[b].r;
        e[b].g.c[0].setZero();
    }
    for (std::size_t k = 0; k < e.lambda.size(); ++k)
        e.lambda[k].c[0] = lambda[static_cast<Eigen::Index>(k)];
    e.a.c[0] = a;
    const auto place_all = [&](auto& terms) {
        for (auto& term : terms) std::visit([&](auto& t) { place(t, q); }, term);
    };
    place_all(e.elastics);
    place_all(e.constraints);
    place_all(e.loads);
}

void evaluate(Equations& e, Order o) {
    if (o.pass == Pass::known) {
        e.G.setZero();
        e.Phi.setZero();
    }
    for (std::size_t b = o.k == 0 ? 0 : 1; b < e.slots.size(); ++b) move(o, e.slots[b]);
    for (auto& elastic : e.elastics) std::visit([&](auto& t) { evaluate(e, t, o); }, elastic);
    std::size_t row = 0;
    for (auto& constraint : e.constraints)
        std::visit(
            [&](auto& t) {
                evaluate(e, t, &e.lambda[row], e.Phi.data() + row, o);
                row += t.rows;
            },
            constraint);
    for (auto& load : e.loads) std::visit([&](auto& t) { evaluate(e, t, o); }, load);
    if (o.pass == Pass::change) return;
    if (e.drive == Drive::rate) return;
    const double missing = (o.k == 0 ? 1 : 0) - at(e.a, o.k);  // 1 - t
    e.G -= missing * e.G_d;
    e.Phi -= missing * e.Phi_d;
}

void assign(Equations& e, int k, const Vector<double>& x, double a) {
    const auto put = [k](auto& s, const auto& value) { at(s, k) = s.change = value; };
    const auto bodies = static_cast<BodyId>(e.slots.size()) - 1;
    for (BodyId b = 0; b < bodies; ++b) {
        put(e[b].r, V3(x.segment<3>(6 * b)));
        put(e[b].g, V3(x.segment<3>(6 * b + 3) / 2));
    }
    for (std::size_t row = 0; row < e.lambda.size(); ++row)
        put(e.lambda[row], x[6 * bodies + static_cast<Eigen::Index>(row)]);
    put(e.a, a);
}

}  // namespace elastocheck::recursive::series
