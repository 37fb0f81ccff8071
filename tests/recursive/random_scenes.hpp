// Generator of random scenes: one to five bodies on random joints, bushings and springs.
// Some are preloaded or under a static load. Loads make many of them rotate far, turn over or reach
// the end of their branch.
#pragma once

#include <fmt/format.h>

#include "elastocheck/scene.hpp"
#include "tests/recursive/random.hpp"

namespace elastocheck::recursive {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// All attachments fit as drawn, in ground axes.
struct Builder {
    Scene scene;
    Random random;

    Pose pose(BodyId b) const {
        return b == ground ? Pose{} : scene.bodies[static_cast<std::size_t>(b)].design;
    }
    Point point(BodyId b, const Vector3d& p) const {
        return {b, pose(b).p.conjugate() * (p - pose(b).r)};
    }
    Direction direction(BodyId b, const Vector3d& u) const {
        return {b, pose(b).p.conjugate() * u};
    }
    Marker marker(BodyId b, const Vector3d& p, const Quaterniond& A) const {
        return {b, point(b, p).s_local, pose(b).p.conjugate() * A};
    }
    bool chance(double share) { return random(0, 1) < share; }
    double decades(double low, double high) { return std::pow(10, random(low, high)); }
    // Ground or a body before b.
    BodyId earlier(BodyId b) { return static_cast<BodyId>(std::floor(random(-1, b))); }
};

inline JointKind random_joint(Builder& at, int kind, BodyId i, BodyId j) {
    const Vector3d p = at.random.vector(0.4), other = at.random.vector(0.4), u = at.random.unit(),
                   v = u.unitOrthogonal();
    const Point p_i = at.point(i, p), p_j = at.point(j, p);
    const Direction u_i = at.direction(i, u), u_j = at.direction(j, u), v_i = at.direction(i, v),
                    v_j = at.direction(j, v);
    switch (kind) {
        case 0: return Spherical{p_i, p_j};
        case 1: return Revolute{p_i, p_j, u_i, u_j};
        case 2: return Universal{p_i, p_j, u_i, v_j};
        case 3: return Cylindrical{p_i, p_j, u_i, u_j};
        case 4: return Translational{p_i, p_j, u_i, u_j};
        case 5: return Planar{p_i, p_j, u_i, u_j};
        case 6: return Fixed{p_i, p_j, u_i, v_i, u_j, v_j};
        case 7: return Distance{p_i, at.point(j, other), (p - other).norm()};
        case 8: return InPlane{p_i, p_j, u_j};
        case 9: return InLine{p_i, p_j, u_j};
        case 10: return Perpendicular{u_i, v_j};
        default: return Parallel{u_i, u_j};
    }
}

inline Scene random_scene(int number) {
    Builder at;
    at.random.engine.seed(static_cast<unsigned>(number));
    const int nb = 1 + number % 5;
    for (int b = 0; b < nb; ++b)
        at.scene.bodies.push_back({fmt::format("body{}", b), at.random.pose()});
    for (auto& body : at.scene.bodies) body.design.r *= 0.4;
    for (BodyId b = 0; b < nb; ++b) {
        for (int k = at.chance(0.6) + at.chance(0.3); k > 0; --k)
            at.scene.joints.push_back(
                {fmt::format("joint{}", at.scene.joints.size()),
                 random_joint(at, static_cast<int>(at.random(0, 12)), b, at.earlier(b))});
        for (int k = 1 + at.chance(0.5); k > 0; --k) {
            const Vector3d p = at.random.vector(0.4);
            const Quaterniond A = at.random.rotation();
            Bushing bushing{at.marker(b, p, A),
                            at.marker(at.earlier(b), p, A),
                            {},
                            elastocheck::Vector6::Zero()};
            LinearStiffness law;
            const double rate = at.decades(4, 6.5),
                         rotational = at.chance(0.2) ? 0 : at.decades(1, 3.5);
            for (int a = 0; a < 6; ++a)
                law.K(a, a) = (a < 3 ? rate : rotational) * at.decades(-0.7, 0.7);
            bushing.law = law;
            if (at.chance(0.3)) bushing.preload.head<3>() = at.random.vector(500);
            at.scene.elastics.push_back(
                {fmt::format("bushing{}", at.scene.elastics.size()), bushing});
        }
        if (at.chance(0.5)) {
            const Vector3d p = at.random.vector(0.4), other = at.random.vector(0.4);
            at.scene.elastics.push_back(
                {fmt::format("spring{}", at.scene.elastics.size()),
                 AxialSpring{at.point(b, p), at.point(at.earlier(b), other),
                             LinearRate{at.decades(3, 5)},
                             (p - other).norm() * (at.chance(0.4) ? at.random(0.8, 1.2) : 1)}});
        }
    }
    if (at.chance(0.3))
        at.scene.static_loads.push_back(
            {"weight", DeadForce{{0, at.random.vector(0.3)}, {0, 0, -at.decades(1, 2.7)}}});
    Branch branch{"push", 0, at.decades(1.5, 3.7), 20, ParameterUnit::newton, {}};
    branch.drivers.push_back(
        {Load{"force", DeadForce{{nb - 1, at.random.vector(0.3)}, at.random.unit()}}, 0, 1});
    if (at.chance(0.3))
        branch.drivers.push_back({Load{"moment", DeadMoment{0, at.random.vector(0.2)}}, 0, 1});
    at.scene.branches = {branch};
    at.scene.probes = {{"first", {0, Vector3d::Zero()}}, {"last", {nb - 1, Vector3d::Zero()}}};
    return at.scene;
}

}  // namespace elastocheck::recursive
