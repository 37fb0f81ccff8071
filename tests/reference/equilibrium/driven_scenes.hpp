// Driven mechanisms with their closed-form kinematics.
#pragma once

#include <utility>

#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {

inline const Direction ground_x{ground, {1, 0, 0}}, ground_y{ground, {0, 1, 0}},
    ground_z{ground, {0, 0, 1}};

// In the x-y plane: a crank r about z at the origin, along +x in the design position, a rod l, a
// slider on the line y = e. 12 coordinates, 12 constraints.
inline Scene slider_crank(double r, double l, double e, double to) {
    Scene s;
    s.name = "slider-crank";
    const Vector3d slider(r + std::sqrt(l * l - e * e), e, 0);
    s.bodies = {{"crank", {}}, {"slider", {slider, Quaterniond::Identity()}}};
    s.joints = {
        {"crank pin", Revolute{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, {0, {0, 0, 1}}, ground_z}},
        {"guide", Translational{{1, {0, 0, 0}}, {ground, slider}, {1, {1, 0, 0}}, ground_x}},
        {"rod", Distance{{0, {r, 0, 0}}, {1, {0, 0, 0}}, l}},
        {"drive", Angle{{0, {1, 0, 0}}, ground_x, ground_y, 0}, true},
    };
    s.branches = {branch_of("turn", {{Motion{3}, 0, 1}}, to, 36, ParameterUnit::radian)};
    s.probes = {{"pin", {0, {r, 0, 0}}}, {"slider", {1, {0, 0, 0}}}};
    return s;
}

// Point at distance b from p and c from q in the x-y plane, to the left of the line from p to q.
inline Vector3d circles_meet(const Vector3d& p, double b, const Vector3d& q, double c) {
    const Vector3d way = q - p;
    const double d = way.norm(), along = (d * d + b * b - c * c) / (2 * d),
                 across = std::sqrt(b * b - along * along);
    return p + along * way / d + across * Vector3d(-way[1], way[0], 0) / d;
}

// In the x-y plane: crank a at the origin, along +x in the design position, coupler b, rocker c
// about (d, 0). 18 coordinates, 18 constraints.
inline Scene four_bar(double a, double b, double c, double d) {
    Scene s;
    s.name = "four-bar";
    const Vector3d pin(a, 0, 0), pivot(d, 0, 0), tip = circles_meet(pin, b, pivot, c);
    const auto along = [](const Vector3d& u) {
        return Quaterniond(Eigen::AngleAxisd(std::atan2(u[1], u[0]), Vector3d::UnitZ()));
    };
    s.bodies = {{"crank", {}},
                {"coupler", {pin, along(tip - pin)}},
                {"rocker", {pivot, along(tip - pivot)}}};
    const auto z = [](BodyId body) { return Direction{body, {0, 0, 1}}; };
    s.joints = {
        {"crank pivot", Revolute{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, z(0), ground_z}},
        {"crank pin", Revolute{{1, {0, 0, 0}}, {0, {a, 0, 0}}, z(1), z(0)}},
        {"rocker pivot", Revolute{{2, {0, 0, 0}}, {ground, pivot}, z(2), ground_z}},
        {"rocker pin", InLine{{1, {b, 0, 0}}, {2, {c, 0, 0}}, z(2)}},
        {"drive", Angle{{0, {1, 0, 0}}, ground_x, ground_y, 0}, true},
    };
    s.branches = {branch_of("turn", {{Motion{4}, 0, 1}}, 2 * M_PI, 36, ParameterUnit::radian)};
    s.probes = {{"rocker", {2, {c, 0, 0}}}, {"coupler", {1, {b, 0, 0}}}};
    return s;
}

inline Vector3d position_in(const Scene& s, const Wheel& wheel) {
    const auto& pose = s.bodies[static_cast<std::size_t>(wheel.body)].design;
    return pose.r + pose.p * wheel.centre_local;
}

// A jack under the wheel centre as the last joint, active only where driven.
inline Scene with_jack(Scene s) {
    const Wheel& wheel = s.wheels[0];
    s.joints.push_back(
        {"jack",
         InPlane{{wheel.body, wheel.centre_local}, {ground, position_in(s, wheel)}, ground_z},
         true});
    return s;
}

// The McPherson strut whose tie rod ends on a rack, the fourth body, which slides along y and is
// held by the last joint, 'rack'.
inline Scene with_rack(Scene s) {
    auto& tie = std::get<Distance>(s.joints[2].kind);
    const Vector3d inner = tie.j.s_local;
    const BodyId rack = static_cast<BodyId>(s.bodies.size());
    s.bodies.push_back({"rack", {inner, Quaterniond::Identity()}});
    tie.j = {rack, {0, 0, 0}};
    s.joints.push_back(
        {"rack guide",
         Translational{{rack, {0, 0, 0}}, {ground, inner}, {rack, {0, 1, 0}}, ground_y}});
    s.joints.push_back({"rack", InPlane{{rack, {0, 0, 0}}, {ground, inner}, ground_y}});
    return s;
}

// e = (d, θ) of a bushing between ground and a body, or two bodies, in a state.
inline Vector6 deformation(const Bushing& b, const Equilibrium& state) {
    const auto pose = [&](BodyId body) {
        return body == ground ? Pose{} : state.poses[static_cast<std::size_t>(body)];
    };
    const Pose i = pose(b.i.body), j = pose(b.j.body);
    const Eigen::AngleAxisd turn(
        Quaterniond((i.p * b.i.A_local).conjugate() * (j.p * b.j.A_local)));
    Vector6 e;
    e << (i.p * b.i.A_local).conjugate() * (j.r + j.p * b.j.s_local - i.r - i.p * b.i.s_local),
        turn.angle() * turn.axis();
    return e;
}

inline double stored_energy(const Model& model, const Equilibrium& state) {
    const auto pose = [&](BodyId body) {
        return body == ground ? Pose{} : state.poses[static_cast<std::size_t>(body)];
    };
    double U = 0;
    for (const auto& elastic : model.elastics)
        U += std::visit([&](const auto& e) { return energy(e, pose(e.i.body), pose(e.j.body)); },
                        elastic.kind);
    return U;
}

// Nodes in (0, 1), ascending, and weights: the roots of the Legendre polynomial P_n by Newton's
// method.
inline std::vector<std::pair<double, double>> gauss_legendre(int n) {
    std::vector<std::pair<double, double>> rule;
    for (int k = n; k >= 1; --k) {
        double x = std::cos(M_PI * (k - 0.25) / (n + 0.5)), slope = 0;
        for (int iteration = 0; iteration < 10; ++iteration) {
            double p_0 = 1, p_1 = x;
            for (int m = 2; m <= n; ++m)
                p_0 = std::exchange(p_1, ((2 * m - 1) * x * p_1 - (m - 1) * p_0) / m);
            slope = n * (x * p_1 - p_0) / (x * x - 1);
            x -= p_1 / slope;
        }
        rule.emplace_back((1 + x) / 2, 1 / ((1 - x * x) * slope * slope));
    }
    return rule;
}

}  // namespace elastocheck::reference::equilibrium::test
