// Ends of branches at bifurcations and loss of stability, independent of the requested points.
#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"

namespace elastocheck::legs {
namespace {

constexpr int counts[] = {1, 2, 3, 5, 8, 20, 80};

struct Stability : LegTest {
    // The branch ends at the parameter `at` for any number of points; the points before are there.
    void expect_lost(const Scene& scene, double at, const std::string& what = "") const {
        const SideModel side = side_of(scene);
        const double margin = leg().kind == Leg::recursive ? 1e-4 : 1e-6;
        for (const int steps : counts) {
            const auto path = solve(leg(), side, steps);
            const auto where =
                fmt::format("{} in {} steps: {} {}", what, steps, name(path.outcome), path.detail);
            // An unstable stretch narrower than the smallest step is stable on both sides, so that
            // the equilibrium leg does not tell it from a limit point.
            EXPECT_TRUE(path.outcome == Outcome::bifurcation_point ||
                        path.outcome == Outcome::singular)
                << where;
            long least = 0, most = 0;
            for (int k = 0; k <= steps; ++k) {
                const double a = std::abs(side.branch.to * k / steps / at);
                least += a < 1 - margin;
                most += a < 1 + margin;
            }
            const auto points = static_cast<long>(path.points.size());
            EXPECT_TRUE(least <= points && points <= most) << where << ": " << points;
        }
    }
    void expect_passed(const Scene& scene, const std::string& what = "") const {
        for (const int steps : counts) {
            const auto path = solve(leg(), side_of(scene), steps);
            EXPECT_EQ(path.outcome, Outcome::converged)
                << what << " in " << steps << " steps: " << path.detail;
        }
    }
};
ELASTOCHECK_FOR(accurate_legs, Stability);

// An arch whose apex may leave sideways against a rate of k_y, and is pushed through by a jack, or
// by a load against a rate k_z that excludes a limit point. Its sideways stiffness at the height z,
// k_y + 2 k (1 - ℓ₀ / ℓ), is negative for |z| < z_c with k_y = 2 k (ℓ₀ / ℓ(z_c) - 1).
struct Arch {
    double b = 0.3, h = 0.08, k = 100e3, k_z = 60e3;
    double length(double z) const { return std::hypot(b, z); }
    double side_rate(double z_c) const { return 2 * k * (length(h) / length(z_c) - 1); }
    double load(double z) const { return 2 * k * (1 - length(h) / length(z)) * z + k_z * (z - h); }

