// Scenes for the tests of the equilibrium leg: those of models/scenes, some built in code, and
// invariance transforms.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"

namespace elastocheck::reference::equilibrium::test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

inline Scene scene(const std::string& file) {
    return read_scene(std::string(ELASTOCHECK_SCENES) + "/" + file + ".yaml");
}

// The load factors of a branch, 0 included.
inline std::vector<double> every_load(const Branch& branch) {
    std::vector<double> loads;
    for (int n = 0; n <= branch.steps; ++n) loads.push_back(branch.to * n / branch.steps);
    return loads;
}

inline Branch branch_of(const std::string& name, const std::vector<Driver>& drivers, double to,
                        int steps, ParameterUnit unit = ParameterUnit::newton) {
    return {name, 0, to, steps, unit, drivers};
}
inline Driver driven_by(const Load& load) { return {load, 0, 1}; }

inline LinearStiffness& stiffness_of(Bushing& bushing) {
    return std::get<LinearStiffness>(bushing.law);
}
inline LinearRate& rate_of(AxialSpring& spring) { return std::get<LinearRate>(spring.law); }

inline Vector3d position(const Equilibrium& state, const Point& p) {
    if (p.body == ground) return p.s_local;
    const auto& pose = state.poses[static_cast<std::size_t>(p.body)];
    return pose.r + pose.p * p.s_local;
}

inline Vector3d random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> in(-size, size);
    return {in(random), in(random), in(random)};
}
inline Quaterniond random_turn(std::mt19937& random) {
    std::normal_distribution<double> in;
    return Quaterniond(in(random), in(random), in(random), in(random)).normalized();
}
inline Matrix6 random_stiffness(std::mt19937& random) {
    const Matrix6 root =
        Matrix6::NullaryExpr([&] { return std::uniform_real_distribution<double>(-1, 1)(random); });
    Vector6 units;  // √(N/m), √(N·m/rad)
    units << 400, 400, 400, 30, 30, 30;
    const Matrix6 spd = root * root.transpose() + 0.3 * Matrix6::Identity();
    return units.asDiagonal() * spd * units.asDiagonal();
}

// ---- Everything in a scene that belongs to a body

struct Visitor {
    std::function<void(Point&)> point = [](Point&) {};
    std::function<void(Direction&)> direction = [](Direction&) {};
    std::function<void(Marker&)> marker = [](Marker&) {};

    void operator()(Point& p) const { point(p); }
    void operator()(Direction& d) const { direction(d); }
    void operator()(Marker& m) const { marker(m); }
};

inline void visit_load(Load& load, const Visitor& v) {
    if (auto* f = std::get_if<DeadForce>(&load.kind)) return v(f->at);
    Direction stand_in{std::get<DeadMoment>(load.kind).body, Vector3d::Zero()};
    v.direction(stand_in);
    std::get<DeadMoment>(load.kind).body = stand_in.body;
}

inline void visit(Scene& s, const Visitor& v) {
    for (auto& joint : s.joints)
        std::visit(
            [&](auto& k) {
                v(k.i);
                v(k.j);
                if constexpr (requires { k.axis_i; }) v(k.axis_i);
                if constexpr (requires { k.axis_j; }) v(k.axis_j);
                if constexpr (requires { k.normal_i; }) v(k.normal_i);
                if constexpr (requires { k.normal_j; }) v(k.normal_j);
                if constexpr (requires { k.x_i; }) v(k.x_i), v(k.y_i), v(k.x_j);
                if constexpr (requires { k.y_j; }) v(k.y_j);
            },
            joint.kind);
    for (auto& elastic : s.elastics) std::visit([&](auto& k) { v(k.i), v(k.j); }, elastic.kind);
    for (auto& load : s.static_loads) visit_load(load, v);
    for (auto& branch : s.branches)
        for (auto& driver : branch.drivers)
            if (auto* load = std::get_if<Load>(&driver.what)) visit_load(*load, v);
    for (auto& wheel : s.wheels) {
        Point centre{wheel.body, wheel.centre_local}, contact{wheel.body, wheel.contact_local};
        Direction axis{wheel.body, wheel.spin_axis_local};
        v(centre), v(contact), v(axis);
        if (auto& steering = wheel.steering_axis) v(steering->lower), v(steering->upper);
        wheel = {wheel.name,   centre.body, centre.s_local,  contact.s_local,
                 axis.u_local, wheel.side,  wheel.tyre_rate, wheel.steering_axis};
    }
    for (auto& probe : s.probes) v(probe.at);
    for (auto& damper : s.dampers) v(damper.i), v(damper.j);
}

