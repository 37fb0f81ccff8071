// Element outputs: closed forms, signs, names.
#include "compare/comparison/elements.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

double value(const Model& model, const Branch& branch, const Equilibrium& state,
             const std::string& name) {
    const auto list = element_channels(model);
    const int c = find_channel(list, name);
    if (c < 0) {
        ADD_FAILURE() << "no output " << name;
        return 0;
    }
    return evaluate(model, branch, {&list[static_cast<std::size_t>(c)], 1}, state).front();
}

// ---- Closed forms

// A body at the origin, moved to `pose`, with one element to ground.
struct One {
    Model model;
    Branch branch;
    Equilibrium state;
    One(Elastic elastic, const Pose& pose) {
        model.bodies.push_back({"body", {}});
        model.elastics.push_back(std::move(elastic));
        state.poses = {pose};
        state.load = 3;
    }
    double operator[](const std::string& name) const { return value(model, branch, state, name); }
};

Pose turned(const Vector3d& r, double degrees, const Vector3d& axis) {
    return {r, Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis))};
}

TEST(ElementOutputs, SpringAndStopArePositiveInCompression) {
    const AxialSpring coil{{0, Vector3d::Zero()}, {ground, {0, 0, 0.5}}, LinearRate{20e3}, 0.55};
    One spring({"coil", coil}, {Vector3d(0, 0, 0.03), Eigen::Quaterniond::Identity()});
    EXPECT_NEAR(spring["coil.deflection"], 80, 1e-10);
    EXPECT_NEAR(spring["coil.force"], 1600, 1e-9);
    // A branch that lengthens the spring by 10 mm per unit, at 3 units, starting from 5 mm.
    spring.branch.drivers = {{FreeLength{0}, 0.005, 0.01}};
    EXPECT_NEAR(spring["coil.deflection"], 115, 1e-10);
    EXPECT_NEAR(spring["coil.force"], 2300, 1e-9);

    // Acts from 20 mm of compression on, at a design length of 0.5 m.
    const elastocheck::Curve closing{{-0.02}, {{0, 1e5, 0, 0}, {0, 0, 0, 0}}};
    const One stop(
        {"coil.bump_stop", AxialSpring{coil.i, coil.j, closing, 0.5}, false, WrittenAs::stop},
        {Vector3d(0, 0, 0.03), Eigen::Quaterniond::Identity()});
    EXPECT_NEAR(stop["coil.bump_stop.deflection"], 30, 1e-10);
    EXPECT_NEAR(stop["coil.bump_stop.force"], 1000, 1e-8);
}

// In frame axes, of which y is ground's x, z ground's y and x ground's z.
TEST(ElementOutputs, BushingForceIsInItsAxesAndRestoresItsSecondBody) {
    Eigen::Matrix3d axes;
    axes.col(0) = Vector3d::UnitZ();
    axes.col(1) = Vector3d::UnitX();
    axes.col(2) = Vector3d::UnitY();
    const Eigen::Quaterniond A(axes);
    Matrix6 K = Matrix6::Zero();
    K.diagonal() << 1e6, 2e6, 3e6, 100, 200, 300;
    Bushing rubber{{ground, Vector3d::Zero(), A}, {0, Vector3d::Zero(), A}, LinearStiffness{K}};
    rubber.preload << 10, 20, 30, 1, 2, 3;
    rubber.undeformed << 1e-4, 0, 0, 0, 0, 0.01;
    One bushing({"mount", rubber}, turned({0.001, 0.002, 0.003}, 2, Vector3d::UnitX()));
    const double rad = std::numbers::pi / 180;
    EXPECT_NEAR(bushing["mount.displacement_x"], 3 - 0.1, 1e-10);
    EXPECT_NEAR(bushing["mount.displacement_y"], 1, 1e-10);
    EXPECT_NEAR(bushing["mount.displacement_z"], 2, 1e-10);
    EXPECT_NEAR(bushing["mount.rotation_x"], 0, 1e-10);
    EXPECT_NEAR(bushing["mount.rotation_y"], 2, 1e-10);
    EXPECT_NEAR(bushing["mount.rotation_z"], -0.01 / rad, 1e-10);
    EXPECT_NEAR(bushing["mount.elastic_force_x"], 2900 + 10, 1e-7);
    EXPECT_NEAR(bushing["mount.elastic_force_y"], 2000 + 20, 1e-7);
    EXPECT_NEAR(bushing["mount.elastic_force_z"], 6000 + 30, 1e-7);
    EXPECT_NEAR(bushing["mount.elastic_moment_x"], 1, 1e-9);
    EXPECT_NEAR(bushing["mount.elastic_moment_y"], 200 * 2 * rad + 2, 1e-9);
    EXPECT_NEAR(bushing["mount.elastic_moment_z"], -3 + 3, 1e-9);
    bushing.branch.drivers = {{Preload{0, 2 * Vector6::Unit(1)}, 100, 50}};
    EXPECT_NEAR(bushing["mount.elastic_force_y"], 2020 + 2 * (100 + 3 * 50), 1e-7);
    EXPECT_NEAR(bushing["mount.displacement_y"], 1, 1e-10);
}

