// Bodies, joints, elastic elements, forces, their balance, its derivatives and the linear algebra are Simbody's; from the
// model comes what there is, and from here the loop over the loads, and Newton's over
//
//   E(q, λ) = ( (Φ_uᵀ λ - f) / k,  Φ ) = 0      f: the generalised forces of all elements and loads,
//                                              Φ: the errors of all constraints
//
// with λ in units of k = 10⁶ N/m, so that what is a force, a moment or a length is about as large as what it belongs to.
// The step is the shortest that solves the linearised equations: idle modes stay where they are.
#include "tests/engines/simbody/engine.hpp"

// Two of Simbody's indices compare as integers, of which C++20 finds too many kinds, and its headers do compare them.
namespace SimTK {
template <class Index>
requires requires(const Index& index) { index.isValidExtended(); }
bool operator==(const Index& a, const Index& b) {
    return static_cast<int>(a) == static_cast<int>(b);
}
}  // namespace SimTK

#include <Simbody.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::engines {
namespace {

using SimTK::Constraint, SimTK::Force, SimTK::MobilizedBody, SimTK::Transform, SimTK::UnitVec3,
    SimTK::Vec3, SimTK::Vec6;

constexpr double unit_of_stiffness = 1e6;  // k [N/m]
constexpr double settled =
    1e-11;  // what Newton's last step moves [m, rad] and leaves [m, 1e6 N, 1e6 N·m]
constexpr double far =
    0.5;  // [m, rad] for one step of the load: some other equilibrium, not the next
constexpr int iteration_limit = 40, max_halvings = 8;
constexpr double rank =
    1e-8;  // reciprocal condition of J below which a motion is idle; differences leave less

Vec3 vec(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
UnitVec3 unit(const Direction& d) { return UnitVec3(vec(d.u_local)); }
SimTK::Rotation rotation(const Eigen::Quaterniond& p) {
    return SimTK::Rotation(SimTK::Quaternion(p.w(), p.x(), p.y(), p.z()));
}

// ---- The model at one value of the parameter: what is driven, written into it as plain data.

void offset(ConstraintKind& kind, double by) {
    std::visit(overloaded{[&](PointInPlane& c) { c.offset += by; },
                          [&](DistanceBetween& c) { c.length += by; },
                          [&](DirectionAtAngle& c) { c.angle += by; }, [](CoincidentPoints&) {},
                          [](PerpendicularDirections&) {}},
               kind);
}

Load times(Load load, double factor) {
    load_vector(load.kind) *= factor;
    return load;
}

Model standing_at(double a, Model model, const Branch& branch) {
    const auto at = [](auto& list, int k) -> auto& { return list[static_cast<std::size_t>(k)]; };
    for (const Driver& driver : branch.drivers) {
        const double value = driver.start + driver.rate * a;
        std::visit(
            overloaded{[&](const Load& load) { model.static_loads.push_back(times(load, value)); },
                       [&](const Motion& m) {
                           offset(at(model.constraints, at(model.joints, m.joint).driven).kind,
                                  value);
                       },
                       [&](const FreeLength& f) {
                           ElasticKind& kind = at(model.elastics, f.elastic).kind;
                           if (double* length = driven_number(kind))
                               *length += value;
                           else
                               std::get<Bushing>(kind).undeformed[2] += value;
                       },
                       [&](const Preload& p) {
                           std::get<Bushing>(at(model.elastics, p.elastic).kind).preload +=
                               value * p.direction;
                       }},
            driver.what);
    }
    return model;
}

// ---- What Simbody has no element for: a spring whose force is a curve, a force on one body along a
// line through a point of another.

class CurvedSpring : public Force::Custom::Implementation {
  public:
    CurvedSpring(MobilizedBody i, MobilizedBody j, AxialSpring spring)
        : i_(std::move(i)), j_(std::move(j)), spring_(std::move(spring)) {}

    void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& on_bodies,
                   SimTK::Vector_<Vec3>&, SimTK::Vector&) const override {
        const Vec3 from_i = between(state);
        const Vec3 pull = force(from_i.norm() - spring_.free_length) * from_i.normalize();
        i_.applyForceToBodyPoint(state, vec(spring_.i.s_local), pull, on_bodies);
        j_.applyForceToBodyPoint(state, vec(spring_.j.s_local), -pull, on_bodies);
    }
    SimTK::Real calcPotentialEnergy(const SimTK::State&) const override {
        return SimTK::NaN;
    }  // nobody asks
    bool dependsOnlyOnPositions() const override { return true; }

  private:
    Vec3 between(const SimTK::State& state) const {
        return j_.findStationLocationInGround(state, vec(spring_.j.s_local)) -
               i_.findStationLocationInGround(state, vec(spring_.i.s_local));
    }
    double force(double x) const {
        const Curve& curve = std::get<Curve>(spring_.law);
        const auto piece = static_cast<std::size_t>(std::ranges::upper_bound(curve.knots, x) -
                                                    curve.knots.begin());
        const auto& c = curve.pieces[piece];
        const double t = x - curve.knots[piece == 0 ? 0 : piece - 1];
        return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    }

    MobilizedBody i_, j_;
    AxialSpring spring_;
};

class ForceThroughPatch : public Force::Custom::Implementation {
  public:
    ForceThroughPatch(MobilizedBody carrier, MobilizedBody wheel, const BrakeForce& load)
        : carrier_(std::move(carrier)),
          wheel_(std::move(wheel)),
          at_(vec(load.patch.s_local)),
          f_(vec(load.f)) {}

