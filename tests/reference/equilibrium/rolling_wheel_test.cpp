// A wheel that rolls, on a carrier with one degree of freedom: the contact patch
//
//   p = c - R (n - (n·e) e) / |n - (n·e) e|
//
// is a function of the angle θ of a hinge u through the origin, and a force F there is in balance
// with the moment of the hinge where M(θ) = F · dp/dθ.
#include <fmt/format.h>

#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "reference/equilibrium/linear_response.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

constexpr double R = 0.32, k = 4050, P = 3500, k_t = 200e3;

struct Hinge {
    std::string name;
    Vector3d u, c, e;  // axis; centre and spin axis as drawn

    struct Patch {
        Vector3d p, slope;  // dp/dθ
    };
    Patch patch(double theta) const {
        const Eigen::AngleAxisd turn(theta, u);
        const Vector3d at = turn * c, spin = turn * e, v = u.cross(spin), w = Z - spin.z() * spin,
                       m = w.normalized(), dw = -v.z() * spin - spin.z() * v;
        return {at - R * m, u.cross(at) - R * (dw - m * m.dot(dw)) / w.norm()};
    }
    double preload() const { return P * patch(0).slope.z(); }  // as drawn in balance with P upwards
    double moment(double theta) const { return preload() + k * theta; }
    Scene scene() const {
        const auto xyz = [](const Vector3d& v) {
            return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
        };
        return parse_scene(
            fmt::format(
                "elastocheck: 1\nname: {}\nunits: {{length: m, angle: rad, force: N}}\n"
                "points: {{o: [0, 0, 0], c: {}, p: {}}}\nbodies: {{arm: {{origin: c}}}}\n"
                "joints: {{hinge: {{type: revolute, bodies: [arm, ground], at: o, axis: {}}}}}\n"
                "torsion_springs: {{bar: {{bodies: [arm, ground], at: o, axis: {}, rate: {}, "
                "preload_moment: {:.17g}}}}}\n"
                "tyres: {{t: {{rate: {}, preload: {}}}}}\n"
                "loads: {{up: {{on: arm, at: p, force: [0, 0, 1]}}, brake: {{on: arm, at: p, "
                "force: "
                "[-1, 0, 0]}}, side: {{on: arm, at: p, force: [0, 1, 0]}}}}\n"
                "branches:\n"
                "  road: {{drive: tyres.t.road, from: -0.4, to: 0.1, steps: 12}}\n"
                "  jack: {{drive: patch_travel, from: -0.1, to: 0.1, steps: 8}}\n"
                "  up: {{load: up, to: 5000, steps: 8}}\n"
                "  brake: {{load: brake, to: 3000, steps: 4}}\n"
                "  side: {{load: side, from: -2000, to: 2000, steps: 4}}\n"
                "wheel: {{body: arm, centre: c, contact_patch: p, spin_axis: {}, side: left, "
                "contact: rolling}}\n",
                name, xyz(c), xyz(patch(0).p), xyz(u), xyz(u), k, -preload(), k_t, P, xyz(e)),
            "hinge.yaml");
    }
};

double root(const std::function<double(double)>& f) {
    double low = -0.9, high = 0.9;
    EXPECT_LT(f(low), 0);
    EXPECT_GT(f(high), 0);
    for (int n = 0; n < 100; ++n) {
        const double middle = (low + high) / 2;
        (f(middle) < 0 ? low : high) = middle;
    }
    return low;
}

// The force of the road at height h, zero once the wheel has left it.
double road_force(const Hinge& hinge, double h, double theta) {
    return std::max(0., P - k_t * (hinge.patch(theta).p.z() - hinge.patch(0).p.z() - h));
}

