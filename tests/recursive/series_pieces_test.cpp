// The series method across pieces of force curves; formulations and followers on branches.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/series/path.hpp"
#include "recursive/series/pieces.hpp"
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

// f = k (x - c) for x > c, else 0.
Curve stop(double c, double k) { return {{c}, {{0, 0, 0, 0}, {0, k, 0, 0}}}; }
// f = below · x for x < 0, above · x for x > 0.
Curve bent(double below, double above) { return {{0}, {{0, below, 0, 0}, {0, above, 0, 0}}}; }

double value(const Curve& f, double x) {
    std::size_t piece = 0;
    while (piece < f.knots.size() && x >= f.knots[piece]) ++piece;
    const double t = x - f.knots[piece == 0 ? 0 : piece - 1];
    const auto& c = f.pieces[piece];
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}
// Hermite interpolant with the given slopes, linear outside.
Curve hermite(const std::vector<double>& x, const std::vector<double>& f,
              const std::vector<double>& slope) {
    Curve curve{x, {{f[0], slope[0], 0, 0}}};
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
        const double h = x[k + 1] - x[k], s = (f[k + 1] - f[k]) / h;
        curve.pieces.push_back({f[k], slope[k], (3 * s - 2 * slope[k] - slope[k + 1]) / h,
                                (slope[k] + slope[k + 1] - 2 * s) / (h * h)});
    }
    curve.pieces.push_back({f.back(), slope.back(), 0, 0});
    return curve;
}
// Distance from the curve's inverse, to first order [m].
double off(const Curve& f, double x, double force) {
    const double h = 1e-7, slope = (value(f, x + h) - value(f, x - h)) / (2 * h);
    return std::abs((value(f, x) - force) / slope);
}
Curve rising() {
    return hermite({-0.03, -0.01, 0, 0.005, 0.02, 0.04}, {-2000, -300, 0, 100, 900, 4000},
                   {120e3, 40e3, 22e3, 25e3, 90e3, 200e3});
}

