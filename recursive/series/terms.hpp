// The equations in power series, term by term: templates over their arithmetic.
#pragma once

#include "recursive/series/term_coefficients.hpp"
#include "recursive/series/term_values.hpp"

namespace elastocheck::recursive::series {
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
    std::size_t position = 0;
    const auto load = [&](const Load& what, double start) {
        detail::take_kind(e.loads.at(position), what.kind, lane);
        std::visit([&](auto& t) { detail::put(t.factor, lane, start); }, e.loads[position]);
    };
    for (const auto& each : model.static_loads) {
        load(each, 1);
        ++position;
    }
    for (const auto& driver : branch.drivers)
        std::visit(
            overloaded{[&](const Load& what) {
                           load(what, 0);
                           std::visit(
                               [&](auto& t) { detail::add(t.factor, e.drive, driver, 1.0, lane); },
                               e.loads[position++]);
                       },
                       [&](const auto& what) { detail::drive(e, model, driver, what, lane); }},
            driver.what);
    same(position, e.loads.size());
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
    for (std::size_t b = o.k == 0 ? 0 : 1; b < e.slots.size(); ++b)
        detail::rotation_coefficients(o, e.slots[b]);
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
