#include "reference/equilibrium/linear_algebra/number_rates.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <stdexcept>

#include "reference/equilibrium/linear_algebra/mixed.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Dual = ceres::Jet<double, 1>;

// ---- Rigid motion v + w × s of the features of one body that a term uses, body axes.

struct Twist {
    Vector3d v = Vector3d::Zero(), w = Vector3d::Zero();
};
Twist turned_about(const Vector3d& w, const Point& p, const Point& d) {
    return {d.s_local - w.cross(p.s_local), w};
}
Vector3d turn_of(const Direction& u, const Direction& d) { return u.u_local.cross(d.u_local); }

Twist twist(const Point&, const Point& d) { return {d.s_local, Vector3d::Zero()}; }
Twist twist(const Direction& u, const Direction& d) { return {Vector3d::Zero(), turn_of(u, d)}; }
Twist twist(const Marker& m, const Marker& d) {
    const Vector3d w = 2 * product(d.A_local, conjugate(m.A_local)).vec();
    return {d.s_local - w.cross(m.s_local), w};
}

// Of the two bodies of a kind.
struct Twists {
    Twist i, j;
};
template <class Kind>
Twists twists(const Kind& kind, const Kind& d) {
    return {twist(kind.i, d.i), twist(kind.j, d.j)};
}
Twists twists(const PointInPlane& c, const PointInPlane& d) {
    return {twist(c.i, d.i), turned_about(turn_of(c.normal_j, d.normal_j), c.j, d.j)};
}
// The axes x, y, z = x × y of j turn together: w = ½ Σ e × δe.
Twists twists(const DirectionAtAngle& c, const DirectionAtAngle& d) {
    const Vector3d &x = c.j.u_local, &y = c.y_j.u_local, &dx = d.j.u_local, &dy = d.y_j.u_local;
    const Vector3d z = x.cross(y), dz = dx.cross(y) + x.cross(dy);
    return {twist(c.i, d.i), {Vector3d::Zero(), (x.cross(dx) + y.cross(dy) + z.cross(dz)) / 2}};
}
Twists twists(const DeadForce& l, const DeadForce& d) { return {twist(l.at, d.at), {}}; }
Twists twists(const FollowerForce& l, const FollowerForce& d) { return {twist(l.at, d.at), {}}; }
Twists twists(const DeadMoment&, const DeadMoment&) { return {}; }
Twists twists(const FollowerMoment&, const FollowerMoment&) { return {}; }

template <class Variant>
Twists twists_of(const Variant& kind, const Variant& d) {
    return std::visit([&]<class Kind>(const Kind& held) { return twists(held, std::get<Kind>(d)); },
                      kind);
}

// Loads of the rate in the order of System::loads: static, then driven.
const LoadKind* load_rate(const Model& rate, std::size_t k) {
    if (k < rate.static_loads.size()) return &rate.static_loads[k].kind;
    k -= rate.static_loads.size();
    for (const auto& driver : rate.branches.front().drivers)
        if (const Load* load = driven_load(driver.what))
            if (k-- == 0) return &load->kind;
    return nullptr;  // an added load, which is zero here
}

Twist twist_of(const NumberRate& number, const Part& part, int which) {
    const Model &model = *number.changing.model, &rate = *number.rate;
    const std::size_t k = part.number;
    Twists both;
    switch (part.term) {
        case Term::element: both = twists_of(model.elastics[k].kind, rate.elastics[k].kind); break;
        case Term::load:
            if (const LoadKind* d = load_rate(rate, k))
                both = twists_of(number.changing.loads[k].kind, *d);
            break;
        case Term::ground_spring: break;
        case Term::constraint:
            both = twists_of(model.constraints[k].kind, rate.constraints[k].kind);
            break;
    }
    return which == 0 ? both.i : both.j;
}

// A frame with the motion δr, δπ [m, rad] of its body in ground axes, and a twist in it.
Frame<Dual> moving(const Frame<double>& at, const Vector3d& dr, const Vector3d& dpi,
                   const Twist& twist) {
    Frame<Dual> frame{at.r.cast<Dual>(), at.p.cast<Dual>()};
    const Vector3d by = dr + turned(at.p, twist.v), turn = (dpi + turned(at.p, twist.w)) / 2;
    const Quaterniond dp = product(Quaterniond(0, turn.x(), turn.y(), turn.z()), at.p);
    for (int k = 0; k < 3; ++k) frame.r[k].v[0] = by[k];
    for (int k = 0; k < 4; ++k) frame.p.coeffs()[k].v[0] = dp.coeffs()[k];
    return frame;
}
Frame<Dual> moving(const System& system, const VectorXd& x, const VectorXd& dx, BodyId body,
                   const Twist& twist) {
    const Frame<double> at = frame_of(system, x, body);
    if (body == ground || dx.size() == 0)
        return moving(at, Vector3d::Zero(), Vector3d::Zero(), twist);
    return moving(at, system.length * dx.segment<3>(6 * body), dx.segment<3>(6 * body + 3), twist);
}

