// The series method across pieces of force curves; formulations and followers on branches.
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/recursive.hpp"
#include "recursive/series/path.hpp"
#include "tests/recursive/random.hpp"
#include "tests/recursive/walks.hpp"

namespace elastocheck::recursive::series {
namespace {

Branch loaded(double to, std::vector<Driver> drivers) {
    Branch branch;
    branch.name = "load";
    branch.to = to;
    branch.steps = 100;
    branch.drivers = std::move(drivers);
    return branch;
}

// ---- A body on the x axis, one metre from the origin, with springs along x only.

constexpr BodyId slider = 0;
Scene on_the_x_axis(std::vector<Elastic> elastics) {
    Scene scene;
    scene.bodies = {{"slider", {Eigen::Vector3d(1, 0, 0), Eigen::Quaterniond::Identity()}}};
    const Direction along{ground, Eigen::Vector3d::UnitX()},
        on_slider{slider, Eigen::Vector3d::UnitX()};
    scene.joints = {{"rail", Translational{{slider, Eigen::Vector3d::Zero()},
                                           {ground, Eigen::Vector3d::Zero()},
                                           on_slider,
                                           along}}};
    scene.elastics = std::move(elastics);
    scene.probes = {{"slider", {slider, Eigen::Vector3d::Zero()}}};
    return scene;
}
// A spring with the slider's displacement as stretch, plus `drawn`.
Elastic along_x(const std::string& name, const ScalarLaw& law, double drawn = 0) {
    return {
        name,
        AxialSpring{
            {ground, Eigen::Vector3d::Zero()}, {slider, Eigen::Vector3d::Zero()}, law, 1 - drawn}};
}
Driver push(double start, double rate) {
    return {Load{"push", DeadForce{{slider, Eigen::Vector3d::Zero()}, Eigen::Vector3d::UnitX()}},
            start, rate};
}
double moved(const Equilibrium& point) { return point.poses[slider].r.x() - 1; }

// f = below · x for x < 0, above · x for x > 0.
Curve bent(double below, double above) { return {{0}, {{0, below, 0, 0}, {0, above, 0, 0}}}; }

// Distance from the curve's inverse, to first order [m].
double off(const Curve& f, double x, double force) {
    const double h = 1e-7,
                 slope =
                     (support::stated_force(f, x + h) - support::stated_force(f, x - h)) / (2 * h);
    return std::abs((support::stated_force(f, x) - force) / slope);
}
Curve rising() {
    return support::hermite({-0.03, -0.01, 0, 0.005, 0.02, 0.04}, {-2000, -300, 0, 100, 900, 4000},
                            {120e3, 40e3, 22e3, 25e3, 90e3, 200e3});
}

// An expansion ends where the knot is, and each knot crossed is counted once; the one at the start is
// not. That a body moves by the inverse of its curve is tested in tests/legs (Stops).
TEST(SeriesPieces, ExpansionEndsAtTheKnot) {
    for (const double to : {6000.0, -4000.0}) {
        const SideModel w =
            walked(on_the_x_axis({along_x("spring", rising())}), loaded(to, {push(0, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        std::vector<double> met;
        for (std::size_t k = 0; k + 1 < path.expansions.size(); ++k)
            if (path.expansions[k].knots > 0)
                met.push_back(path.expansions[k + 1].start[slider].r.x() - 1);
        const std::vector<double> knots =
            to > 0 ? std::vector{0.005, 0.02, 0.04} : std::vector{-0.01, -0.03};
        ASSERT_EQ(met.size(), knots.size());
        for (std::size_t k = 0; k < knots.size(); ++k)
            EXPECT_NEAR(met[k], knots[k], to > 0 ? 1e-15 : 1e-12);
        for (const auto& point : sample(w.model, path, w.branch, 40).points)
            EXPECT_LE(off(rising(), moved(point), point.load), 1e-12) << to;  // 1e-9 mm
    }
}

TEST(SeriesPieces, TwoStopsClosingTogetherAreCrossedTogether) {
    // ... two knots at the same place within rounding.
    for (const double apart : {-1e-17, 0.0, 1e-17, 1e-15, 1e-12, 1e-9}) {
        const SideModel w =
            walked(on_the_x_axis({along_x("spring", LinearRate{20e3}),
                                  along_x("left", support::stop(0.03, 1e5)),
                                  along_x("right", support::stop(0.03 + apart, 2e5))}),
                   loaded(2000, {push(0, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << apart << path.detail;
        EXPECT_LE(path.expansions.size(), std::abs(apart) < 1e-13 ? 2u : 3u) << apart;
        const auto sampled = sample(w.model, path, w.branch, 50);
        EXPECT_NEAR(moved(sampled.points.back()),
                    (2000 + 0.03 * 1e5 + (0.03 + apart) * 2e5) / 320e3, 1e-14)
            << apart;
    }
}

TEST(SeriesPieces, MotionFromAKnotUsesThePieceItEnters) {
    // A curve with its kink at the design position, or within rounding of it.
    for (const double drawn : {0.0, 1e-17, -1e-17, 1e-16, -1e-16})
        for (const double to : {500.0, -500.0})
            for (const bool arc : {false, true}) {
                const SideModel w =
                    walked(on_the_x_axis({along_x("spring", bent(10e3, 40e3), drawn)}),
                           loaded(to, {push(0, 1)}));
                const Path path = follow(w.model, w.branch, {.arc_length = arc});
                ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
                EXPECT_EQ(path.expansions.size(), 1u);
                const auto sampled = sample(w.model, path, w.branch, 10);
                for (const auto& point : sampled.points)
                    EXPECT_NEAR(moved(point), point.load / (to > 0 ? 40e3 : 10e3), 1e-15)
                        << drawn << " " << to;
            }
}

TEST(SeriesPieces, PiecesOfManyKnotsAtTheStartAreConsistent) {
    // Sixty curves that all start at a knot; the sign of each deflection depends on the pieces of
    // all others.
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        Scene scene;
        scene.bodies = {{"block", {}}};
        for (int k = 0; k < 60; ++k) {
            const Eigen::Vector3d at = random.vector(0.2);
            PerAxis law;
            for (auto& axis : law.axis) axis = LinearRate{0};
            law.axis[0] = bent(random(1e4, 2e4), random(1e4, 1e6));
            const Eigen::Quaterniond axes = random.rotation();
            scene.elastics.push_back({"leg", Bushing{{ground, at, axes}, {0, at, axes}, law}});
        }
        scene.probes = {{"block", {0, Eigen::Vector3d::Zero()}}};
        const SideModel w = walked(
            scene,
            loaded(100, {{Load{"f", DeadForce{{0, random.vector(0.1)}, random.unit()}}, 0, 1}}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << trial << " " << path.detail;
        for (const auto& point : sample(w.model, path, w.branch, 7).points) {
            const auto left = recursive::residuals(w.model, w.branch, point);
            EXPECT_LE(std::max(left.force, left.moment), 1e-7)
                << trial << " " << point.load;  // 1e-12 m of 1e7 N/m
        }
    }
}

// ---- A jack moves a slider past a spring whose other end is h beside the rail.

Scene beside_the_rail(double h, const ScalarLaw& law, double free_length, double from) {
    Scene scene = on_the_x_axis({});
    scene.bodies[0].design.r = Eigen::Vector3d(from, 0, 0);
    scene.elastics = {{"spring", AxialSpring{{ground, Eigen::Vector3d(0, h, 0)},
                                             {slider, Eigen::Vector3d::Zero()},
                                             law,
                                             free_length}}};
    scene.joints.push_back({"jack",
                            InPlane{{slider, Eigen::Vector3d::Zero()},
                                    {ground, scene.bodies[0].design.r},
                                    {ground, Eigen::Vector3d::UnitX()},
                                    0},
                            true});
    return scene;
}
Branch jacked(double to) {
    Branch branch;
    branch.name = "jack";
    branch.unit = ParameterUnit::metre;
    branch.to = to;
    branch.steps = 100;
    branch.drivers = {{Motion{1}, 0, 1}};
    return branch;
}

TEST(SeriesPieces, GrazedKnotIsNotCrossed) {
    // The spring is shortest at x = 0, where its stretch is h - ℓ₀ = `deep` beyond the knot at 0.
    const double h = 0.1;
    for (const double deep : {0.0, 1e-17, -1e-17, 1e-16, -1e-16, 1e-14, -1e-14, 5e-14, -1e-13,
                              1e-12, -1e-12, 1e-10, -1e-10, 1e-6, -1e-6}) {
        const Curve f = bent(200e3, 4e3);
        const double free_length = h + deep;
        const SideModel w = walked(beside_the_rail(h, f, free_length, -0.06), jacked(0.12));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << deep << path.detail;
        int knots = 0;
        for (const auto& expansion : path.expansions) knots += expansion.knots;
        EXPECT_EQ(knots, deep > 1.5e-13 ? 2 : 0) << deep;
        EXPECT_LE(path.expansions.size(), 9u) << deep;
        for (const auto& point : sample(w.model, path, w.branch, 240).points) {
            const double x = -0.06 + point.load, l = std::hypot(h, x);
            // of the jack along x
            const double force = support::stated_force(f, l - free_length) * x / l;
            EXPECT_NEAR(point.reactions[1].force.x(), force, 2e-8) << deep << " " << x;
        }
    }
}

// ---- A non-monotone curve: f rises to 100 N at 10 mm, falls to 50 at 20 mm, rises again.
Curve falling() { return {{0.01, 0.02}, {{100, 1e4, 0, 0}, {100, -5e3, 0, 0}, {50, 1e4, 0, 0}}}; }

TEST(SeriesPieces, ArcLengthPassesTurningPointsOfACurve) {
    const SideModel w =
        walked(on_the_x_axis({along_x("spring", falling())}), loaded(200, {push(0, 1)}));
    const Path path = follow(w.model, w.branch, {.arc_length = true});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    ASSERT_EQ(path.limits.size(), 2u);
    EXPECT_NEAR(path.limits[0], 100, 1e-10);
    EXPECT_NEAR(path.limits[1], 50, 1e-10);
    const auto sampled = sample(w.model, path, w.branch, 70);
    for (const auto& point : sampled.points)
        EXPECT_NEAR(support::stated_force(falling(), moved(point)), point.load, 1e-9);
    EXPECT_NEAR(sampled.points.back().load, 200, 1e-9);
}

TEST(SeriesPieces, EquilibriumAtTheStartIsFoundAcrossKnots) {
    for (const double held : {700.0, 3000.0, -900.0}) {
        const SideModel w =
            walked(on_the_x_axis({along_x("spring", rising())}), loaded(1500, {push(held, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& point : sample(w.model, path, w.branch, 30).points)
            EXPECT_LE(off(rising(), moved(point), held + point.load), 1e-12) << held;
    }
    // Exactly to a knot, and on from there, in both directions.
    for (const double to : {300.0, -300.0}) {
        const SideModel w = walked(on_the_x_axis({along_x("spring", LinearRate{20e3}),
                                                  along_x("stop", support::stop(0.03, 3e5))}),
                                   loaded(to, {push(600, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& point : sample(w.model, path, w.branch, 30).points)
            EXPECT_NEAR(moved(point), 0.03 + point.load / (to > 0 ? 320e3 : 20e3), 1e-12) << to;
    }
}

}  // namespace
}  // namespace elastocheck::recursive::series
