// Ends of branches at bifurcations and loss of stability, independent of the points.
#include <fmt/format.h>

#include "models/branch.hpp"
#include "tests/reference/equilibrium/driven_scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

constexpr int point_counts[] = {1, 2, 3, 4, 5, 7, 10, 20, 33, 100, 1001};

// For any number of points, the branch bifurcates at `at`, and all points before it are present.
void expect_dividing_at(const Scene& s, double to, double at) {
    const Model whole = compile(s);
    const Model model = on_branch(whole, whole.branches[0]);
    for (const int steps : point_counts) {
        std::vector<double> points;
        std::size_t before = 0;
        for (int n = 0; n <= steps; ++n) {
            points.push_back(to * n / steps);
            before += std::abs(points.back()) < std::abs(at);
        }
        const auto path = solve(model, model.branches[0], points);
        // A stretch narrower than the smallest step is stable on both sides; the outcome does not
        // distinguish this case.
        EXPECT_TRUE(path.outcome == Outcome::bifurcation_point ||
                    (path.outcome == Outcome::singular &&
                     path.detail.find("may divide") != std::string::npos))
            << steps << " steps: " << path.detail;
        EXPECT_NE(path.detail.find("divide"), std::string::npos) << path.detail;
        EXPECT_EQ(path.points.size(), before) << steps << " steps: " << path.detail;
    }
}

// An arch whose apex may leave sideways against a rate of k_y, and is pushed through by a jack, or
// by a load against a rate of k_z that is large enough to exclude a limit point. In the plane, at
// the height z,
//
//   sideways stiffness  k_y + 2 k (1 - ℓ₀ / ℓ)
//
// which is negative for |z| < z_c with  k_y = 2 k (ℓ₀ / ℓ(z_c) - 1).
struct Arch {
    double b = 0.3, h = 0.08, k = 100e3, k_z = 60e3;
    double length(double z) const { return std::hypot(b, z); }
    double side_rate(double z_c) const { return 2 * k * (length(h) / length(z_c) - 1); }
    double load(double z) const { return 2 * k * (1 - length(h) / length(z)) * z + k_z * (z - h); }

    Scene scene(double k_y, bool driven) const {
        Scene s;
        s.name = "arch";
        s.bodies = {{"apex", {{0, 0, h}, Quaterniond::Identity()}}};
        const Direction x{0, {1, 0, 0}}, y{0, {0, 1, 0}};
        const Point apex{0, {0, 0, 0}}, at{ground, {0, 0, h}};
        s.joints = {{"x", InPlane{apex, at, ground_x}},
                    {"about z", Perpendicular{x, ground_y}},
                    {"about y", Perpendicular{x, ground_z}},
                    {"about x", Perpendicular{y, ground_z}},
                    {"jack", InPlane{apex, at, ground_z}, true}};
        for (const double side : {-1., 1.})
            s.elastics.push_back(
                {"side", AxialSpring{apex, {ground, {side * b, 0, 0}}, LinearRate{k}, length(h)}});
        Bushing mount;
        mount.j.body = 0;
        mount.i.s_local = at.s_local;
        stiffness_of(mount).K.diagonal() << 0, k_y, driven ? 0 : k_z, 0, 0, 0;
        s.elastics.push_back({"mount", mount});
        s.branches = {
            driven
                ? branch_of("push", {{Motion{4}, 0, 1}}, -2 * h, 1, ParameterUnit::metre)
                : branch_of("push", {driven_by({"f", DeadForce{apex, {0, 0, 1}}})}, load(-h), 1)};
        s.probes = {{"apex", apex}};
        return s;
    }
};

TEST(EquilibriumStability, AnUnstableStretchEndsTheBranchWhereverThePointsFall) {
    const Arch arch;
    for (const double z_c : {0.05, 0.02, 0.005, 0.001}) {
        expect_dividing_at(arch.scene(arch.side_rate(z_c), true), -2 * arch.h, z_c - arch.h);
        expect_dividing_at(arch.scene(arch.side_rate(z_c), false), arch.load(-arch.h),
                           arch.load(z_c));
    }
}

TEST(EquilibriumStability, AnArchThatNeverLeavesItsPlaneGoesThrough) {
    const Arch arch;
    for (const double part : {1.5, 1.05, 1.002})
        for (const bool driven : {true, false})
            for (const int steps : point_counts) {
                const Model whole = compile(arch.scene(part * arch.side_rate(0), driven));
                const Model model = on_branch(whole, whole.branches[0]);
                std::vector<double> points;
                for (int n = 0; n <= steps; ++n) points.push_back(model.branches[0].to * n / steps);
                const auto path = solve(model, model.branches[0], points);
                EXPECT_EQ(path.outcome, Outcome::converged)
                    << part << ", " << steps << ": " << path.detail;
            }
}