// ---- Change of a law's force at a constant deformation x.

double force_rate(const LinearRate&, const LinearRate& d, double x) { return d.k * x; }
// Knots move the origin of a piece.
double force_rate(const Curve& u, const Curve& d, double x) {
    const auto k = static_cast<std::size_t>(piece_at(u, x));
    const std::size_t knot = k == 0 ? 0 : k - 1;
    const auto &c = u.pieces[k], &dc = d.pieces[k];
    Dual h(x - u.knots[knot]);
    h.v[0] = -d.knots[knot];
    Dual f(0.);
    for (std::size_t n = 4; n-- > 0;) {
        Dual c_n(c[n]);
        c_n.v[0] = dc[n];
        f = f * h + c_n;
    }
    return f.v[0];
}
double force_rate(const ScalarLaw& law, const ScalarLaw& d, double x) {
    return std::visit([&]<class Law>(const Law& u) { return force_rate(u, std::get<Law>(d), x); },
                      law);
}
Vector6 force_rate(const SpatialLaw& law, const SpatialLaw& d, const Vector6& e) {
    return std::visit(
        overloaded{
            [&](const LinearStiffness&) -> Vector6 { return std::get<LinearStiffness>(d).K * e; },
            [&](const PerAxis& u) {
                Vector6 f;
                for (std::size_t k = 0; k < 6; ++k)
                    f[static_cast<int>(k)] =
                        force_rate(u.axis[k], std::get<PerAxis>(d).axis[k], e[static_cast<int>(k)]);
                return f;
            }},
        law);
}

template <class Kind>
void check_size(const std::vector<Kind>& a, const std::vector<Kind>& b) {
    if (a.size() != b.size()) throw std::invalid_argument("the rate belongs to another model");
}

}  // namespace