TEST(SeriesPieces, ABodyOnACurveMovesByItsInverse) {
    for (const double to : {6000.0, -4000.0}) {
        const OneWay w =
            walked(on_the_x_axis({along_x("spring", rising())}), loaded(to, {push(0, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        int knots = 0;
        for (const auto& expansion : path.expansions) knots += expansion.knots;
        // each knot crossed is counted once; the one at the start is not
        EXPECT_EQ(knots, to > 0 ? 3 : 2);
        double worst = 0;
        const auto sampled = sample(w.model, path, w.branch, 400);
        ASSERT_EQ(sampled.points.size(), 401u);
        for (const auto& point : sampled.points)
            worst = std::max(worst, off(rising(), moved(point), point.load));
        EXPECT_LE(worst, 1e-12) << to;  // 1e-9 mm
    }
}

TEST(SeriesPieces, AnExpansionEndsWhereTheKnotIs) {
    const OneWay w =
        walked(on_the_x_axis({along_x("spring", rising())}), loaded(6000, {push(0, 1)}));
    const Path path = follow(w.model, w.branch);
    std::vector<double> met;
    for (std::size_t k = 0; k + 1 < path.expansions.size(); ++k)
        if (path.expansions[k].knots > 0)
            met.push_back(path.expansions[k + 1].start[slider].r.x() - 1);
    ASSERT_EQ(met.size(), 3u);
    EXPECT_NEAR(met[0], 0.005, 1e-15);
    EXPECT_NEAR(met[1], 0.02, 1e-15);
    EXPECT_NEAR(met[2], 0.04, 1e-15);
}

TEST(SeriesPieces, TwoStopsThatCloseAtOnceArePassedAtOnce) {
    // ... two knots at the same place within rounding.
    for (const double apart : {-1e-17, 0.0, 1e-17, 1e-15, 1e-12, 1e-9}) {
        const OneWay w = walked(
            on_the_x_axis({along_x("spring", LinearRate{20e3}), along_x("left", stop(0.03, 1e5)),
                           along_x("right", stop(0.03 + apart, 2e5))}),
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

TEST(SeriesPieces, FromAKnotTheMotionGoesIntoItsOwnPiece) {
    // A curve with its kink at the design position, or within rounding of it.
    for (const double drawn : {0.0, 1e-17, -1e-17, 1e-16, -1e-16})
        for (const double to : {500.0, -500.0})
            for (const bool arc : {false, true}) {
                const OneWay w = walked(on_the_x_axis({along_x("spring", bent(10e3, 40e3), drawn)}),
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

TEST(SeriesPieces, ManyKnotsAtTheStartAgreeOnTheirPieces) {
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
        const OneWay w = walked(
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

TEST(SeriesPieces, AKnotThatIsGrazedIsNotGoneOver) {
    // The spring is shortest at x = 0, where its stretch is h - ℓ₀ = `deep` beyond the knot at 0.
    const double h = 0.1;
    for (const double deep : {0.0, 1e-17, -1e-17, 1e-16, -1e-16, 1e-14, -1e-14, 5e-14, -1e-13,
                              1e-12, -1e-12, 1e-10, -1e-10, 1e-6, -1e-6}) {
        const Curve f = bent(200e3, 4e3);
        const double free_length = h + deep;
        const OneWay w = walked(beside_the_rail(h, f, free_length, -0.06), jacked(0.12));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << deep << path.detail;
        int knots = 0;
        for (const auto& expansion : path.expansions) knots += expansion.knots;
        EXPECT_EQ(knots, deep > 1.5e-13 ? 2 : 0) << deep;
        EXPECT_LE(path.expansions.size(), 9u) << deep;
        for (const auto& point : sample(w.model, path, w.branch, 240).points) {
            const double x = -0.06 + point.load, l = std::hypot(h, x);
            const double force = value(f, l - free_length) * x / l;  // of the jack along x
            EXPECT_NEAR(point.reactions[1].force.x(), force, 2e-8) << deep << " " << x;
        }
    }
}

TEST(SeriesPieces, FromAKnotAMotionBeginsAcrossTheSpring) {
    // The stretch starts as x² / 2h: its first coefficient is zero.
    const double h = 0.1;
    for (const double to : {0.05, -0.05})
        for (const auto& f : {bent(200e3, 4e3), bent(4e3, 200e3)}) {
            const OneWay w = walked(beside_the_rail(h, f, h, 0), jacked(to));
            const Path path = follow(w.model, w.branch);
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            for (const auto& point : sample(w.model, path, w.branch, 100).points) {
                const double x = point.load, l = std::hypot(h, x);
                EXPECT_NEAR(point.reactions[1].force.x(), value(f, l - h) * x / l, 2e-7);
            }
        }
}

// ---- A non-monotone curve: f rises to 100 N at 10 mm, falls to 50 at 20 mm, rises again.
Curve falling() { return {{0.01, 0.02}, {{100, 1e4, 0, 0}, {100, -5e3, 0, 0}, {50, 1e4, 0, 0}}}; }

TEST(SeriesPieces, ArcLengthGoesOnThroughTheTurnsOfACurve) {
    const OneWay w =
        walked(on_the_x_axis({along_x("spring", falling())}), loaded(200, {push(0, 1)}));
    const Path path = follow(w.model, w.branch, {.arc_length = true});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    ASSERT_EQ(path.limits.size(), 2u);
    EXPECT_NEAR(path.limits[0], 100, 1e-10);
    EXPECT_NEAR(path.limits[1], 50, 1e-10);
    const auto sampled = sample(w.model, path, w.branch, 70);
    for (const auto& point : sampled.points)
        EXPECT_NEAR(value(falling(), moved(point)), point.load, 1e-9);
    EXPECT_NEAR(sampled.points.back().load, 200, 1e-9);
}

TEST(SeriesPieces, WhatIsHeldSettlesOverKnotsToo) {
    for (const double held : {700.0, 3000.0, -900.0}) {
        const OneWay w =
            walked(on_the_x_axis({along_x("spring", rising())}), loaded(1500, {push(held, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& point : sample(w.model, path, w.branch, 30).points)
            EXPECT_LE(off(rising(), moved(point), held + point.load), 1e-12) << held;
    }
    // Exactly to a knot, and on from there, in both directions.
    for (const double to : {300.0, -300.0}) {
        const OneWay w = walked(
            on_the_x_axis({along_x("spring", LinearRate{20e3}), along_x("stop", stop(0.03, 3e5))}),
            loaded(to, {push(600, 1)}));
        const Path path = follow(w.model, w.branch);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& point : sample(w.model, path, w.branch, 30).points)
            EXPECT_NEAR(moved(point), 0.03 + point.load / (to > 0 ? 320e3 : 20e3), 1e-12) << to;
    }
}

// ---- Formulations along a branch: an arm on two bushings of any formulation, rotated by tenths of
// a radian.

TEST(SeriesFormulations, EveryOneHoldsInItsOwnFullEquations) {
    using Frame = Formulation::Frame;
    using Angles = Formulation::Angles;
    Random random;
    Matrix6<double> K = Matrix6<double>::Zero();
    K.diagonal() << 2e5, 3e5, 1e5, 300, 200, 400;
    for (const Frame frame : {Frame::on_i, Frame::on_j, Frame::middle})
        for (const Angles angles : {Angles::rotation_vector, Angles::cardan, Angles::projected})
            for (const bool conjugate : {true, false})
                for (const bool offset_moment : {true, false}) {
                    if (!conjugate && frame == Frame::middle) continue;
                    Scene scene;
                    scene.bodies = {
                        {"arm", {Eigen::Vector3d(0.2, 0, 0), Eigen::Quaterniond::Identity()}}};
                    for (const double side : {-0.1, 0.1}) {
                        Bushing e{{ground, Eigen::Vector3d(0, side, 0), random.rotation(0.3)},
                                  {0, Eigen::Vector3d(-0.2, side, 0), random.rotation(0.3)},
                                  LinearStiffness{K + 1e-2 * random.stiffness()}};
                        e.formulation = {frame, angles, conjugate, offset_moment};
                        e.undeformed = Vector6<double>::Constant(1e-3);
                        scene.elastics.push_back({"bushing", e});
                    }
                    scene.probes = {{"tip", {0, Eigen::Vector3d(0.2, 0, 0)}}};
                    const Load load{"tip", DeadForce{{0, Eigen::Vector3d(0.2, 0, 0)},
                                                     Eigen::Vector3d(0, 0.2, 1)}};
                    const OneWay w = walked(scene, loaded(300, {{load, 0, 1}}));
                    const Path path = follow(w.model, w.branch);
                    const std::string what = std::to_string(static_cast<int>(frame)) +
                                             std::to_string(static_cast<int>(angles)) +
                                             (conjugate ? "" : " free") +
                                             (offset_moment ? "" : " offset");
                    ASSERT_EQ(path.outcome, Outcome::converged) << what << path.detail;
                    const auto sampled = sample(w.model, path, w.branch, 20);
                    ASSERT_EQ(sampled.points.size(), 21u);
                    for (const auto& point : sampled.points) {
                        const auto left = recursive::residuals(w.model, w.branch, point);
                        EXPECT_LE(std::max(left.force, left.moment), 1e-9 * 300)
                            << what << point.load;
                    }
                }
}

// n bodies along x, connected to each other and to ground by beams of length L between their
// origins.
Scene chain(int n, double L) {
    Scene scene;
    Matrix6<double> K = Matrix6<double>::Zero();
    const double EA = 8e7, EI = 2.4e3, GJ = 1.8e3;
    K.diagonal() << EA / L, 12 * EI / (L * L * L), 12 * EI / (L * L * L), GJ / L, EI / L, EI / L;
    for (int b = 0; b < n; ++b)
        scene.bodies.push_back(
            {"b" + std::to_string(b),
             {Eigen::Vector3d((b + 1) * L, 0, 0), Eigen::Quaterniond::Identity()}});
    for (int b = 0; b < n; ++b) {
        const Eigen::Vector3d half(L / 2, 0, 0);
        Bushing e{{b == 0 ? ground : b - 1, half}, {b, -half}, LinearStiffness{K}};
        e.formulation.frame = Formulation::Frame::middle;
        scene.elastics.push_back({"beam", e});
    }
    scene.probes = {{"tip", {n - 1, Eigen::Vector3d::Zero()}}};
    return scene;
}

TEST(SeriesFormulations, AChainOfBeamsHoldsInItsFullEquations) {
    const int n = 5;
    const Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (const LoadKind& kind : {LoadKind(DeadForce{{n - 1, at}, Eigen::Vector3d(0, 0.3, 1)}),
                                 LoadKind(FollowerForce{{n - 1, at}, Eigen::Vector3d(0, 0.3, 1)}),
                                 LoadKind(FollowerMoment{n - 1, Eigen::Vector3d(0.4, 0, 1)})}) {
        const OneWay w = walked(chain(n, 0.2), loaded(3000, {{Load{"tip", kind}, 0, 1}}));
        // A beam has 4e8 N/m along itself: at the usual 1e-12 m the error would be 2e-9 of the
        // load.
        const Path path = follow(w.model, w.branch, {.tolerance = 1e-13});
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        const auto sampled = sample(w.model, path, w.branch, 50);
        ASSERT_EQ(sampled.points.size(), 51u);
        double turned = 0;
        for (const auto& point : sampled.points) {
            const auto left = recursive::residuals(w.model, w.branch, point);
            EXPECT_LE(std::max(left.force, left.moment), 1e-9 * 3000)
                << kind.index() << " at " << point.load;
            turned = std::max(turned,
                              point.poses.back().p.angularDistance(Eigen::Quaterniond::Identity()));
        }
        EXPECT_GT(turned, 0.3) << kind.index();
    }
}

}  // namespace
}  // namespace elastocheck::recursive::series
