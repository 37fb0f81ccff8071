// Rank, redundancy, idle modes: what the design position tells.
#include "recursive/diagnosis.hpp"

#include <gtest/gtest.h>

#include "models/compile.hpp"
#include "models/reader/scene_file.hpp"
#include "recursive/solve.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

// A bar from the origin to (1, 0, 0), with the given joints, elements and loads.
Scene bar(const std::string& rest) {
    return parse_scene(
        "elastocheck: 1\nname: bar\nunits: {length: m, angle: rad, force: N}\n"
        "points: {a: [0, 0, 0], b: [1, 0, 0], c: [1, 1, 0]}\n"
        "bodies: {bar: {origin: a}}\n"
        "branches: {out: {load: load, to: 100, steps: 10}}\n"
        "probes: {tip: {on: bar, at: b}}\n" +
            rest,
        "bar");
}

TEST(Diagnosis, CountsThePapersMcPhersonAs18Coordinates9Constraints27Unknowns) {
    const auto d = diagnose(compile(support::scene("chrono_mcpherson")));
    EXPECT_EQ(d.coordinates, 18);
    EXPECT_EQ(d.rows, 9);
    EXPECT_EQ(d.coordinates + d.rows, 27);
    EXPECT_EQ(d.rank, 9);
    EXPECT_EQ(d.degrees_of_freedom(), 9);
    EXPECT_TRUE(d.redundant.empty());
}

TEST(Diagnosis, NamesTheSpinOfTheStrutAboutItsOwnAxis) {
    const auto d = diagnose(compile(support::scene("chrono_mcpherson")));
    ASSERT_EQ(d.idle.size(), 1u);
    EXPECT_EQ(d.idle[0].description,
              "strut: rotation about the line through 'strut_tube' and 'K2_strut_mount'");
}

TEST(Diagnosis, RatesOfAnySizeHideNoMode) {
    for (const double factor : {1e-9, 1e-3, 1.0, 1e3, 1e6, 1e9}) {
        Scene scene = support::scene("chrono_mcpherson");
        for (auto& elastic : scene.elastics) {
            if (elastic.name != "K3_arm_front") continue;  // one stiff or soft element among ordinary ones
            std::get<LinearStiffness>(std::get<Bushing>(elastic.kind).law).K *= factor;
        }
        const auto d = diagnose(compile(scene));
        EXPECT_EQ(d.idle.size(), 1u) << factor;
        EXPECT_EQ(d.rank, 9) << factor;
    }
}

TEST(Diagnosis, ThreeIdleModesOfABodyAreAllFound) {
    // A spherical joint alone leaves three rotations; the spring along the bar does not resist any of them.
    const auto d =
        diagnose(compile(bar("joints: {pin: {type: spherical, bodies: [bar, ground], at: a}}\n"
                             "springs: {s: {bodies: [bar, ground], from: b, to: a, rate: 1000}}\n"
                             "loads: {load: {on: bar, at: b, force: [1, 0, 0]}}\n")));
    EXPECT_EQ(d.idle.size(), 3u);
    for (const auto& mode : d.idle)
        EXPECT_NE(mode.description.find("bar: rotation"), std::string::npos) << mode.description;
}

TEST(Diagnosis, TranslationIsNamedWithItsDirection) {
    const auto d =
        diagnose(compile(bar("joints: {guide: {type: translational, bodies: [bar, ground], at: a, axis: x}}\n"
                             "loads: {load: {on: bar, at: b, force: [0, 1, 0]}}\n")));
    ASSERT_EQ(d.idle.size(), 1u);
    EXPECT_EQ(d.idle[0].description, "bar: translation along (1.000, 0.000, 0.000)");
}

TEST(Diagnosis, RedundantConstraintsAreCountedAndNamedByJoint) {
    const Model model =
        compile(bar("joints:\n  hinge_1: {type: revolute, bodies: [bar, ground], at: a, axis: x}\n"
                    "  hinge_2: {type: revolute, bodies: [bar, ground], at: b, axis: x}\n"
                    "bushings: {k: {bodies: [bar, ground], at: c, rates: [1e4, 1e4, 1e4]}}\n"
                    "loads: {load: {on: bar, at: c, force: [0, 0, 1]}}\n"));
    const auto d = diagnose(model);
    EXPECT_EQ(d.rows, 10);
    EXPECT_EQ(d.rank, 5);
    ASSERT_EQ(d.redundant.size(), 1u);
    EXPECT_EQ(model.joints[static_cast<std::size_t>(d.redundant[0].joint)].name, "hinge_2");
    EXPECT_EQ(d.redundant[0].rows, 5);
    EXPECT_FALSE(d.redundant[0].contradicts);
}