NumberRate number_rate(const System& frozen, const Model& rate, double a, const VectorXd& x) {
    const Model& model = *frozen.model;
    check_size(model.bodies, rate.bodies);
    check_size(model.constraints, rate.constraints);
    check_size(model.elastics, rate.elastics);
    check_size(model.static_loads, rate.static_loads);
    if (rate.branches.empty()) throw std::invalid_argument("the rate belongs to another model");
    check_size(frozen.branch->drivers, rate.branches.front().drivers);

    NumberRate number{&rate, frozen};
    System& system = number.changing;
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        if (const double* value = driven_number(rate.constraints[c].kind))
            system.values[c].rate = *value;
    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        ElementPath& path = system.elements[e];
        if (const double* length = driven_number(rate.elastics[e].kind))
            path.free_length.rate = *length;
        if (const Vector6* wrench = preload(rate.elastics[e].kind))
            for (std::size_t k = 0; k < 6; ++k)
                path.preload[k].rate = (*wrench)[static_cast<int>(k)];
    }
    // The drivers at a, by the product rule. A load that changes is one more load.
    std::size_t next_load = model.static_loads.size();
    std::vector<LoadPath> more;
    const auto add_change = [&](LoadKind load, const LoadKind& d, double by) {
        load_vector(load) = load_vector(d);
        more.push_back({load, {0, by}});
    };
    for (std::size_t k = 0; k < next_load; ++k)
        add_change(model.static_loads[k].kind, rate.static_loads[k].kind, 1);
    for (std::size_t k = 0; k < frozen.branch->drivers.size(); ++k) {
        const Driver &driver = frozen.branch->drivers[k], &d = rate.branches.front().drivers[k];
        const double by = driver.start + a * driver.rate, dby = d.start + a * d.rate;
        std::visit(
            overloaded{[&](const Load& load) {
                           system.loads[next_load++].factor.rate = dby;
                           add_change(load.kind, std::get<Load>(d.what).kind, by);
                       },
                       [&](const Motion& motion) {
                           const auto& joint = model.joints[static_cast<std::size_t>(motion.joint)];
                           system.values[static_cast<std::size_t>(joint.driven)].rate += dby;
                       },
                       [&](const FreeLength& f) {
                           system.elements[static_cast<std::size_t>(f.elastic)].free_length.rate +=
                               dby;
                       },
                       [&](const Preload& p) {
                           auto& preload =
                               system.elements[static_cast<std::size_t>(p.elastic)].preload;
                           for (std::size_t n = 0; n < 6; ++n)
                               preload[n].rate +=
                                   dby * p.direction[static_cast<int>(n)] +
                                   by * std::get<Preload>(d.what).direction[static_cast<int>(n)];
                       }},
            driver.what);
    }
    system.loads.insert(system.loads.end(), more.begin(), more.end());

    // Whether features move.
    const auto moves = [&](const Twists& both) {
        double most = 0;
        for (const Twist* twist : {&both.i, &both.j})
            most = std::max({most, twist->v.norm() / system.length, twist->w.norm()});
        number.motion = std::max(number.motion, most);
        return most != 0;
    };
    for (std::size_t e = 0; e < model.elastics.size(); ++e)
        number.elements.push_back(moves(twists_of(model.elastics[e].kind, rate.elastics[e].kind)) ||
                                  system.elements[e].free_length.rate != 0);
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        number.constraints.push_back(
            moves(twists_of(model.constraints[c].kind, rate.constraints[c].kind)) ||
            system.values[c].rate != 0);
    for (std::size_t k = 0; k < system.loads.size(); ++k) {
        const LoadKind* d = load_rate(rate, k);
        number.loads.push_back(system.loads[k].factor.rate != 0 ||
                               (d != nullptr && moves(twists_of(system.loads[k].kind, *d))));
    }
    for (const ElementPath& path : system.elements)
        number.motion = std::max(number.motion, std::abs(path.free_length.rate) / system.length);
    for (const auto& elastic : rate.elastics)
        each_member(elastic.kind, [&](Deformation<const Vector6> e) {
            number.motion = std::max({number.motion, e.value.head<3>().norm() / system.length,
                                      e.value.tail<3>().norm()});
        });

    // The laws of bushings, and their undeformed state.
    number.laws.assign(model.elastics.size(), Vector6::Zero());
    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        const auto of_bushing = [&](const Bushing& bushing) {
            const auto& d = std::get<Bushing>(rate.elastics[e].kind);
            ElementPath& path = system.elements[e];
            path.rotational = path.rotational || resists_rotation(d.law);
            const Vector6 at = deformations(system, e, 0., frame_of(system, x, bushing.i.body),
                                            frame_of(system, x, bushing.j.body));
            Vec6<Dual> moving_at = at.cast<Dual>();
            for (int k = 0; k < 6; ++k) moving_at[k].v[0] = -d.undeformed[k];
            const Vec6<Dual> answer = gradient(bushing.law, moving_at);
            const Vector6 law = force_rate(bushing.law, d.law, at);
            for (int k = 0; k < 6; ++k) {
                number.laws[e][k] = answer[k].v[0] + law[k];
                path.preload[static_cast<std::size_t>(k)].rate += number.laws[e][k];
            }
            for (std::size_t k = 3; k < 6; ++k)
                path.rotational = path.rotational || path.preload[k].rate != 0;
            number.elements[e] =
                number.elements[e] || std::ranges::any_of(path.preload, [](const Affine& preload) {
                    return preload.rate != 0;
                });
        };
        // of springs: rate_of
        std::visit(overloaded{of_bushing, [](const AxialSpring&) {}}, model.elastics[e].kind);
    }
    return number;
}

namespace {

struct Source {
    const NumberRate& number;
    const VectorXd& x;
    const VectorXd& dx;  // empty: none

    bool wants(Term term, std::size_t k) const {
        switch (term) {
            case Term::element: return number.elements[k];
            case Term::load: return number.loads[k];
            case Term::ground_spring: return false;
            case Term::constraint: return number.constraints[k];
        }
        return true;
    }
    Frame<Dual> frame(const Part& part, int which) const {
        return moving(number.changing, x, dx, which == 0 ? part.i : part.j,
                      twist_of(number, part, which));
    }
    Dual reaction(const Part& part, int k) const {
        const int n = 6 * number.changing.bodies;
        Dual R(x[7 * number.changing.bodies + part.row + k]);
        if (dx.size() > 0) R.v[0] = dx[n + part.row + k];
        return R;
    }
};

struct Sink {
    const NumberRate& number;
    const VectorXd& x;
    VectorXd E_rate;

