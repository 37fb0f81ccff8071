// The series method with drivers other than loads, and with start values.
// Offsets, angles, free lengths, preloads.
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "recursive/series/path.hpp"
#include "tests/recursive/random.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive::series {
namespace {

// The point is an equilibrium within rounding: 1e-5 N of elements of up to 1e8 N/m.
void expect_balance(const SideModel& w, const Equilibrium& point) {
    const Residuals left = recursive::residuals(w.model, w.branch, point);
    EXPECT_LE(std::max(left.force, left.moment), 1e-5) << point.load;
    EXPECT_LE(left.length, 1e-12) << point.load;
}

TEST(SeriesDrivers, HeldValuesAreSettledBeforeTheBranch) {
    // Combined: the jack held 30 mm up, a preload in a bushing, a free length 20 mm longer, a
    // rearward load; then the travel changes.
    Scene scene = support::scene("chrono_mcpherson");
    const Wheel& wheel = scene.wheels[0];
    const Eigen::Vector3d centre =
        scene.bodies[static_cast<std::size_t>(wheel.body)].design.r + wheel.centre_local;
    scene.joints.push_back({"jack",
                            InPlane{{wheel.body, wheel.centre_local},
                                    {ground, centre},
                                    {ground, Eigen::Vector3d::UnitZ()},
                                    0},
                            true});
    const Motion jack{static_cast<int>(scene.joints.size()) - 1};
    Branch branch{"travel", 0, 0.05, 100, ParameterUnit::metre, {{jack, 0, 1}}};
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
        {Load{"brake", DeadForce{scene.wheels[0].contact, Eigen::Vector3d(-1, 0, 0)}}, 800, 1e4});
    const SideModel w = walked(scene, branch);
    const Path path = follow(w.model, w.branch);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const auto sampled = sample(w.model, path, w.branch, 20);
    ASSERT_EQ(sampled.points.size(), 21u);
    for (const auto& point : sampled.points) {
        expect_balance(w, point);
        const Pose& pose = point.poses[static_cast<std::size_t>(wheel.body)];
        EXPECT_NEAR((pose.r + pose.p * wheel.centre_local - centre).z(), 0.03 + point.load, 1e-13);
    }
}

// ---- Regression scenes: the result is right, or the outcome is a failure.

TEST(SeriesRegression, PointsOfScenesThatOnceCrashedAreEquilibria) {
    for (const char* name : {"adaptive-segfault-arch", "adaptive-segfault-five-links"}) {
        const Model model = found(name);
        for (const auto& branch : model.branches) {
            const Path path = follow(model, branch);
            EXPECT_FALSE(path.outcome != Outcome::converged && path.detail.empty());
            const SideModel w{model, branch};
            const auto sampled = sample(model, path, branch, 20);
            for (const auto& point : sampled.points) expect_balance(w, point);
            EXPECT_TRUE(
                path.outcome == Outcome::converged || path.outcome == Outcome::limit_point ||
                path.outcome == Outcome::bifurcation_point || path.outcome == Outcome::singular)
                << name << " " << path.detail;
        }
    }
}

// ---- One analysis shared by branches; tests/threads shares models between threads.

TEST(Analysis, AnalysisOfAnotherModelIsRejected) {
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
    const auto inputs = inputs_at<double>(model, branch, branch.to / 2);
    assemble_constraints<double>(model, inputs, q, M, Phi);
    add_consistent_tangent<double>(model, branch, inputs, q, lambda, M);
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

TEST(TangentPattern, CoversEveryNonzeroEntry) {
    Random random;
    for (const auto& name : support::small_scene_names())
        EXPECT_EQ(coverage(compile(support::scene(name)), random).missed, 0) << name;
}

TEST(TangentPattern, HasAtMostFivePercentStructuralZerosOnASuspension) {
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
