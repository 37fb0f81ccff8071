// The contact of a rolling wheel against closed forms of mechanisms with one coordinate α.
//
// A torsion spring of rate k resists α with the moment M_0 + k α. The wheel's centre c and spin axis
// e are functions of α, ω is the rotation of its carrier per α. With n up, m = (n - (n·e) e) / |...|
// and h = e × m, the patch keeps its drawn place s in the axes (m, e, h):
//
//   p = c + s_m m + s_e e + s_h h        lowest point of a disc: s_m = -R, s_e = s_h = 0
//
// Forces F on a rolling wheel have the potential -F·p, so that they balance M_0 + k α = F · dp/dα.
// A braked wheel is held to its carrier: F · dc/dα + ω · ((p - c) × F) instead. A jack of height
// z_p carries (M_0 + k α - other forces) / (dz_p/dα); a tyre pushes with max(0, P + k_t (h - z_p)).
#include <fmt/format.h>

#include <functional>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/legs/legs.hpp"

namespace elastocheck::legs {
namespace {

struct Place {
    Vector3d c, e, dc, de, omega;
};

struct Corner {
    std::string name, parts;  // its bodies, joints and hardpoints
    Vector3d centre, patch, axis;
    std::function<Place(double)> at;

    struct Patch {
        Vector3d p, dp;
    };
    static Patch carried(const Place& w, const Vector3d& s) {
        const double u = w.e.z(), du = w.de.z(), square = 1 - u * u;
        const Vector3d m = (Z - u * w.e) / std::sqrt(square),
                       dm = (-du * w.e - u * w.de) / std::sqrt(square) + u * du / square * m;
        const Vector3d h = w.e.cross(m), dh = w.de.cross(m) + w.e.cross(dm);
        return {w.c + s[0] * m + s[1] * w.e + s[2] * h, w.dc + s[0] * dm + s[1] * w.de + s[2] * dh};
    }
    Patch patch_at(double alpha) const {
        const Place drawn = at(0);
        const Vector3d m = (Z - drawn.e.z() * drawn.e).normalized(), arm = patch - centre;
        return carried(at(alpha), {arm.dot(m), arm.dot(drawn.e), arm.dot(drawn.e.cross(m))});
    }
    double free(double alpha, const Vector3d& F) const { return F.dot(patch_at(alpha).dp); }
    double braked(double alpha, const Vector3d& F) const {
        const Place w = at(alpha);
        return F.dot(w.dc) + w.omega.dot((patch_at(alpha).p - w.c).cross(F));
    }
    double height(double alpha) const { return patch_at(alpha).p.z() - patch.z(); }
};

constexpr double rate = 4500, weight = 3500, tyre_rate = 200e3;  // [N·m/rad] [N] [N/m]

std::string list(const Vector3d& v) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}
Quaterniond turned(double angle, const Vector3d& axis) {
    return Quaterniond(Eigen::AngleAxisd(angle, axis));
}

// An arm on a revolute joint: a trailing arm with its axis across, a semi-trailing arm with an
// oblique one, drawn with toe and camber.
Corner arm(const std::string& name, const Vector3d& pivot, const Vector3d& along,
           const Vector3d& spin) {
    const Vector3d a = along.normalized(), e = spin.normalized(), c(0, 0.75, 0);
    return {name,
            fmt::format(
                R"(points: {{pivot: {}, w: {}, p: [0, 0.75, -0.32]}}
bodies: {{arm: {{origin: w}}}}
joints: {{pivot: {{type: revolute, bodies: [arm, ground], at: pivot, axis: {}}}}}
wheel: {{body: arm, centre: w, contact_patch: p, spin_axis: {}, side: left, contact: rolling}}
)",
                list(pivot), list(c), list(a), list(e)),
            c,
            {0, 0.75, -0.32},
            a,
            [=](double alpha) {
                const Quaterniond by = turned(alpha, a);
                const Vector3d now = pivot + by * (c - pivot), e_now = by * e;
                return Place{now, e_now, a.cross(now - pivot), a.cross(e_now), a};
            }};
}

