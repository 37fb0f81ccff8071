// Second reference without the energy leg: where no energy exists, or the scene is too large, the
// equilibrium leg and the series judge each other; for a large scene the energy leg still judges
// the states.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// The paper's strut under a follower force on its wheel.
Scene follower() {
    Scene scene = support::scene("chrono_mcpherson");
    scene.branches.resize(1);
    scene.branches[0].steps = 20;
    auto& load = std::get<Load>(scene.branches[0].drivers[0].what);
    const auto dead = std::get<DeadForce>(load.kind);
    load.kind = FollowerForce{dead.at, dead.f};
    load.name = "kick";
    return scene;
}

TEST(SecondReference, IsTheSeriesUnderAFollowerLoad) {
    const Comparison found = compare(compile(follower()));
    const BranchComparison& branch = found.branches[0];
    EXPECT_TRUE(found.conclusive())
        << (branch.inconclusive.empty() ? "" : branch.inconclusive.worst.front().what);
    EXPECT_EQ(branch.second, Leg::series);
    EXPECT_NE(branch.why_not_energy.find("'kick'"), std::string::npos) << branch.why_not_energy;
    ASSERT_EQ(branch.runs.size(), 4u);
    EXPECT_EQ(branch.runs[2].outcome, Outcome::not_conservative);
    EXPECT_TRUE(branch.runs[2].curve.a.empty());
    EXPECT_EQ(branch.runs[3].leg, Leg::series);
    EXPECT_EQ(branch.uncertainty.b, Leg::series);
    for (std::size_t c = 0; c < found.channels.size(); ++c)
        if (found.channels[c].main) {
            const double off = branch.uncertainty.equal_parameter.channels[c].max;
            EXPECT_TRUE(std::isfinite(off) && off <= 1e-6) << found.channels[c].name << " " << off;
        }
    EXPECT_GT(found.compared, 100);
}

TEST(SecondReference, DisagreementWithTheSeriesIsReported) {
    const Model model = compile(follower());
    Comparison found = compare(model);
    BranchComparison& branch = found.branches[0];
    branch.uncertainty.equal_parameter.channels[0].max = 1;
    const Objections objections = disagreements(model, found.channels, model.branches[0], branch);
    ASSERT_FALSE(objections.empty());
    EXPECT_NE(objections.worst.front().what.find("the reference legs disagree on wheel_centre_x"),
              std::string::npos)
        << objections.worst.front().what;
}

TEST(SecondReference, StudiesUseTheSeriesUnderAFollowerLoad) {
    const Model model = compile(follower());
    const auto all = channels(model);
    const References known =
        references(model, all, model.branches[0], sides_of(model, model.branches[0], 10));
    EXPECT_TRUE(known.failures.empty()) << known.failures.front();
    EXPECT_EQ(known.second_leg, Leg::series);
    EXPECT_TRUE(known.uncertainty.mm <= 1e-6) << known.uncertainty.mm;
}

// A cantilever of bushings. The energy leg is given too few operations to solve it, but judges it.
const Model& chain() {
    static const Model model = [] {
        constexpr int n = 140;
        constexpr double h = 1.0 / n;
        using Eigen::Quaterniond, Eigen::Vector3d;
        Scene scene;
        scene.name = "chain";
        for (int b = 0; b < n; ++b) {
            scene.bodies.push_back(
                {fmt::format("b{}", b), {Vector3d(b * h, 0, 0), Quaterniond::Identity()}});
            Matrix6 K = Matrix6::Zero();
            K.diagonal() << Vector3d::Constant(1e6 * n), Vector3d::Constant(100 / h);
            const Marker i{b - 1, Vector3d(b == 0 ? 0 : h, 0, 0), Quaterniond::Identity()},
                j{b, Vector3d::Zero(), Quaterniond::Identity()};
            scene.elastics.push_back({fmt::format("k{}", b), Bushing{i, j, LinearStiffness{K}}});
        }
        const Point tip{n - 1, Vector3d(h, 0, 0)};
        scene.probes.push_back({"tip", tip});
        Branch up{.name = "up", .to = 50, .steps = 5, .drivers = {}};
        up.drivers.push_back({Load{"force", DeadForce{tip, Vector3d::UnitZ()}}, 0, 1});
        scene.branches.push_back(up);
        return compile(scene);
    }();
    return model;
}

const Comparison& compared_chain() {
    static const Comparison found = compare(chain(), {.energy = {.operation_limit = 1e6}});
    return found;
}

Residuals& witness(BranchComparison& branch) {
    return branch.runs[1].judged[static_cast<std::size_t>(Leg::energy)];
}

TEST(SecondReference, IsTheSeriesForALargeSceneWithEnergyLegResiduals) {
    BranchComparison branch = compared_chain().branches[0];
    EXPECT_TRUE(compared_chain().conclusive())
        << (branch.inconclusive.empty() ? "" : branch.inconclusive.worst.front().what);
    EXPECT_EQ(branch.runs[2].outcome, Outcome::too_large);
    EXPECT_NE(branch.why_not_energy.find("operations for 840 coordinates"), std::string::npos)
        << branch.why_not_energy;
    EXPECT_EQ(branch.second, Leg::series);
    EXPECT_TRUE(energy_judges_states(branch));
    const Residuals left = witness(branch);
    EXPECT_TRUE(std::isfinite(left.force) && left.force <= branch.bounds.residual_force)
        << left.force;
    EXPECT_TRUE(std::isfinite(left.moment) && left.moment <= branch.bounds.residual_moment)
        << left.moment;
}

TEST(SecondReference, EnergyLegResidualsReportABodyDisplacedByAMicrometre) {
    BranchComparison branch = compared_chain().branches[0];
    const BranchSide side = sides_of(chain(), chain().branches[0]).front();
    Equilibrium moved = branch.runs[1].landmarks.back.value();
    moved.poses[70].r.y() += 1e-6;
    witness(branch) = judge(Leg::energy, side, moved);
    const Objections objections =
        disagreements(chain(), compared_chain().channels, chain().branches[0], branch);
    ASSERT_EQ(objections.count, 1);
    EXPECT_TRUE(
        objections.worst[0].what.starts_with("the equilibrium leg's states have residuals of "))
        << objections.worst[0].what;
    EXPECT_NE(objections.worst[0].what.find("in the energy leg's equations"), std::string::npos)
        << objections.worst[0].what;
}

TEST(SecondReference, MissingEnergyLegResidualsMakeTheComparisonInconclusive) {
    BranchComparison branch = compared_chain().branches[0];
    witness(branch).moment = std::nan("");
    EXPECT_EQ(disagreements(chain(), compared_chain().channels, chain().branches[0], branch).count,
              1);
    branch = compared_chain().branches[0];
    witness(branch).length = 1e-6;
    EXPECT_EQ(disagreements(chain(), compared_chain().channels, chain().branches[0], branch).count,
              1);
}

TEST(SecondReference, SceneWithoutEnergyHasNoEnergyLegResiduals) {
    const Comparison found = compare(compile(follower()));
    EXPECT_FALSE(energy_judges_states(found.branches[0]));
}

}  // namespace
}  // namespace elastocheck::compare
