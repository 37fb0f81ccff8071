// Stability along a branch: the outcome is independent of the requested points.
#include <numbers>

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

// The two-spring arch with its apex guided in the plane y-z without rotation. Its out-of-plane
// stiffness is
//   k_y + 2 k (1 - ℓ₀/ℓ),  ℓ = √(b² + z²),
// which is negative for |z| < z_c if k_y = 2 k (ℓ₀/√(b² + z_c²) - 1).
struct Sideways {
    double b = 0.3, h = 0.08, k = 1e5, l_0 = std::hypot(b, h), z_c;

    Scene scene() const {
        const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
        Scene scene = scene_named("two_spring_arch");
        scene.joints = {{"plane", InPlane{{0}, {ground}, {ground, X}, 0}},
                        {"no_roll", Perpendicular{{0, Y}, {ground, Z}}},
                        {"no_pitch", Perpendicular{{0, Z}, {ground, X}}},
                        {"no_yaw", Perpendicular{{0, X}, {ground, Y}}},
                        {"jack", InPlane{{0}, {ground}, {ground, Z}, h}, true}};
        Bushing side{Marker{0}, Marker{ground, {0, 0, h}}, LinearStiffness{}, Vector6::Zero()};
        stiffness_of(side)(1, 1) = 2 * k * (l_0 / std::hypot(b, z_c) - 1);
        scene.elastics.push_back({"side", side});
        scene.branches = {{.name = "travel",
                           .to = 2 * h,
                           .steps = 20,
                           .unit = ParameterUnit::metre,
                           .drivers = {{Motion{4}, 0, -1}}}};
        return scene;
    }
    double load(double z) const { return 2 * k * (1 - l_0 / std::hypot(b, z)) * z; }
};

std::vector<double> values_to(double to, int steps) {
    std::vector<double> values;
    for (int i = 0; i <= steps; ++i) values.push_back(to * i / steps);
    return values;
}

// Every point before the unstable stretch has its equilibrium; none beyond, although the far side
// is stable again.
void expect_lost(const Scene& scene, double critical, int steps, const std::string& what) {
    const auto values = values_to(scene.branches[0].to, steps);
    const auto path = solve(scene, 0, values);
    EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << what << ": " << path.detail;
    EXPECT_NE(path.detail.find("stops being a minimum"), std::string::npos)
        << what << ": " << path.detail;
    const auto before = std::ranges::count_if(
        values, [&](double a) { return std::abs(a) <= std::abs(critical) * (1 - 1e-9); });
    EXPECT_EQ(static_cast<long>(path.points.size()), before) << what << ": " << path.detail;
}

constexpr int counts[] = {1, 2, 3, 5, 8, 20, 80};

TEST(Stability, AnUnstableStretchIsSeenWhereverThePointsLie) {
    for (const double z_c : {0.041, 0.021, 0.011, 0.0053, 0.0021}) {
        const Sideways arch{.z_c = z_c};
        for (const int steps : counts)
            expect_lost(arch.scene(), arch.h - z_c, steps,
                        fmt::format("|z| < {} in {} steps", z_c, steps));
    }
}

TEST(Stability, AnUnstableStretchIsSeenBehindSofterModes) {
    for (const double softer : {1.0, 20.0}) {
        const Sideways arch{.z_c = 0.021};
        Scene scene = arch.scene();
        scene.joints[3] = scene.joints[4];  // yaw is free, on its own spring
        scene.joints.pop_back();
        std::get<Motion>(scene.branches[0].drivers[0].what).joint = 3;
        stiffness_of(std::get<Bushing>(scene.elastics.back().kind))(5, 5) = softer;
        for (const int steps : counts)
            expect_lost(scene, arch.h - 0.021, steps,
                        fmt::format("yaw on {} N·m/rad in {} steps", softer, steps));
    }
}

TEST(Stability, LoadDrivenTheArchIsLostWhereItGivesWaySideways) {
    const Sideways arch{.z_c = 0.06};
    Scene scene = arch.scene();
    scene.branches = {
        load_branch("down", {{"force", DeadForce{{0}, Vector3d::UnitZ()}}}, -205, 20)};
    for (const int steps : counts)
        expect_lost(scene, arch.load(0.06), steps, fmt::format("{} steps", steps));
}