TEST(ElementOutputs, TorsionSpringHasOneAngleAndTyreOneDeflection) {
    Matrix6 K = Matrix6::Zero();
    K(5, 5) = 40;
    Bushing bar{{ground, Vector3d::Zero()}, {0, Vector3d::Zero()}, LinearStiffness{K}};
    bar.preload[5] = 7;
    const One torsion({"bar", bar, false, WrittenAs::torsion_spring},
                      turned(Vector3d::Zero(), 30, Vector3d::UnitZ()));
    EXPECT_NEAR(torsion["bar.angle"], 30, 1e-12);
    EXPECT_NEAR(torsion["bar.moment"], 40 * std::numbers::pi / 6 + 7, 1e-12);
    EXPECT_EQ(element_channels(torsion.model).size(), 2u);

    // 3 kN at the design height; the wheel 10 mm lower, the road 5 mm per unit higher at 3 units.
    PerAxis pushes;
    pushes.axis[2] = elastocheck::Curve{.knots = {0}, .pieces = {{0, 200e3, 0, 0}, {0, 0, 0, 0}}};
    Bushing flat{{ground, Vector3d::Zero()}, {0, Vector3d::Zero()}, pushes};
    flat.undeformed[2] = 0.015;
    One tyre({"tyre", flat, true, WrittenAs::tyre}, turned({0, 0, -0.01}, 0, Vector3d::UnitZ()));
    EXPECT_TRUE(std::isnan(tyre["tyre.force"])) << "it does not stand on this branch";
    EXPECT_TRUE(std::isnan(tyre["tyre.deflection"]));
    tyre.branch.drivers = {{FreeLength{0}, 0, 0.005}};
    EXPECT_NEAR(tyre["tyre.force"], 3000 + 2000 + 3000, 1e-8);
    EXPECT_NEAR(tyre["tyre.deflection"], 15 + 10 + 15, 1e-10);
}

TEST(ElementOutputs, LinkForceIsPositiveInTension) {
    Model model;
    model.bodies.push_back({"hook", {}});
    model.joints = {{"rod", 0, ground, {0, Vector3d::Zero()}, 0, false}};
    model.constraints = {{0, DistanceBetween{{0, Vector3d::Zero()}, {ground, {0, 3, 4}}, 5}}};
    Equilibrium state = design_state(model);
    state.reactions[0].force = {0, 30, 40};
    EXPECT_NEAR(value(model, {}, state, "rod.axial_force"), 50, 1e-12);
    state.reactions[0].force = {0, -30, -40};
    EXPECT_NEAR(value(model, {}, state, "rod.axial_force"), -50, 1e-12);
}

// By the definition of Formulation, a bushing with its frame on j equals one on i with exchanged
// bodies and reversed signs. Outputs are in the axes of the scene file.
TEST(ElementOutputs, BushingFramedOnItsSecondBodyUsesTheAxesAsWritten) {
    Matrix6 K = Matrix6::Zero();
    K.diagonal() << 1e6, 2e6, 3e6, 100, 200, 300;
    Scene scene;
    scene.bodies = {{"i", {}}, {"j", {}}};
    Bushing rubber{{0, Vector3d::Zero()}, {1, Vector3d::Zero()}, LinearStiffness{K}};
    rubber.preload << 10, 20, 30, 1, 2, 3;
    rubber.formulation.frame = Formulation::Frame::on_j;
    scene.elastics = {{"mount", rubber}};
    scene.branches = {
        {.name = "a", .to = 1, .steps = 1, .drivers = {{Preload{0, Vector6::Unit(0)}, 0, 100}}}};
    const Model model = compile(scene, Detail::everything);
    Equilibrium state = design_state(model);
    state.load = 2;
    state.poses[1] = turned({0.001, 0, 0}, 90, Vector3d::UnitZ());  // ground x is -y of j
    const auto of = [&](const char* name) { return value(model, model.branches[0], state, name); };
    EXPECT_NEAR(of("mount.displacement_x"), 0, 1e-10);
    EXPECT_NEAR(of("mount.displacement_y"), -1, 1e-10);
    EXPECT_NEAR(of("mount.rotation_z"), 90, 1e-10);
    EXPECT_NEAR(of("mount.elastic_force_x"), 10 + 200, 1e-9);
    EXPECT_NEAR(of("mount.elastic_force_y"), 20 - 2000, 1e-9);
    EXPECT_NEAR(of("mount.elastic_moment_z"), 3 + 300 * std::numbers::pi / 2, 1e-9);
}

TEST(ElementOutputs, NamesDifferFromThoseOfJoints) {
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        auto all = channels(model);
        const std::size_t first = all.size();
        for (const auto& channel : element_channels(model)) all.push_back(channel);
        for (std::size_t c = first; c < all.size(); ++c) {
            EXPECT_EQ(find_channel(all, all[c].name), static_cast<int>(c))
                << name << " " << all[c].name;
            EXPECT_FALSE(all[c].main || all[c].kinematic());
            EXPECT_TRUE(all[c].definition.find("positive") != std::string::npos ||
                        all[c].definition.find("right-handed") != std::string::npos)
                << all[c].definition;
        }
    }
    Model twice;
    twice.elastics = {{"a", AxialSpring{}}, {"a", AxialSpring{}}, {"a", Bushing{}}};
    const auto list = element_channels(twice);
    EXPECT_EQ(list[0].name, "a.deflection");
    EXPECT_EQ(list[2].name, "a#2.deflection");
    EXPECT_EQ(list[4].name, "a.displacement_x");
}

}  // namespace
}  // namespace elastocheck::compare