    // The terms take moments about the origin of the frame that they receive; the twist moves it
    // by A v and the body does not move: M = M' + A v × F.
    void balance(const Part& part, BodyId body, const Vec3<Dual>& force, const Vec3<Dual>& moment) {
        const System& system = number.changing;
        const Vector3d F(force[0].a, force[1].a, force[2].a);
        const Twist by = twist_of(number, part, body == part.i ? 0 : 1);
        const Vector3d moved = turned(frame_of(system, x, body).p, by.v) / system.length;
        const Vector3d arm = moved.cross(F);
        for (int k = 0; k < 3; ++k) {
            E_rate[6 * body + k] += force[k].v[0];
            E_rate[6 * body + 3 + k] += moment[k].v[0] + arm[k];
        }
    }
    void constraint(const Part& part, int k, const Dual& Phi) {
        E_rate[6 * number.changing.bodies + part.row + k] += Phi.v[0];
    }
};

}  // namespace

VectorXd rate_of(const NumberRate& number, const VectorXd& x) {
    const System& system = number.changing;
    const Model& model = *system.model;
    Dual a(0.);
    a.v[0] = 1;
    const VectorXd still;
    Sink sink{number, x, VectorXd::Zero(system.equations())};
    assemble<Dual>(system, a, Dual(0.), {}, Source{number, x, still}, sink);
    // The laws of springs.
    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        const auto of_spring = [&](const AxialSpring& spring) {
            const auto& d = std::get<AxialSpring>(number.rate->elastics[e].kind);
            const Frame<double> i = frame_of(system, x, spring.i.body),
                                j = frame_of(system, x, spring.j.body);
            const double at = deformations(system, e, 0., i, j)[0];
            AxialSpring without = spring;
            without.law = LinearRate{};
            const auto on =
                interaction(without, 0., force_rate(spring.law, d.law, at), by_itself, i, j);
            const auto add = [&](BodyId body, const Frame<double>& frame,
                                 const Interaction<double>& action) {
                if (body == ground) return;
                const Vector3d moment =
                    action.moment + cross(Vector3d(action.at - frame.r), action.force);
                sink.E_rate.segment<3>(6 * body) += action.force / system.force;
                sink.E_rate.segment<3>(6 * body + 3) += moment / (system.force * system.length);
            };
            add(spring.i.body, i, on.i);
            add(spring.j.body, j, on.j);
        };
        // of bushings: their preload, number_rate()
        std::visit(overloaded{of_spring, [](const Bushing&) {}}, model.elastics[e].kind);
    }
    return std::move(sink.E_rate);
}

std::vector<Wrench> wrench_rates(const NumberRate& number, const VectorXd& x, const VectorXd& dx) {
    const System& system = number.changing;
    const Model& model = *system.model;
    std::vector<Wrench> rates(model.joints.size());
    const Source source{number, x, dx};
    Dual a(0.);
    a.v[0] = 1;
    int row = 0;
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const auto& constraint = model.constraints[c];
        const auto [i, j] = bodies_of(constraint.kind);
        const Part part{.i = i,
                        .j = j,
                        .row = row,
                        .rows = rows(constraint.kind),
                        .term = Term::constraint,
                        .number = c};
        const double unit =
            is_direction(constraint.kind) ? system.force * system.length : system.force;
        Dual R[3];
        for (int k = 0; k < part.rows; ++k) R[k] = source.reaction(part, k) * unit;
        const auto h =
            holding(system, c, a, Dual(0.), source.frame(part, 0), source.frame(part, 1), R);
        const auto at = static_cast<std::size_t>(constraint.joint);
        const ModelJoint& joint = model.joints[at];
        const Vec3<Dual> p = position(
            moving(system, x, dx, joint.at.body, twist(joint.at, number.rate->joints[at].at)),
            joint.at.s_local);
        const Vec3<Dual> moment =
            h.reaction.moment + cross(Vec3<Dual>(h.reaction.at - p), h.reaction.force);
        const double sign = i == joint.i ? +1 : -1;
        for (int k = 0; k < 3; ++k) {
            rates[at].force[k] += sign * h.reaction.force[k].v[0];
            rates[at].moment[k] += sign * moment[k].v[0];
        }
        row += part.rows;
    }
    return rates;
}

