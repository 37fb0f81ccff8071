// The series method with drivers other than loads, and with start values.
// Offsets, angles, free lengths, preloads.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <thread>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/path.hpp"
#include "tests/recursive/random.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive::series {
namespace {

// Newton's method with dense factors from `start`; minimum-norm steps along idle modes.
Equilibrium newton(const OneWay& w, double a, const std::vector<Pose>& start) {
    const int n = coordinates(w.model), m = constraint_rows(w.model);
    const Inputs<double> inputs = inputs_at<double>(w.model, w.branch, a);
    State<double> q = state_of<double>(start);
    Vector<double> lambda = Vector<double>::Zero(m), f, f_ext, f_elast, Phi(m), step;
    SaddleMatrix<double> kept = saddle_matrix(w.model);
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 60; ++k) {
        assemble_consistent<double>(w.model, w.branch, inputs, q, lambda, kept, Phi);
        const Matrix<double> M = sparse(kept);
        external_force<double>(w.model, w.branch, inputs, q, f_ext);
        elastic_force<double>(w.model, inputs, q, f_elast);
        constraint_force<double>(w.model, inputs, q, lambda, f, Phi);
        Vector<double> right(n + m);
        right << f_ext - f_elast - f, -Phi;
        const Vector<double> D = equilibration(kept);
        Eigen::CompleteOrthogonalDecomposition<Matrix<double>> factors;
        factors.setThreshold(1e-10);
        factors.compute(D.asDiagonal() * M * D.asDiagonal());
        step = D.asDiagonal() * factors.solve(Vector<double>(D.asDiagonal() * right));
        const double size = step.head(n).norm();
        if (k > 3 && size < 1e-13 && !(size < before)) break;
        before = size;
        advance(q, step.head(n));
        lambda += step.tail(m);
    }
    EXPECT_LE(before, 1e-12) << "Newton did not converge";
    Equilibrium point{a, start, std::vector<Wrench>(w.model.joints.size()), 0};
    record<double>(w.model, inputs, q, q, lambda, a, point);
    return point;
}

Scene mcpherson_on_a_jack(Branch& branch) {
    Scene scene = support::scene("chrono_mcpherson");
    const Wheel& wheel = scene.wheels[0];
    const Eigen::Vector3d centre =
        scene.bodies[static_cast<std::size_t>(wheel.body)].design.r +
        scene.bodies[static_cast<std::size_t>(wheel.body)].design.p * wheel.centre_local;
    scene.joints.push_back({"jack",
                            InPlane{{wheel.body, wheel.centre_local},
                                    {ground, centre},
                                    {ground, Eigen::Vector3d::UnitZ()},
                                    0},
                            true});
    branch.name = "travel";
    branch.unit = ParameterUnit::metre;
    branch.steps = 100;
    branch.drivers = {{Motion{static_cast<int>(scene.joints.size()) - 1}, 0, 1}};
    return scene;
}

// ---- Mechanisms without elasticity against exact geometry.

const Direction along_z{ground, Eigen::Vector3d::UnitZ()};
Direction z_of(BodyId body) { return {body, Eigen::Vector3d::UnitZ()}; }
Body bar(const std::string& name, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return {name, {from, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), to - from)}};
}
Joint hinge(const std::string& name, BodyId i, const Eigen::Vector3d& on_i, BodyId j,
            const Eigen::Vector3d& on_j) {
    return {name, Revolute{{i, on_i}, {j, on_j}, z_of(i), z_of(j)}};
}
Joint crank_drive(BodyId crank) {
    return {"drive", Angle{{crank, Eigen::Vector3d::UnitX()},
                           {ground, Eigen::Vector3d::UnitX()},
                           {ground, Eigen::Vector3d::UnitY()},
                           0}};
}
Branch full_turn(int joint) {
    Branch branch;
    branch.name = "turn";
    branch.to = 2 * std::numbers::pi;
    branch.steps = 360;
    branch.unit = ParameterUnit::radian;
    branch.drivers = {{Motion{joint}, 0, 1}};
    return branch;
}

