// Deformations of elements as computed by compare/, and ends of curves.
#include "compare/outputs/deformation.hpp"

#include <gtest/gtest.h>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Law = elastocheck::Curve;

constexpr double third = 1.0 / 3;

// f = 1000 x + 2e5 x³ between -0.02 and 0.03, linear beyond, given in two pieces.
Law cubic(bool known_outside = true) {
    const auto f = [](double x) { return 1000 * x + 2e5 * x * x * x; };
    const auto slope = [](double x) { return 1000 + 6e5 * x * x; };
    const auto about = [&](double x) {
        return std::array<double, 4>{f(x), slope(x), 6e5 * x, 2e5};
    };
    return {
        {-0.02, 0.01, 0.03},
        {{f(-0.02), slope(-0.02), 0, 0}, about(-0.02), about(0.01), {f(0.03), slope(0.03), 0, 0}},
        known_outside};
}

TEST(Laws, CurveForceEqualsItsPolynomialOnEveryPiece) {
    for (double x = -0.02; x <= 0.03; x += 0.0005)
        EXPECT_NEAR(force(ScalarLaw(cubic()), x), 1000 * x + 2e5 * x * x * x, 1e-11) << x;
    EXPECT_NEAR(force(ScalarLaw(cubic()), 0.05),
                1000 * 0.03 + 2e5 * 27e-6 + 0.02 * (1000 + 6e5 * 9e-4), 1e-11);
}

TEST(Laws, SteepestSlopeOfACurveIsFoundAtTheEndsAndInside) {
    EXPECT_NEAR(max_slope(cubic()), 1000 + 6e5 * 9e-4, 1e-9);
    EXPECT_EQ(max_slope(LinearRate{42}), 42);
    // f = 3 x² - 2 x³ is steepest halfway.
    EXPECT_NEAR(max_slope(Law{{0, 1}, {{0, 0, 0, 0}, {0, 0, 3, -2}, {1, 0, 0, 0}}}), 1.5, 1e-12);
}

struct Pair {
    Bushing bushing;
    Equilibrium state;
};
// A bushing from ground to a displaced and rotated body.
Pair turned(const Quaterniond& B, const Vector3d& d) {
    Pair pair;
    pair.bushing.j.body = 0;
    pair.state.poses = {{d, B}};
    return pair;
}

TEST(Deformation, AnglesEqualTheirNamedFormulation) {
    using Angles = Formulation::Angles;
    const Quaterniond cardan = Quaterniond(AngleAxisd(0.3, Vector3d::UnitX())) *
                               AngleAxisd(-0.2, Vector3d::UnitY()) *
                               AngleAxisd(0.5, Vector3d::UnitZ());
    auto [bushing, state] = turned(cardan, {0, 0, 0});
    bushing.formulation.angles = Angles::cardan;
    EXPECT_LE((deformation(bushing, state).tail<3>() - Vector3d(0.3, -0.2, 0.5)).norm(), 1e-15);
    const Vector3d theta(0.4, -0.3, 0.2);
    auto [other, turn] =
        turned(Quaterniond(AngleAxisd(theta.norm(), theta.normalized())), {0, 0, 0});
    EXPECT_LE((deformation(other, turn).tail<3>() - theta).norm(), 1e-15);
    // About one axis all three angle conventions agree.
    for (int axis = 0; axis < 3; ++axis) {
        auto [single, at] = turned(Quaterniond(AngleAxisd(0.7, Vector3d::Unit(axis))), {0, 0, 0});
        for (const auto angles : {Angles::rotation_vector, Angles::cardan, Angles::projected}) {
            single.formulation.angles = angles;
            EXPECT_LE((deformation(single, at).tail<3>() - 0.7 * Vector3d::Unit(axis)).norm(),
                      1e-15);
        }
    }
}

