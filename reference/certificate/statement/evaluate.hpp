// Assembly of the system and its Jacobian by forward automatic differentiation, part by part. A
// part is an element, a constraint or a load with at most two bodies; its derivatives are taken
// with respect to their 7 or 14 coordinates and a.
#pragma once

#include "reference/certificate/statement/system.hpp"

namespace elastocheck::reference::certificate {

// Derivative slots of a part: the poses of its bodies, and a as the last.
struct Slots {
    BodyId i = ground, j = ground;
    int at_i() const { return 0; }
    int at_j() const { return i == ground ? 0 : 7; }
    bool two() const { return i != ground && j != ground; }
};

// A number with its derivatives with respect to the six forces of an element's laws.
template <class S>
using InForces = Dual<S, 6>;

template <class S>
struct Assembly {
    const System& system;
    const std::vector<S>& z;
    const S& a;
    Values<S> out;
    std::vector<Slope<S>> slopes = {};  // of all parts, one after the other
    bool fixed_forces = false;          // elastic forces are constant: slopes of the geometry alone
    // Σ |force| + |moment| / L of the parts on each body; not computed if empty
    std::vector<double> force_sizes = {};

    // ---- Bodies, with or without slopes

    template <class T>
    T unknown(int k, int slot) const {
        if constexpr (std::is_same_v<T, S>) {
            return z[static_cast<std::size_t>(k)];
        } else {
            T x;
            x.v = z[static_cast<std::size_t>(k)];
            if constexpr (!std::is_same_v<T, InForces<S>>)
                x.set(static_cast<std::size_t>(slot), constant<S>(1.));
            return x;
        }
    }
    template <class T>
    Frame<T> frame(BodyId body, int slot) const {
        const T one = constant<T>(1.), zero = constant<T>(0.);
        if (body == ground)
            return {constant<T>(Eigen::Vector3d(-system.c)), {one, {{zero, zero, zero}}}};
        const int k = system.pose(body);
        const auto x = [&](int q) { return unknown<T>(k + q, slot + q); };
        return {{{x(0), x(1), x(2)}}, {x(3), {{x(4), x(5), x(6)}}}};
    }
    template <class T>
    T parameter() const {
        if constexpr (std::is_same_v<T, S>) {
            return a;
        } else {
            T x;
            x.v = a;
            if constexpr (!std::is_same_v<T, InForces<S>>) x.set(x.d.size() - 1, constant<S>(1.));
            return x;
        }
    }

    // ---- Sums

    void add(const Slots&, int row, const S& x) {
        S& E = out.E[static_cast<std::size_t>(row)];
        E = E + x;
    }
    template <int N>
    void add(const Slots& slots, int row, const Dual<S, N>& x) {
        add(slots, row, x.v);
        if constexpr (N == 6) {
            for (std::size_t k = 0; k < 6; ++k)
                if (!is_zero(x.d[k]))
                    out.laws.D.push_back(
                        {row, out.laws.column + static_cast<int>(k), along_curve(x.d[k])});
            return;
        }
        const auto columns = [&](BodyId body, int from) {
            if (body == ground) return;
            for (int q = 0; q < 7; ++q)
                add_slope(row, system.pose(body) + q, x.d.at(static_cast<std::size_t>(from + q)));
        };
        columns(slots.i, slots.at_i());
        columns(slots.j, slots.at_j());
        if (!is_zero(x.d.back())) {
            S& E_a = out.E_a[static_cast<std::size_t>(row)];
            E_a = E_a + x.d.back();
        }
    }
    void add_slope(int row, int column, const S& d) {
        if (is_zero(d)) return;
        slopes.push_back({row, column, d});
    }
    static const S& value(const S& x) { return x; }
    template <int N>
    static const S& value(const Dual<S, N>& x) {
        return x.v;
    }