// ---- Mixed derivatives: along p, a number or a step of one unknown, and along the responses.

namespace {

constexpr int at_once = 8;  // responses of one pass
using Second = Mixed<at_once>;

// Responses first ... first + count - 1.
struct Pass {
    const Responding& to;
    Eigen::Index first, count;

    // Entry (row, of the responses).
    Second::Along entries(const Eigen::MatrixXd& all, Eigen::Index row) const {
        Second::Along s = Second::Along::Zero();
        s.head(count) = all.row(row).segment(first, count).transpose().array();
        return s;
    }
};

// The step p of the unknowns: of one body or of one reaction.
struct UnitStep {
    Eigen::Index entry = -1;  // in dx; -1: none
    bool is(Eigen::Index k) const { return entry == k; }
};

// The frame of a body at x. It moves by the responses, before that by p (so exp(η π_t) exp(ε π_p)),
// and before that by a twist in its own axes along p.
Frame<Second> moving(const System& system, const VectorXd& x, const Pass& pass, const UnitStep& p,
                     BodyId body, const Twist& twist) {
    const Frame<double> at = frame_of(system, x, body);
    Vector3d dr = turned(at.p, twist.v), omega = turned(at.p, twist.w);
    const Vector3d v = dr;
    Frame<Second> frame{at.r.cast<Second>(), at.p.cast<Second>()};
    Second::Along r_t[3], pi_t[3];
    for (int k = 0; k < 3; ++k) r_t[k].setZero(), pi_t[k].setZero();
    if (body != ground)
        for (int k = 0; k < 3; ++k) {
            if (p.is(6 * body + k)) dr[k] += system.length;
            if (p.is(6 * body + 3 + k)) omega[k] += 1;
            r_t[k] = system.length * pass.entries(pass.to.X, 6 * body + k);
            pi_t[k] = pass.entries(pass.to.X, 6 * body + 3 + k);
        }
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        frame.r[k].p = dr[k];
        frame.r[k].s = r_t[k];
        frame.r[k].ps = pi_t[l] * v[m] - pi_t[m] * v[l];
    }
    // Half of π times a quaternion, from the left.
    const Vector3d half = omega / 2;
    const Quaterniond by_p = product(Quaterniond(0, half.x(), half.y(), half.z()), at.p);
    for (int n = 0; n < at_once; ++n) {
        const Quaterniond turn(0, pi_t[0][n] / 2, pi_t[1][n] / 2, pi_t[2][n] / 2),
            by_s = product(turn, at.p), by_ps = product(turn, by_p);
        for (int k = 0; k < 4; ++k) {
            frame.p.coeffs()[k].s[n] = by_s.coeffs()[k];
            frame.p.coeffs()[k].ps[n] = by_ps.coeffs()[k];
        }
    }
    for (int k = 0; k < 4; ++k) frame.p.coeffs()[k].p = by_p.coeffs()[k];
    return frame;
}

struct MixedSource {
    const System& system;
    const VectorXd& x;
    const Pass& pass;
    UnitStep p;
    const NumberRate* number = nullptr;  // or a number

    bool wants(Term term, std::size_t k) const {
        if (number == nullptr) return touched(term, k);
        switch (term) {
            case Term::element: return number->elements[k];
            case Term::load: return number->loads[k];
            case Term::ground_spring: return false;
            case Term::constraint: return number->constraints[k];
        }
        return true;
    }
    Frame<Second> frame(const Part& part, int which) const {
        return moving(system, x, pass, p, which == 0 ? part.i : part.j, twist(part, which));
    }
    Second reaction(const Part& part, int k) const {
        const Eigen::Index at = 6 * system.bodies + part.row + k;
        Second R(x[system.bodies + at]);
        if (p.is(at)) R.p = 1;
        R.s = pass.entries(pass.to.X, at);
        return R;
    }
    Second offset(std::size_t c) const {
        Second more;
        more.s = pass.entries(pass.to.offset, static_cast<Eigen::Index>(c));
        return more;
    }
    Twist twist(const Part& part, int which) const {
        return number == nullptr ? Twist{} : twist_of(*number, part, which);
    }

