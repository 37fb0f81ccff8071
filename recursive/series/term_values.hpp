// The terms of the equations in power series, as templates over their arithmetic: memory, numbers
// of the elements, driven inputs, values at τ = 0.
#pragma once

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "models/overloaded.hpp"
#include "recursive/series/equations.hpp"

namespace elastocheck::recursive::series {
// In an unnamed namespace, since two files instantiate them: the compiler inlines a function with
// one caller only where no other file can call it, which saves a seventh of the instructions.
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
    const auto each = [&](auto&... series) { (reserve(room, series, constant), ...); };
    each(t.g, t.h, t.stretch, t.shrink, t.hg, t.C);
}
template <class Real>
void reserve(Arena& room, CubicSeries<Real>& t) {
    for (auto* series : {&t.xi, &t.inner, &t.slope}) reserve(room, *series);
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
                     &T::relative, &T::e, &T::gradient, &T::element_force, &T::moment_local,
                     &T::u_M, &T::u_u_M, &T::spread_1, &T::spread_2, &T::force_i, &T::moment_i,
                     &T::F, &T::M, &T::dot_g, &T::W, &T::inverse, &T::s);
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
        for (auto* series : {&s.squared, &s.size, &s.sum, &s.inverse}) reserve(room, *series);
        for (auto* series : {&s.d_i, &s.d, &s.F_local, &s.F_i, &s.m, &s.g_m})
            reserve(room, *series);
    }
    if (e.formulation.angles != Formulation::Angles::rotation_vector) {
        t.angles = room.take<AnglesSeries<Real>>(1, {});
        reserve(room, t.angles->B);
        for (auto& s : t.angles->axis) {
            for (auto* series : {&s.xy, &s.unit}) reserve(room, *series);
            for (auto* series :
                 {&s.squared, &s.r, &s.inverse, &s.angle, &s.z, &s.factor, &s.moment})
                reserve(room, *series);
            for (auto* series : {&s.along, &s.row, &s.share}) reserve(room, *series);
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

// Sets one lane of a number, or of all numbers of a matrix.
template <class Real, class Value>
void put(Real& lanes, int lane, const Value& value) {
    if constexpr (std::is_same_v<Real, Value>)
        lanes = value;
    else if constexpr (std::is_base_of_v<Eigen::MatrixBase<Real>, Real>)
        for (Eigen::Index k = 0; k < lanes.size(); ++k)
            set_lane(lanes.data()[k], lane, value.data()[k]);
    else
        set_lane(lanes, lane, value);
}
// One lane of a matrix.
template <class Real, int rows, int columns>
Eigen::Matrix<double, rows, columns> lane_of(const Eigen::Matrix<Real, rows, columns>& lanes,
                                             int at) {
    if constexpr (std::is_same_v<Real, double>) {
        return lanes;
    } else {
        Eigen::Matrix<double, rows, columns> value;
        for (Eigen::Index k = 0; k < lanes.size(); ++k) value.data()[k] = lane(lanes.data()[k], at);
        return value;
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
// A term of one kind, an element of another.
template <class Term, class Kind>
void take(Term&, const Kind&, int) {
    throw std::invalid_argument("a variant has elements of other kinds than the design");
}
// Takes the numbers of an element for its term, which was made for an element of the same kind.
template <class Terms, class Kind>
void take_kind(Terms& terms, const Kind& kind, int lane) {
    std::visit([&](auto& t, const auto& k) { take(t, k, lane); }, terms, kind);
}

// ---- Driven inputs. Constraints without an offset cannot be driven (models/lowering.hpp).

// Adds `direction` times the driver to a lane of a driven input.
template <class T, class Value>
void add(Driven<T>& driven, Drive drive, const Driver& driver, const Value& direction, int at) {
    const auto add_to = [&](auto& lanes, double by) {
        if constexpr (std::is_base_of_v<Eigen::MatrixBase<T>, T>) {
            for (Eigen::Index k = 0; k < lanes.size(); ++k)
                set_lane(lanes[k], at, lane(lanes[k], at) + by * direction[k]);
        } else {
            set_lane(lanes, at, lane(lanes, at) + by * direction);
        }
    };
    if (drive == Drive::rate) add_to(driven.start, driver.start);
    add_to(driven.rate, amplitude<double>(driver, drive));
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
    put(arm.fixed, lane, q[arm.body].lever(lane_of(arm.local, lane)));
}
// For a term with two arms and nothing else that turns.
template <class Term>
requires requires(Term& t) {
    t.i;
    t.j;
}
void place(Term& t, const State<double>& q, int lane) {
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
        return q[arm.body].p * Eigen::Quaterniond(lane_of(local, lane));
    };
    const Eigen::Quaterniond p_i = axes(t.i, t.A_i_local), p_j = axes(t.j, t.A_j_local);
    put(t.E_i, lane, p_i.toRotationMatrix());
    Eigen::Matrix4d to_relative = sandwich(p_i.conjugate(), p_j);
    if (to_relative(0, 0) < 0) to_relative = -to_relative;  // rotation angle below π
    put(t.to_relative, lane, to_relative);
}
template <class Real>
void place(PlaneSeries<Real>& t, const State<double>& q, int lane) {
    place(t.i, q, lane);
    place(t.j, q, lane);
    place(t.normal, q, lane);
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

}  // namespace
}  // namespace detail
}  // namespace elastocheck::recursive::series