TEST(EquilibriumStability, AStraightColumnEndsAtItsBucklingLoad) {
    Scene s = hinged_bar({0, 0, 0.5}, {0, 1, 0}, 1000);
    s.branches = {pull({0, {0, 0, 0.5}}, {0, 0, -1})};
    expect_dividing_at(s, 3929.4, 1000 / 0.5);
    expect_dividing_at(s, 4000, 1000 / 0.5);  // with points at the bifurcation itself
}

// Two bars in a line, torsion springs c in both hinges: c (2θ₁ - θ₂) = P L θ₁, c (θ₂ - θ₁) = P L
// θ₂, hence P L / c = (3 - √5) / 2.
TEST(EquilibriumStability, AColumnOfTwoBarsEndsAtItsLowestBucklingLoad) {
    Scene s = hinged_bar({0, 0, 0.5}, {0, 1, 0}, 1000);
    s.bodies.push_back({"upper", {{0, 0, 0.5}, Quaterniond::Identity()}});
    s.joints.push_back(
        {"middle", Revolute{{1, {0, 0, 0}}, {0, {0, 0, 0.5}}, {1, {0, 1, 0}}, {0, {0, 1, 0}}}});
    Bushing torsion = std::get<Bushing>(s.elastics[0].kind);
    torsion.i = {1, {0, 0, 0}};
    torsion.j = {0, {0, 0, 0.5}};
    s.elastics.push_back({"upper torsion", torsion});
    s.branches = {pull({1, {0, 0, 0.5}}, {0, 0, -1})};
    s.probes.push_back({"top", {1, {0, 0, 0.5}}});
    expect_dividing_at(s, 1969.1, 2000 * (3 - std::sqrt(5)) / 2);
    // past the second buckling load too, 5236 N
    expect_dividing_at(s, 8000, 2000 * (3 - std::sqrt(5)) / 2);
}

// Free to lean in two planes with equal stiffness: both eigenvalues cross zero together and the
// determinant keeps its sign.
TEST(EquilibriumStability, AColumnThatBucklesInTwoPlanesAtOnceIsNoticed) {
    Scene s = hinged_bar({0, 0, 0.5}, {0, 1, 0}, 1000);
    s.joints = {{"ball", Spherical{{0, {0, 0, 0}}, {ground, {0, 0, 0}}}}};
    s.branches = {pull({0, {0, 0, 0.5}}, {0, 0, -1})};
    expect_dividing_at(s, 3929.4, 1000 / 0.5);
}

// Upright under a weight beyond its buckling load from the start.
TEST(EquilibriumStability, AnUnstableStartIsNamed) {
    Scene s = hinged_bar({0, 0, 0.5}, {0, 1, 0}, 1000);
    s.branches = {pull({0, {0, 0, 0.5}}, {0, 0, -1})};
    s.static_loads = {{"weight", DeadForce{{0, {0, 0, 0.5}}, {0, 0, -2100}}}};
    const Model model = compile(s);
    for (const double to : {500., -500.}) {
        const std::vector<double> points = {0, to};
        const auto path = solve(model, model.branches[0], points);
        EXPECT_EQ(path.outcome, Outcome::singular) << path.detail;
        EXPECT_NE(path.detail.find("unstable"), std::string::npos) << path.detail;
        EXPECT_TRUE(path.points.empty());
    }
}

// A parallelogram is flat at half a turn, where it may continue in either of two configurations.
TEST(EquilibriumStability, AMechanismEndsWhereItsMotionDivides) {
    Scene s = four_bar(0.04, 0.1, 0.04 * (1 + 1e-15), 0.1);
    s.bodies[1].design = {{0, 0.04, 0}, Quaterniond::Identity()};
    const Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
    s.bodies[0].design.p = s.bodies[2].design.p = quarter;
    s.bodies[2].design.r = {0.1, 0, 0};
    std::get<InLine>(s.joints[3].kind).j.s_local = {0.04, 0, 0};
    std::get<Angle>(s.joints[4].kind).j.u_local = {0, 1, 0};
    std::get<Angle>(s.joints[4].kind).y_j.u_local = {-1, 0, 0};
    const Model model = compile(s);
    const Model driven = on_branch(model, model.branches[0]);
    for (const int steps : {1, 5, 20, 101}) {
        std::vector<double> points;
        for (int n = 0; n <= steps; ++n) points.push_back(M_PI * n / steps);
        const auto path = solve(driven, driven.branches[0], points);
        EXPECT_EQ(path.outcome, Outcome::singular) << steps << ": " << path.detail;
        EXPECT_NEAR(static_cast<double>(path.points.size()), 1 + std::floor(steps / 2.), 1)
            << path.detail;
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
