#include "recursive/series/equations.hpp"

#include <functional>
#include <stdexcept>

namespace elastocheck::recursive::series {
namespace {

// ---- Room.

void reserve_arm(Room& room, Arm& arm, BodyId body) {
    arm.body = body;
    reserve(room, arm.s, body == ground);
}
// A term between two bodies with the series it needs beside its arms.
template <class Term, class Kind, class... Members>
Term between(Room& room, const Kind& kind, Members... members) {
    Term t;
    t.kind = kind;
    reserve_arm(room, t.i, kind.i.body);
    reserve_arm(room, t.j, kind.j.body);
    (reserve(room, t.*members), ...);
    return t;
}

ElasticSeries term(Room& room, const AxialSpring& e) {
    using T = SpringSeries;
    T t = between<T>(room, e, &T::D, &T::F, &T::length_squared, &T::length, &T::inverse, &T::stretch,
                     &T::force, &T::tension);
    t.free_length.start = e.free_length;
    return t;
}
ElasticSeries term(Room& room, const Bushing& e) {
    using T = BushingSeries;
    T t = between<T>(room, e, &T::rho, &T::D, &T::strain, &T::cross_g, &T::V, &T::u, &T::theta, &T::relative,
                     &T::e, &T::gradient, &T::stress, &T::moment_local, &T::u_M, &T::u_u_M, &T::spread_1,
                     &T::spread_2, &T::force_i, &T::moment_i, &T::F, &T::M, &T::dot_g, &T::W, &T::inverse,
                     &T::s, &T::phi, &T::psi);
    t.preload.start = e.preload;
    t.rotational = rotational(e.law) || !e.preload.tail<3>().isZero(0);
    return t;
}

ConstraintSeries term(Room& room, const CoincidentPoints& c) {
    return between<CoincidentSeries>(room, c, &CoincidentSeries::F);
}
ConstraintSeries term(Room& room, const PointInPlane& c) {
    auto t = between<PlaneSeries>(room, c, &PlaneSeries::d, &PlaneSeries::rho, &PlaneSeries::F);
    reserve_arm(room, t.normal, c.normal_j.body);
    t.offset.start = c.offset;
    return t;
}
ConstraintSeries term(Room& room, const PerpendicularDirections& c) {
    return between<PerpendicularSeries>(room, c, &PerpendicularSeries::M);
}
ConstraintSeries term(Room& room, const DistanceBetween& c) {
    using T = DistanceSeries;
    T t = between<T>(room, c, &T::ell, &T::inverse, &T::share, &T::d, &T::F);
    t.length.start = c.length;
    return t;
}
ConstraintSeries term(Room& room, const DirectionAtAngle& c) {
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

LoadSeries term(Room& room, const DeadForce& f) {
    ForceSeries t;
    t.kind = f;
    reserve(room, t.size);
    reserve_arm(room, t.at, f.at.body);
    return t;
}
LoadSeries term(Room&, const DeadMoment& m) {
    MomentSeries t;
    t.kind = m;
    return t;
}
LoadSeries load(Room& room, const Load& load, const Driven<double>& factor) {
    LoadSeries all = std::visit([&](const auto& kind) { return term(room, kind); }, load.kind);
    std::visit([&](auto& t) { t.factor = factor; }, all);
    return all;
}

// ---- What a driver moves. What has no offset is driven by none (models/lowering.hpp).

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
void move(DistanceSeries& t, Drive drive, const Driver& driver) { add(t.length, drive, driver, 1.0); }
void move(AngleSeries& t, Drive drive, const Driver& driver) { add(t.angle, drive, driver, 1.0); }

void drive(Equations& e, const Model&, const Driver& driver, const Load& what) {
    Driven<double> factor;
    add(factor, e.drive, driver, 1.0);
    e.loads.push_back(load(e.room, what, factor));
}
void drive(Equations& e, const Model& model, const Driver& driver, const Motion& what) {
    std::visit([&](auto& t) { move(t, e.drive, driver); }, e.constraints[constraint_of(model, what)]);
}
void drive(Equations& e, const Model&, const Driver& driver, const FreeLength& what) {
    add(std::get<SpringSeries>(e.elastics[static_cast<std::size_t>(what.elastic)]).free_length, e.drive,
        driver, 1.0);
}
void drive(Equations& e, const Model&, const Driver& driver, const Preload& what) {
    auto& t = std::get<BushingSeries>(e.elastics[static_cast<std::size_t>(what.elastic)]);
    add(t.preload, e.drive, driver, what.direction);
    t.rotational = t.rotational || !what.direction.tail<3>().isZero(0);
}

// What does not move has coefficient 0 alone.
void settle_on_constants(CoincidentSeries&) {}
void settle_on_constants(PerpendicularSeries&) {}
void settle_on_constants(PlaneSeries&) {}
void settle_on_constants(DistanceSeries& t) {
    if (t.length.rate == 0) t.ell.last = t.inverse.last = 0;
}
void settle_on_constants(AngleSeries& t) {
    if (t.angle.rate == 0) t.alpha.last = t.cosine.last = t.sine.last = 0;
}

// ---- Where things are at τ = 0.

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
    if (t.to_relative(0, 0) < 0) t.to_relative = -t.to_relative;  // the shorter way round
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

// ---- Coefficient k.

void move(Order o, BodySeries& b) {
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

// A force with its moment from the lever `at` enters coefficient k of G, times sign.
void push(Equations& e, int k, BodyId b, double sign, const Vector3Series& lever, const Vector3Series& F) {
    if (b == ground) return;
    e.G.segment<3>(6 * b) += sign * at(F, k);
    e.G.segment<3>(6 * b + 3) += sign * convolution(k, lever, F, cross);
}
void twist(Equations& e, int k, BodyId b, double sign, const Vector3Series& M) {
    if (b != ground) e.G.segment<3>(6 * b + 3) += sign * at(M, k);
}

void distance(Order o, const Equations& e, const Arm& i, const Arm& j, Vector3Series& D) {  // p_j - p_i
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

// ---- One function a law: ∂u/∂x of the deformation x, ∂u/∂e of the deformations e.

void law_gradient(Order o, const LinearRate& law, const Scalar& x, Scalar& f) {
    linear(o, f, [&](auto of) { return law.k * of(x); });
}
void law_gradient(Order o, const LinearStiffness& law, const Vector6Series& e, Vector6Series& f) {
    linear(o, f, [&](auto of) -> Vector6<double> { return law.K * of(e); });
}

// ---- One function a geometry.

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
    std::visit([&](const auto& law) { law_gradient(o, law, t.stretch, t.force); }, t.kind.law);
    product(o, t.force, t.inverse, t.tension, std::multiplies<>());
    product(o, t.tension, t.D, t.F, scale);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.i.s, t.F);
}

// u = tan(|θ|/2) θ/|θ|,  θ = 2 F_1(u·u) u
void evaluate_rotation(Equations& e, BushingSeries& t, Order o) {
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

// M = A_i J(θ)⁻ᵀ M',  J(θ)⁻ᵀ = I + F_1 ũ + F_3 ũ²
void evaluate_moment(Equations& e, BushingSeries& t, Order o) {
    linear(o, t.moment_local, [&](auto of) -> V3 { return of(t.stress).template tail<3>(); });
    product(o, t.u, t.moment_local, t.u_M, cross);
    product(o, t.u, t.u_M, t.u_u_M, cross);
    product(o, t.phi.f, t.u_M, t.spread_1, scale);
    product(o, t.psi.f, t.u_u_M, t.spread_2, scale);
    linear(o, t.moment_i,
           [&](auto of) -> V3 { return t.E_i * (of(t.moment_local) + of(t.spread_1) + of(t.spread_2)); });
    product(o, e[t.i.body].C, t.moment_i, t.M, apply);
}

// F = A_i F',  (F', M') = ∂u/∂e + preload,  e = (d, θ)
void evaluate(Equations& e, BushingSeries& t, Order o) {
    const BodySeries &b_i = e[t.i.body], &b_j = e[t.j.body];
    turn(o, e, t.i);
    turn(o, e, t.j);
    linear(o, t.rho, [&](auto of) -> V3 { return of(b_j.r) + of(t.j.s) - of(b_i.r); });
    linear(o, t.D, [&](auto of) -> V3 { return of(t.rho) - of(t.i.s); });
    product(o, b_i.C, t.D, t.strain, apply_transposed);
    if (t.rotational) evaluate_rotation(e, t, o);
    linear(o, t.e, [&](auto of) -> Vector6<double> {
        Vector6<double> deformation;
        deformation << t.E_i.transpose() * of(t.strain), of(t.theta);
        return deformation;
    });
    std::visit([&](const auto& law) { law_gradient(o, law, t.e, t.gradient); }, t.kind.law);
    linear(o, t.stress,
           [&](auto of) -> Vector6<double> { return of(t.gradient) + of(e.a) * t.preload.rate; });
    if (o.k == 0) t.stress.c[0] += t.preload.start;
    linear(o, t.force_i, [&](auto of) -> V3 { return t.E_i * of(t.stress).template head<3>(); });
    product(o, b_i.C, t.force_i, t.F, apply);
    if (t.rotational) evaluate_moment(e, t, o);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.rho, t.F);
    if (!t.rotational) return;
    twist(e, o.k, t.j.body, +1, t.M);
    twist(e, o.k, t.i.body, -1, t.M);
}

// ---- One function a constraint: Φ_qᵀ λ into G, and Φ.

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

}  // namespace

Equations equations(const Model& model, const Branch& branch, int order, Drive drive_) {
    Equations e{Room(order), drive_, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    Room& room = e.room;
    e.slots.resize(model.bodies.size() + 1);
    for (std::size_t b = 0; b < e.slots.size(); ++b) {
        BodySeries& body = e.slots[b];
        const auto reserve_each = [&](auto&... all) { (reserve(room, all, b == 0), ...); };
        reserve_each(body.r, body.g, body.h, body.stretch, body.shrink, body.hg, body.C);
    }
    e.lambda.resize(static_cast<std::size_t>(constraint_rows(model)));
    for (auto& lambda : e.lambda) reserve(room, lambda);
    reserve(room, e.a);
    e.elastics.reserve(model.elastics.size());
    e.constraints.reserve(model.constraints.size());
    e.loads.reserve(model.static_loads.size() + branch.drivers.size());
    for (const auto& elastic : model.elastics)
        e.elastics.push_back(std::visit([&](const auto& kind) { return term(room, kind); }, elastic.kind));
    for (const auto& constraint : model.constraints)
        e.constraints.push_back(
            std::visit([&](const auto& kind) { return term(room, kind); }, constraint.kind));
    for (const auto& each : model.static_loads) e.loads.push_back(load(room, each, {1, 0}));
    for (const auto& driver : branch.drivers)
        std::visit([&](const auto& what) { drive(e, model, driver, what); }, driver.what);
    for (auto& constraint : e.constraints) std::visit([](auto& t) { settle_on_constants(t); }, constraint);
    e.G.setZero(coordinates(model));
    e.Phi.setZero(constraint_rows(model));
    e.G_d = e.G;
    e.Phi_d = e.Phi;
    return e;
}

void begin(Equations& e, const State<double>& q, const Vector<double>& lambda, double a) {
    for (BodyId b = 0; b < q.bodies(); ++b) {
        e[b].r.c[0] = q[b].r;
        e[b].g.c[0].setZero();
    }
    for (std::size_t k = 0; k < e.lambda.size(); ++k) e.lambda[k].c[0] = lambda[static_cast<Eigen::Index>(k)];
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
