// Scenes nobody designed: one to five bodies on random joints, bushings and springs, some of them preloaded or
// under a static load, pushed until many turn, tip over or come to the end of their branch. What is said of
// them has to be right, or no more than that it could not be said.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "models/compile.hpp"
#include "recursive/solve.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"
#include "tests/recursive/random.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Everything is attached where it fits as drawn, told in ground axes.
struct Builder {
    Scene scene;
    Random random;

    Pose pose(BodyId b) const {
        return b == ground ? Pose{} : scene.bodies[static_cast<std::size_t>(b)].design;
    }
    Point point(BodyId b, const Vector3d& p) const { return {b, pose(b).p.conjugate() * (p - pose(b).r)}; }
    Direction direction(BodyId b, const Vector3d& u) const { return {b, pose(b).p.conjugate() * u}; }
    Marker marker(BodyId b, const Vector3d& p, const Quaterniond& A) const {
        return {b, point(b, p).s_local, pose(b).p.conjugate() * A};
    }
    bool chance(double share) { return random(0, 1) < share; }
    double decades(double low, double high) { return std::pow(10, random(low, high)); }
    // Of ground and the bodies before b.
    BodyId earlier(BodyId b) { return static_cast<BodyId>(std::floor(random(-1, b))); }
};

JointKind random_joint(Builder& at, int kind, BodyId i, BodyId j) {
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

Scene random_scene(int number) {
    Builder at;
    at.random.engine.seed(static_cast<unsigned>(number));
    const int nb = 1 + number % 5;
    for (int b = 0; b < nb; ++b) at.scene.bodies.push_back({fmt::format("body{}", b), at.random.pose()});
    for (auto& body : at.scene.bodies) body.design.r *= 0.4;
    for (BodyId b = 0; b < nb; ++b) {
        for (int k = at.chance(0.6) + at.chance(0.3); k > 0; --k)
            at.scene.joints.push_back(
                {fmt::format("joint{}", at.scene.joints.size()),
                 random_joint(at, static_cast<int>(at.random(0, 12)), b, at.earlier(b))});
        for (int k = 1 + at.chance(0.5); k > 0; --k) {
            const Vector3d p = at.random.vector(0.4);
            const Quaterniond A = at.random.rotation();
            Bushing bushing{
                at.marker(b, p, A), at.marker(at.earlier(b), p, A), {}, elastocheck::Vector6::Zero()};
            LinearStiffness law;
            const double rate = at.decades(4, 6.5), rotational = at.chance(0.2) ? 0 : at.decades(1, 3.5);
            for (int a = 0; a < 6; ++a) law.K(a, a) = (a < 3 ? rate : rotational) * at.decades(-0.7, 0.7);
            bushing.law = law;
            if (at.chance(0.3)) bushing.preload.head<3>() = at.random.vector(500);
            at.scene.elastics.push_back({fmt::format("bushing{}", at.scene.elastics.size()), bushing});
        }
        if (at.chance(0.5)) {
            const Vector3d p = at.random.vector(0.4), other = at.random.vector(0.4);
            at.scene.elastics.push_back(
                {fmt::format("spring{}", at.scene.elastics.size()),
                 AxialSpring{at.point(b, p), at.point(at.earlier(b), other), LinearRate{at.decades(3, 5)},
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

// How far two states of a model are apart, as a share of the tolerances for origins and for orientations.
// Bodies that an idle mode moves are anywhere along it.
double apart(const Diagnosis& diagnosis, const Equilibrium& a, const Equilibrium& b, double length,
             double angle) {
    double worst = 0;
    for (std::size_t body = 0; body < a.poses.size(); ++body) {
        double moves = 0;
        for (const auto& mode : diagnosis.idle)
            moves += mode.dq.segment<6>(6 * static_cast<Eigen::Index>(body)).norm();
        if (moves > 1e-6) continue;
        worst = std::max({worst, (a.poses[body].r - b.poses[body].r).norm() / length,
                          a.poses[body].p.angularDistance(b.poses[body].p) / angle});
    }
    return worst;
}

TEST(RandomScenes, AreRightOrSaidToBeUnsolved) {
    constexpr int scenes = 200;  // of a thousand 846 are judged, adaptive declines 1 and series 2 of them
    int judged = 0;
    std::map<std::string, int> declined;
    std::set<int> unsolved;  // by either
    std::string which;
    for (int number = 0; number < scenes; ++number) {
        const Model model = compile(random_scene(number));
        const Branch& branch = model.branches[0];
        const Analysis analysis = analyse(model);
        std::map<std::string_view, EquilibriumPath> paths;
        for (const auto& method : methods) {
            const auto& path = paths[method.name] = solve(model, branch, {.method = method}, analysis);
            EXPECT_EQ(path.outcome == Outcome::converged, path.detail.empty())
                << number << " " << method.name;
            EXPECT_TRUE(path.outcome != Outcome::converged || path.points.size() == 21u)
                << number << " " << method.name;
            for (const auto& point : path.points)
                for (const auto& pose : point.poses)
                    ASSERT_TRUE(pose.r.allFinite() && pose.p.coeffs().allFinite())
                        << number << " " << method.name;
        }
        std::vector<double> loads;
        for (const auto& k : {0, 5, 10, 15, 20}) loads.push_back(branch.to * k / 20);
        const auto equilibrium = reference::equilibrium::solve(model, branch, loads);
        const auto energy = equilibrium.outcome == Outcome::converged
                                ? reference::energy::solve(model, branch, loads)
                                : EquilibriumPath{Outcome::branch_lost, {}, {}, {}};
        double references = 0;
        for (std::size_t k = 0; k < std::min(energy.points.size(), equilibrium.points.size()); ++k)
            references = std::max(
                references, apart(analysis.diagnosis, energy.points[k], equilibrium.points[k], 1e-7, 1e-7));
        if (energy.outcome != Outcome::converged || !(references <= 1)) continue;
        ++judged;
        for (const auto& [name, length, angle] :
             {std::tuple{"adaptive", Adaptive{}.length_tolerance, Adaptive{}.angle_tolerance},
              std::tuple{"series", 1e-7, 1e-7}}) {
            const auto& path = paths[name];
            if (path.outcome != Outcome::converged) {
                ++declined[name];
                unsolved.insert(number);
                which += fmt::format("\n{} {}: {}", number, name, path.detail);
                continue;
            }
            for (std::size_t k = 0; k < loads.size(); ++k)
                EXPECT_LE(apart(analysis.diagnosis, path.points[5 * k], equilibrium.points[k], length, angle),
                          1)
                    << number << " " << name << " at " << loads[k];
        }
    }
    // The equilibrium leg has a second way to settle, to states that no path from the drawing leads to.
    EXPECT_LE(static_cast<int>(unsolved.size()), judged / 100) << which;
    RecordProperty("judged", judged);
    RecordProperty("adaptive declined", declined["adaptive"]);
    RecordProperty("series declined", declined["series"]);
    EXPECT_GE(judged, scenes * 6 / 10);
}

}  // namespace
}  // namespace elastocheck::recursive
