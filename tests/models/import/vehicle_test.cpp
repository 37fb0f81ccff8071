// Import of a vehicle of Chrono::Vehicle: one axle with its steering and anti-roll bar.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/import/import.hpp"
#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using namespace tests;

// Chrono's data folder with the samples that a vehicle names.
struct Data : support::Folder {
    Data() {
        for (const char* name : {"suspension", "steering", "antirollbar", "vehicle"})
            fs::create_directories(path / "generic" / name);
        put("suspension/DoubleWishbone.json", sample("generic__DoubleWishbone.json"));
        put("suspension/DoubleWishboneCurve.json", sample("generic__DoubleWishbone.json"));
        put("suspension/SemiTrailingArm.json", sample("generic__SemiTrailingArm.json"));
        put("steering/PitmanArm.json", sample("generic__PitmanArm.json"));
        put("steering/RackPinion.json", sample("generic__RackPinion.json"));
        put("antirollbar/AntirollBarRSD.json", sample("generic__AntirollBarRSD.json"));
    }
    std::string put(const std::string& name, const std::string& text) const {
        return write("generic/" + name, text);
    }
    importer::Imported import(const std::string& vehicle, const std::string& axle) const {
        return importer::import_file(put("vehicle/vehicle.json", vehicle), {.axle = axle});
    }
    std::string refusal(const std::string& vehicle, const std::string& axle) const {
        return refusal_of([&] { import(vehicle, axle); });
    }
};

const std::string with_bar = sample("generic__Vehicle_DoubleWishbones_ARB.json");
const std::string with_rack = replaced(with_bar, "PitmanArm", "RackPinion");

std::size_t position(const auto& list, const std::string& name) {
    for (std::size_t k = 0; k < list.size(); ++k)
        if (list[k].name == name) return k;
    ADD_FAILURE() << "there is no " << name;
    return 0;
}

// Every point of a branch by the equilibrium leg and the series, which agree.
std::vector<Equilibrium> solved_twice(const Model& model, const std::string& branch) {
    const auto a = solved(model, branch, 4).points,
               b = solved(model, branch, 4, compare::Leg::series).points;
    EXPECT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n)
        for (std::size_t k = 0; k < a[n].poses.size(); ++k)
            EXPECT_LE((a[n].poses[k].r - b[n].poses[k].r).norm(), 1e-9);
    return a;
}

TEST(ChronoVehicle, TheRackMovesTheSteeringLinkByThePinionsAngleTimesItsRadius) {
    const Data data;
    const Model model =
        compile(parse_scene(data.import(with_rack, "front").yaml, "scene"), Detail::everything);
    const auto path = solved_twice(model, "steer");
    // Orientation: about y; so the rack moves along y.
    const double range = 0.1 * 30 * std::numbers::pi / 180;
    const std::size_t link = position(model.bodies, "steering_link");
    const Vector3d drawn = model.bodies[link].design.r;
    // Locations of the steering and the suspension: [1.1, 0, -0.4] and [1.25, 0, -0.21].
    EXPECT_LE((drawn - Vector3d(-0.15, 0, -0.19)).norm(), 1e-12);
    EXPECT_LE((path.back().poses[link].r - drawn - Vector3d(0, range, 0)).norm(), 1e-9);
    EXPECT_LE((path.front().poses[link].r - drawn + Vector3d(0, range, 0)).norm(), 1e-9);
    // Both wheels turn, the same way.
    const auto turned = [&](const char* name) {
        const std::size_t k = position(model.bodies, name);
        return (path.back().poses[k].p * model.bodies[k].design.p.conjugate()).z();
    };
    EXPECT_GT(std::abs(turned("upright_left")), 0.02);
    EXPECT_GT(turned("upright_left") * turned("upright_right"), 0);
}