    void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& on_bodies,
                   SimTK::Vector_<Vec3>&, SimTK::Vector&) const override {
        const Vec3 p = wheel_.findStationLocationInGround(state, at_);
        carrier_.applyForceToBodyPoint(state, carrier_.findStationAtGroundPoint(state, p), f_,
                                       on_bodies);
    }
    SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return SimTK::NaN; }
    bool dependsOnlyOnPositions() const override { return true; }

  private:
    MobilizedBody carrier_, wheel_;
    Vec3 at_, f_;
};

// ---- The same mechanism, of Simbody's parts.

struct Mechanism {
    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter{system};
    SimTK::GeneralForceSubsystem forces{system};
    SimTK::State state;

    // The ground is its body 0.
    MobilizedBody& body(BodyId b) {
        return matter.updMobilizedBody(SimTK::MobilizedBodyIndex(b + 1));
    }
    MobilizedBody& on(const Point& p) { return body(p.body); }
    MobilizedBody& on(const Direction& d) { return body(d.body); }

    explicit Mechanism(const Model& model) {
        // Free bodies, by three angles and three lengths that are 0 at the design position; at rest masses play no part.
        for (const Body& b : model.bodies)
            MobilizedBody::Bushing(
                matter.Ground(), Transform(rotation(b.design.p), vec(b.design.r)),
                SimTK::Body::Rigid(SimTK::MassProperties(1, Vec3(0), SimTK::Inertia(1))),
                Transform());
        for (const auto& constraint : model.constraints)
            std::visit([&](const auto& kind) { add(kind); }, constraint.kind);
        for (const Elastic& elastic : model.elastics)
            std::visit([&](const auto& kind) { add(elastic.name, kind); }, elastic.kind);
        for (const Load& load : model.static_loads)
            std::visit([&](const auto& kind) { add(load.name, kind); }, load.kind);
        state = system.realizeTopology();
        system.realize(
            state, SimTK::Stage::Instance);  // by then it is known how many constraints there are
    }

    void add(const CoincidentPoints& c) {
        Constraint::Ball(on(c.i), vec(c.i.s_local), on(c.j), vec(c.j.s_local));
    }
    void add(const PointInPlane& c) {
        const double height = c.normal_j.u_local.dot(c.j.s_local) + c.offset;
        Constraint::PointInPlane(on(c.j), unit(c.normal_j), height, on(c.i), vec(c.i.s_local));
    }
    void add(const PerpendicularDirections& c) {
        Constraint::ConstantAngle(on(c.j), unit(c.j), on(c.i), unit(c.i), SimTK::Pi / 2);
    }
    void add(const DistanceBetween& c) {
        Constraint::Rod(on(c.i), vec(c.i.s_local), on(c.j), vec(c.j.s_local), c.length);
    }
    void add(const DirectionAtAngle& c) {
        const Direction across{c.j.body,
                               std::cos(c.angle) * c.y_j.u_local - std::sin(c.angle) * c.j.u_local};
        add(PerpendicularDirections{c.i, across});
    }