    // yaw > 0: turning about z is free, on this rate [N·m/rad].
    Scene scene(double k_y, bool driven, double yaw = 0) const {
        Scene s;
        s.bodies = {{"apex", {h * Z}}};
        s.joints = {{"x", InPlane{{0}, {ground}, ground_x}},
                    {"about y", Perpendicular{{0, X}, ground_z}},
                    {"about x", Perpendicular{{0, Y}, ground_z}},
                    {"jack", InPlane{{0}, {ground, h * Z}, ground_z}, true}};
        if (yaw == 0) s.joints.push_back({"about z", Perpendicular{{0, X}, ground_y}});
        for (const double side : {-1., 1.})
            s.elastics.push_back(
                {"side", AxialSpring{{0}, {ground, side * b * X}, LinearRate{k}, length(h)}});
        s.elastics.push_back(
            {"mount", bushing({ground, h * Z}, {0}, {0, k_y, driven ? 0 : k_z}, {0, 0, yaw})});
        s.branches = {driven ? motion_branch(3, -2 * h) : load_branch(DeadForce{{0}, Z}, load(-h))};
        s.probes = {{"apex", {0}}};
        return s;
    }
};

// A mast on a ball joint under more than its buckling load, on a carriage at rest, beside a block that a load moves: the
// message names the mast.
TEST_P(Stability, UnstableStartNamesTheBodyOfTheUnstableMode) {
    if (leg().kind == Leg::energy) GTEST_SKIP() << "says that there is no minimum, not where to";
    constexpr double rate = 100, height = 0.5;
    Scene s;
    s.bodies = {{"carriage", {0 * Z}}, {"mast", {height * Z}}, {"block", {X}}};
    s.joints = {{"rail", Translational{{0}, {ground}, {0, Z}, ground_z}},
                {"ball", Spherical{{1, -height * Z}, {0}}}};
    s.elastics = {{"carriage", bushing({ground}, {0}, {1e5, 1e5, 1e5}, {1e3, 1e3, 1e3})},
                  {"spring", bushing({0}, {1, -height * Z}, {0, 0, 0}, {rate, rate, rate})},
                  {"block", bushing({ground, X}, {2}, {1e4, 1e4, 1e4}, {100, 100, 100})}};
    s.static_loads = {{"weight", DeadForce{{1}, -1.5 * rate / height * Z}}};
    s.branches = {load_branch(DeadForce{{2}, X}, 10)};
    s.probes = {{"block", {2}}, {"mast", {1}}, {"carriage", {0}}};
    const auto path = solve(leg(), side_of(s), 4);
    EXPECT_NE(path.outcome, Outcome::converged);
    EXPECT_TRUE(contains(path.detail, "unstable: bodies that are displaced: 'mast'"))
        << path.detail;
    EXPECT_FALSE(contains(path.detail, "'carriage'") || contains(path.detail, "'block'"))
        << path.detail;
}

TEST_P(Stability, UnstableStretchEndsTheBranchForAnyOutputPoints) {
    const Arch arch;
    for (const double z_c : {0.05, 0.02, 0.0053, 0.0021}) {
        const auto what = fmt::format("|z| < {}", z_c);
        expect_lost(arch.scene(arch.side_rate(z_c), true), z_c - arch.h, "jack, " + what);
        expect_lost(arch.scene(arch.side_rate(z_c), false), arch.load(z_c), "load, " + what);
        for (const double yaw : {1., 20.})
            expect_lost(arch.scene(arch.side_rate(z_c), true, yaw), z_c - arch.h, "yaw, " + what);
    }
}

TEST_P(Stability, BranchOfAnArchThatDoesNotBuckleSidewaysReachesItsEnd) {
    const Arch arch;
    for (const double part : {1.5, 1.05, 1.01, 1.002})
        for (const bool driven : {true, false})
            expect_passed(arch.scene(part * arch.side_rate(0), driven), fmt::format("{}", part));
}

// An arch of unequal sides whose apex is pushed through in a plane and may leave it sideways, with a
// rotation so soft that the sideways stiffness is not the least one where it dips.
struct UnequalArch {
    double b, h, drop;  // half width, height, and how far the right end is below the left [m]
    double k = 1e5;
    double side_rate(double z) const {
        double sum = 0;
        for (const double end : {0., -drop})
            sum += k * (1 - std::hypot(b, h - end) / std::hypot(b, z - end));
        return sum;
    }
    // The height from which on the sides push hardest.
    double worst(double to) const {
        double least = h;
        for (int k_ = 0; k_ <= 1000; ++k_)
            if (const double z = h + to * k_ / 1000; side_rate(z) < side_rate(least)) least = z;
        return least;
    }
    Scene scene(double k_y, double to) const {
        Scene s;
        s.bodies = {{"apex", {h * Z}}};
        s.joints = {{"x", InPlane{{0}, {ground}, ground_x}},
                    {"about y", Perpendicular{{0, X}, ground_z}},
                    {"about z", Perpendicular{{0, X}, ground_y}},
                    {"jack", InPlane{{0}, {ground, h * Z}, ground_z}, true}};
        for (const double side : {-1., 1.})
            s.elastics.push_back(
                {"side", AxialSpring{{0},
                                     {ground, Vector3d(side * b, 0, side > 0 ? -drop : 0)},
                                     LinearRate{k},
                                     std::hypot(b, h + (side > 0 ? drop : 0))}});
        s.elastics.push_back(
            {"mount", bushing({ground, h * Z}, {0}, {0, k_y, 0}, {0.57, 0.57, 0.57})});
        s.branches = {motion_branch(3, to)};
        s.probes = {{"apex", {0}}};
        return s;
    }
};

struct UnstableStretch : LegTest {};
ELASTOCHECK_FOR(legs_by_every_method, UnstableStretch);

// Arches with unstable stretches of 0.2 to 20 % of the way, in 1 to 20 steps, adaptive in up to 80;
// golden ratio fractions instead of random numbers.
TEST_P(UnstableStretch, EndsTheBranchOfADrivenArchInAnyNumberOfSteps) {
    const auto share = [](int k, double by) { return std::fmod(by * k, 1.); };
    for (int k = 1; k <= 1025; ++k) {
        UnequalArch arch{0.2 + 0.2 * share(k, 0.618034), 0.02 + 0.1 * share(k, 0.754878), 0};
        arch.drop = share(k, 0.569840) < 0.5 ? 0 : 0.4 * arch.h;
        const double to = -arch.h * (1.6 + 1.4 * share(k, 0.381966));
        const double z = arch.worst(to), half = std::pow(10., -3 + 2 * share(k, 0.324718)) * to;
        const double k_y = -std::max(arch.side_rate(z + half), arch.side_rate(z - half));
        if (!(k_y > 0)) continue;
        const bool adaptive = leg().kind == Leg::recursive && leg().method.name == "adaptive";
        const int steps = adaptive ? 20 + 60 * k % 61 : 1 + k % 20;
        const auto path = solve(leg(), side_of(arch.scene(k_y, to)), steps);
        EXPECT_TRUE(path.outcome == Outcome::bifurcation_point || path.outcome == Outcome::singular)
            << fmt::format("arch {} in {} steps: {} {}", k, steps, name(path.outcome), path.detail);
    }
}

// ---- Columns.

Scene column(double k_R, bool two_planes = false) {
    Scene s = hinged_bar(0.5 * Z, Y, k_R);
    if (two_planes) s.joints = {{"ball", Spherical{{0}, {ground}}}};
    s.branches = {load_branch(DeadForce{{0, 0.5 * Z}, -Z}, 1)};
    return s;
}
Scene pressed(Scene scene, double to) {
    scene.branches[0].to = to;
    return scene;
}

// P = k_R / L. Free to lean in two planes with equal stiffness, both eigenvalues cross zero
// together and the determinant keeps its sign.
TEST_P(Stability, BranchOfAStraightColumnEndsAtItsBucklingLoad) {
    for (const bool two_planes : {false, true})
        for (const double to : {2020., 3929.4, 60000.})
            expect_lost(pressed(column(1000, two_planes), to), 1000 / 0.5, fmt::format("{} N", to));
}

// A second bar on a hinge of the same rate c, at the end of the first.
Scene two_bars(const LoadKind& load, double to) {
    Scene s = column(1000);
    s.bodies.push_back({"upper", {0.5 * Z}});
    s.joints.push_back({"middle", Revolute{{1}, {0, 0.5 * Z}, {1, Y}, {0, Y}}});
    s.elastics.push_back(
        {"upper torsion", bushing({1}, {0, 0.5 * Z}, Vector3d::Zero(), Vector3d::Constant(1000))});
    s.branches = {load_branch(load, to)};
    s.probes.push_back({"top", {1, 0.5 * Z}});
    return s;
}

// c (2θ₁ - θ₂) = P L θ₁, c (θ₂ - θ₁) = P L θ₂, hence P L / c = (3 - √5) / 2; the second is 5236 N.
TEST_P(Stability, BranchOfATwoBarColumnEndsAtItsLowestBucklingLoad) {
    for (const double to : {1969.1, 8000.})
        expect_lost(two_bars(DeadForce{{1, 0.5 * Z}, -Z}, to), 2000 * (3 - std::sqrt(5)) / 2);
}

// A force along the upper bar (Ziegler's column): det [2c - P L, -c + P L; -c, c] = c² at any load.
// Where only part of the force follows, M = k - D L reaches zero under the dead weight D.
TEST_P(Stability, ColumnUnderAFollowerForceAloneHasNoDivergence) {
    if (leg().needs_energy()) GTEST_SKIP() << "a follower has no energy";
    expect_passed(two_bars(FollowerForce{{1, 0.5 * Z}, -Z}, 20e3));
    Scene s = pressed(column(1000), 3929.4);
    s.static_loads = {{"follower", FollowerForce{{0, 0.5 * Z}, -5000 * Z}}};
    expect_lost(s, 2000, "beside a follower");
}

TEST_P(Stability, UnstableStartIsReported) {
    Scene s = column(1000);
    s.static_loads = {{"weight", DeadForce{{0, 0.5 * Z}, -2100 * Z}}};
    for (const double to : {500., -500.}) {
        const auto path = solve(leg(), side_of(pressed(s, to)), 1);
        EXPECT_NE(path.outcome, Outcome::converged) << path.detail;
        EXPECT_TRUE(path.points.empty());
    }
}

// A column on a ball joint beyond its buckling load with a lever of 1e-7 m, which alone determines
// the direction of buckling.
TEST_P(Stability, LeverOfATenthOfAMicrometreDeterminesTheBucklingDirection) {
    Scene s = column(1000, true);
    s.branches = {load_branch(DeadForce{{0, {1e-7, 0, 0.5}}, -Z}, 6100)};
    const auto path = solve(leg(), side_of(s), 20);
    if (leg().exact()) {
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    }
    for (const auto& state : path.points)
        EXPECT_LE(std::abs(position(state, {0, 0.25 * Z}).y()), 1e-9) << state.load;
}

// Second variation of a straight chain of n segments under N (models/reader/definitions/beams.hpp),
// with nodes rotated by φ_k = sin(α k), α = π / (2n): the segments' κ² and φ² sum to
// 4 sin²(α/2) : cos²(α/2), so that
//
//   4 tan²(α/2) (½ k_r + ⅛ N ℓ) + ½ N ℓ - ½ N² (1/k_y - 1/k_x) = 0
//
// is its singularity: under compression, Euler's load for n elements; under tension, never below
// N = k_y ℓ = 12 EI / ℓ², where the beam theory does not apply.
TEST_P(Stability, BranchOfAStraightChainEndsAtItsCriticalLoadInCompressionAndTension) {
    constexpr double L = 1, EI = 100, EI_y = 400, GJ = 150, EA = 4e6;
    for (const int n : {1, 2, 4}) {
        const double l = L / n, k_x = EA / l, k_y = 12 * EI / (l * l * l), k_r = EI / l,
                     T = 4 * std::pow(std::tan(M_PI / (4 * n)), 2), a = (1 / k_y - 1 / k_x) / 2,
                     b = l / 2 + T * l / 8, c = T * k_r / 2, root = std::sqrt(b * b + 4 * a * c);
        Scene s;
        for (int k = 0; k < n; ++k) {
            s.bodies.push_back({fmt::format("node {}", k + 1), {(k + 1) * l * X}});
            Bushing segment =
                bushing({k - 1, l / 2 * X}, {k, -l / 2 * X}, {k_x, k_y, 12 * EI_y / (l * l * l)},
                        {GJ / l, EI_y / l, EI / l});
            segment.formulation.frame = Formulation::Frame::middle;
            s.elastics.push_back({fmt::format("segment {}", k + 1), segment});
        }
        s.probes = {{"tip", {n - 1}}};
        EXPECT_GT((b + root) / (2 * a), k_y * l);
        EXPECT_NEAR((b - root) / (2 * a) * L * L / EI, -M_PI * M_PI / 4, 1. / (n * n));
        for (const double N : {(b + root) / (2 * a), (b - root) / (2 * a)}) {
            s.branches = {load_branch(DeadForce{{n - 1}, X}, 1)};
            EXPECT_EQ(solve(leg(), side_of(pressed(s, N * (1 - 1e-4))), 1).outcome,
                      Outcome::converged)
                << n << " segments, " << N << " N";
            expect_lost(pressed(s, N * (1 + 1e-3)), N, fmt::format("{} segments", n));
        }
    }
}

// ---- Events that no slope announces.

// A block driven up by z, laterally free on k_y, under a strut whose force is zero, then within 15
// mm so large that the block buckles laterally, then permanently smaller.
TEST_P(Stability, InstabilityBetweenTwoStableEndsOfAStepIsDetected) {
    const double k_y = 1e4, l = 0.5;
    for (const double at : {0.02, 0.05, 0.083, 0.15}) {
        const double most = -1.2 * k_y * (l + at), left = -0.7 * k_y * (l + at);
        const Curve press{{at, at + 0.003, at + 0.012, at + 0.015},
                          {{0, 0, 0, 0},
                           {0, most / 0.003, 0, 0},
                           {most, 0, 0, 0},
                           {most, (left - most) / 0.003, 0, 0},
                           {left, 0, 0, 0}}};
        Scene s;
        s.bodies = {{"block", {}}};
        s.joints = {{"plane", InPlane{{0}, {ground}, ground_x}},
                    {"no roll", Perpendicular{{0, Y}, ground_z}},
                    {"no pitch", Perpendicular{{0, Z}, ground_x}},
                    {"no yaw", Perpendicular{{0, X}, ground_y}},
                    {"jack", InPlane{{0}, {ground}, ground_z}, true}};
        s.elastics = {{"side", bushing({ground}, {0}, {0, k_y, 0}, Vector3d::Zero())},
                      {"strut", AxialSpring{{ground, -l * Z}, {0}, press, l}}};
        s.probes = {{"block", {0}}};
        s.branches = {motion_branch(4, 0.2)};
        const auto path = solve(leg(), side_of(s), 1);
        EXPECT_NE(path.outcome, Outcome::converged) << at;
        EXPECT_EQ(path.points.size(), 1u) << at << path.detail;
    }
}

}  // namespace
}  // namespace elastocheck::legs