TEST(ChronoVehicle, ThePitmanArmTurnsAboutItsAxisAndTheIdlerKeepsItsLength) {
    const Data data;
    const Model model =
        compile(parse_scene(data.import(with_bar, "1").yaml, "scene"), Detail::everything);
    const auto path = solved_twice(model, "steer");
    const double angle = 30 * std::numbers::pi / 180;
    const std::size_t arm = position(model.bodies, "pitman_arm"),
                      link = position(model.bodies, "steering_link");
    const Eigen::Quaterniond turn(0.98699637, 0, 0.16074256, 0);
    const Eigen::Matrix3d A = turn.normalized().toRotationMatrix();
    const Vector3d origin(-0.15, 0, -0.19);
    EXPECT_LE((model.bodies[arm].design.r - origin - A * Vector3d(0.064, 0.249, 0)).norm(), 1e-12);
    const auto& last = path.back();
    const Eigen::Quaterniond by = last.poses[arm].p * model.bodies[arm].design.p.conjugate();
    const Eigen::Quaterniond meant(Eigen::AngleAxisd(angle, A.col(2)));
    EXPECT_LE(by.angularDistance(meant), 1e-9);
    // The link's point: moved with the link, at the idler's length in its plane.
    const Vector3d outer = origin + A * Vector3d(0.129, -0.325, 0),
                   inner = origin + A * Vector3d(0, -0.325, 0);
    const Eigen::Quaterniond link_turn =
        last.poses[link].p * model.bodies[link].design.p.conjugate();
    const Vector3d moved = last.poses[link].r + link_turn * (outer - model.bodies[link].design.r);
    EXPECT_NEAR((moved - inner).norm(), 0.129, 1e-9);
    EXPECT_NEAR((moved - inner).dot(A.col(2)), 0, 1e-9);
    EXPECT_GT((moved - outer).norm(), 0.05);
}

// With equal travel the bar turns and is not twisted; in roll its arms twist it.
TEST(ChronoVehicle, TheAntiRollBarActsInRollOnly) {
    const Data data;
    const std::string yaml = data.import(with_rack, "front").yaml;
    const Model model = compile(parse_scene(yaml, "scene"), Detail::everything);
    EXPECT_TRUE(
        has_text(yaml, "antiroll_bar.twist: {bodies: [antiroll_bar_left, antiroll_bar_right]"));
    EXPECT_TRUE(has_text(yaml, "rate: 10000"));
    const std::size_t left = position(model.bodies, "antiroll_bar_left"),
                      right = position(model.bodies, "antiroll_bar_right");
    // Arms at half of Arm/Length on each side, from [0.6586, 0, -0.2364] in the chassis.
    EXPECT_LE((model.bodies[left].design.r - Vector3d(-0.5914, 0.35, -0.0264)).norm(), 1e-12);
    EXPECT_LE((model.bodies[right].design.r - Vector3d(-0.5914, -0.35, -0.0264)).norm(), 1e-12);
    const auto twist = [&](const Equilibrium& point) {
        return point.poses[left].p.angularDistance(point.poses[right].p);
    };
    const auto travel = solved_twice(model, "travel"), roll = solved_twice(model, "roll");
    EXPECT_LE(twist(travel.back()), 1e-9);
    EXPECT_GT(twist(roll.back()), 0.05);
    // The left link's force on its arm balances the spring about the axis.
    const auto& end = roll.back();
    const Vector3d arm = end.poses[left].p * model.bodies[left].design.p.conjugate() *
                         Vector3d(0.4, 0.35, 0),
                   force = end.reactions[position(model.joints, "antiroll_bar.link_left")].force;
    EXPECT_NEAR(std::abs(arm.cross(force).y()) / (10000 * twist(end)), 1, 1e-9);
}

TEST(ChronoVehicle, RefusalOfAnInvalidFileNamesFileAndField) {
    const Data data;
    expect_refusals("vehicle", with_rack, "vehicle.json",
                    [&](const std::string& text) { return data.refusal(text, "front"); });
}

}  // namespace
}  // namespace elastocheck
