// compare/variants/: figures of variants against those of single solves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/design/figures.hpp"
#include "compare/variants/solve_variants.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare::variants {
namespace {

using Eigen::Index;

VariantFigure figure_at(const std::string& output, const std::string& branch, double at) {
    return {.name = output, .output = output, .branch = branch, .at = at};
}

// Positions, reactions, forces of elements and characteristics of variants are those of the series leg
// alone, of scenes with one-sided branches, with two-sided ones, and with parts that are active on
// some branches only.
TEST(VariantSolver, FiguresEqualThoseOfEachVariantAloneAndOfTheReference) {
    const struct {
        std::string scene, number;
        std::vector<VariantFigure> figures;
    } cases[]{
        {"mcpherson",
         "points.tie_rod_inner.z",
         {figure_at("toe", "jounce", 1500), figure_at("bump_steer", "rebound", -3000),
          figure_at("ball_joint.force_z", "jounce", 3000), figure_at("wheel_rate", "jounce", 0),
          figure_at("K4_arm_rear.displacement_x", "rebound", -750)}},
        {"front_axle",
         "points.tie_rod_inner_left.z",
         {figure_at("left.toe", "parallel", -0.04), figure_at("left.wheel_rate", "roll", 1000),
          figure_at("right.camber", "lateral", 3000), figure_at("left.toe", "steering", 0.05)}},
        {"chrono_mcpherson_travel",
         "points.tie_rod_inner.z",
         {figure_at("toe", "travel", -0.04), figure_at("camber", "travel", 0.08)}},
    };
    for (const auto& [name, number, figures] : cases) {
        const std::string file = ELASTOCHECK_SCENES "/" + name + ".yaml";
        const Scene scene = read_scene(file);
        const Model design = compile(trim(scene).scene);
        const VariantSolver solver(design, figures);
        const double nominal = std::ranges::find(scene.numbers, number, &Number::path)->value;
        std::vector<Scene> scenes;
        std::vector<Model> models;
        for (const double by : {-0.002, 0.0, 0.001, 0.003, 0.004}) {
            scenes.push_back(read_scene(file, std::vector{setting(number, nominal + by)}));
            models.push_back(compile(trim(scenes.back()).scene));
        }
        std::vector<Figure> plain;
        for (const auto& figure : figures)
            plain.push_back({.name = figure.output, .branch = figure.branch, .station = figure.at});
        const auto found = solver.solve(models);
        ASSERT_EQ(found.size(), models.size());
        for (std::size_t v = 0; v < models.size(); ++v) {
            EXPECT_EQ(found[v].outcome, outcome::solved) << found[v].reason;
            const auto reference = figure_values(scenes[v], plain, Leg::equilibrium);
            const auto alone = solver.solve_alone(models[v], Leg::equilibrium);
            for (std::size_t k = 0; k < figures.size(); ++k) {
                const double expected = reference.value[static_cast<Index>(k)];
                EXPECT_NEAR(found[v].values[k], expected, 1e-9 * (1 + std::abs(expected)))
                    << name << " " << figures[k].output;
                EXPECT_NEAR(alone.values[k], expected, 1e-9 * (1 + std::abs(expected)))
                    << name << " " << figures[k].output;
            }
        }
        EXPECT_GT(std::abs(found[4].values[0] - found[0].values[0]), 1e-6) << "nothing varies";
    }
}

// The strut of the design spins freely, which its analysis holds; that of the variant is resisted.
TEST(VariantSolver, CharacteristicsOfAVariantWithOtherIdleModesAreComputed) {
    const Model design = compile(read_scene(ELASTOCHECK_SCENES "/mcpherson.yaml"));
    Model resisted = design;
    for (Elastic& elastic : resisted.elastics)
        if (elastic.name == "K2_strut_mount")
            std::get<LinearStiffness>(std::get<Bushing>(elastic.kind).law).K(5, 5) = 100;
    const VariantSolver solver(design, {figure_at("bump_steer", "jounce", 3000)});
    const VariantFigures found = solver.solve(std::vector{resisted}).front(),
                         expected = solver.solve_alone(resisted, Leg::equilibrium);
    ASSERT_EQ(found.outcome, outcome::solved) << found.reason;
    EXPECT_NEAR(found.values[0], expected.values[0], 1e-9 * std::abs(expected.values[0]));
}

TEST(VariantSolver, ExtremesOverATwoSidedBranchAreThoseOfItsCurve) {
    const std::string file = ELASTOCHECK_SCENES "/chrono_mcpherson_travel.yaml";
    const Model design = compile(read_scene(file));
    const std::string branch = design.branches.front().name;
    std::vector<VariantFigure> figures;
    for (const Over over : {Over::least, Over::largest})
        figures.push_back({.name = "toe", .output = "toe", .branch = branch, .over = over});
    const VariantSolver solver(design, figures);
    const auto found = solver.solve(std::vector{design}).front();
    const auto sides = sides_of(design, design.branches.front());
    double least = 1e9, largest = -1e9;
    for (BranchSide side : sides) {
        side.branch.steps = solver.points();
        for (const auto& point : solve_branch(side, {.leg = Leg::equilibrium}).points) {
            const auto all = channels(design);
            const double toe =
                evaluate(design, point)[static_cast<std::size_t>(find_channel(all, "toe"))];
            least = std::min(least, toe);
            largest = std::max(largest, toe);
        }
    }
    EXPECT_NEAR(found.values[0], least, 1e-9);
    EXPECT_NEAR(found.values[1], largest, 1e-9);
    EXPECT_GT(largest - least, 1);
}

TEST(VariantSolver, EndOfABranchIsExplainedAndOtherFiguresAreKept) {
    const std::string file = ELASTOCHECK_SCENES "/two_spring_arch.yaml";
    Scene scene = read_scene(file);
    const Model design = compile(scene);
    const std::string branch = design.branches.front().name;
    const Branch& of = design.branches.front();
    std::string output;
    for (const Channel& channel : channels(design))
        if (output.empty() && channel.name.ends_with("_z")) output = channel.name;
    const VariantSolver solver(
        design, {figure_at(output, branch, 0),
                 figure_at(output, branch, of.to),
                 {.name = "least", .output = output, .branch = branch, .over = Over::least}});
    Model beyond = design;
    for (auto& driver : beyond.branches.front().drivers) driver.rate *= 50;
    const auto found = solver.solve(std::vector{design, beyond, design});
    EXPECT_EQ(found[0].outcome, outcome::solved) << found[0].reason;
    EXPECT_EQ(found[1].outcome, outcome::ended_early);
    EXPECT_NE(found[1].reason.find(branch), std::string::npos) << found[1].reason;
    EXPECT_TRUE(std::isfinite(found[1].values[0]));
    EXPECT_TRUE(std::isnan(found[1].values[1]));
    EXPECT_TRUE(std::isnan(found[1].values[2])) << "an extreme of a part of the branch";
    EXPECT_EQ(found[0].values, found[2].values) << "beside a variant that ends";
}

// A chain of bushings of 46 to 3e8 N/mm, on which series gives up.
TEST(VariantSolver, VariantThatTheSeriesDeclinesIsSolvedByTheEquilibriumLeg) {
    const Model design = compile(
        read_scene(ELASTOCHECK_SCENES "/../../tests/compare/scenes/stiff_beside_soft.yaml"));
    const VariantSolver solver(design, {figure_at("tip_z", "pull", 152.4)});
    EXPECT_EQ(solver.solve_alone(design, Leg::series).outcome, outcome::ended_early);
    const VariantFigures found = solver.solve(std::vector{design}).front();
    EXPECT_EQ(found.outcome, outcome::solved) << found.reason;
    EXPECT_EQ(found.leg, Leg::equilibrium);
    EXPECT_NE(found.reason.find("by the equilibrium leg, since series: branch 'pull': "),
              std::string::npos)
        << found.reason;
    EXPECT_EQ(found.values, solver.solve_alone(design, Leg::equilibrium).values);
}

TEST(VariantSolver, UnknownFiguresAreRejected) {
    const Model design = compile(read_scene(ELASTOCHECK_SCENES "/mcpherson.yaml"));
    const auto make = [&](const VariantFigure& figure) { return VariantSolver(design, {figure}); };
    EXPECT_THROW(make(figure_at("to", "jounce", 0)), std::invalid_argument);
    EXPECT_THROW(make(figure_at("toe", "jump", 0)), std::invalid_argument);
    EXPECT_THROW(make(figure_at("toe", "jounce", 3000 / std::numbers::pi)), std::invalid_argument);
    EXPECT_EQ(make(figure_at("toe", "jounce", 1500)).points(), 2);
    EXPECT_EQ(make(figure_at("toe", "jounce", 1100)).points(), 30);
}

}  // namespace
}  // namespace elastocheck::compare::variants