    template <class T>
    void add_force_size(BodyId body, const BodyWrench<T>& on, double times = 1) {
        if (force_sizes.empty()) return;
        double force = 0, moment = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            force = std::max(force, mag(range(on.force[k])));
            moment = std::max(moment, mag(range(on.moment[k])));
        }
        force_sizes[static_cast<std::size_t>(body)] +=
            std::abs(times) * (force + moment / system.length);
    }
    template <class T>
    void add(const Slots& slots, BodyId body, const BodyWrench<T>& on) {
        if (body == ground) return;
        add_force_size(body, on);
        const int row = system.balance(body);
        for (int k = 0; k < 3; ++k) {
            add(slots, row + k, on.force[static_cast<std::size_t>(k)]);
            add(slots, row + 3 + k, on.moment[static_cast<std::size_t>(k)]);
        }
    }
    // Adds the action times R, the unknown in column `column`.
    template <class T>
    void add_times(const Slots& slots, BodyId body, const BodyWrench<T>& on, const S& R,
                   int column) {
        if (body == ground) return;
        add_force_size(body, on, mag(range(R)));
        const int row = system.balance(body);
        const auto add_row = [&](int to, const T& x) {
            add(slots, to, T(x * R));
            if constexpr (!std::is_same_v<T, S>) add_slope(to, column, x.v);
        };
        for (int k = 0; k < 3; ++k) {
            add_row(row + k, on.force[static_cast<std::size_t>(k)]);
            add_row(row + 3 + k, on.moment[static_cast<std::size_t>(k)]);
        }
    }

    // ---- Parts

    template <class T>
    void element(std::size_t e) {
        const ElementPath& path = system.elements[e];
        out.laws.column = 6 * static_cast<int>(e);
        std::visit(
            [&](const auto& kind) {
                const Slots slots{kind.i.body, kind.j.body};
                const auto i = frame<T>(slots.i, slots.at_i()), j = frame<T>(slots.j, slots.at_j());
                if (is_separated(kind, path)) return;
                const WrenchPair<T> on = wrenches_at(kind, path, i, j);
                add(slots, slots.i, on.i);
                add(slots, slots.j, on.j);
            },
            system.model->elastics[e].kind);
    }
    // Whether the only law of an element is separated.
    static bool is_separated(const AxialSpring&, const ElementPath& path) {
        return path.separated[0];
    }
    static bool is_separated(const Bushing&, const ElementPath&) { return false; }
    // Deformations of an element; `back`: with the slopes of turned_back().
    template <class T>
    std::array<T, 6> deformations_at(const AxialSpring& spring, const ElementPath& path,
                                     const Frame<T>& i, const Frame<T>& j, bool = false) const {
        std::array<T, 6> e{};
        e[0] = deformation(spring, path.free_length.at(parameter<T>()), i, j);
        return e;
    }
    template <class T>
    std::array<T, 6> deformations_at(const Bushing& bushing, const ElementPath& path,
                                     const Frame<T>& i, const Frame<T>& j,
                                     bool back = false) const {
        const RelativePose<T> m = relative_pose(bushing, path.rotational, i, j);
        const std::array<T, 6> e = deformation(bushing, path.free_length.at(parameter<T>()), m);
        if (!back) return e;
        return turned_back(e, path, m.A_f, +1);
    }
    template <class T>
    WrenchPair<T> wrenches_at(const AxialSpring& spring, const ElementPath& path, const Frame<T>& i,
                              const Frame<T>& j) {
        return element_wrenches(spring, path.free_length.at(parameter<T>()), i, j, [&](const T& x) {
            const T f = force(spring.law, x);
            return fixed_forces ? constant_of(f) : as_one(f, 0);
        });
    }
    template <class T>
    WrenchPair<T> wrenches_at(const Bushing& bushing, const ElementPath& path, const Frame<T>& i,
                              const Frame<T>& j) {
        const RelativePose<T> m = relative_pose(bushing, path.rotational, i, j);
        const T raised = path.free_length.at(parameter<T>());
        std::array<T, 6> u = force(bushing.law, deformation(bushing, raised, m), path.separated);
        for (std::size_t k = 0; k < 6; ++k)
            u[k] = as_one(T(u[k] + path.preload[k].at(parameter<T>())), k);
        if (fixed_forces) {
            for (T& x : u) x = constant_of(x);
            u = turned_back(u, path, m.A_f, -1);
        }
        return element_wrenches(bushing, u, m, path.rotational, i, j);
    }