// A stretch that stays stable is passed, with any number of points.
TEST(Stability, AStretchThatStaysStableIsPassed) {
    const Sideways almost{.z_c = 0.02};
    Scene scene = almost.scene();
    // SubspaceBasis at z = 0: 1 % above the limit of stability there.
    stiffness_of(std::get<Bushing>(scene.elastics.back().kind))(1, 1) =
        1.01 * 2e5 * (almost.l_0 / 0.3 - 1);
    for (const int steps : counts) {
        const auto path = solve(scene, 0, values_to(0.16, steps));
        EXPECT_EQ(path.outcome, Outcome::converged) << steps << ": " << path.detail;
    }
}

// A straight column never passes its buckling load P = k_R / L, in one step or many.
TEST(Stability, AColumnBucklesAtItsLoadInAnyNumberOfSteps) {
    const double k_R = 1e6, L = 0.5;
    Scene scene;
    scene.bodies = {{"column", {}}};
    scene.joints = {
        {"foot", Revolute{{0}, {ground}, {0, Vector3d::UnitY()}, {ground, Vector3d::UnitY()}}}};
    Bushing foot{Marker{0}, Marker{ground}, LinearStiffness{}, Vector6::Zero()};
    stiffness_of(foot).bottomRightCorner<3, 3>().diagonal().setConstant(k_R);
    scene.elastics = {{"foot", foot}};
    scene.probes = {{"head", {0, {0, 0, L}}}};
    for (const double beyond : {1.01, 1.9, 30.0}) {
        scene.branches = {load_branch("press",
                                      {{"force", DeadForce{{0, {0, 0, L}}, -Vector3d::UnitZ()}}},
                                      beyond * k_R / L, 1)};
        for (const int steps : counts)
            expect_lost(scene, k_R / L, steps, fmt::format("to {} P in {}", beyond, steps));
    }
}

// A block driven up by z, laterally free on k_y, under a strut with the force of a curve: zero,
// then within 15 mm so large that the block buckles laterally, then permanently smaller. No slope
// predicts it, and the equilibria on both sides are minima; it is detected because the second one
// does not have the predicted stiffness.
TEST(Stability, AStretchThatNothingAnnouncesIsSeenByWhatItLeavesBehind) {
    const double k_y = 1e4, l = 0.5;
    const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
    for (const double at : {0.02, 0.035, 0.05, 0.08, 0.083, 0.12, 0.15}) {
        const double most = -1.2 * k_y * (l + at), left = -0.7 * k_y * (l + at);
        Curve press{{at, at + 0.003, at + 0.012, at + 0.015}, {{{0, 0, 0, 0}}}};
        press.pieces.push_back({0, most / 0.003, 0, 0});
        press.pieces.push_back({most, 0, 0, 0});
        press.pieces.push_back({most, (left - most) / 0.003, 0, 0});
        press.pieces.push_back({left, 0, 0, 0});
        Scene scene;
        scene.bodies = {{"block", {}}};
        scene.joints = {{"plane", InPlane{{0}, {ground}, {ground, X}, 0}},
                        {"no_roll", Perpendicular{{0, Y}, {ground, Z}}},
                        {"no_pitch", Perpendicular{{0, Z}, {ground, X}}},
                        {"no_yaw", Perpendicular{{0, X}, {ground, Y}}},
                        {"jack", InPlane{{0}, {ground}, {ground, Z}, 0}, true}};
        Bushing side{Marker{ground}, Marker{0}, LinearStiffness{}};
        stiffness_of(side)(1, 1) = k_y;
        scene.elastics = {{"side", side},
                          {"strut", AxialSpring{{ground, {0, 0, -l}}, {0}, press, l}}};
        scene.probes = {{"block", {0}}};
        scene.branches = {{.name = "travel",
                           .to = 0.2,
                           .steps = 1,
                           .unit = ParameterUnit::metre,
                           .drivers = {{Motion{4}, 0, 1}}}};
        const double values[] = {0, 0.2};
        const auto path = solve(scene, 0, values);
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << at << ": " << path.detail;
        EXPECT_EQ(path.points.size(), 1u) << at;
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
