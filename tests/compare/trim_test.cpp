// Trim: closed forms, equilibrium after the trim, and all ill-posed or unreachable cases.
#include "elastocheck/trim.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/comparison/legs.hpp"
#include "compare/comparison/trim.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// A block on a vertical slide and a spring of 20 N/mm, 0.4 m long in the design position,
// under 500 N.
Scene block() { return support::scene_of("compare/scenes/block"); }

Trim::Adjustment preload(const Scene& scene, const std::string& spring) {
    for (std::size_t k = 0; k < scene.elastics.size(); ++k)
        if (scene.elastics[k].name == spring) {
            const auto& e = std::get<AxialSpring>(scene.elastics[k].kind);
            return {.name = "springs." + spring + ".preload",
                    .what = FreeLength{static_cast<int>(k)},
                    .per_unit = 1 / std::get<LinearRate>(e.law).k,
                    .unit = ParameterUnit::newton};
        }
    throw std::logic_error(spring);
}
Trim::Condition height(std::optional<double> value = {}) {
    return {"top.z", ProbeCoordinate{0, 2}, value};
}

// The paper's strut under a corner weight, with its original spring.
Scene mcpherson() {
    Scene scene = support::scene("chrono_mcpherson");
    const Wheel& wheel = scene.wheels[0];
    scene.static_loads.push_back(
        {"weight", DeadForce{{wheel.body, wheel.centre_local}, {0, 0, 3500}}});
    std::string spring;
    for (const auto& elastic : scene.elastics)
        if (std::holds_alternative<AxialSpring>(elastic.kind)) spring = elastic.name;
    scene.trim = Trim{{preload(scene, spring)}, {{"travel", WheelTravel{0}, std::nullopt}}};
    return scene;
}