TEST(Deformation, ExchangedMarkersReverseTheDeformationInTheMiddleFrame) {
    const Vector3d theta(0.4, -0.3, 0.2), d(1e-3, 2e-3, -3e-3);
    auto [bushing, state] = turned(Quaterniond(AngleAxisd(theta.norm(), theta.normalized())), d);
    bushing.formulation.frame = Formulation::Frame::middle;
    Bushing other = bushing;
    std::swap(other.i, other.j);
    EXPECT_LE((deformation(bushing, state) + deformation(other, state)).norm(), 1e-16);
    bushing.formulation.frame = Formulation::Frame::on_i;
    EXPECT_LE((deformation(bushing, state).head<3>() - d).norm(), 1e-17) << "i is at rest";
}

TEST(Deformation, UndeformedOffsetIsSubtracted) {
    auto [bushing, state] = turned(Quaterniond::Identity(), {1e-3, 0, 0});
    bushing.undeformed = Vector6::Constant(third);
    EXPECT_LE((deformation(bushing, state) - Vector6::Unit(0) * 1e-3 + bushing.undeformed).norm(),
              1e-16);
}

// The paper's strut whose spring curve ends at 60 mm on both sides.
Scene short_table(bool known_outside) {
    Scene scene = support::scene("chrono_mcpherson");
    for (auto& branch : scene.branches) branch.steps = 30;
    for (auto& elastic : scene.elastics)
        if (auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            const double k = std::get<LinearRate>(spring->law).k, x = 0.06;
            spring->law = Law{
                {-x, x}, {{-k * x, k, 0, 0}, {-k * x, k, 0, 0}, {k * x, k, 0, 0}}, known_outside};
        }
    return scene;
}

TEST(OutsideTable, ExtrapolatedCurveHasTheRateOfItsEnd) {
    Scene linear = support::scene("chrono_mcpherson");
    for (auto& branch : linear.branches) branch.steps = 30;
    const Comparison straight = compare(compile(linear)),
                     curved = compare(compile(short_table(true)));
    EXPECT_TRUE(curved.conclusive());
    for (std::size_t b = 0; b < straight.branches.size(); ++b) {
        const Reading apart = at_equal_parameter(straight.branches[b].runs[1].curve,
                                                 curved.branches[b].runs[1].curve);
        for (std::size_t c = 0; c < 5; ++c)
            EXPECT_LE(apart.channels[c].max, 1e-8) << straight.channels[c].name;
        // Bounds depend on the largest stiffness and force, for any law.
        EXPECT_NEAR(curved.branches[b].bounds.force, straight.branches[b].bounds.force,
                    1e-9 * straight.branches[b].bounds.force);
    }
}

TEST(OutsideTable, EveryLegEndsTheBranchWhereTheDeformationLeavesTheTable) {
    const Model model = compile(short_table(false));
    const Comparison found = compare(model);
    EXPECT_FALSE(found.conclusive());
    for (std::size_t b = 0; b < found.branches.size(); ++b) {
        const auto& branch = found.branches[b];
        for (const auto& run : branch.runs) {
            EXPECT_EQ(run.outcome, Outcome::outside_table) << branch.branch << " " << name(run.leg);
            EXPECT_NE(run.detail.find("is deformed by"), run.detail.npos) << run.detail;
            EXPECT_NE(run.detail.find("60 mm"), run.detail.npos) << run.detail;
        }
        const auto &equilibrium = branch.runs[1], &energy = branch.runs[2];
        EXPECT_EQ(equilibrium.curve.a.size(), energy.curve.a.size());
        EXPECT_GT(equilibrium.curve.a.size(), 10u);
        EXPECT_LT(equilibrium.curve.a.size(), 31u);
        ASSERT_FALSE(branch.inconclusive.empty());
        EXPECT_NE(branch.inconclusive.worst.front().what.find("outside its table"),
                  std::string::npos)
            << branch.inconclusive.worst.front().what;
        const auto ways = sides_of(model, model.branches[b]);
        const auto points = solve_branch(ways, {.leg = Leg::equilibrium}).points;
        EXPECT_EQ(points.size(), equilibrium.curve.a.size());
        for (const auto& point : points)
            EXPECT_EQ(outside_table(ways.front().model, model.branches[b], point), "");
    }
}

}  // namespace
}  // namespace elastocheck::compare