inline void turn_loads(Scene& s, const Matrix3d& force, const Matrix3d& moment) {
    const auto turn = [&](Load& load) {
        if (auto* f = std::get_if<DeadForce>(&load.kind))
            f->f = force * f->f;
        else
            std::get<DeadMoment>(load.kind).m = moment * std::get<DeadMoment>(load.kind).m;
    };
    for (auto& load : s.static_loads) turn(load);
    for (auto& branch : s.branches)
        for (auto& driver : branch.drivers)
            if (auto* load = std::get_if<Load>(&driver.what)) turn(*load);
}

// ---- Invariance transforms

// Everything rotated by Q and shifted by t, in the same ground axes.
inline Scene moved_with_ground(Scene s, const Quaterniond& Q, const Vector3d& t) {
    for (auto& body : s.bodies) body.design = {Q * body.design.r + t, Q * body.design.p};
    visit(s, {[&](Point& p) {
                  if (p.body == ground) p.s_local = Q * p.s_local + t;
              },
              [&](Direction& d) {
                  if (d.body == ground) d.u_local = Q * d.u_local;
              },
              [&](Marker& m) {
                  if (m.body == ground) m.s_local = Q * m.s_local + t, m.A_local = Q * m.A_local;
              }});
    turn_loads(s, Q.toRotationMatrix(), Q.toRotationMatrix());
    return s;
}

// Other body axes and origins: rotated by Q[b], origin moved to c[b] of the old body axes.
inline Scene with_body_frames(Scene s, const std::vector<Quaterniond>& Q,
                              const std::vector<Vector3d>& c) {
    const auto n = [](BodyId body) { return static_cast<std::size_t>(body); };
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
        auto& pose = s.bodies[b].design;
        pose = {pose.r + pose.p * c[b], pose.p * Q[b]};
    }
    visit(s, {[&](Point& p) {
                  if (p.body != ground)
                      p.s_local = Q[n(p.body)].conjugate() * (p.s_local - c[n(p.body)]);
              },
              [&](Direction& d) {
                  if (d.body != ground) d.u_local = Q[n(d.body)].conjugate() * d.u_local;
              },
              [&](Marker& m) {
                  if (m.body == ground) return;
                  m.s_local = Q[n(m.body)].conjugate() * (m.s_local - c[n(m.body)]);
                  m.A_local = Q[n(m.body)].conjugate() * m.A_local;
              }});
    return s;
}

// Bodies, joints, elements and loads in the opposite order.
inline Scene reversed(Scene s) {
    const auto turn = [&](BodyId& body) {
        if (body != ground) body = static_cast<BodyId>(s.bodies.size()) - 1 - body;
    };
    visit(s, {[&](Point& p) { turn(p.body); }, [&](Direction& d) { turn(d.body); },
              [&](Marker& m) { turn(m.body); }});
    std::reverse(s.bodies.begin(), s.bodies.end());
    std::reverse(s.joints.begin(), s.joints.end());
    std::reverse(s.elastics.begin(), s.elastics.end());
    const auto other_end = [](int& k, std::size_t count) { k = static_cast<int>(count) - 1 - k; };
    for (auto& branch : s.branches) {
        std::reverse(branch.drivers.begin(), branch.drivers.end());
        for (auto& driver : branch.drivers) {
            if (auto* motion = std::get_if<Motion>(&driver.what))
                other_end(motion->joint, s.joints.size());
            if (auto* length = std::get_if<FreeLength>(&driver.what))
                other_end(length->elastic, s.elastics.size());
            if (auto* preload = std::get_if<Preload>(&driver.what))
                other_end(preload->elastic, s.elastics.size());
        }
    }
    return s;
}