TEST(SeriesDrivers, SliderCrankGoesAFullTurn) {
    const double r = 0.1, l = 0.27;
    Scene scene;
    const Eigen::Vector3d O(0, 0, 0), A(r, 0, 0), B(r + l, 0, 0);
    scene.bodies = {bar("crank", O, A), bar("rod", A, B)};
    scene.joints = {
        hinge("main", 0, O, ground, O),
        hinge("pin", 0, A, 1, O),
        {"slide", InPlane{{1, {l, 0, 0}}, {ground, O}, {ground, Eigen::Vector3d::UnitY()}, 0}},
        crank_drive(0)};
    scene.probes = {{"slider", {1, {l, 0, 0}}}};
    const OneWay w = walked(scene, full_turn(3));
    ASSERT_EQ(w.model.bodies.size(), 2u);
    const Path path = follow(w.model, w.branch, {.tolerance = 1e-14});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    double worst = 0;
    const auto sampled = sample(w.model, path, w.branch, 360);
    ASSERT_EQ(sampled.points.size(), 361u);
    for (const auto& point : sampled.points) {
        const double x =
            r * std::cos(point.load) + std::sqrt(l * l - std::pow(r * std::sin(point.load), 2));
        const Eigen::Vector3d slider =
            point.poses[1].r + point.poses[1].p * Eigen::Vector3d(l, 0, 0);
        worst = std::max(worst, (slider - Eigen::Vector3d(x, 0, 0)).norm() / x);
    }
    EXPECT_LE(worst, 1e-12);
}

// ---- Start values.

TEST(SeriesDrivers, WhatIsHeldIsSettledFirst) {
    // Combined: the jack held 30 mm up, a preload in a bushing, a free length 20 mm longer, a
    // rearward load; then the travel changes.
    Branch branch;
    branch.to = 0.05;
    Scene scene = mcpherson_on_a_jack(branch);
    branch.drivers[0].start = 0.03;
    Preload preload{0, Vector6<double>::Zero()};
    preload.direction << 300, -200, 1500, 0, 0, 0;
    for (std::size_t k = 0; k < scene.elastics.size(); ++k)
        if (std::holds_alternative<AxialSpring>(scene.elastics[k].kind))
            branch.drivers.push_back({FreeLength{static_cast<int>(k)}, 0.02, 0.1});
        else if (preload.direction[0] == 300 &&
                 scene.elastics[k].name.find("arm_front") != std::string::npos)
            preload.elastic = static_cast<int>(k);
    branch.drivers.push_back({preload, 1, 3});
    branch.drivers.push_back(
        {Load{"brake", DeadForce{{scene.wheels[0].body, scene.wheels[0].contact_local},
                                 Eigen::Vector3d(-1, 0, 0)}},
         800, 1e4});
    const OneWay w = walked(scene, branch);
    const Path path = follow(w.model, w.branch);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const auto sampled = sample(w.model, path, w.branch, 20);
    ASSERT_EQ(sampled.points.size(), 21u);
    double worst = 0;
    for (const auto& point : sampled.points)
        worst = std::max(worst, apart(w.model, point, newton(w, point.load, point.poses)));
    EXPECT_LE(worst, 1e-12);
}

// ---- Regression scenes: the result is right, or the outcome is a failure.