    // The force k of an element as one number in all equations: its middle, with a derivative of
    // one by itself; the radius is in laws.rho (Laws in system.hpp).
    template <class T>
    T as_one(const T& f, std::size_t k) {
        T one = f;
        if constexpr (std::is_same_v<T, InForces<S>>) {
            const double radius = take_radius(one.v);
            if (!std::isfinite(radius)) return f;
            out.laws.rho[out.laws.column + static_cast<int>(k)] = radius;
            one.set(k, constant<S>(1.));
        }
        return one;
    }

    static S constant_of(const S& x) { return x; }
    template <int N>
    static Dual<S, N> constant_of(const Dual<S, N>& x) {
        Dual<S, N> result;
        result.v = x.v;
        return result;
    }

    static Quat<S> constant_of(const Quat<S>& q) { return q; }
    template <int N>
    static Quat<Dual<S, N>> constant_of(const Quat<Dual<S, N>>& q) {
        return {constant_of(q.w),
                {{constant_of(q.v[0]), constant_of(q.v[1]), constant_of(q.v[2])}}};
    }
    // Slopes of components in the frame's axes as if the frame did not rotate about the axes of
    // `turns_freely` (`by` = +1), or rotated about these alone (-1): x' ± ω × x.
    template <class T>
    static std::array<T, 6> turned_back(std::array<T, 6> x, const ElementPath& path,
                                        const Quat<T>& A_f, double by) {
        // zero, with the slopes of half the rotation
        const Vec<T> half_turn = product(conjugate(constant_of(A_f)), A_f).v;
        const std::array<T, 6> from = x;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!path.turns_freely[k]) continue;
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const T turn = half_turn[k] * Base<T>(2 * by);
            x[i] = x[i] - turn * constant_of(from[j]);
            x[j] = x[j] + turn * constant_of(from[i]);
        }
        return x;
    }

    // Deformation of one separated law, and the actions of its unit force.
    template <class T>
    struct UnitAction {
        T x;
        WrenchPair<T> on;
    };
    template <class T>
    UnitAction<T> unit_action(const AxialSpring& spring, const ElementPath& path, std::size_t,
                              const Frame<T>& i, const Frame<T>& j) {
        UnitAction<T> result;
        result.on =
            element_wrenches(spring, path.free_length.at(parameter<T>()), i, j, [&](const T& x) {
                result.x = x;
                return constant<T>(1.);
            });
        return result;
    }
    template <class T>
    UnitAction<T> unit_action(const Bushing& bushing, const ElementPath& path, std::size_t axis,
                              const Frame<T>& i, const Frame<T>& j) {
        const RelativePose<T> m = relative_pose(bushing, path.rotational, i, j);
        std::array<T, 6> u;
        u.fill(constant<T>(0.));
        u[axis] = constant<T>(1.);
        const T raised = path.free_length.at(parameter<T>());
        return {deformation(bushing, raised, m)[axis],
                element_wrenches(bushing, u, m, path.rotational, i, j)};
    }
    template <class T>
    void curve(std::size_t c) {
        const SeparatedCurve& separated = system.separated[c];
        const ScalarLaw& law = law_of(system, separated);
        const int to = system.curve(c), x_at = system.deformation(c), f_at = x_at + 1;
        const S &x = z[static_cast<std::size_t>(x_at)], &f = z[static_cast<std::size_t>(f_at)];
        std::visit(
            [&](const auto& kind) {
                const Slots slots{kind.i.body, kind.j.body};
                const auto i = frame<T>(slots.i, slots.at_i()), j = frame<T>(slots.j, slots.at_j());
                const UnitAction<T> one =
                    unit_action(kind, system.elements[separated.element], separated.axis, i, j);
                add(slots, to, T(one.x - x));
                add_times(slots, slots.i, one.on.i, f, f_at);
                add_times(slots, slots.j, one.on.j, f, f_at);
            },
            system.model->elastics[separated.element].kind);
        if constexpr (std::is_same_v<T, S>) {
            add({}, to + 1, f - force(law, x));
        } else {
            Dual<S, 1> law_at_x;
            law_at_x.v = x;
            law_at_x.set(0, constant<S>(1.));
            law_at_x = force(law, law_at_x);
            add({}, to + 1, f - law_at_x.v);
            add_slope(to, x_at, constant<S>(-1.));
            add_slope(to + 1, x_at, -law_at_x.d[0]);
            add_slope(to + 1, f_at, constant<S>(1.));
        }
    }

    template <class T>
    void constraint(std::size_t c) {
        const ConstraintKind& kind = system.model->constraints[c].kind;
        std::visit(
            [&](const auto& k) {
                const Slots slots{k.i.body, k.j.body};
                const auto i = frame<T>(slots.i, slots.at_i()), j = frame<T>(slots.j, slots.at_j());
                int column = system.reaction(c), closure = system.closure(c);
                for (const Row<T>& row : rows_of(k, system.values[c].at(parameter<T>()), i, j)) {
                    const S& R = z[static_cast<std::size_t>(column)];
                    add(slots, closure++, row.Phi);
                    add_times(slots, slots.i, row.reaction.i, R, column);
                    add_times(slots, slots.j, row.reaction.j, R, column++);
                }
            },
            kind);
    }

    // A load acts on i; a brake force depends on the wheel as well.
    static Slots slots_of(const LoadKind& load) {
        const Point* point = member<Point>(load);
        const BodyId on = body_of(load);
        return {on, point != nullptr && point->body != on ? point->body : ground};
    }
    template <class T>
    void load(const LoadPath& path) {
        const Slots slots = slots_of(path.kind);
        const auto body = frame<T>(slots.i, 0);
        const T factor = path.factor.at(parameter<T>());
        const BodyWrench<T> on = std::visit(
            overloaded{[&](const auto& kind) { return load_wrench(kind, body); },
                       [&](const BrakeForce& brake) {
                           const bool own = brake.patch.body == brake.body;
                           return load_wrench(brake, body,
                                              own ? body : frame<T>(slots.j, slots.at_j()));
                       }},
            path.kind);
        add(slots, slots.i, BodyWrench<T>{on.force * factor, on.moment * factor});
    }

    template <class T>
    void norm(BodyId body) {
        const Slots slots{body, ground};
        const Quat<T> p = frame<T>(body, 0).p;
        add(slots, system.norm(body), T(sqr(p.w) + squared(p.v) - Base<T>(1.)));
    }
};