// y -> -y. With S = diag(1, -1, 1): vectors S v, rotations and axes S A S, axial vectors (moments,
// θ) -S v.
inline Scene mirrored(Scene s) {
    const Matrix3d S = Vector3d(1, -1, 1).asDiagonal();
    const auto mirror = [&](const Quaterniond& p) {
        return Quaterniond(p.w(), -p.x(), p.y(), -p.z());
    };
    for (auto& body : s.bodies) body.design = {S * body.design.r, mirror(body.design.p)};
    visit(s, {[&](Point& p) { p.s_local = S * p.s_local; },
              [&](Direction& d) { d.u_local = S * d.u_local; },
              [&](Marker& m) { m.s_local = S * m.s_local, m.A_local = mirror(m.A_local); }});
    turn_loads(s, S, -S);
    Vector6 T;
    T << 1, -1, 1, -1, 1, -1;
    for (auto& elastic : s.elastics)
        if (auto* b = std::get_if<Bushing>(&elastic.kind)) {
            stiffness_of(*b).K = T.asDiagonal() * stiffness_of(*b).K * T.asDiagonal();
            b->preload = T.asDiagonal() * b->preload;
        }
    for (auto& branch : s.branches)
        for (auto& driver : branch.drivers)
            if (auto* preload = std::get_if<Preload>(&driver.what))
                preload->direction = T.asDiagonal() * preload->direction;
    return s;
}

// Numbers for a unit of length of 1/c m, forces still in N.
inline Scene with_length_unit(Scene s, double c) {
    for (auto& body : s.bodies) body.design.r *= c;
    visit(s, {[&](Point& p) { p.s_local *= c; }, [](Direction&) {},
              [&](Marker& m) { m.s_local *= c; }});
    turn_loads(s, Matrix3d::Identity(), c * Matrix3d::Identity());
    Vector6 T;
    T << 1, 1, 1, c, c, c;  // (force, moment), and 1 / length becomes / c for translations
    Vector6 E;
    E << 1 / c, 1 / c, 1 / c, 1, 1, 1;
    for (auto& elastic : s.elastics) {
        if (auto* b = std::get_if<Bushing>(&elastic.kind)) {
            stiffness_of(*b).K = T.asDiagonal() * stiffness_of(*b).K * E.asDiagonal();
            b->preload = T.asDiagonal() * b->preload;
        } else {
            auto& spring = std::get<AxialSpring>(elastic.kind);
            rate_of(spring).k /= c;
            spring.free_length *= c;
        }
    }
    for (auto& joint : s.joints)
        if (auto* bar = std::get_if<Distance>(&joint.kind))
            bar->length *= c;
        else if (auto* plane = std::get_if<InPlane>(&joint.kind))
            plane->offset *= c;
    for (auto& branch : s.branches) {
        const bool length = branch.unit == ParameterUnit::metre;
        if (length) branch.to *= c;
        for (auto& driver : branch.drivers) {
            if (length) driver.rate /= c;
            double of_length = 1;  // factor of the driven quantity
            if (const auto* motion = std::get_if<Motion>(&driver.what))
                of_length = std::holds_alternative<Angle>(
                                s.joints[static_cast<std::size_t>(motion->joint)].kind)
                                ? 1
                                : c;
            if (std::holds_alternative<FreeLength>(driver.what)) of_length = c;
            if (auto* preload = std::get_if<Preload>(&driver.what))
                preload->direction = T.asDiagonal() * preload->direction;
            driver.start *= of_length;
            driver.rate *= of_length;
        }
    }
    return s;
}

// ---- Built in code