    void add(const std::string& name, const AxialSpring& s) {
        if (const auto* linear = std::get_if<LinearRate>(&s.law))
            Force::TwoPointLinearSpring(forces, on(s.i), vec(s.i.s_local), on(s.j),
                                        vec(s.j.s_local), linear->k, s.free_length);
        else if (std::get<Curve>(s.law).known_outside)
            Force::Custom(forces, new CurvedSpring(on(s.i), on(s.j), s));  // theirs from now on
        else
            throw NotRepresented("spring '" + name +
                                 "': its curve has ends, and a load step may lead beyond them");
    }

    void add(const std::string& name, const Bushing& b) {
        const auto refuse = [&](const char* why) {
            throw NotRepresented("bushing '" + name + "': Simbody's has " + why);
        };
        const Formulation& f = b.formulation;
        if (f.frame != Formulation::Frame::on_i) refuse("no frame but that of its first body");
        if (f.angles == Formulation::Angles::projected) refuse("no projected angles");
        if (!has_energy(f)) refuse("no forces but those of its energy");
        if (!b.preload.isZero(0) || !b.undeformed.isZero(0)) refuse("no preload");
        Vec6 k(0);  // rotations first
        for (int axis = 0; axis < 6; ++axis) {
            double& rate = k[(axis + 3) % 6];
            if (const auto* stiffness = std::get_if<LinearStiffness>(&b.law)) {
                if (!stiffness->K.isDiagonal(0)) refuse("no rate between two axes");
                rate = stiffness->K(axis, axis);
            } else if (const auto* linear = std::get_if<LinearRate>(
                           &std::get<PerAxis>(b.law).axis[static_cast<std::size_t>(axis)])) {
                rate = linear->k;
            } else {
                refuse("no curves");
            }
        }
        const auto frame = [](const Marker& m) {
            return Transform(rotation(m.A_local), vec(m.s_local));
        };
        Force::LinearBushing(forces, body(b.i.body), frame(b.i), body(b.j.body), frame(b.j), k,
                             Vec6(0));
    }

    void add(const std::string&, const DeadForce& l) {
        Force::ConstantForce(forces, on(l.at), vec(l.at.s_local), vec(l.f));
    }
    void add(const std::string&, const DeadMoment& l) {
        Force::ConstantTorque(forces, body(l.body), vec(l.m));
    }
    void add(const std::string& name, const FollowerForce&) { refuse_follower(name); }
    void add(const std::string& name, const FollowerMoment&) { refuse_follower(name); }
    void add(const std::string&, const BrakeForce& l) {
        Force::Custom(forces, new ForceThroughPatch(body(l.body), body(l.patch.body), l));
    }
    static void refuse_follower(const std::string& name) {
        throw NotRepresented("load '" + name + "': Simbody's keep their direction in ground axes");
    }
};

// E over x = (q, λ / k), for Simbody's differences.
class Equations : public SimTK::Differentiator::JacobianFunction {
  public:
    explicit Equations(Mechanism& mechanism)
        : JacobianFunction(mechanism.state.getNU() + mechanism.state.getNMultipliers(),
                           mechanism.state.getNQ() + mechanism.state.getNMultipliers()),
          at_(mechanism) {}

    int f(const SimTK::Vector& x, SimTK::Vector& E) const override {
        const int n = at_.state.getNQ(), m = x.size() - n;
        at_.state.updQ() = x(0, n);
        at_.system.realize(at_.state, SimTK::Stage::Dynamics);
        SimTK::Vector lambda = unit_of_stiffness * x(n, m), unbalanced;
        at_.matter.calcResidualForce(
            at_.state, at_.system.getMobilityForces(at_.state, SimTK::Stage::Dynamics),
            at_.system.getRigidBodyForces(at_.state, SimTK::Stage::Dynamics), SimTK::Vector(),
            lambda, unbalanced);
        E(0, n) = unbalanced / unit_of_stiffness;
        E(n, m) = at_.state.getQErr();
        return 0;
    }

  private:
    Mechanism& at_;
};

// ---- Newton's method, and the loop over the loads

// Of the first n entries.
double largest(const SimTK::Vector& v, int n) {
    double all = 0;
    for (int k = 0; k < n; ++k) all = std::max(all, std::abs(v[k]));
    return all;
}