// A four-bar linkage in the plane x = 0: a lower arm from A to B turned by α, a link of fixed length
// from D to C, and between B and C the carrier, turned by φ: |B + R(φ) v - D| = l, v = C - B.
Corner four_bar() {
    const Vector3d A(0, 0.35, -0.10), B(0, 0.68, -0.12), C(0, 0.66, 0.16), D(0, 0.42, 0.20),
        c(0, 0.75, 0), patch(0, 0.75, -0.32), e = Vector3d(0, 1, -0.02).normalized();
    const auto angle = [](const Vector3d& v) { return std::atan2(v.z(), v.y()); };
    return {
        "four_bar",
        fmt::format(R"(points: {{A: {}, B: {}, C: {}, D: {}, w: {}, p: {}}}
bodies: {{arm: {{origin: B}}, carrier: {{origin: w}}}}
joints:
  pivot: {{type: revolute, bodies: [arm, ground], at: A, axis: x}}
  hinge: {{type: revolute, bodies: [carrier, arm], at: B, axis: x}}
  link: {{type: distance, bodies: [carrier, ground], from: C, to: D}}
wheel: {{body: carrier, centre: w, contact_patch: p, spin_axis: {}, side: left, contact: rolling}}
)",
                    list(A), list(B), list(C), list(D), list(c), list(patch), list(e)),
        c,
        patch,
        X,
        [=](double alpha) {
            const Vector3d b = A + turned(alpha, X) * (B - A), v = C - B, w = D - b;
            const double opened =
                std::acos((v.squaredNorm() + w.squaredNorm() - (C - D).squaredNorm()) /
                          (2 * v.norm() * w.norm()));
            const double phi = std::remainder(angle(w) - angle(v) - opened, 2 * M_PI);
            const Quaterniond by = turned(phi, X);
            const Vector3d top = b + by * v, now = b + by * (c - B), e_now = by * e;
            const Vector3d db = X.cross(b - A);
            const double dphi = -(top - D).dot(db) / (top - D).dot(X.cross(top - b));
            return Place{now, e_now, db + dphi * X.cross(now - b), dphi * X.cross(e_now), dphi * X};
        }};
}

std::vector<Corner> corners() {
    return {arm("trailing_arm", {0.45, 0.6, 0}, Y, Y),
            arm("semi_trailing_arm", {0.40, 0.45, 0.03}, {0.3, 1, 0.05}, {0.02, 1, -0.03}),
            four_bar()};
}

// The corner under a weight at its patch, which the spring balances as drawn; on a tyre instead
// of the weight where the branch moves its road.
Scene scene_of(const Corner& corner, const std::string& branch) {
    const bool on_tyre = branch.find("tyres") != std::string::npos;
    const std::string body = corner.name == "four_bar" ? "carrier" : "arm";
    const auto load = [&](const char* force, const char* more = "") {
        return fmt::format("{{on: {}, at: p, force: {}{}}}", body, force, more);
    };
    return parse_scene(
        "elastocheck: 1\nname: corner\nunits: {length: m, angle: rad, force: N}\n" + corner.parts +
            fmt::format(
                "torsion_springs: {{bar: {{bodies: [ground, arm], at: {}, axis: {}, rate: {}, "
                "preload_moment: {:.17g}}}}}\n",
                corner.name == "four_bar" ? "A" : "pivot", list(corner.axis), rate,
                corner.free(0, weight * Z)) +
            (on_tyre ? fmt::format("tyres: {{t: {{rate: {}, preload: {}}}}}\n", tyre_rate, weight)
                     : fmt::format("static_loads: {{weight: {}}}\n", load("[0, 0, 3500]"))) +
            fmt::format("loads: {{vertical: {}, lateral: {}, brake: {}, drive: {}}}\n",
                        load("[0, 0, 1]"), load("[0, 1, 0]"), load("[-1, 0, 0]"),
                        load("[1, 0, 0]", ", torque: ground")) +
            "branches: {b: " + branch + "}\n",
        "corner.yaml");
}