  private:
    // Whether a term depends on the unknown that p moves.
    bool touched(Term term, std::size_t k) const {
        const Model& model = *system.model;
        const int body = p.entry < 6 * system.bodies ? static_cast<int>(p.entry / 6) : ground;
        const auto joins = [&](const Pair& pair) { return pair.i == body || pair.j == body; };
        switch (term) {
            case Term::element: return body != ground && joins(bodies_of(model.elastics[k].kind));
            case Term::load: return body != ground && body_of(system.loads[k].kind) == body;
            case Term::ground_spring: return false;
            case Term::constraint: break;
        }
        if (body != ground) return joins(bodies_of(model.constraints[k].kind));
        int row = static_cast<int>(p.entry) - 6 * system.bodies;
        for (std::size_t c = 0; c < k; ++c) row -= rows(model.constraints[c].kind);
        return row >= 0 && row < rows(model.constraints[k].kind);
    }
};

// Sums the mixed derivatives of the equations [n × responses of the pass].
struct MixedSink {
    const MixedSource& source;
    Eigen::MatrixXd E;

    // The arm of the twist, as in Sink.
    void balance(const Part& part, BodyId body, const Vec3<Second>& force,
                 const Vec3<Second>& moment) {
        const Vector3d v = source.twist(part, body == part.i ? 0 : 1).v / source.system.length;
        Vec3<Second> arm = Vec3<Second>::Constant(Second(0.));
        if (!v.isZero(0)) {
            Second along(0.);
            along.p = 1;
            const Frame<Second> frame =
                moving(source.system, source.x, source.pass, {}, body, Twist{});
            arm = cross(Vec3<Second>(turned(frame.p, v) * along), force);
        }
        for (int k = 0; k < 3; ++k) {
            add(6 * body + k, force[k]);
            add(6 * body + 3 + k, moment[k] + arm[k]);
        }
    }
    void constraint(const Part& part, int k, const Second& Phi) {
        add(6 * source.system.bodies + part.row + k, Phi);
    }
    void add(Eigen::Index row, const Second& value) {
        E.row(row) += value.ps.head(E.cols()).matrix().transpose();
    }
};

// Change of a law's force along p: of its numbers, and of the deformation x by -p dx.
Second law_change(const LinearRate& u, const LinearRate& d, const Second& x, const Second& p,
                  double dx) {
    return p * (d.k * x - Second(u.k * dx));
}
Second law_change(const Curve& u, const Curve& d, const Second& x, const Second& p, double dx) {
    const auto k = static_cast<std::size_t>(piece_at(u, x));
    const std::size_t knot = k == 0 ? 0 : k - 1;
    const Second h = x - Second(u.knots[knot]), moved = h - p * Second(d.knots[knot] + dx);
    Second before(0.), after(0.);
    for (std::size_t n = 4; n-- > 0;) {
        before = before * h + Second(u.pieces[k][n]);
        after = after * moved + Second(u.pieces[k][n]) + p * Second(d.pieces[k][n]);
    }
    return after - before;
}
Second law_change(const ScalarLaw& law, const ScalarLaw& d, const Second& x, const Second& p,
                  double dx) {
    return std::visit(
        [&]<class Law>(const Law& u) { return law_change(u, std::get<Law>(d), x, p, dx); }, law);
}
Vec6<Second> law_change(const SpatialLaw& law, const SpatialLaw& d, const Vec6<Second>& e,
                        const Second& p, const Vector6& de) {
    return std::visit(overloaded{[&](const LinearStiffness& u) {
                                     const Vector6 constant = u.K * de;
                                     Vec6<Second> f = gradient(d, e);
                                     for (int k = 0; k < 6; ++k)
                                         f[k] = p * (f[k] - Second(constant[k]));
                                     return f;
                                 },
                                 [&](const PerAxis& u) {
                                     Vec6<Second> f;
                                     for (int k = 0; k < 6; ++k) {
                                         const auto at = static_cast<std::size_t>(k);
                                         f[k] =
                                             law_change(u.axis[at], std::get<PerAxis>(d).axis[at],
                                                        e[k], p, de[k]);
                                     }
                                     return f;
                                 }},
                      law);
}
bool changes(const ScalarLaw& d) {
    return std::visit(
        overloaded{[](const LinearRate& u) { return u.k != 0; }, [](const Curve&) { return true; }},
        d);
}
bool changes(const SpatialLaw& d) {
    return std::visit(overloaded{[](const LinearStiffness& u) { return !u.K.isZero(0); },
                                 [](const PerAxis&) { return true; }},
                      d);
}