template <class Kind>
bool has_two_bodies(const Kind& kind) {
    return std::visit([](const auto& k) { return Slots{k.i.body, k.j.body}.two(); }, kind);
}

// All parts but the elements.
template <class S, class One, class Two>
void assemble_others(Assembly<S>& sum) {
    const System& system = sum.system;
    const Model& model = *system.model;
    for (std::size_t c = 0; c < system.separated.size(); ++c)
        has_two_bodies(model.elastics[system.separated[c].element].kind)
            ? sum.template curve<Two>(c)
            : sum.template curve<One>(c);
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        has_two_bodies(model.constraints[c].kind) ? sum.template constraint<Two>(c)
                                                  : sum.template constraint<One>(c);
    for (const LoadPath& load : system.loads)
        if (body_of(load.kind) != ground)
            sum.slots_of(load.kind).two() ? sum.template load<Two>(load)
                                          : sum.template load<One>(load);
    for (BodyId body = 0; body < system.bodies; ++body) sum.template norm<One>(body);
}

// Assembles all parts; `One` and `Two` are the number types for parts with one and with two bodies.
template <class S, class One, class Two>
void assemble(Assembly<S>& sum, Slopes slopes) {
    const System& system = sum.system;
    const Model& model = *system.model;
    const auto n = static_cast<std::size_t>(system.n());
    sum.out.E.assign(n, constant<S>(0.));
    if (slopes == Slopes::yes) sum.out.E_a.assign(n, constant<S>(0.));
    for (std::size_t e = 0; e < model.elastics.size(); ++e)
        has_two_bodies(model.elastics[e].kind) ? sum.template element<Two>(e)
                                               : sum.template element<One>(e);
    assemble_others<S, One, Two>(sum);
    if (slopes == Slopes::yes) sum.out.J = by_rows(sum.slopes, system.n());
}

