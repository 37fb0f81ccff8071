// Spread of the outputs over bushing formulations.
#include "compare/studies/formulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "compare/comparison/compare.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

Scene mcpherson(double to = 0) {
    Scene scene = support::scene("chrono_mcpherson");
    for (auto& branch : scene.branches) {
        branch.steps = to > 0 ? 1 : 20;
        if (to > 0) branch.to = std::copysign(to, branch.to);
    }
    return scene;
}

// The paper's wheel is constrained fore and aft, independent of the formulation.
const std::string held = "wheel_centre_x";

// `export --formulation` converts every bushing except torsion springs, tyres, and bushings whose markers only
// change their order.
TEST(Formulations, ConversionChangesEveryBushingAndItsEffectIsTheDifference) {
    const Formulation target{.angles = Formulation::Angles::projected, .conjugate = false};
    Scene scene = support::scene("multi_link");
    const Conversion all = converted(scene, target);
    ASSERT_GT(all.bushings.size(), 3u);
    EXPECT_TRUE(converted(all.scene, target).bushings.empty());
    for (Elastic& elastic : scene.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind);
            bushing && elastic.name == all.bushings[0]) {
            bushing->formulation = target;
            bushing->formulation.frame = Formulation::Frame::on_j;
        }
    EXPECT_EQ(converted(scene, target).bushings.size(), all.bushings.size() - 1);
    const FormulationStudy study =
        spread_among({{"a", support::scene("multi_link")}, {"b", all.scene}}, 2);
    ASSERT_TRUE(study.conclusive());
    const Model before = compile(support::scene("multi_link")), after = compile(all.scene);
    double most = 0;
    for (std::size_t b = 0; b < study.branches.size(); ++b) {
        const Curve x = run(before, before.branches[b], Leg::equilibrium, {.steps = 2}).curve,
                    y = run(after, after.branches[b], Leg::equilibrium, {.steps = 2}).curve;
        for (const auto& found : study.branches[b].outputs) {
            const auto c = static_cast<std::size_t>(
                find_channel(channels(before), study.channels[found.channel].name));
            double largest = 0;
            for (std::size_t k = 0; k < x.a.size(); ++k)
                largest = std::max(largest, std::abs(x.values[k][c] - y.values[k][c]));
            EXPECT_NEAR(found.spread, largest, 1e-9) << study.channels[found.channel].name;
            most = std::max(most, found.spread);
        }
    }
    EXPECT_GT(most, 1e-4);
}

TEST(Formulations, SpreadIsTheLargestMinusTheSmallestResult) {
    const Scene scene = mcpherson();
    const FormulationStudy study = formulation_study(scene);
    ASSERT_TRUE(study.conclusive()) << study.inconclusive.front();
    ASSERT_EQ(study.branches.size(), 2u);
    for (std::size_t b = 0; b < study.branches.size(); ++b) {
        // In the paper's mount the strut is free to spin; a frame in the middle turns half as far,
        // and the mount's force then pushes the idle mode.
        ASSERT_EQ(study.branches[b].not_solved.size(), 1u);
        EXPECT_TRUE(
            study.branches[b].not_solved[0].starts_with("frame in the middle: loaded idle mode: "))
            << study.branches[b].not_solved[0];
        EXPECT_EQ(study.branches[b].solved.size(), formulations.size() - 1);
        std::vector<double> low(study.channels.size(), INFINITY),
            high(study.channels.size(), -INFINITY);
        for (const auto& [name, formulation] : formulations) {
            if (name == "frame in the middle") continue;
            const Model model = compile(formulation ? reformulated(scene, *formulation) : scene);
            const Curve end = run(model, model.branches[b], Leg::equilibrium).curve;
            for (const auto& found : study.branches[b].outputs)
                if (found.at == end.a.back()) {
                    low[found.channel] =
                        std::min(low[found.channel], end.values.back()[found.channel]);
                    high[found.channel] =
                        std::max(high[found.channel], end.values.back()[found.channel]);
                }
        }
        int at_end = 0;
        for (const auto& found : study.branches[b].outputs) {
            if (study.channels[found.channel].name == held) continue;
            EXPECT_GT(found.spread, 1e-4) << study.channels[found.channel].name;
            EXPECT_LT(found.spread, 5) << study.channels[found.channel].name;
            if (!std::isfinite(low[found.channel])) continue;
            ++at_end;
            EXPECT_NEAR(found.spread, high[found.channel] - low[found.channel], 1e-8);
        }
        EXPECT_GT(at_end, 0);
    }
}

TEST(Formulations, SpreadFallsAtLeastWithTheSquareOfTheLoad) {
    // Formulations differ by products of deformations.
    double spread_of_one = 0;
    for (const double load : {1.0, 10.0}) {
        const FormulationStudy study = formulation_study(mcpherson(load));
        ASSERT_TRUE(study.conclusive());
        double spread = 0;
        for (const auto& found : study.branches[0].outputs)
            if (study.channels[found.channel].unit == Unit::mm)
                spread = std::max(spread, found.spread);
        if (load == 1)
            spread_of_one = spread;
        else
            EXPECT_GT(spread, 50 * spread_of_one) << "second order or higher";
    }
    EXPECT_LT(spread_of_one, 1e-5);
}

TEST(Formulations, TorsionSpringsTyresAndBeamSegmentsKeepTheirFormulation) {
    Bushing bushing;
    Matrix6 K = Matrix6::Zero();
    K(2, 2) = 2e5;
    bushing.law = LinearStiffness{K};
    EXPECT_FALSE(is_reformulated({"tyre", bushing, true}));
    PerAxis torsion;
    torsion.axis[5] = LinearRate{40};
    bushing.law = torsion;
    EXPECT_FALSE(is_reformulated({"torsion bar", bushing}));
    bushing.law = LinearStiffness{Matrix6::Identity()};
    EXPECT_TRUE(is_reformulated({"mount", bushing}));
    bushing.formulation.frame = Formulation::Frame::middle;
    EXPECT_FALSE(is_reformulated({"beam.1", bushing}));
    EXPECT_FALSE(is_reformulated({"coil", AxialSpring{}}));
}

TEST(Formulations, UnsolvedFormulationIsNamedAndExcluded) {
    Scene scene = support::scene("two_spring_arch");
    scene.branches[0].to *= 2;  // past its limit point, for every formulation
    Bushing idle;
    idle.i.body = 0;
    idle.law = LinearStiffness{Matrix6::Identity() * 1e-6};
    scene.elastics.push_back({"soft", idle});
    const FormulationStudy study = formulation_study(scene);
    EXPECT_FALSE(study.conclusive());
    ASSERT_FALSE(study.branches.empty());
    EXPECT_EQ(study.branches[0].not_solved.size(), formulations.size());
}

TEST(Formulations, TableHasColumnsForSpreadUncertaintyAndDeviation) {
    const Scene scene = mcpherson();
    const Comparison comparison = compare(compile(scene));
    const FormulationStudy study = formulation_study(scene);
    const auto rows = formulation_rows(study, comparison);
    ASSERT_EQ(rows.size(), 2 * study.channels.size());
    for (const auto& row : rows) {
        if (row.output == held) continue;
        EXPECT_TRUE(row.apart < 1e-6) << row.output;
        EXPECT_TRUE(row.deviation > 1e-3) << row.output;
        EXPECT_GT(row.spread, 100 * row.apart)
            << "tools differ by more than the references are uncertain";
    }
}

}  // namespace
}  // namespace elastocheck::compare
