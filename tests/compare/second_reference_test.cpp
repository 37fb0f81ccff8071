// Where no energy exists the equilibrium leg and the series judge each other.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/compare.hpp"
#include "compare/study.hpp"
#include "models/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// The paper's strut pushed by a force that turns with its wheel.
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

TEST(SecondReference, IsTheSeriesWhereALoadTurnsWithItsBody) {
    const Comparison found = compare(compile(follower()));
    const BranchComparison& branch = found.branches[0];
    EXPECT_TRUE(found.conclusive()) << (branch.inconclusive.empty() ? ""
                                                                    : branch.inconclusive.worst.front().what);
    EXPECT_EQ(branch.second, Leg::series);
    EXPECT_NE(branch.no_energy.find("'kick'"), std::string::npos) << branch.no_energy;
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

TEST(SecondReference, IsTheSeriesWhereAFormulationHasNoEnergy) {
    Scene scene = support::scene("chrono_mcpherson");
    scene.branches.resize(1);
    scene.branches[0].steps = 20;
    for (auto& elastic : scene.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind)) bushing->formulation.offset_moment = false;
    const Comparison found = compare(compile(scene));
    EXPECT_EQ(found.branches[0].second, Leg::series);
    EXPECT_TRUE(found.conclusive()) << (found.branches[0].inconclusive.empty()
                                            ? ""
                                            : found.branches[0].inconclusive.worst.front().what);
}

TEST(SecondReference, StaysTheEnergyLegWhereEnergyExists) {
    Scene scene = support::scene("pinned_bar");
    scene.branches.resize(1);
    const Comparison found = compare(compile(scene));
    EXPECT_EQ(found.branches[0].second, Leg::energy);
    EXPECT_TRUE(found.branches[0].no_energy.empty());
    EXPECT_EQ(found.branches[0].runs.size(), 3u);
}

TEST(SecondReference, DisagreementWithTheSeriesIsSaid) {
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

TEST(SecondReference, StudiesTakeItToo) {
    const Model model = compile(follower());
    const auto all = channels(model);
    const References known = references(model, all, model.branches[0], ways_of(model, model.branches[0], 10));
    EXPECT_TRUE(known.failures.empty()) << known.failures.front();
    EXPECT_EQ(known.second_leg, Leg::series);
    EXPECT_NE(known.no_energy.find("'kick'"), std::string::npos);
    EXPECT_TRUE(known.uncertainty.mm <= 1e-6) << known.uncertainty.mm;
}

}  // namespace
}  // namespace elastocheck::compare