// A general axle corner: eight kinds of joints, bushings with full 6×6 rates and preload, preloaded
// springs, a static load, a load of force and moment together, body axes different from ground
// axes.
inline Scene rich_scene() {
    std::mt19937 random(7);
    Scene s;
    s.name = "rich";
    enum : BodyId { subframe, arm, knuckle, upper, slider, link, plate };
    const std::vector<Vector3d> origins = {{0, .3, 0},   {0, .7, -.1}, {0, .8, .1}, {0, .6, .3},
                                           {.2, .5, .1}, {-.2, .6, 0}, {.1, .9, .1}};
    const char* names[] = {"subframe", "arm", "knuckle", "upper", "slider", "link", "plate"};
    for (std::size_t b = 0; b < origins.size(); ++b)
        s.bodies.push_back({names[b], {origins[b], random_turn(random)}});
    const auto point = [&](BodyId body, const Vector3d& p) {
        if (body == ground) return Point{body, p};
        const auto& pose = s.bodies[static_cast<std::size_t>(body)].design;
        return Point{body, pose.p.conjugate() * (p - pose.r)};
    };
    const auto along = [&](BodyId body, const Vector3d& u) {
        if (body == ground) return Direction{body, u.normalized()};
        return Direction{
            body, s.bodies[static_cast<std::size_t>(body)].design.p.conjugate() * u.normalized()};
    };
    const auto marker = [&](BodyId body, const Vector3d& p, const Quaterniond& axes) {
        const auto at = point(body, p);
        return Marker{body, at.s_local,
                      body == ground
                          ? axes
                          : s.bodies[static_cast<std::size_t>(body)].design.p.conjugate() * axes};
    };
    const auto bushing = [&](const char* name, BodyId i, BodyId j, const Vector3d& at,
                             double preload) {
        const Quaterniond axes = random_turn(random);
        Vector6 pre;
        pre << random_vector(random, 1), random_vector(random, 0.02);
        s.elastics.push_back(
            {name, Bushing{marker(i, at, axes), marker(j, at, axes),
                           LinearStiffness{random_stiffness(random)}, preload * pre}});
    };
    const Vector3d lower_ball(.02, .75, -.12), upper_ball(-.01, .68, .3), tie_out(-.12, .72, 0),
        tie_in(-.15, .35, .02);
    for (const Vector3d& at : {Vector3d(.3, .3, .05), Vector3d(-.3, .3, .05), Vector3d(.3, .2, -.1),
                               Vector3d(-.3, .2, -.1)})
        bushing("mount", ground, subframe, at, 200);
    bushing("front", arm, subframe, {.2, .35, -.1}, 100);
    bushing("rear", subframe, arm, {-.2, .35, -.1}, 0);
    const Vector3d axis(1, .05, .02);
    s.joints = {
        {"lower ball", Spherical{point(arm, lower_ball), point(knuckle, lower_ball)}},
        {"upper ball", Spherical{point(knuckle, upper_ball), point(upper, upper_ball)}},
        {"upper pivot", Revolute{point(ground, {0, .4, .32}), point(upper, {0, .4, .32}),
                                 along(ground, axis), along(upper, axis)}},
        {"tie rod",
         Distance{point(knuckle, tie_out), point(ground, tie_in), (tie_out - tie_in).norm()}},
        {"damper", Translational{point(slider, {.2, .5, .1}), point(subframe, {.2, .5, .1}),
                                 along(slider, {.1, .2, 1}), along(subframe, {.1, .2, 1})}},
        {"cross", Universal{point(link, {-.2, .5, 0}), point(subframe, {-.2, .5, 0}),
                            along(link, {1, 0, 0}), along(subframe, {0, 0, 1})}},
        {"weld",
         Fixed{point(plate, {.1, .9, .1}), point(knuckle, {.1, .9, .1}), along(plate, {1, 0, 0}),
               along(plate, {0, 1, 0}), along(knuckle, {1, 0, 0}), along(knuckle, {0, 1, 0})}},
        {"tube",
         InLine{point(link, {-.2, .7, 0}), point(arm, {-.2, .7, 0}), along(arm, {1, .1, 0})}},
    };
    bushing("spin", link, arm, {-.2, .7, 0}, 0);
    s.elastics.push_back(
        {"coil", AxialSpring{point(arm, {.05, .6, -.1}), point(ground, {.05, .5, .35}),
                             LinearRate{30e3}, .49}});
    s.elastics.push_back(
        {"damper spring", AxialSpring{point(slider, {.25, .5, .15}), point(arm, {.2, .6, -.1}),
                                      LinearRate{20e3}, .27}});
    s.static_loads = {{"weight", DeadForce{point(knuckle, {0, .85, .1}), {0, 0, 400}}}};
    s.branches = {
        branch_of("mixed",
                  {driven_by({"push", DeadForce{point(plate, {.1, 1.0, 0}), {.1, .2, 1}}}),
                   driven_by({"twist", DeadMoment{knuckle, {.02, .05, .03}}})},
                  1500, 30)};
    s.wheels = {Wheel{"", plate, point(plate, {0, .95, .1}).s_local,
                      point(plate, {0, .95, -.2}).s_local, along(plate, {0, 1, 0}).u_local, 1}};
    return s;
}