// The laws of elements: their change of force acts as a preload, at frames that only respond.
void add_law_changes(const NumberRate& number, const MixedSource& source, const Second& p,
                     MixedSink& sink) {
    const System& system = source.system;
    const Model& model = *system.model;
    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        const ElasticKind &kind = model.elastics[e].kind, &rate = number.rate->elastics[e].kind;
        const auto [body_i, body_j] = bodies_of(kind);
        const auto frame = [&](BodyId body) {
            return moving(system, source.x, source.pass, {}, body, Twist{});
        };
        const auto apply = [&](BodyId body, const Frame<Second>& at,
                               const Interaction<Second>& on) {
            if (body == ground) return;
            const Vec3<Second> moment = on.moment + cross(Vec3<Second>(on.at - at.r), on.force);
            for (int k = 0; k < 3; ++k) {
                sink.add(6 * body + k, on.force[k] * (1 / system.force));
                sink.add(6 * body + 3 + k, moment[k] * (1 / (system.force * system.length)));
            }
        };
        const auto act = [&](const Frame<Second>& i, const Frame<Second>& j,
                             const OnBoth<Second>& on) {
            apply(body_i, i, on.i);
            apply(body_j, j, on.j);
        };
        std::visit(
            overloaded{
                [&](const AxialSpring& spring) {
                    const auto& d = std::get<AxialSpring>(rate);
                    if (!changes(d.law)) return;
                    const Frame<Second> i = frame(body_i), j = frame(body_j);
                    const Second x = deformations(system, e, Second(0.), i, j)[0];
                    AxialSpring without = spring;
                    without.law = LinearRate{};
                    act(i, j,
                        interaction(without, Second(0.), law_change(spring.law, d.law, x, p, 0),
                                    by_itself, i, j));
                },
                [&](const Bushing& bushing) {
                    const auto& d = std::get<Bushing>(rate);
                    if (!changes(d.law) && d.undeformed.isZero(0)) return;
                    const Frame<Second> i = frame(body_i), j = frame(body_j);
                    const Vec6<Second> at = deformations(system, e, Second(0.), i, j);
                    Bushing without = bushing;
                    without.law = LinearStiffness{Matrix6::Zero()};
                    act(i, j,
                        interaction(without, law_change(bushing.law, d.law, at, p, d.undeformed),
                                    system.elements[e].rotational, all_by_themselves, i, j));
                }},
            kind);
    }
}

template <class EachPass>
void in_passes(const Responding& to, const EachPass& each) {
    for (Eigen::Index first = 0; first < to.X.cols(); first += at_once)
        each(Pass{to, first, std::min<Eigen::Index>(at_once, to.X.cols() - first)});
}

}  // namespace

std::vector<Eigen::MatrixXd> curvatures(const System& frozen, const VectorXd& x,
                                        const Responding& to) {
    const int n = frozen.equations();
    std::vector<Eigen::MatrixXd> D(static_cast<std::size_t>(to.X.cols()),
                                   Eigen::MatrixXd::Zero(n, n));
    in_passes(to, [&](const Pass& pass) {
        for (int k = 0; k < n; ++k) {
            const MixedSource source{frozen, x, pass, {k}};
            MixedSink sink{source, Eigen::MatrixXd::Zero(n, pass.count)};
            assemble<Second>(frozen, Second(0.), Second(0.), {}, source, sink);
            for (Eigen::Index t = 0; t < pass.count; ++t)
                D[static_cast<std::size_t>(pass.first + t)].col(k) = sink.E.col(t);
        }
    });
    return D;
}

Eigen::MatrixXd rates_of(const NumberRate& number, const VectorXd& x, const Responding& to) {
    // The laws change with the deformation, beside the terms.
    System system = number.changing;
    for (std::size_t e = 0; e < number.laws.size(); ++e)
        for (int k = 0; k < 6; ++k)
            system.elements[e].preload[static_cast<std::size_t>(k)].rate -= number.laws[e][k];
    Second a(0.);
    a.p = 1;
    Eigen::MatrixXd all(system.equations(), to.X.cols());
    in_passes(to, [&](const Pass& pass) {
        const MixedSource source{system, x, pass, {}, &number};
        MixedSink sink{source, Eigen::MatrixXd::Zero(system.equations(), pass.count)};
        assemble<Second>(system, a, Second(0.), {}, source, sink);
        add_law_changes(number, source, a, sink);
        all.middleCols(pass.first, pass.count) = sink.E;
    });
    return all;
}

}  // namespace elastocheck::reference::equilibrium