struct RollingWheel : LegTest {
    // At every point α is the root of moment(a, α) - M_0 - k α, which decreases.
    void expect(const Corner& corner, const std::string& branch,
                const std::function<double(double, double)>& moment,
                const std::function<double(double, double)>& effort = {}) const {
        const double M_0 = corner.free(0, weight * Z);
        const Model model = compile(scene_of(corner, branch));
        for (const Branch& side : branch_sides(model.branches[0])) {
            const SideModel one{on_branch(model, side), side};
            Worst places, forces;
            for (const Equilibrium& state : solved(leg(), one, 20, 1e-6).points) {
                const double a = state.load;
                double low = -0.45, high = 0.45;
                for (int k = 0; k < 100; ++k) {
                    const double alpha = (low + high) / 2;
                    (moment(a, alpha) - M_0 - rate * alpha > 0 ? low : high) = alpha;
                }
                places.add(
                    (position(state, model.wheels[0].contact) - corner.patch_at(low).p).norm(), a);
                places.add((position(state, {model.wheels[0].body, model.wheels[0].centre_local}) -
                            corner.at(low).c)
                               .norm(),
                           a);
                if (effort) {
                    const double jack = state.reactions[joint_named(model, "patch_jack")].force.z();
                    forces.add(std::abs(jack - effort(a, low)) / weight, a);
                }
            }
            EXPECT_TRUE(within(places, limit(1e-12))) << corner.name << ": " << branch;
            if (!effort) continue;
            EXPECT_TRUE(within(forces, limit(1e-9))) << corner.name << ": " << branch;
        }
    }
};
ELASTOCHECK_FOR(accurate_legs, RollingWheel);

TEST_P(RollingWheel, CarriesDeadForcesAtItsLowestPoint) {
    const std::pair<const char*, Vector3d> loads[] = {
        {"vertical", Z}, {"lateral", Y}, {"drive", X}};
    for (const Corner& corner : corners())
        for (const auto& [name, f] : loads)
            expect(corner, fmt::format("{{load: {}, from: -2000, to: 3000, steps: 40}}", name),
                   [&](double F, double alpha) { return corner.free(alpha, weight * Z + F * f); });
}

TEST_P(RollingWheel, BrakeForceAtThePatchActsOnTheCarrier) {
    for (const Corner& corner : corners())
        expect(corner, "{load: brake, from: -1500, to: 3000, steps: 40}",
               [&](double F, double alpha) {
                   return corner.free(alpha, weight * Z) + corner.braked(alpha, -F * X);
               });
}

TEST_P(RollingWheel, IsLiftedByAJackUnderItsLowestPoint) {
    for (const Corner& corner : corners()) {
        const double M_0 = corner.free(0, weight * Z);
        expect(
            corner,
            "{drive: patch_travel, from: -0.08, to: 0.08, steps: 40, static_loads: {lateral: 800}}",
            [&](double z, double alpha) {  // any force that closes the gap
                return M_0 + rate * alpha + 1e6 * (z - corner.height(alpha));
            },
            [&](double, double alpha) {
                return (M_0 + rate * alpha - corner.free(alpha, weight * Z + 800 * Y)) /
                       corner.free(alpha, Z);
            });
    }
}

// The branch ends where the tyre has left the road and the corner hangs on its spring: α = -M_0 / k.
TEST_P(RollingWheel, TyreUnderItPushesAndLiftsOffWithoutPulling) {
    for (const Corner& corner : corners())
        expect(corner, "{drive: tyres.t.road, from: -0.25, to: 0.1, steps: 40}",
               [&](double h, double alpha) {
                   const double F = weight + tyre_rate * (h - corner.height(alpha));
                   return corner.free(alpha, std::max(0.0, F) * Z);
               });
}

}  // namespace
}  // namespace elastocheck::legs