// A bar from the origin along `u`, hinged at the origin about `axis`, with a rotational bushing
// there. Its probe is its tip.
inline Scene hinged_bar(const Vector3d& u, const Vector3d& axis, double k_R) {
    Scene s;
    s.name = "hinged bar";
    s.bodies = {{"bar", {}}};
    s.joints = {
        {"hinge", Revolute{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, {0, axis}, {ground, axis}}}};
    Bushing torsion;
    torsion.i.body = 0;
    stiffness_of(torsion).K.bottomRightCorner<3, 3>() = k_R * Matrix3d::Identity();
    s.elastics = {{"torsion", torsion}};
    s.probes = {{"tip", {0, u}}};
    return s;
}

inline Branch pull(const Point& at, const Vector3d& f) {
    return branch_of("pull", {driven_by({"pull", DeadForce{at, f}})}, 1, 1);
}
inline Branch twist(BodyId body, const Vector3d& m) {
    return branch_of("twist", {driven_by({"twist", DeadMoment{body, m}})}, 1, 1);
}

// ---- The energies of mechanism.hpp, implemented independently

inline double energy(const AxialSpring& spring, const Pose& i, const Pose& j) {
    const double length = (j.r + j.p * spring.j.s_local - i.r - i.p * spring.i.s_local).norm();
    return 0.5 * std::get<LinearRate>(spring.law).k * std::pow(length - spring.free_length, 2);
}

inline double energy(const Bushing& b, const Pose& i, const Pose& j) {
    const Matrix3d A_i = (i.p * b.i.A_local).toRotationMatrix(),
                   A_j = (j.p * b.j.A_local).toRotationMatrix();
    Eigen::AngleAxisd turn(Quaterniond((i.p * b.i.A_local).conjugate() * (j.p * b.j.A_local)));
    Vector6 e;
    e << A_i.transpose() * (j.r + j.p * b.j.s_local - i.r - i.p * b.i.s_local),
        turn.angle() * turn.axis();
    EXPECT_TRUE((A_i * turn.toRotationMatrix()).isApprox(A_j, 1e-9));
    return 0.5 * e.dot(std::get<LinearStiffness>(b.law).K * e) + b.preload.dot(e);
}

// Keeps the worst of many comparisons and its place, to be judged and printed once.
struct Worst {
    double value = 0;
    std::string where = "nowhere";
    int compared = 0;
    void see(double deviation, const std::string& at) {
        ++compared;
        if (!(std::isfinite(deviation) && deviation <= value)) value = deviation, where = at;
        if (!std::isfinite(deviation)) value = std::numeric_limits<double>::infinity();
    }
};
inline ::testing::AssertionResult within(const Worst& worst, double limit) {
    const bool ok = worst.compared > 0 && std::isfinite(worst.value) && worst.value <= limit;
    return (ok ? ::testing::AssertionSuccess() : ::testing::AssertionFailure())
           << "worst " << worst.value << " of " << worst.compared << " at " << worst.where
           << ", allowed " << limit;
}

}  // namespace elastocheck::reference::equilibrium::test