double angle_at(const Hinge& hinge, const std::string& branch, double a) {
    return root([&](double theta) {
        const auto [p, slope] = hinge.patch(theta);
        if (branch == "jack") return p.z() - hinge.patch(0).p.z() - a;
        const double driven = branch == "road"   ? road_force(hinge, a, theta) * slope.z()
                              : branch == "up"   ? a * slope.z()
                              : branch == "side" ? a * slope.y()
                                                 : hinge.u.dot(p.cross(-a * X));  // the brake
        return hinge.moment(theta) - driven;
    });
}

const std::vector<Hinge> hinges = {
    {"trailing arm", Y, {-0.45, 0.15, 0}, Y},
    {"semi-trailing arm",
     Vector3d(0.4, 0.9, 0.1).normalized(),
     {-0.4, 0.2, -0.02},
     Vector3d(0.03, 1, -0.04).normalized()},
    {"swing axle", X, {0, 0.6, -0.05}, Vector3d(0, 1, -0.1).normalized()}};

TEST(EquilibriumRollingWheel, OnAHingeIsWhereTheClosedFormPutsIt) {
    Worst poses, forces;
    for (const Hinge& hinge : hinges) {
        const Model model = compile(hinge.scene());
        for (const Branch& branch : model.branches)
            for (const Branch& side : ways(branch)) {
                const auto points = every_point(side, 8);
                const Model active = on_branch(model, side);
                const EquilibriumPath path = solve(active, side, points);
                ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
                for (const Equilibrium& state : path.points) {
                    const std::string where =
                        fmt::format("{} {} {}", hinge.name, branch.name, state.load);
                    const double theta = angle_at(hinge, branch.name, state.load);
                    const Eigen::AngleAxisd turn(theta, hinge.u);
                    poses.see((state.poses[0].r - turn * hinge.c).norm(), where);
                    poses.see(state.poses[0].p.angularDistance(Quaterniond(turn)), where);
                    poses.see(
                        (position(state, active.wheels[0].contact) - hinge.patch(theta).p).norm(),
                        where);
                    const Residuals left = residuals(active, side, state);
                    forces.see(left.force + left.moment, where + " residual");
                    if (branch.name != "jack") continue;
                    forces.see(std::abs(state.reactions.back().force.z() -
                                        hinge.moment(theta) / hinge.patch(theta).slope.z()),
                               where);
                }
            }
    }
    EXPECT_TRUE(within(poses, 1e-12));  // m, rad
    EXPECT_TRUE(within(forces, 1e-7));  // N, N·m
}

// Along a force or a jack at the patch the response is the slope of the closed form.
TEST(EquilibriumRollingWheel, RespondsToSmallForcesAtItsPatchAsTheClosedFormDoes) {
    Worst worst;
    for (const Hinge& hinge : hinges) {
        const Model model = compile(hinge.scene());
        for (const Branch& branch : model.branches) {
            const double size = branch.name == "jack" ? 0.05 : 1500;
            if (branch.name == "road" || branch.name == "brake") continue;
            const Branch side = ways(branch).front();
            const Model active = on_branch(model, side);
            const std::vector<double> a = {size};
            const Equilibrium state = solve(active, side, a).points.at(0);
            const Disturbance along =
                branch.name == "jack"
                    ? Disturbance{Motion{static_cast<int>(active.joints.size()) - 1}}
                    : UnitWrench{active.wheels[0].contact, branch.name == "up" ? Z : Y};
            const Response response = linear_response(active, side, state, {&along, 1});
            ASSERT_EQ(response.outcome, Outcome::converged) << response.detail;
            const auto angle = [&](double by) { return angle_at(hinge, branch.name, size + by); };
            const double h = 1e-3 * size,
                         slope = (8 * (angle(h) - angle(-h)) - (angle(2 * h) - angle(-2 * h))) /
                                 (12 * h);
            worst.see(
                (response.increments.at(0).at(0).dpi - slope * hinge.u).norm() /
                    std::max(std::abs(slope), 1e-5),  // zero for a side force on the trailing arm

                hinge.name + " " + branch.name);
        }
    }
    EXPECT_TRUE(within(worst, 1e-9));
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