// The equilibrium next to x. Its last step is short and leaves nothing: where a load pushes what nothing resists, the
// shortest step is short as well.
Outcome settle(Mechanism& mechanism, SimTK::Vector& x) {
    const int n = mechanism.state.getNQ(), m = mechanism.state.getNQErr();
    if (x.size() == 0) x = SimTK::Vector(n + m, 0.0);
    const SimTK::Vector start = x;
    const Equations equations(mechanism);
    const SimTK::Differentiator differences(equations, SimTK::Differentiator::CentralDifference);
    SimTK::Vector E(n + m), dx(n + m);
    SimTK::Matrix J(n + m, n + m);
    for (int iteration = 0; iteration < iteration_limit; ++iteration) {
        equations.f(x, E);
        differences.calcJacobian(x, E, J);
        if (!std::isfinite(E.norm()) || !std::isfinite(J.norm())) return Outcome::not_finite;
        SimTK::FactorQTZ(J, rank).solve(E, dx);
        x -= dx;
        if (largest(x - start, n) > far) return Outcome::branch_lost;
        if (largest(dx, n) <= settled && largest(E, n + m) <= settled) return Outcome::converged;
    }
    return Outcome::iteration_limit;
}

// From x at `from` to the equilibrium at `to`: in one step, or halfway first where that does not settle.
Outcome advance(const Model& model, const Branch& branch, double from, double to, int halvings,
                SimTK::Vector& x) {
    SimTK::Vector tried = x;
    Mechanism mechanism(standing_at(to, model, branch));
    const Outcome outcome = settle(mechanism, tried);
    if (outcome == Outcome::converged) x = tried;
    if (outcome == Outcome::converged || halvings == 0 || from == to) return outcome;
    const double half = (from + to) / 2;
    const Outcome first = advance(model, branch, from, half, halvings - 1, x);
    return first == Outcome::converged ? advance(model, branch, half, to, halvings - 1, x) : first;
}

// How many steps a driven angle takes over `by` of the parameter, since half a turn on its sine is the same.
int turns(const Model& model, const Branch& branch, double by) {
    double steps = 1;
    for (const Driver& driver : branch.drivers)
        if (const auto* motion = std::get_if<Motion>(&driver.what)) {
            const int driven = model.joints[static_cast<std::size_t>(motion->joint)].driven;
            const auto& kind = model.constraints[static_cast<std::size_t>(driven)].kind;
            if (std::holds_alternative<DirectionAtAngle>(kind))
                steps = std::max(steps, std::ceil(std::abs(driver.rate * by) / far));
        }
    return static_cast<int>(steps);
}

Equilibrium state_at(double a, const Model& model, const Branch& branch, const SimTK::Vector& x) {
    Mechanism mechanism(standing_at(a, model, branch));
    mechanism.state.updQ() = x(0, mechanism.state.getNQ());
    mechanism.system.realize(mechanism.state, SimTK::Stage::Position);
    Equilibrium found{.load = a,
                      .poses = {},
                      .reactions = {},
                      .constraint_error = mechanism.state.getQErr().normInf()};
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
        const Transform& X = mechanism.body(b).getBodyTransform(mechanism.state);
        const SimTK::Quaternion p = X.R().convertRotationToQuaternion();
        found.poses.push_back({{X.p()[0], X.p()[1], X.p()[2]}, {p[0], p[1], p[2], p[3]}});
    }
    return found;
}

}  // namespace

EquilibriumPath simbody(const Model& model, const Branch& branch, std::span<const double> values) {
    EquilibriumPath path;
    SimTK::Vector x;  // of the last equilibrium
    double from = values.empty() ? 0 : values.front();
    for (const double a : values) {
        const int steps = turns(model, branch, a - from);
        path.outcome = Outcome::converged;
        for (int k = 0; k < steps && path.outcome == Outcome::converged; ++k)
            path.outcome = advance(model, branch, from + (a - from) * k / steps,
                                   from + (a - from) * (k + 1) / steps, max_halvings, x);
        if (path.outcome != Outcome::converged) {
            path.detail =
                branch.name + ", on the way to " + std::to_string(a) + ": " + name(path.outcome);
            break;
        }
        path.points.push_back(state_at(a, model, branch, x));
        from = a;
    }
    return path;
}

}  // namespace elastocheck::engines
