#include "recursive/series/equations.hpp"

#include <stdexcept>

#include "recursive/overloaded.hpp"

namespace elastocheck::recursive::series {
namespace {

// ---- Room.

void reserve_arm(Arm& arm, BodyId body, int order) {
    arm.body = body;
    reserve(arm.s, order, body == ground);
}
// A term between two bodies with the series it needs beside its arms.
template <class Term, class Kind, class... Members>
Term between(const Kind& kind, int p, Members... members) {
    Term t;
    reserve_arm(t.i, kind.i.body, p);
    reserve_arm(t.j, kind.j.body, p);
    (reserve(t.*members, p), ...);
    return t;
}
ElasticSeries room(const AxialSpring& e, int p) {
    using T = SpringSeries;
    return between<T>(e, p, &T::D, &T::F, &T::length_squared, &T::length, &T::inverse, &T::tension);
}
ElasticSeries room(const Bushing& e, int p) {
    using T = BushingSeries;
    return between<T>(e, p, &T::rho, &T::D, &T::strain, &T::cross_g, &T::V, &T::u, &T::theta, &T::relative,
                      &T::stress, &T::moment_local, &T::u_M, &T::u_u_M, &T::spread_1, &T::spread_2,
                      &T::force_i, &T::moment_i, &T::F, &T::M, &T::dot_g, &T::W, &T::inverse, &T::s, &T::phi,
                      &T::psi);
}
ConstraintSeries room(const CoincidentPoints& c, int p) {
    return between<CoincidentSeries>(c, p, &CoincidentSeries::F);
}
ConstraintSeries room(const PointInPlane& c, int p) {
    auto t = between<PlaneSeries>(c, p, &PlaneSeries::d, &PlaneSeries::rho, &PlaneSeries::F);
    reserve_arm(t.normal, c.normal_j.body, p);
    return t;
}
ConstraintSeries room(const PerpendicularDirections& c, int p) {
    return between<PerpendicularSeries>(c, p, &PerpendicularSeries::M);
}
ConstraintSeries room(const DistanceBetween& c, int p) {
    return between<DistanceSeries>(c, p, &DistanceSeries::d, &DistanceSeries::F);
}
ConstraintSeries room(const DirectionAtAngle&, int) {
    throw std::invalid_argument("the series does not know a direction at an angle yet");
}
// What a branch drives of loads, as loads.
std::vector<Load> driven_loads(const Branch& branch) {
    std::vector<Load> loads;
    for (const auto& driver : branch.drivers)
        std::visit(
            overloaded{
                [&](const Load& load) {
                    if (driver.start != 0 || driver.rate != 1)
                        throw std::invalid_argument("the series does not know weighted loads yet");
                    loads.push_back(load);
                },
                [](const Motion&) { throw std::invalid_argument("the series knows no motion yet"); },
                [](const FreeLength&) { throw std::invalid_argument("the series knows no free length yet"); },
                [](const Preload&) { throw std::invalid_argument("the series knows no preload yet"); },
            },
            driver.what);
    return loads;
}
std::vector<LoadSeries> room(const std::vector<Load>& loads, int p) {
    std::vector<LoadSeries> all(loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k)
        if (const auto* force = std::get_if<DeadForce>(&loads[k].kind))
            reserve_arm(all[k].at, force->at.body, p);
    return all;
}

// ---- Where things are at τ = 0.

void place(Arm& arm, const State<double>& q, const Eigen::Vector3d& local) {
    arm.fixed = q[arm.body].lever(local);
}
const Eigen::Vector3d& local(const Point& at) { return at.s_local; }
const Eigen::Vector3d& local(const Direction& along) { return along.u_local; }
const Eigen::Vector3d& local(const Marker& marker) { return marker.s_local; }
template <class Term, class Kind>
void place(Term& t, const Kind& kind, const State<double>& q) {
    place(t.i, q, local(kind.i));
    place(t.j, q, local(kind.j));
    if constexpr (requires {
                      t.normal;
                      kind.normal_j;
                  })
        place(t.normal, q, local(kind.normal_j));
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
void place(BushingSeries& t, const Bushing& e, const State<double>& q) {
    place<BushingSeries, Bushing>(t, e, q);
    const Eigen::Quaterniond p_i = q[e.i.body].p * e.i.A_local, p_j = q[e.j.body].p * e.j.A_local;
    t.E_i = p_i.toRotationMatrix();
    t.to_relative = sandwich(p_i.conjugate(), p_j);
    if (t.to_relative(0, 0) < 0) t.to_relative = -t.to_relative;  // the shorter way round
}
void place(std::vector<LoadSeries>& all, const std::vector<Load>& loads, const State<double>& q) {
    for (std::size_t k = 0; k < loads.size(); ++k)
        if (const auto* force = std::get_if<DeadForce>(&loads[k].kind))
            place(all[k].at, q, force->at.s_local);
}

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

// F = k (1 - ℓ₀/ℓ) D
void evaluate(Equations& e, const AxialSpring& spring, SpringSeries& t, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    distance(o, e, t.i, t.j, t.D);
    product(o, t.D, t.D, t.length_squared, dot);
    square_root(o, t.length_squared, t.length);
    reciprocal(o, t.length, t.inverse);
    linear(o, t.tension,
           [&](auto of) { return -std::get<LinearRate>(spring.law).k * spring.free_length * of(t.inverse); });
    if (o.k == 0) t.tension.c[0] += std::get<LinearRate>(spring.law).k;
    product(o, t.tension, t.D, t.F, scale);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.i.s, t.F);
}

// u = tan(|θ|/2) θ/|θ|,  θ = 2 F_1(u·u) u,  J(θ)⁻ᵀ = I + F_1 ũ + F_3 ũ²
void evaluate(Equations& e, const Bushing& bushing, BushingSeries& t, Order o) {
    const BodySeries &b_i = e[t.i.body], &b_j = e[t.j.body];
    turn(o, e, t.i);
    turn(o, e, t.j);
    linear(o, t.rho, [&](auto of) -> V3 { return of(b_j.r) + of(t.j.s) - of(b_i.r); });
    linear(o, t.D, [&](auto of) -> V3 { return of(t.rho) - of(t.i.s); });
    product(o, b_i.C, t.D, t.strain, apply_transposed);

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

    linear(o, t.stress, [&](auto of) -> Vector6<double> {
        Vector6<double> strain;
        strain << t.E_i.transpose() * of(t.strain), of(t.theta);
        return std::get<LinearStiffness>(bushing.law).K * strain;
    });
    if (o.k == 0) t.stress.c[0] += bushing.preload;
    linear(o, t.moment_local, [&](auto of) -> V3 { return of(t.stress).template tail<3>(); });
    product(o, t.u, t.moment_local, t.u_M, cross);
    product(o, t.u, t.u_M, t.u_u_M, cross);
    product(o, t.phi.f, t.u_M, t.spread_1, scale);
    product(o, t.psi.f, t.u_u_M, t.spread_2, scale);
    linear(o, t.force_i, [&](auto of) -> V3 { return t.E_i * of(t.stress).template head<3>(); });
    linear(o, t.moment_i,
           [&](auto of) -> V3 { return t.E_i * (of(t.moment_local) + of(t.spread_1) + of(t.spread_2)); });
    product(o, b_i.C, t.force_i, t.F, apply);
    product(o, b_i.C, t.moment_i, t.M, apply);
    if (o.pass == Pass::change) return;
    push(e, o.k, t.j.body, +1, t.j.s, t.F);
    push(e, o.k, t.i.body, -1, t.rho, t.F);
    twist(e, o.k, t.j.body, +1, t.M);
    twist(e, o.k, t.i.body, -1, t.M);
}

void evaluate(Equations& e, const CoincidentPoints&, CoincidentSeries& t, const Scalar* lambda, double* Phi,
              Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    linear(o, t.F, [&](auto of) -> V3 { return {of(lambda[0]), of(lambda[1]), of(lambda[2])}; });
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.j.s, t.F);
    Eigen::Map<V3> value(Phi);
    value = at(e[t.i.body].r, o.k) + at(t.i.s, o.k) - at(e[t.j.body].r, o.k) - at(t.j.s, o.k);
}

void evaluate(Equations& e, const PointInPlane&, PlaneSeries& t, const Scalar* lambda, double* Phi, Order o) {
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
    *Phi = convolution(o.k, t.normal.s, t.d, dot);
}

void evaluate(Equations& e, const PerpendicularDirections&, PerpendicularSeries& t, const Scalar* lambda,
              double* Phi, Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    product(o, t.i.s, t.j.s, t.M, cross);
    if (o.pass == Pass::change) return;
    const V3 M = convolution(o.k, *lambda, t.M, scale);
    if (t.i.body != ground) e.G.segment<3>(6 * t.i.body + 3) += M;
    if (t.j.body != ground) e.G.segment<3>(6 * t.j.body + 3) -= M;
    *Phi = convolution(o.k, t.i.s, t.j.s, dot);
}

void evaluate(Equations& e, const DistanceBetween& c, DistanceSeries& t, const Scalar* lambda, double* Phi,
              Order o) {
    turn(o, e, t.i);
    turn(o, e, t.j);
    distance(o, e, t.j, t.i, t.d);
    product(o, *lambda, t.d, t.F, [&](double x, const V3& d) -> V3 { return x / c.length * d; });
    if (o.pass == Pass::change) return;
    push(e, o.k, t.i.body, +1, t.i.s, t.F);
    push(e, o.k, t.j.body, -1, t.j.s, t.F);
    *Phi = convolution(o.k, t.d, t.d, dot) / (2 * c.length) - (o.k == 0 ? c.length / 2 : 0);
}

void evaluate(Equations& e, const std::vector<Load>& loads, std::vector<LoadSeries>& all,
              const Scalar& factor, Order o) {
    for (std::size_t k = 0; k < loads.size(); ++k) {
        if (const auto* force = std::get_if<DeadForce>(&loads[k].kind)) {
            Arm& arm = all[k].at;
            turn(o, e, arm);
            if (o.pass == Pass::change) continue;
            e.G.segment<3>(6 * arm.body) -= at(factor, o.k) * force->f;
            e.G.segment<3>(6 * arm.body + 3) -= convolution(o.k, factor, arm.s, scale).cross(force->f);
        } else if (o.pass == Pass::known) {
            const auto& moment = std::get<DeadMoment>(loads[k].kind);
            e.G.segment<3>(6 * moment.body + 3) -= at(factor, o.k) * moment.m;
        }
    }
}

}  // namespace

