// The terms of the equations in power series, as templates over their arithmetic: memory, numbers,
// values at τ = 0, and coefficient k of every element, constraint and load.
#pragma once

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "models/overloaded.hpp"
#include "recursive/series/equations.hpp"

namespace elastocheck::recursive::series {
// Unnamed, for the two files that instantiate them: the compiler inlines a function of one caller only
// where no other file can call it, a seventh of the instructions of a coefficient.
namespace detail {
namespace {

using series::reserve;

// ---- Memory.

template <class Real>
void reserve_arm(Arena& room, Arm<Real>& arm, BodyId body) {
    arm.body = body;
    reserve(room, arm.s, body == ground);
}
template <class Real>
void reserve(Arena& room, TurnSeries<Real>& t, bool constant = false) {
    const auto each = [&](auto&... all) { (reserve(room, all, constant), ...); };
    each(t.g, t.h, t.stretch, t.shrink, t.hg, t.C);
}
template <class Real>
void reserve(Arena& room, CubicSeries<Real>& t) {
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

template <class Real>
ElasticSeries<Real> term(Arena& room, const AxialSpring& e) {
    using T = SpringSeries<Real>;
    T t = between<T>(room, e, &T::D, &T::F, &T::length_squared, &T::length, &T::inverse,
                     &T::stretch, &T::force, &T::tension);
    if (std::holds_alternative<Curve>(e.law)) reserve(room, t.cubic);
    return t;
}

template <class Real>
ElasticSeries<Real> term(Arena& room, const Bushing& e) {
    using T = BushingSeries<Real>;
    T t = between<T>(room, e, &T::rho, &T::D, &T::strain, &T::cross_g, &T::V, &T::u, &T::theta,
                     &T::relative, &T::e, &T::gradient, &T::stress, &T::moment_local, &T::u_M,
                     &T::u_u_M, &T::spread_1, &T::spread_2, &T::force_i, &T::moment_i, &T::F, &T::M,
                     &T::dot_g, &T::W, &T::inverse, &T::s);
    reserve(room, t.phi);
    reserve(room, t.psi, &t.phi);
    if (const auto* law = std::get_if<PerAxis>(&e.law)) {
        t.axis = room.take<AxisSeries<Real>>(6, {});
        for (std::size_t k = 0; k < 6; ++k) {
            reserve(room, t.axis[k].x);
            reserve(room, t.axis[k].force);
            if (std::holds_alternative<Curve>(law->axis[k])) reserve(room, t.axis[k].cubic);
        }
    }
    if (e.formulation.frame == Formulation::Frame::middle) {
        t.middle = room.take<MiddleSeries<Real>>(1, {});
        MiddleSeries<Real>& s = *t.middle;
        reserve(room, s.half);
        for (auto* all : {&s.squared, &s.size, &s.sum, &s.inverse}) reserve(room, *all);
        for (auto* all : {&s.d_i, &s.d, &s.F_local, &s.F_i, &s.m, &s.g_m}) reserve(room, *all);
    }
    if (e.formulation.angles != Formulation::Angles::rotation_vector) {
        t.angles = room.take<AnglesSeries<Real>>(1, {});
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

template <class Real>
ConstraintSeries<Real> term(Arena& room, const CoincidentPoints& c) {
    return between<CoincidentSeries<Real>>(room, c, &CoincidentSeries<Real>::F);
}
template <class Real>
ConstraintSeries<Real> term(Arena& room, const PointInPlane& c) {
    auto t = between<PlaneSeries<Real>>(room, c, &PlaneSeries<Real>::d, &PlaneSeries<Real>::rho,
                                        &PlaneSeries<Real>::F);
    reserve_arm(room, t.normal, c.normal_j.body);
    return t;
}
template <class Real>
ConstraintSeries<Real> term(Arena& room, const PerpendicularDirections& c) {
    return between<PerpendicularSeries<Real>>(room, c, &PerpendicularSeries<Real>::M);
}
template <class Real>
ConstraintSeries<Real> term(Arena& room, const DistanceBetween& c) {
    using T = DistanceSeries<Real>;
    T t = between<T>(room, c, &T::ell, &T::inverse, &T::share, &T::d, &T::F);
    return t;
}
template <class Real>
ConstraintSeries<Real> term(Arena& room, const DirectionAtAngle& c) {
    AngleSeries<Real> t;
    t.kind = c;
    reserve_arm(room, t.i, c.i.body);
    reserve_arm(room, t.x, c.j.body);
    reserve_arm(room, t.y, c.y_j.body);
    for (auto* s : {&t.alpha, &t.cosine, &t.sine}) reserve(room, *s);
    for (auto* s : {&t.along, &t.across, &t.w, &t.M}) reserve(room, *s);
    return t;
}

template <class Real>
LoadSeries<Real> term(Arena& room, const DeadForce& f) {
    ForceSeries<Real> t;
    t.kind = f;
    reserve(room, t.size);
    reserve_arm(room, t.at, f.at.body);
    return t;
}
template <class Real>
LoadSeries<Real> term(Arena& room, const BrakeForce& f) {
    BrakeSeries<Real> t;
    t.kind = f;
    reserve(room, t.size);
    reserve(room, t.lever);
    reserve_arm(room, t.patch, f.patch.body);
    return t;
}
template <class Real>
LoadSeries<Real> term(Arena&, const DeadMoment& m) {
    MomentSeries<Real> t;
    t.kind = m;
    return t;
}
template <class Real>
LoadSeries<Real> follower(Arena& room, BodyId body) {
    FollowerSeries<Real> t;
    reserve(room, t.size);
    reserve_arm(room, t.f, body);
    reserve_arm(room, t.m, body);
    return t;
}
template <class Real>
LoadSeries<Real> term(Arena& room, const FollowerForce& f) {
    return follower<Real>(room, f.at.body);
}
template <class Real>
LoadSeries<Real> term(Arena& room, const FollowerMoment& m) {
    return follower<Real>(room, m.body);
}
// ---- Numbers of a lane.

// A number of one lane, or all numbers of a matrix.
template <class Real, class Value>
void put(Real& all, int lane, const Value& value) {
    if constexpr (std::is_same_v<Real, Value>)
        all = value;
    else if constexpr (std::is_base_of_v<Eigen::MatrixBase<Real>, Real>)
        for (Eigen::Index k = 0; k < all.size(); ++k)
            set_lane(all.data()[k], lane, value.data()[k]);
    else
        set_lane(all, lane, value);
}
// A matrix of one lane.
template <class Real, int rows, int columns>
Eigen::Matrix<double, rows, columns> got(const Eigen::Matrix<Real, rows, columns>& all, int at) {
    if constexpr (std::is_same_v<Real, double>) {
        return all;
    } else {
        Eigen::Matrix<double, rows, columns> one;
        for (Eigen::Index k = 0; k < all.size(); ++k) one.data()[k] = lane(all.data()[k], at);
        return one;
    }
}
template <class T, class Value>
void put(Driven<T>& driven, int lane, const Value& start) {
    put(driven.start, lane, start);
    put(driven.rate, lane, Value(0 * start));
}

template <class Real>
void take(Real& k, const ScalarLaw& law, int lane) {
    if (const double* rate = rate_of(law)) put(k, lane, *rate);
}
template <class Real>
void take(SpringSeries<Real>& t, const AxialSpring& e, int lane) {
    put(t.i.local, lane, e.i.s_local);
    put(t.j.local, lane, e.j.s_local);
    take(t.k, e.law, lane);
    put(t.free_length, lane, e.free_length);
}
template <class Real>
void take(BushingSeries<Real>& t, const Bushing& e, int lane) {
    put(t.i.local, lane, e.i.s_local);
    put(t.j.local, lane, e.j.s_local);
    put(t.A_i_local, lane, e.i.A_local.coeffs());
    put(t.A_j_local, lane, e.j.A_local.coeffs());
    if (const Matrix6<double>* K = matrix_of(e.law)) put(t.K, lane, *K);
    if (const auto* law = std::get_if<PerAxis>(&e.law))
        for (std::size_t k = 0; k < 6; ++k) take(t.axis[k].k, law->axis[k], lane);
    put(t.undeformed, lane, e.undeformed);
    put(t.preload, lane, e.preload);
    t.rotational = t.rotational || rotational(e.law) || !e.preload.tail<3>().isZero(0);
}
template <class Real>
void take(CoincidentSeries<Real>& t, const CoincidentPoints& c, int lane) {
    put(t.i.local, lane, c.i.s_local);
    put(t.j.local, lane, c.j.s_local);
}
template <class Real>
void take(PlaneSeries<Real>& t, const PointInPlane& c, int lane) {
    put(t.i.local, lane, c.i.s_local);
    put(t.j.local, lane, c.j.s_local);
    put(t.normal.local, lane, c.normal_j.u_local);
    put(t.offset, lane, c.offset);
}
template <class Real>
void take(PerpendicularSeries<Real>& t, const PerpendicularDirections& c, int lane) {
    put(t.i.local, lane, c.i.u_local);
    put(t.j.local, lane, c.j.u_local);
}
template <class Real>
void take(DistanceSeries<Real>& t, const DistanceBetween& c, int lane) {
    put(t.i.local, lane, c.i.s_local);
    put(t.j.local, lane, c.j.s_local);
    put(t.length, lane, c.length);
}
template <class Real>
void take(AngleSeries<Real>& t, const DirectionAtAngle& c, int lane) {
    put(t.i.local, lane, c.i.u_local);
    put(t.x.local, lane, c.j.u_local);
    put(t.y.local, lane, c.y_j.u_local);
    put(t.angle, lane, c.angle);
}
template <class Real>
void take(ForceSeries<Real>& t, const DeadForce& f, int lane) {
    put(t.at.local, lane, f.at.s_local);
    put(t.f, lane, f.f);
}
template <class Real>
void take(MomentSeries<Real>& t, const DeadMoment& m, int lane) {
    put(t.m, lane, m.m);
}
template <class Real>
void take(BrakeSeries<Real>& t, const BrakeForce& f, int lane) {
    put(t.patch.local, lane, f.patch.s_local);
    put(t.f, lane, f.f);
}
template <class Real>
void take(FollowerSeries<Real>& t, const FollowerForce& f, int lane) {
    put(t.f.local, lane, f.f_local);
    put(t.m.local, lane, Eigen::Vector3d(f.at.s_local.cross(f.f_local)));
}
template <class Real>
void take(FollowerSeries<Real>& t, const FollowerMoment& m, int lane) {
    put(t.f.local, lane, Eigen::Vector3d(Eigen::Vector3d::Zero()));
    put(t.m.local, lane, m.m_local);
}
// A term and a kind that do not belong together.
template <class Term, class Kind>
void take(Term&, const Kind&, int) {
    throw std::invalid_argument("a variant has elements of other kinds");
}
// Takes the numbers of the kind that the term is of. The term was made for a kind of the same name.
template <class Terms, class Kind>
void take_kind(Terms& terms, const Kind& kind, int lane) {
    std::visit([&](auto& t, const auto& k) { take(t, k, lane); }, terms, kind);
}

// ---- Driven inputs. Constraints without an offset cannot be driven (models/lowering.hpp).

// Adds `what` times the driver to a lane.
template <class T, class Value>
void add(Driven<T>& driven, Drive drive, const Driver& driver, const Value& what, int at) {
    const auto add_to = [&](auto& all, double by) {
        if constexpr (std::is_base_of_v<Eigen::MatrixBase<T>, T>) {
            for (Eigen::Index k = 0; k < all.size(); ++k)
                set_lane(all[k], at, lane(all[k], at) + by * what[k]);
        } else {
            set_lane(all, at, lane(all, at) + by * what);
        }
    };
    if (drive == Drive::rate) add_to(driven.start, driver.start);
    add_to(driven.rate, speed<double>(driver, drive));
}
template <class Real>
void move(CoincidentSeries<Real>&, Drive, const Driver&, int) {
    throw std::invalid_argument("coincident points have no offset");
}
template <class Real>
void move(PerpendicularSeries<Real>&, Drive, const Driver&, int) {
    throw std::invalid_argument("perpendicular directions have no offset");
}
template <class Real>
void move(PlaneSeries<Real>& t, Drive drive, const Driver& driver, int lane) {
    add(t.offset, drive, driver, 1.0, lane);
}
template <class Real>
void move(DistanceSeries<Real>& t, Drive drive, const Driver& driver, int lane) {
    add(t.length, drive, driver, 1.0, lane);
}
template <class Real>
void move(AngleSeries<Real>& t, Drive drive, const Driver& driver, int lane) {
    add(t.angle, drive, driver, 1.0, lane);
}

template <class Real>
void drive(Equations<Real>& e, const Model& model, const Driver& driver, const Motion& what,
           int lane) {
    std::visit([&](auto& t) { move(t, e.drive, driver, lane); },
               e.constraints[constraint_of(model, what)]);
}
template <class Real>
void drive(Equations<Real>& e, const Model&, const Driver& driver, const FreeLength& what,
           int lane) {
    std::visit(
        overloaded{[&](SpringSeries<Real>& t) { add(t.free_length, e.drive, driver, 1.0, lane); },
                   [&](BushingSeries<Real>& t) {
                       add(t.rise, e.drive, driver, 1.0, lane);
                       t.is_rising = true;
                   }},
        e.elastics[static_cast<std::size_t>(what.elastic)]);
}
template <class Real>
void drive(Equations<Real>& e, const Model&, const Driver& driver, const Preload& what, int lane) {
    auto& t = std::get<BushingSeries<Real>>(e.elastics[static_cast<std::size_t>(what.elastic)]);
    add(t.preload, e.drive, driver, what.direction, lane);
    t.rotational = t.rotational || !what.direction.template tail<3>().isZero(0);
}

// A series that does not change has only coefficient 0.
template <class Real>
void settle_on_constants(CoincidentSeries<Real>&, int) {}
template <class Real>
void settle_on_constants(PerpendicularSeries<Real>&, int) {}
template <class Real>
void settle_on_constants(PlaneSeries<Real>&, int) {}
template <class Real>
void settle_on_constants(DistanceSeries<Real>& t, int order) {
    t.ell.last = t.inverse.last = is_zero(t.length.rate) ? 0 : order;
}
template <class Real>
void settle_on_constants(AngleSeries<Real>& t, int order) {
    t.alpha.last = t.cosine.last = t.sine.last = is_zero(t.angle.rate) ? 0 : order;
}

template <class Real>
bool curved(const SpringSeries<Real>& t) {
    return std::holds_alternative<Curve>(t.kind.law);
}
template <class Real>
bool curved(const BushingSeries<Real>& t) {
    const auto* law = std::get_if<PerAxis>(&t.kind.law);
    return law != nullptr && std::ranges::any_of(law->axis, [](const ScalarLaw& axis) {
               return std::holds_alternative<Curve>(axis);
           });
}

// ---- Values at τ = 0.

template <class Real>
void place(Arm<Real>& arm, const State<double>& q, int lane) {
    put(arm.fixed, lane, q[arm.body].lever(got(arm.local, lane)));
}
template <class Real>
void place(SpringSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
}
// p ↦ l p r of quaternions (w, x, y, z)
inline Eigen::Matrix4d sandwich(const Eigen::Quaterniond& l, const Eigen::Quaterniond& r) {
    Eigen::Matrix4d L;
    for (int c = 0; c < 4; ++c) {
        const Eigen::Quaterniond unit(c == 0, c == 1, c == 2, c == 3);
        const Eigen::Quaterniond p = l * unit * r;
        L.col(c) << p.w(), p.x(), p.y(), p.z();
    }
    return L;
}
template <class Real>
void place(BushingSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
    const auto axes = [&](const Arm<Real>& arm, const Vector4<Real>& local) {
        return q[arm.body].p * Eigen::Quaterniond(got(local, lane));
    };
    const Eigen::Quaterniond p_i = axes(t.i, t.A_i_local), p_j = axes(t.j, t.A_j_local);
    put(t.E_i, lane, p_i.toRotationMatrix());
    Eigen::Matrix4d to_relative = sandwich(p_i.conjugate(), p_j);
    if (to_relative(0, 0) < 0) to_relative = -to_relative;  // rotation angle below π
    put(t.to_relative, lane, to_relative);
}
template <class Real>
void place(CoincidentSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
}
template <class Real>
void place(PlaneSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
    place(t.normal, q, lane);
}
template <class Real>
void place(PerpendicularSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
}
template <class Real>
void place(DistanceSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
}
template <class Real>
void place(AngleSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.x, q, lane);
    place(t.y, q, lane);
}
template <class Real>
void place(ForceSeries<Real>& t, const State<double>& q, int lane) {
    place(t.at, q, lane);
}
template <class Real>
void place(BrakeSeries<Real>& t, const State<double>& q, int lane) {
    place(t.patch, q, lane);
}
template <class Real>
void place(MomentSeries<Real>&, const State<double>&, int) {}
template <class Real>
void place(FollowerSeries<Real>& t, const State<double>& q, int lane) {
    place(t.f, q, lane);
    place(t.m, q, lane);
}

// ---- Coefficient k.

template <class Real>
void move(Order o, TurnSeries<Real>& b) {
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
template <class Real>
void turn(Order o, const Equations<Real>& e, Arm<Real>& arm) {
    if (o.k > 0 && arm.body == ground) return;
    linear(o, arm.s, [&](auto of) -> Vector3<Real> { return of(e[arm.body].C) * arm.fixed; });
}

// Adds a force with its moment from the lever to coefficient k of G, times sign.
template <class Real>
void push(Equations<Real>& e, int k, BodyId b, int sign, const Vector3Series<Real>& lever,
          const Vector3Series<Real>& F) {
    if (b == ground) return;
    e.G.template segment<3>(6 * b) += Real(sign) * at(F, k);
    e.G.template segment<3>(6 * b + 3) += Real(sign) * convolution(k, lever, F, cross);
}
template <class Real>
void twist(Equations<Real>& e, int k, BodyId b, int sign, const Vector3Series<Real>& M) {
    if (b != ground) e.G.template segment<3>(6 * b + 3) += Real(sign) * at(M, k);
}

template <class Real>
void distance(Order o, const Equations<Real>& e, const Arm<Real>& i, const Arm<Real>& j,
              Vector3Series<Real>& D) {  // p_j - p_i
    const Vector3Series<Real>&r_i = e[i.body].r, &r_j = e[j.body].r;
    linear(o, D, [&](auto of) -> Vector3<Real> { return of(r_j) + of(j.s) - of(r_i) - of(i.s); });
}

// Coefficient k of start + rate · a.
template <class Real, class T>
void follow(Order o, const Equations<Real>& e, const Driven<T>& driven, Series<T>& s) {
    linear(o, s, [&](auto of) -> T { return driven.rate * of(e.a); });
    if (o.k == 0) s.c[0] += driven.start;
}
template <class Real, class T>
T coefficient(const Equations<Real>& e, const Driven<T>& driven, int k) {
    const T moved = driven.rate * at(e.a, k);
    return k == 0 ? T(moved + driven.start) : moved;
}

// ---- Laws: ∂u/∂x of a deformation x, ∂u/∂e of the deformations e.

template <class Real>
void law_gradient(Order o, const LinearRate&, const Real& rate, CubicSeries<Real>&,
                  const Series<Real>& x, Series<Real>& f) {
    linear(o, f, [&](auto of) -> Real { return rate * of(x); });
}
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

// F = u'(ℓ - ℓ₀) D / ℓ
template <class Real>
void evaluate(Equations<Real>& e, SpringSeries<Real>& t, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    distance(o, e, t.i, t.j, t.D);
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
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.i.s, t.F);
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

// u = tan(|θ|/2) θ/|θ|,  θ = 2 F_1(u·u) u
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
// J(θ)⁻ᵀ = I + F_1 ũ + F_3 ũ²
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

// p·p B(p), as a bilinear map of p with itself
template <class Real>
Matrix3<Real> rotation_of(const Vector4<Real>& a, const Vector4<Real>& b) {
    const Vector3<Real> v = a.template tail<3>(), w = b.template tail<3>();
    return (a[0] * b[0] - v.dot(w)) * Matrix3<Real>::Identity() + 2 * v * w.transpose() +
           2 * a[0] * tilde<Real>(w);
}
template <class Real>
void angle(Order o, PlaneAngleSeries<Real>& t) {
    product(o, t.xy, t.xy, t.squared,
            [](const Vector2<Real>& a, const Vector2<Real>& b) -> Real { return a.dot(b); });
    square_root(o, t.squared, t.r);
    reciprocal(o, t.r, t.inverse);
    product(o, t.inverse, t.xy, t.unit,
            [](const Real& a, const Vector2<Real>& b) -> Vector2<Real> { return a * b; });
    arc(o, t.unit, t.angle);
}
// row = fixed + z/r (cos · of_cosine + sin · of_sine)
template <class Real>
void row_of(Order o, PlaneAngleSeries<Real>& t, const Vector3<std::type_identity_t<Real>>& fixed,
            const Vector3<std::type_identity_t<Real>>& of_cosine,
            const Vector3<std::type_identity_t<Real>>& of_sine) {
    product(o, t.z, t.inverse, t.factor, std::multiplies<>());
    linear(o, t.along, [&](auto of) -> Vector3<Real> {
        return of(t.unit).x() * of_cosine + of(t.unit).y() * of_sine;
    });
    product(o, t.factor, t.along, t.row, scale);
    if (o.k == 0) t.row.c[0] += fixed;
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
    angle(o, x);  // r = p·p cos θ_y
    linear(o, y.xy, [&](auto of) -> Vector2<Real> { return {of(x.r), of(B)(0, 2)}; });
    angle(o, y);  // r = p·p
    linear(o, z.xy, [&](auto of) -> Vector2<Real> { return {of(B)(0, 0), -of(B)(0, 1)}; });
    angle(o, z);
    row_of(o, x, Vector3<Real>::UnitX(), -Vector3<Real>::UnitZ(), Vector3<Real>::UnitY());
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
    for (auto* each : {&x, &y, &z}) angle(o, *each);
    row_of(o, x, Vector3<Real>::UnitX(), -Vector3<Real>::UnitZ(), Vector3<Real>::UnitY());
    row_of(o, y, Vector3<Real>::UnitY(), -Vector3<Real>::UnitZ(), -Vector3<Real>::UnitX());
    row_of(o, z, Vector3<Real>::UnitZ(), -Vector3<Real>::UnitX(), -Vector3<Real>::UnitY());
}
template <class Real>
void plane_angles(BushingSeries<Real>& t, Order o) {
    product(o, t.relative, t.relative, t.angles->B, rotation_of<Real>);
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
    linear(o, t.force_i,
           [&](auto of) -> Vector3<Real> { return t.E_i * of(t.stress).template head<3>(); });
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
    move(o, s.half);
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
// which is the part of the offset's moment that acts on j; left out where the moment is left out.
template <class Real>
void middle_force(BushingSeries<Real>& t, Order o) {
    MiddleSeries<Real>& s = *t.middle;
    linear(o, s.F_local, [&](auto of) -> Vector3<Real> { return of(t.stress).template head<3>(); });
    product(o, s.half.C, s.F_local, s.F_i, apply);
    product(o, s.F_i, s.d_i, s.m, cross);
    product(o, s.half.g, s.m, s.g_m, cross);
    linear(o, t.force_i, [&](auto of) -> Vector3<Real> { return t.E_i * of(s.F_i); });
}

// M on j, its opposite on i: conjugate to θ, and to d where the frame rotates with j.
template <class Real>
void evaluate_moment(Equations<Real>& e, BushingSeries<Real>& t, Order o) {
    linear(o, t.moment_local,
           [&](auto of) -> Vector3<Real> { return of(t.stress).template tail<3>(); });
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

// F = A_f F',  (F', M') = ∂u/∂e(e - e₀) + preload,  e = (d, θ)
template <class Real>
void evaluate(Equations<Real>& e, BushingSeries<Real>& t, Order o) {
    const BodySeries<Real>&b_i = e[t.i.body], &b_j = e[t.j.body];
    turn(o, e, t.i);
    turn(o, e, t.j);
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
    linear(o, t.stress,
           [&](auto of) -> Vector6<Real> { return of(t.gradient) + of(e.a) * t.preload.rate; });
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

template <class Real>
void evaluate(Equations<Real>& e, CoincidentSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    linear(o, t.F, [&](auto of) -> Vector3<Real> {
        return {of(lambda[0]), of(lambda[1]), of(lambda[2])};
    });
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.j.s, t.F);
    Eigen::Map<Vector3<Real>> value(Phi);
    value = at(e[t.i.body].r, o.k) + at(t.i.s, o.k) - at(e[t.j.body].r, o.k) - at(t.j.s, o.k);
}

template <class Real>
void evaluate(Equations<Real>& e, PlaneSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    turn(o, e, t.normal);
    distance(o, e, t.j, t.i, t.d);
    const Vector3Series<Real>&r_i = e[t.i.body].r, &r_j = e[t.j.body].r;
    linear(o, t.rho, [&](auto of) -> Vector3<Real> { return of(r_i) + of(t.i.s) - of(r_j); });
    product(o, *lambda, t.normal.s, t.F, scale);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.rho, t.F);
    *Phi = convolution(o.k, t.normal.s, t.d, dot) - coefficient(e, t.offset, o.k);
}

template <class Real>
void evaluate(Equations<Real>& e, PerpendicularSeries<Real>& t, const Series<Real>* lambda,
              Real* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
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
    Real squared_over_length = 0;
    for (int l = 0; l <= std::min(o.k, t.inverse.last); ++l)
        squared_over_length += at(t.inverse, l) * convolution(o.k - l, t.d, t.d, dot);
    *Phi = (squared_over_length - at(t.ell, o.k)) / 2;
}

// Φ = u_i·w,  w = cos α y_j - sin α x_j
template <class Real>
void evaluate(Equations<Real>& e, AngleSeries<Real>& t, const Series<Real>* lambda, Real* Phi,
              Order o) {
    turn(o, e, t.i);
    turn(o, e, t.x);
    turn(o, e, t.y);
    if (o.k <= t.alpha.last) {
        follow(o, e, t.angle, t.alpha);
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

template <class Real>
void evaluate(Equations<Real>& e, ForceSeries<Real>& t, Order o) {
    turn(o, e, t.at);
    follow(o, e, t.factor, t.size);
    if (o.pass == Pass::change) return;
    const BodyId b = t.at.body;
    e.G.template segment<3>(6 * b) -= at(t.size, o.k) * t.f;
    e.G.template segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.at.s, scale).cross(t.f);
}
template <class Real>
void evaluate(Equations<Real>& e, BrakeSeries<Real>& t, Order o) {
    turn(o, e, t.patch);
    follow(o, e, t.factor, t.size);
    const BodySeries<Real>&on = e[t.kind.body], &wheel = e[t.patch.body];
    linear(o, t.lever,
           [&](auto of) -> Vector3<Real> { return of(wheel.r) + of(t.patch.s) - of(on.r); });
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
    turn(o, e, t.f);
    turn(o, e, t.m);
    follow(o, e, t.factor, t.size);
    if (o.pass == Pass::change) return;
    const BodyId b = t.f.body;
    e.G.template segment<3>(6 * b) -= convolution(o.k, t.size, t.f.s, scale);
    e.G.template segment<3>(6 * b + 3) -= convolution(o.k, t.size, t.m.s, scale);
}

}  // namespace
}  // namespace detail

template <class Real>
Equations<Real> equations(const Model& model, const Branch& branch, int order, Drive drive) {
    Equations<Real> e{Arena(order), drive, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, false};
    Arena& room = e.room;
    e.slots.resize(model.bodies.size() + 1);
    for (std::size_t b = 0; b < e.slots.size(); ++b) {
        reserve(room, e.slots[b].r, b == 0);
        detail::reserve(room, static_cast<TurnSeries<Real>&>(e.slots[b]), b == 0);
    }
    e.lambda.resize(static_cast<std::size_t>(constraint_rows(model)));
    for (auto& lambda : e.lambda) reserve(room, lambda);
    reserve(room, e.a);
    e.elastics.reserve(model.elastics.size());
    e.constraints.reserve(model.constraints.size());
    e.loads.reserve(model.static_loads.size() + branch.drivers.size());
    const auto all = [&](auto& terms, const auto& kinds) {
        std::visit([&](const auto& kind) { terms.push_back(detail::term<Real>(room, kind)); },
                   kinds);
    };
    for (const auto& elastic : model.elastics) all(e.elastics, elastic.kind);
    for (const auto& constraint : model.constraints) all(e.constraints, constraint.kind);
    for (const auto& load : model.static_loads) all(e.loads, load.kind);
    for (const auto& driver : branch.drivers)
        if (const Load* load = driven_load(driver.what)) all(e.loads, load->kind);
    take(e, model, branch, 0);
    settle_on_constants(e);
    e.curved = std::ranges::any_of(e.elastics, [](const ElasticSeries<Real>& elastic) {
        return std::visit([](const auto& t) { return detail::curved(t); }, elastic);
    });
    e.G.setZero(coordinates(model));
    e.Phi.setZero(constraint_rows(model));
    e.G_d = e.G;
    e.Phi_d = e.Phi;
    return e;
}

template <class Real>
void take(Equations<Real>& e, const Model& model, const Branch& branch, int lane) {
    const auto same = [](std::size_t terms, std::size_t kinds) {
        if (terms != kinds) throw std::invalid_argument("a variant has other numbers of elements");
    };
    same(e.elastics.size(), model.elastics.size());
    same(e.constraints.size(), model.constraints.size());
    for (std::size_t k = 0; k < e.elastics.size(); ++k)
        detail::take_kind(e.elastics[k], model.elastics[k].kind, lane);
    for (std::size_t k = 0; k < e.constraints.size(); ++k)
        detail::take_kind(e.constraints[k], model.constraints[k].kind, lane);
    std::size_t at = 0;
    const auto load = [&](const Load& what, double start) {
        detail::take_kind(e.loads.at(at), what.kind, lane);
        std::visit([&](auto& t) { detail::put(t.factor, lane, start); }, e.loads[at]);
    };
    for (const auto& each : model.static_loads) load(each, 1), ++at;
    for (const auto& driver : branch.drivers)
        std::visit(
            overloaded{[&](const Load& what) {
                           load(what, 0);
                           std::visit(
                               [&](auto& t) { detail::add(t.factor, e.drive, driver, 1.0, lane); },
                               e.loads[at++]);
                       },
                       [&](const auto& what) { detail::drive(e, model, driver, what, lane); }},
            driver.what);
    same(at, e.loads.size());
}

template <class Real>
void settle_on_constants(Equations<Real>& e) {
    for (auto& constraint : e.constraints)
        std::visit([&](auto& t) { detail::settle_on_constants(t, e.order()); }, constraint);
}

template <class Real>
CubicSeries<Real>& cubic_of(Equations<Real>& e, std::size_t elastic, int axis) {
    if (auto* spring = std::get_if<SpringSeries<Real>>(&e.elastics[elastic])) return spring->cubic;
    return std::get<BushingSeries<Real>>(e.elastics[elastic]).axis[axis].cubic;
}
template <class Real>
const Real& deformation(const Equations<Real>& e, std::size_t elastic, int axis, int k) {
    if (const auto* spring = std::get_if<SpringSeries<Real>>(&e.elastics[elastic]))
        return at(spring->stretch, k);
    return at(std::get<BushingSeries<Real>>(e.elastics[elastic]).axis[axis].x, k);
}

template <class Real>
void begin(Equations<Real>& e, const State<double>& q, const Vector<double>& lambda, double a,
           int lane) {
    for (BodyId b = 0; b < q.bodies(); ++b) {
        detail::put(e[b].r.c[0], lane, q[b].r);
        e[b].g.c[0].setZero();
    }
    for (std::size_t k = 0; k < e.lambda.size(); ++k)
        set_lane(e.lambda[k].c[0], lane, lambda[static_cast<Eigen::Index>(k)]);
    set_lane(e.a.c[0], lane, a);
    const auto place_all = [&](auto& terms) {
        for (auto& term : terms) std::visit([&](auto& t) { detail::place(t, q, lane); }, term);
    };
    place_all(e.elastics);
    place_all(e.constraints);
    place_all(e.loads);
}

template <class Real>
void evaluate(Equations<Real>& e, Order o) {
    if (o.pass == Pass::known) {
        e.G.setZero();
        e.Phi.setZero();
    }
    for (std::size_t b = o.k == 0 ? 0 : 1; b < e.slots.size(); ++b) detail::move(o, e.slots[b]);
    for (auto& elastic : e.elastics)
        std::visit([&](auto& t) { detail::evaluate(e, t, o); }, elastic);
    std::size_t row = 0;
    for (auto& constraint : e.constraints)
        std::visit(
            [&](auto& t) {
                detail::evaluate(e, t, &e.lambda[row], e.Phi.data() + row, o);
                row += t.rows;
            },
            constraint);
    for (auto& load : e.loads) std::visit([&](auto& t) { detail::evaluate(e, t, o); }, load);
    if (o.pass == Pass::change) return;
    if (e.drive == Drive::rate) return;
    const Real missing = Real(o.k == 0 ? 1 : 0) - at(e.a, o.k);  // 1 - t
    e.G -= missing * e.G_d;
    e.Phi -= missing * e.Phi_d;
}

template <class Real>
void assign(Equations<Real>& e, int k, const Vector<std::type_identity_t<Real>>& x,
            const std::type_identity_t<Real>& a) {
    const auto put = [k](auto& s, const auto& value) { at(s, k) = s.change = value; };
    const auto bodies = static_cast<BodyId>(e.slots.size()) - 1;
    for (BodyId b = 0; b < bodies; ++b) {
        put(e[b].r, Vector3<Real>(x.template segment<3>(6 * b)));
        put(e[b].g, Vector3<Real>(x.template segment<3>(6 * b + 3) / 2));
    }
    for (std::size_t row = 0; row < e.lambda.size(); ++row)
        put(e.lambda[row], x[6 * bodies + static_cast<Eigen::Index>(row)]);
    put(e.a, a);
}

}  // namespace elastocheck::recursive::series