TEST(SeriesFound, WhatConvergesIsAnEquilibriumOfTheSameBranch) {
    for (const char* name : {"adaptive-segfault-arch", "adaptive-segfault-five-links"}) {
        const Model model = found(name);
        for (const auto& branch : model.branches) {
            const Path path = follow(model, branch);
            EXPECT_FALSE(path.outcome != Outcome::converged && path.detail.empty());
            const OneWay w{model, branch};
            const auto sampled = sample(model, path, branch, 20);
            for (const auto& point : sampled.points)
                EXPECT_LE(apart(model, point, newton(w, point.load, point.poses)), 1e-11)
                    << name << " " << point.load;
            EXPECT_TRUE(
                path.outcome == Outcome::converged || path.outcome == Outcome::limit_point ||
                path.outcome == Outcome::bifurcation_point || path.outcome == Outcome::singular)
                << name << " " << path.detail;
        }
    }
}

// ---- One analysis shared by branches and threads.

TEST(Analysis, ServesBranchesAndThreadsAlike) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    const Analysis analysis = analyse(model);
    std::vector<Path> shared(4);
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < shared.size(); ++k)
        threads.emplace_back(
            [&, k] { shared[k] = follow(model, model.branches[k % 2], {}, analysis); });
    for (auto& thread : threads) thread.join();
    for (std::size_t k = 0; k < shared.size(); ++k) {
        const Path own = follow(model, model.branches[k % 2]);
        ASSERT_EQ(own.expansions.size(), shared[k].expansions.size());
        EXPECT_EQ(own.expansions.back().x, shared[k].expansions.back().x);
    }
}

TEST(Analysis, OfAnotherModelIsRefused) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    EXPECT_THROW(
        follow(model, model.branches[0], {}, analyse(compile(support::scene("pinned_bar")))),
        std::invalid_argument);
}

// ---- Sparsity pattern of (24).

// The matrix at a random state, without accidental zeros.
Matrix<double> anywhere(const Model& model, Random& random, Pattern& pattern) {
    State<double> q = design_state<double>(model);
    Vector<double> dq(coordinates(model)), lambda(constraint_rows(model)),
        Phi(constraint_rows(model));
    for (auto& value : dq) value = random(-0.3, 0.3);
    for (auto& value : lambda) value = random(-1e3, 1e3);
    advance(q, dq);
    SaddleMatrix<double> M = saddle_matrix(model);
    const Branch& branch = model.branches[0];
    assemble_consistent<double>(model, branch, inputs_at<double>(model, branch, branch.to / 2), q,
                                lambda, M, Phi);
    pattern = recursive::pattern(model);
    return sparse(M);
}

struct Coverage {
    // Entries: in the pattern; non-zero in some state; of these outside the pattern.
    double held = 0, met = 0, missed = 0;
};
Coverage coverage(const Model& model, Random& random) {
    Pattern pattern;
    Eigen::ArrayXXd met;
    for (int trial = 0; trial < 5; ++trial) {
        const Matrix<double> M = anywhere(model, random, pattern);
        if (trial == 0) met.setZero(M.rows(), M.cols());
        met = met.max((M.array() != 0).cast<double>());
    }
    Coverage result{static_cast<double>(pattern.entries()), met.sum(), 0};
    for (int j = 0; j < pattern.size; ++j)
        for (int e = pattern.first[static_cast<std::size_t>(j)];
             e < pattern.first[static_cast<std::size_t>(j) + 1]; ++e)
            met(pattern.row[static_cast<std::size_t>(e)], j) = 0;
    result.missed = met.sum();
    return result;
}

TEST(Pattern, HoldsAllThatIsNotZero) {
    Random random;
    for (const auto& name : support::small_scene_names())
        EXPECT_EQ(coverage(compile(support::scene(name)), random).missed, 0) << name;
}

TEST(Pattern, OfASuspensionIsAtMostATwentiethMoreThanThat) {
    // Planar mechanisms are excluded: their pattern includes the third dimension.
    Random random;
    for (const char* name :
         {"chrono_mcpherson", "chrono_mcpherson_preload", "chrono_mcpherson_travel"}) {
        const Coverage c = coverage(compile(support::scene(name)), random);
        EXPECT_LE(c.held, 1.05 * c.met) << name;
    }
}

}  // namespace
}  // namespace elastocheck::recursive::series