Equations equations(const Model& model, const Branch& branch, int order) {
    Equations e;
    e.order = order;
    e.slots.resize(model.bodies.size() + 1);
    for (std::size_t b = 0; b < e.slots.size(); ++b) {
        BodySeries& body = e.slots[b];
        const auto reserve_each = [&](auto&... all) { (reserve(all, order, b == 0), ...); };
        reserve_each(body.r, body.g, body.h, body.stretch, body.shrink, body.hg, body.C);
    }
    e.lambda.resize(static_cast<std::size_t>(constraint_rows(model)));
    for (auto& lambda : e.lambda) reserve(lambda, order);
    reserve(e.a, order);
    reserve(e.one, order, true);
    e.one.c[0] = 1;
    for (const auto& elastic : model.elastics)
        e.elastics.push_back(std::visit([&](const auto& kind) { return room(kind, order); }, elastic.kind));
    for (const auto& constraint : model.constraints)
        e.constraints.push_back(
            std::visit([&](const auto& kind) { return room(kind, order); }, constraint.kind));
    e.static_loads = room(model.static_loads, order);
    e.branch_loads = room(driven_loads(branch), order);
    e.G.setZero(coordinates(model));
    e.Phi.setZero(constraint_rows(model));
    return e;
}

void begin(Equations& e, const Model& model, const Branch& branch, const State<double>& q,
           const Vector<double>& lambda, double a) {
    for (BodyId b = 0; b < q.bodies(); ++b) {
        e[b].r.c[0] = q[b].r;
        e[b].g.c[0].setZero();
    }
    for (std::size_t k = 0; k < e.lambda.size(); ++k) e.lambda[k].c[0] = lambda[static_cast<Eigen::Index>(k)];
    e.a.c[0] = a;
    const auto place_all = [&](auto& terms, const auto& kinds) {
        for (std::size_t k = 0; k < kinds.size(); ++k)
            std::visit(
                [&](auto& t, const auto& kind) {
                    if constexpr (requires { place(t, kind, q); }) place(t, kind, q);
                },
                terms[k], kinds[k].kind);
    };
    place_all(e.elastics, model.elastics);
    place_all(e.constraints, model.constraints);
    place(e.static_loads, model.static_loads, q);
    place(e.branch_loads, driven_loads(branch), q);
}

void evaluate(Equations& e, const Model& model, const Branch& branch, Order o) {
    if (o.pass == Pass::known) {
        e.G.setZero();
        e.Phi.setZero();
    }
    for (std::size_t b = o.k == 0 ? 0 : 1; b < e.slots.size(); ++b) move(o, e.slots[b]);
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        std::visit(
            [&](auto& t, const auto& kind) {
                if constexpr (requires { evaluate(e, kind, t, o); }) evaluate(e, kind, t, o);
            },
            e.elastics[k], model.elastics[k].kind);
    std::size_t row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        std::visit(
            [&](auto& t, const auto& kind) {
                if constexpr (requires { evaluate(e, kind, t, &e.lambda[0], (double*)nullptr, o); })
                    evaluate(e, kind, t, &e.lambda[row], e.Phi.data() + row, o);
            },
            e.constraints[k], model.constraints[k].kind);
        row += static_cast<std::size_t>(rows(model.constraints[k].kind));
    }
    evaluate(e, model.static_loads, e.static_loads, e.one, o);
    evaluate(e, driven_loads(branch), e.branch_loads, e.a, o);
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