template <class S>
Values<S> evaluate_without_slopes(const System& system, const std::vector<S>& z, const S& a) {
    Assembly<S> sum{system, z, a, {}};
    assemble<S, S, S>(sum, Slopes::no);
    return std::move(sum.out);
}
template <class S>
Values<S> residual(const System& system, const std::vector<S>& z, const S& a) {
    Assembly<S> sum{system, z, a, {}};
    sum.out.E.assign(static_cast<std::size_t>(system.n()), constant<S>(0.));
    sum.out.laws.rho.setZero(6 * static_cast<Eigen::Index>(system.elements.size()));
    for (std::size_t e = 0; e < system.elements.size(); ++e) sum.template element<InForces<S>>(e);
    assemble_others<S, S, S>(sum);
    return std::move(sum.out);
}
template <class S>
Values<S> evaluate(const System& system, const std::vector<S>& z, const S& a, Slopes slopes) {
    if (slopes == Slopes::no) return evaluate_without_slopes(system, z, a);
    Assembly<S> sum{system, z, a, {}};
    assemble<S, Dual<S, 8>, Dual<S, 15>>(sum, slopes);
    return std::move(sum.out);
}

// ---- Wrenches of joints

// Action on the joint's body i, moved from the body's origin to the joint's point.
template <class S>
JointWrench<S> about_joint(const Assembly<S>& assembly, const ModelJoint& joint,
                           const BodyWrench<S>& on) {
    const Vec<S> arm = position(assembly.template frame<S>(joint.at.body, 0), joint.at.s_local) -
                       assembly.template frame<S>(joint.i, 0).r;
    return {on.force, on.moment - cross(arm, on.force)};
}

template <class S>
std::vector<JointWrench<S>> unit_wrenches(const System& system, int joint, const std::vector<S>& z,
                                          const S& a) {
    const Assembly<S> assembly{system, z, a, {}};
    const ModelJoint& model_joint = system.model->joints[static_cast<std::size_t>(joint)];
    std::vector<JointWrench<S>> columns;
    for (std::size_t c = 0; c < system.model->constraints.size(); ++c) {
        const Constraint& constraint = system.model->constraints[c];
        if (constraint.joint != joint) continue;
        std::visit(
            [&](const auto& kind) {
                const auto i = assembly.template frame<S>(kind.i.body, 0),
                           j = assembly.template frame<S>(kind.j.body, 0);
                for (const Row<S>& row : rows_of(kind, system.values[c].at(a), i, j))
                    columns.push_back(about_joint(
                        assembly, model_joint,
                        kind.i.body == model_joint.i ? row.reaction.i : row.reaction.j));
            },
            constraint.kind);
    }
    return columns;
}

template <class S>
std::vector<JointWrench<S>> wrenches(const System& system, const std::vector<S>& z, const S& a) {
    std::vector<JointWrench<S>> list;
    for (int joint = 0; joint < static_cast<int>(system.model->joints.size()); ++joint) {
        const auto columns = unit_wrenches(system, joint, z, a);
        const auto rows = rows_of_joint(system, joint);
        JointWrench<S> sum{constant<S>(Eigen::Vector3d::Zero()),
                           constant<S>(Eigen::Vector3d::Zero())};
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const S& R = z[static_cast<std::size_t>(7 * system.bodies + rows[k])];
            sum.force = sum.force + columns[k].force * R;
            sum.moment = sum.moment + columns[k].moment * R;
        }
        list.push_back(sum);
    }
    return list;
}

}  // namespace elastocheck::reference::certificate