std::string complaint(const Scene& scene) {
    try {
        (void)trim(scene);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

TEST(Trim, PreloadOfASpringUnderABlockIsItsWeight) {
    Scene scene = block();
    scene.elastics.resize(1);
    scene.trim = Trim{{preload(scene, "coil")}, {height()}};
    const Trimmed found = trim(scene);
    ASSERT_TRUE(found.record && found.record->reached()) << found.record->detail;
    EXPECT_NEAR(found.record->adjusted[0].change, 500, 1e-6);
    EXPECT_NEAR(std::get<AxialSpring>(found.scene.elastics[0].kind).free_length, 0.4 + 500 / 20e3,
                1e-10);
    EXPECT_TRUE(contains(found.record->adjusted[0].resulting, "force 500 N in compression"))
        << found.record->adjusted[0].resulting;
    EXPECT_EQ(found.record->confirmed_by, Leg::energy);
    EXPECT_FALSE(found.scene.trim) << "trimmed once";
}

TEST(Trim, ConditionOnAHeightOtherThanTheDesignIsReached) {
    Scene scene = block();
    scene.elastics.resize(1);
    scene.trim = Trim{{preload(scene, "coil")}, {height(-0.03)}};
    const Trimmed found = trim(scene);
    ASSERT_TRUE(found.record->reached()) << found.record->detail;
    EXPECT_NEAR(found.record->adjusted[0].change, 500 - 0.03 * 20e3, 1e-6);
    EXPECT_NEAR(found.record->conditions[0].target, -30, 1e-12);
}

TEST(Trim, WheelRestsAtItsDesignPositionOnEveryBranchAndInBothReferences) {
    const Trimmed found = trim(mcpherson());
    ASSERT_TRUE(found.record->reached()) << found.record->detail;
    EXPECT_GT(found.record->adjusted[0].change, 3000);
    EXPECT_LT(found.record->adjusted[0].change, 6000);
    const Model model = compile(found.scene);
    const auto list = channels(model);
    const auto travel = static_cast<std::size_t>(find_channel(list, "travel"));
    for (const auto& branch : model.branches) {
        const Settled rest = settled(model, list, branch);
        ASSERT_EQ(rest.outcome, Outcome::converged) << rest.detail;
        EXPECT_LE(std::abs(rest.displacement[travel]), 1e-8) << branch.name;
        const BranchSide way = sides_of(model, branch).front();
        const auto energy = reference::energy::solve(way.model, way.branch, std::vector<double>{0});
        ASSERT_EQ(energy.outcome, Outcome::converged) << energy.detail;
        EXPECT_LE(std::abs(evaluate(model, list, energy.points.front())[travel]), 1e-6)
            << branch.name;
    }
    EXPECT_LE(std::abs(found.record->conditions[0].confirming_residual), 1e-6);
}

TEST(Trim, SceneWithoutATrimIsUnchanged) {
    const Trimmed found = trim(block());
    EXPECT_FALSE(found.record);
    EXPECT_EQ(std::get<AxialSpring>(found.scene.elastics[0].kind).free_length, 0.4);
}

// The series alone, from the design and from the trim of a similar scene: the same trim, the second
// by less work; and from a far start whose Jacobian has the wrong sign.
TEST(Trim, SeriesFromAnyStartGivesTheTrimOfTheReferences) {
    for (const char* name : {"double_wishbone", "front_axle"}) {
        const Scene scene = support::scene(name);
        Scene similar = scene;
        for (auto& elastic : similar.elastics)
            if (auto* spring = std::get_if<AxialSpring>(&elastic.kind)) spring->free_length += 1e-3;
        const Trimmed by_references = trim(scene);
        TrimStart start;
        ASSERT_TRUE(trim_by_series(similar, &start).record->reached());
        TrimStart far = start;
        far.p *= -40;
        far.J *= -1;
        for (TrimStart* from : {static_cast<TrimStart*>(nullptr), &start, &far}) {
            const Trimmed by_series = trim_by_series(scene, from);
            ASSERT_TRUE(by_series.record && by_series.record->reached()) << name;
            EXPECT_EQ(by_series.record->confirmed_by, Leg::series);
            const auto &a = by_references.record->adjusted, &b = by_series.record->adjusted;
            ASSERT_EQ(a.size(), b.size());
            for (std::size_t k = 0; k < a.size(); ++k)
                EXPECT_NEAR(a[k].change, b[k].change, 1e-7 * std::max(1.0, std::abs(a[k].change)))
                    << name << ": " << a[k].name;
            for (const auto& condition : by_series.record->conditions)
                EXPECT_LE(std::abs(condition.residual), 1e-9) << condition.name;
        }
    }
}

TEST(Trim, NumberOfAdjustmentsMustEqualThatOfConditions) {
    Scene scene = block();
    scene.trim = Trim{{preload(scene, "coil"), preload(scene, "second")}, {height()}};
    EXPECT_TRUE(contains(complaint(scene),
                         "2 adjusted quantities for 1 conditions; their numbers must be equal"));
    scene.trim = Trim{};
    EXPECT_TRUE(contains(complaint(scene), "their numbers must be equal"));
}

TEST(Trim, AdjustmentWithoutInfluenceIsNamed) {
    Scene scene = block();  // perpendicular to the slide of the block
    scene.trim = Trim{{preload(scene, "across")}, {height()}};
    const std::string said = complaint(scene);
    EXPECT_TRUE(contains(said, "'springs.across.preload' has no influence on top.z")) << said;
}

TEST(Trim, DependentAdjustmentsAreNamed) {
    Scene scene = block();
    scene.trim = Trim{{preload(scene, "coil"), preload(scene, "second")},
                      {height(), {"top.z again", ProbeCoordinate{0, 2}, 0.01}}};
    const std::string said = complaint(scene);
    EXPECT_TRUE(contains(said,
                         "ambiguous: top.z and top.z again change only together, whatever "
                         "springs.coil.preload and springs.second.preload do"))
        << said;
}

TEST(Trim, ConditionThatNoAdjustmentChangesIsNamed) {
    Scene scene = block();
    scene.trim = Trim{{preload(scene, "coil"), preload(scene, "second")},
                      {height(), {"top.x", ProbeCoordinate{0, 0}, std::nullopt}}};
    const std::string said = complaint(scene);
    EXPECT_TRUE(contains(said, "no adjustment changes 'top.x'")) << said;
}

TEST(Trim, AmbiguousTrimIsReportedEvenIfItsConditionsAreMet) {
    // at rest in the design position for any load sharing of the two springs
    Scene scene = block();
    scene.static_loads.clear();
    scene.trim = Trim{{preload(scene, "coil"), preload(scene, "second")},
                      {height(), {"top.z again", ProbeCoordinate{0, 2}, std::nullopt}}};
    EXPECT_TRUE(contains(complaint(scene), "ambiguous")) << complaint(scene);
}

TEST(Trim, UnreachableConditionIsReportedAndTheSceneUnchanged) {
    Scene scene = mcpherson();
    scene.trim->until[0].value = 2;  // [m]: longer than any strut
    const Trimmed found = trim(scene);
    ASSERT_TRUE(found.record);
    EXPECT_FALSE(found.record->reached());
    EXPECT_FALSE(found.record->detail.empty());
    EXPECT_TRUE(found.scene.trim) << "the scene is the one given";
}

TEST(Trim, SymmetricSidesGetEqualAdjustments) {
    // Two independent blocks.
    Scene scene = block();
    scene.elastics.resize(1);
    const Scene one = scene;
    scene.bodies.push_back({"other", one.bodies[0].design});
    const auto other = [](Point p) {
        if (p.body == 0) p.body = 1;
        return p;
    };
    auto guide = std::get<Translational>(one.joints[0].kind);
    guide.i = other(guide.i);
    guide.axis_i.body = 1;
    scene.joints.push_back({"other guide", guide});
    auto coil = std::get<AxialSpring>(one.elastics[0].kind);
    coil.i = other(coil.i);
    scene.elastics.push_back({"other coil", coil});
    auto weight = std::get<DeadForce>(one.static_loads[0].kind);
    weight.at.body = 1;
    scene.static_loads.push_back({"other weight", weight});
    scene.probes.push_back({"other", {1, Eigen::Vector3d::Zero()}});
    scene.trim = Trim{{preload(scene, "coil"), preload(scene, "other coil")},
                      {height(), {"other.z", ProbeCoordinate{1, 2}, std::nullopt}}};
    const Trimmed found = trim(scene);
    ASSERT_TRUE(found.record->reached()) << found.record->detail;
    for (const auto& adjusted : found.record->adjusted)
        EXPECT_NEAR(adjusted.change, 500, 1e-6) << adjusted.name;
}

// Bushings with preloads such that the drawn position is the equilibrium: every leg settles there,
// also the one that had no part in the trim.
TEST(Trim, BalancingBushingPreloadsKeepEveryLegAtTheDesignPosition) {
    for (const char* name : {"double_wishbone", "front_axle"}) {
        Scene scene = support::scene(name);
        const auto moved = [&](Leg leg) {
            const Trimmed found = trim(scene);
            EXPECT_TRUE(found.record->reached()) << name << ": " << found.record->detail;
            Scene still = found.scene;
            still.branches = {
                {.name = "none", .to = 1, .steps = 1, .unit = ParameterUnit::none, .drivers = {}}};
            const Model model = compile(still);
            const EquilibriumPath path = settle_start({"none", model, model.branches[0]}, leg);
            EXPECT_FALSE(path.points.empty()) << path.detail;
            double most = 0;
            for (std::size_t b = 0; b < model.bodies.size() && !path.points.empty(); ++b)
                most = std::max(most,
                                (path.points.front().poses[b].r - model.bodies[b].design.r).norm());
            return most;
        };
        EXPECT_GT(moved(Leg::equilibrium), 1e-5)
            << name << ": unloaded as drawn, it settles beside it";
        scene.trim->bushings = Trim::Bushings::balanced;
        EXPECT_LT(moved(Leg::equilibrium), 1e-12) << name;
        EXPECT_LT(moved(Leg::series), 1e-11) << name;
        EXPECT_LT(moved(Leg::energy), 1e-9) << name;
    }
}

// Two struts and a bar on a soft subframe: where springs carry much of the load, plain corrections would take hundreds
// of iterations.
TEST(Trim, BalancingBushingPreloadsAreFoundOnASoftSubframe) {
    Scene scene = read_scene(std::string(ELASTOCHECK_SCENES) +
                             "/../../tests/reports/axles/front_subframe_axle.yaml");
    scene.trim->bushings = Trim::Bushings::balanced;
    for (auto& condition : scene.trim->until) condition.value.reset();
    const Trimmed found = trim(scene);
    EXPECT_TRUE(found.record->reached()) << found.record->detail;
}

TEST(Trim, BalancingBushingPreloadsAreRefusedWithAConditionOffTheDesignPosition) {
    Scene scene = support::scene("double_wishbone");
    scene.trim->bushings = Trim::Bushings::balanced;
    scene.trim->until[0].value = 0.01;
    EXPECT_THROW((void)trim(scene), std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::compare