TEST(Diagnosis, OnlyJointsThatShareADependencyAreUndetermined) {
    // Two bars on one ground: the first on two hinges of one line, the second on one.
    Scene scene =
        bar("joints:\n  hinge_1: {type: revolute, bodies: [bar, ground], at: a, axis: x}\n"
            "  hinge_2: {type: revolute, bodies: [bar, ground], at: b, axis: x}\n"
            "bushings: {k: {bodies: [bar, ground], at: c, rates: [1e4, 1e4, 1e4]}}\n"
            "loads: {load: {on: bar, at: c, force: [0, 0, 1]}}\n");
    scene.bodies.push_back({"other", {{0, 1, 0}, Eigen::Quaterniond::Identity()}});
    const Direction x{ground, Eigen::Vector3d::UnitX()}, own_x{1, Eigen::Vector3d::UnitX()};
    scene.joints.push_back(
        {"hinge_3", Revolute{{1, Eigen::Vector3d::Zero()}, {ground, {0, 1, 0}}, own_x, x}});
    scene.joints.push_back({"rod", Distance{{1, {0, 0, 1}}, {0, {0, 0, 1}}, 1}});
    scene.probes.push_back({"other", {1, Eigen::Vector3d::Zero()}});
    const Model model = compile(scene);
    const auto d = diagnose(model);
    EXPECT_EQ(d.determined, (std::vector<bool>{false, false, true, true}));
    EXPECT_EQ(d.redundant_sets, (std::vector<std::vector<int>>{{0, 1}}));
    EXPECT_EQ(diagnose(compile(support::scene("chrono_mcpherson"))).redundant_sets.size(), 0u);
}

TEST(Diagnosis, ASoftDirectionIsNotIdleInATurnedFrame) {
    // Rates of 1e12 beside 100, at an angle to the ground and to the body, as a diagonal of the turned frame
    // and as a full matrix of the straight one.
    const Eigen::Matrix3d R(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -0.5).normalized()));
    for (const bool full : {false, true}) {
        Scene scene;
        scene.bodies = {{"block", {{1, 2, 3}, Eigen::Quaterniond::Identity()}}};
        LinearStiffness law;
        law.K.diagonal() << 1e12, 100, 100, 1e12, 100, 100;
        Bushing mount{{0, Eigen::Vector3d::Zero()}, {ground, {1, 2, 3}}, {}, elastocheck::Vector6::Zero()};
        if (full) {
            for (int k : {0, 3})
                law.K.block<3, 3>(k, k) = (R * law.K.block<3, 3>(k, k) * R.transpose()).eval();
        } else {
            mount.i.A_local = mount.j.A_local = Eigen::Quaterniond(R);
        }
        mount.law = law;
        scene.elastics = {{"mount", mount}};
        scene.probes = {{"block", {0, Eigen::Vector3d::Zero()}}};
        EXPECT_TRUE(diagnose(compile(scene)).idle.empty()) << full;
    }
}

TEST(Diagnosis, EquilibratedConditionDoesNotDependOnTheUnitsOfTheStiffness) {
    Scene scene = support::scene("pinned_bar");
    const auto equilibrated = [](const Scene& told) {
        const Model model = compile(told);
        return conditioning(model, diagnose(model)).equilibrated;
    };
    const double plain = equilibrated(scene);
    std::get<LinearStiffness>(std::get<Bushing>(scene.elastics[0].kind).law).K *= 1e12;
    EXPECT_NEAR(equilibrated(scene) / plain, 1, 1);
    EXPECT_LT(plain, 100);
}

TEST(Diagnosis, ImbalanceAtTheDesignPositionIsSeen) {
    Scene scene = support::scene("parallel_springs");
    EXPECT_LE(diagnose(compile(scene)).imbalance, 1e-9);
    std::get<DeadForce>(scene.static_loads[0].kind).f.z() -= 50;
    EXPECT_NEAR(diagnose(compile(scene)).imbalance, 50, 1e-9);
}

TEST(Diagnosis, DoesNotDependOnFrameOrOrder) {
    const Scene scene = support::scene("chrono_mcpherson");
    const Eigen::Quaterniond R(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized()));
    for (const auto& other : {support::moved(scene, R, {30, -20, 10}), support::reversed(scene),
                              support::mirrored(scene), support::with_body_axes(scene, {R, R.conjugate()})}) {
        const auto a = diagnose(compile(scene)), b = diagnose(compile(other));
        EXPECT_EQ(a.rank, b.rank);
        EXPECT_NEAR(a.length, b.length, 1e-12);
        ASSERT_EQ(b.idle.size(), 1u);
        EXPECT_NE(b.idle[0].description.find("strut: rotation about the line through"), std::string::npos)
            << b.idle[0].description;
    }
}

}  // namespace
}  // namespace elastocheck::recursive
