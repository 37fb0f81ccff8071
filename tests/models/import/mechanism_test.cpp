// Mechanisms made of named points: each program's names are understood, and the result moves as a scene
// written by hand.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

using namespace tests;

std::string points_named(const std::string& name) {
    return support::text_of(import_folder / "points" / name);
}

importer::Options as(const std::string& mechanism, const std::string& axes = "x-forward,y-left") {
    importer::Options options;
    options.axes = axes;
    options.as = mechanism;
    return options;
}

Scene made_of(const std::string& file, const importer::Options& options) {
    return parse_scene(importer::import_text(points_named(file), file, options).yaml, "scene");
}

// The wheel at the end of a branch.
Pose wheel_at_end_of(const Scene& scene, const std::string& branch) {
    const Model model = compile(scene);
    const auto found = std::ranges::find(model.branches, branch, &Branch::name);
    if (found == model.branches.end()) throw std::runtime_error("no branch " + branch);
    const auto path =
        compare::solve_branch(compare::sides_of(model, *found), {.leg = compare::Leg::equilibrium});
    if (path.outcome != Outcome::converged) throw std::runtime_error(path.detail);
    return path.points.back().poses[static_cast<std::size_t>(scene.wheels.at(0).body)];
}

Scene by_hand(const std::string& name) {
    const std::vector<Setting> settings{
        {"branches.travel.from", "-0.03"}, {"branches.travel.to", "0.03"},
        {"branches.travel.steps", "60"},   {"branches.steering.from", "-0.03"},
        {"branches.steering.to", "0.03"},  {"branches.steering.steps", "60"}};
    return read_scene(std::filesystem::path(ELASTOCHECK_SCENES) / name, settings);
}

void expect_same_motion(const Scene& made, const Scene& hand, double mirrored = 1) {
    for (const char* branch : {"travel", "steering"}) {
        Eigen::Vector3d a = wheel_at_end_of(made, branch).r;
        const Eigen::Vector3d b = wheel_at_end_of(hand, branch).r;
        a.y() *= mirrored;
        EXPECT_LT((a - b).norm(), 1e-9) << branch;
    }
}

TEST(Mechanism, MovesAsTheSceneWrittenByHand) {
    const Scene wishbone = by_hand("double_wishbone_rigid.yaml");
    expect_same_motion(made_of("optimum_names.csv", as("double_wishbone")), wishbone);
    // the right side, x to the rear: the rack's positive side is the other one
    for (const char* file : {"saved.shk", "listing.shk"}) {
        const Scene right = made_of(file, as("double_wishbone", "x-rearward,y-right"));
        EXPECT_EQ(right.wheels.at(0).side, -1);
        Eigen::Vector3d a = wheel_at_end_of(right, "travel").r;
        a.y() *= -1;
        EXPECT_LT((a - wheel_at_end_of(wishbone, "travel").r).norm(), 1e-9) << file;
    }
    expect_same_motion(made_of("strut.csv", as("strut")), by_hand("mcpherson_rigid.yaml"));
}

TEST(Mechanism, StandsOnARockerByAPushrod) {
    auto options = as("double_wishbone");
    options.pushrod = "lower";
    const Scene scene = made_of("optimum_names.csv", options);
    EXPECT_EQ(scene.bodies.size(), 5u);
    ASSERT_EQ(scene.dampers.size(), 1u);
    EXPECT_LT((wheel_at_end_of(scene, "travel").r -
               wheel_at_end_of(by_hand("double_wishbone_rigid.yaml"), "travel").r)
                  .norm(),
              1e-9);
    // without a second point the axis is across the rocker's plane: here along x as well
    std::string text = points_named("optimum_names.csv");
    text = replaced(replaced(text, "CHAS_RocAxi_L", "Other_L"), "CHAS_RocAxi_R", "Other_R");
    const auto across = importer::import_text(text, "p.csv", options);
    ASSERT_EQ(across.notes.warnings.size(), 1u);
    EXPECT_TRUE(says(across.yaml, "rocker_axis: [10, 460, 220]"));
}

TEST(Mechanism, OfOneAxleOfTwoInTwoRowsOfHeadings) {
    auto options = as("five_link");
    const std::string text = points_named("five_link.csv");
    EXPECT_TRUE(says(refusal_of(text, "p.csv", options), "--axle: the names are of two axles"));
    Eigen::Vector3d front, rear;
    for (const auto& [axle, at] : {std::pair{"front", &front}, {"rear", &rear}}) {
        options.axle = axle;
        *at = wheel_at_end_of(made_of("five_link.csv", options), "travel").r;
    }
    EXPECT_LT((front - rear - Eigen::Vector3d(2.7, 0, 0)).norm(), 1e-9);
}

// The file has the hand-written scene's points from the wheel centre, x inboard and with the rim's offset.
TEST(Mechanism, OfAssettoCorsaIsThatOfItsPoints) {
    const std::string text = points_named("suspensions.ini");
    importer::Options options;
    EXPECT_TRUE(says(refusal_of(text, "suspensions.ini", options),
                     "--axle: choose an axle of the file: front, rear"));
    options.axle = "front";
    const auto front = importer::import_text(text, "suspensions.ini", options);
    EXPECT_EQ(front.notes.warnings.size(), 2u);  // rate, camber
    const Scene hand = by_hand("double_wishbone_rigid.yaml"),
                made = parse_scene(front.yaml, "scene");
    const Eigen::Vector3d centre = made.bodies.at(2).design.r - hand.bodies.at(2).design.r;
    EXPECT_LT(
        (wheel_at_end_of(made, "travel").r - centre - wheel_at_end_of(hand, "travel").r).norm(),
        1e-9);
    // without VERSION the rim's offset does not count
    const std::string old = replaced(text, "VERSION=2", "");
    EXPECT_TRUE(
        says(importer::import_text(old, "s.ini", options).yaml, "upper_ball: [-48, 788, 269]"));
    EXPECT_TRUE(says(front.yaml, "upper_ball: [-48, 808, 269]"));
    // the rear is that of the table, whose links have other names
    options.axle = "rear";
    const Scene rear = parse_scene(importer::import_text(text, "s.ini", options).yaml, "scene");
    auto table = as("five_link");
    table.axle = "front";
    EXPECT_LT((wheel_at_end_of(rear, "travel").r -
               wheel_at_end_of(made_of("five_link.csv", table), "travel").r)
                  .norm(),
              1e-9);
    const auto refused = [&](const std::string& what, const std::string& by) {
        return refusal_of(replaced(text, what, by), "s.ini", options);
    };
    EXPECT_TRUE(says(refused("TYPE=ML", "TYPE=AXLE"), "s.ini:25: TYPE: 'AXLE' is not read"));
    EXPECT_TRUE(says(refused("JOINT3_TYRE", "JOINT9"), "JOINT3_TYRE: missing in [REAR]"));
    EXPECT_TRUE(says(refused("0.086,-0.156,0.0", "0.086,-0.156"), "JOINT3_TYRE: 2 numbers"));
    EXPECT_TRUE(
        says(refused("0.086,-0.156,0.0", "0.086,x,0.0"), "JOINT3_TYRE: 'x' is not a number"));
    EXPECT_TRUE(says(refused("TRACK=1.9", "TRACK"), "s.ini:26: expected [SECTION] or KEY=VALUE"));
}

TEST(Mechanism, AsksForTheRolesWithoutAPoint) {
    const std::string text = replaced(points_named("strut.csv"), "LBJ", "K7");
    EXPECT_TRUE(says(refusal_of(text, "p.csv", as("strut")),
                     "p.csv: --as strut: no point for ball_joint; name it with --role "
                     "ball_joint=POINT; points without a role: 'K7'"));
    auto options = as("strut");
    options.roles = {"ball_joint=K7"};
    const std::string yaml = importer::import_text(text, "p.csv", options).yaml;
    EXPECT_TRUE(says(yaml, "Point ball_joint: line 5, K7."));
    options.roles = {"ball_joint=K8"};
    EXPECT_TRUE(says(refusal_of(text, "p.csv", options), "there is no point 'K8'; points: "));
    options.roles = {"bal_joint=K7"};
    EXPECT_TRUE(says(refusal_of(text, "p.csv", options), "did you mean 'ball_joint'?"));
    // two points for one role
    const std::string twice = replaced(text, "K7", "Lower ball") + "1,2,3,Lower ball old\n";
    EXPECT_TRUE(says(refusal_of(twice, "p.csv", as("strut")),
                     "no point for ball_joint ('Lower ball' or 'Lower ball old')"));
}

TEST(Mechanism, RefusesOptionsThatDoNotFit) {
    const std::string text = points_named("strut.csv");
    EXPECT_TRUE(says(refusal_of(text, "p.csv", as("strutt")), "did you mean 'strut'?"));
    EXPECT_TRUE(says(
        refusal_of(sample("generic__DoubleWishbone.json"), "p.json", {.as = "double_wishbone"}),
        "--as: only for hardpoints of Adams/Car (.sub), tables of points (.csv), "));
    auto options = as("five_link");
    options.pushrod = "lower";
    options.axle = "front";
    EXPECT_TRUE(says(refusal_of(points_named("five_link.csv"), "p.csv", options),
                     "'lower' is not a part of five_link; allowed: upright"));
    options.as.clear();
    options.axle.clear();
    EXPECT_TRUE(says(refusal_of(text, "p.csv", options), "--as: missing"));
    // left points to the right of the middle
    EXPECT_TRUE(says(refusal_of("name,x_mm,y_mm,z_mm\nArm outer,0,-600,0\nArm inner,0,-300,0\n"
                                "Left wheel centre,-400,-700,0\n",
                                "p.csv", as("trailing_arm")),
                     "p.csv:4: Left wheel centre: lies on the right"));
}

TEST(Shark, IsReadOrRefusedWithItsLine) {
    const auto text = points_named("saved.shk");
    importer::Options options;
    options.axes = "x-rearward,y-right";
    const std::string yaml = importer::import_text(text, "p.shk", options).yaml;
    for (const char* part :
         {"Lower_wishbone_front_pivot: [199, -479, -206]", "Wheel_centre_point: [-40, -1100, -26]",
          "(import --as double_wishbone makes its", "Coordinates in mm, as the program"})
        EXPECT_TRUE(says(yaml, part));
    const auto refused = [&](const std::string& what, const std::string& by) {
        return refusal_of(replaced(text, what, by), "p.shk", options);
    };
    EXPECT_TRUE(says(refused("FRONT SUSPENSION", "SUSPENSION"), "no point in this file"));
    EXPECT_TRUE(says(refused("TEMP_SETTINGS\n", "OLD\n"), "p.shk:4: "));
    EXPECT_TRUE(says(refused("            1\n          ", "            1\n 1 2 3\n          "),
                     "a point without a name: TEMP_SETTINGS has 12 names"));
    // axes in which the front pivot is behind the rear one
    options.axes = "x-forward,y-left";
    EXPECT_TRUE(says(refusal_of(text, "p.shk", options), "lies behind Lower wishbone rear pivot"));
    options.axes = "x-rearward,y-right";
    EXPECT_TRUE(says(refusal_of("FRONT SUSPENSION\n1 2 3 POINT:1\n", "p.shk", options),
                     "p.shk:2: name: a point without a name"));
    EXPECT_TRUE(says(refusal_of("FRONT SUSPENSION\n1 2 POINT:1 a\n", "p.shk", options),
                     "p.shk:2: 2 numbers before POINT:"));
    options.unit = "m";
    EXPECT_TRUE(says(refusal_of(points_named("listing.shk"), "p.shk", options),
                     "--unit: m; the file has its points in mm"));
}

}  // namespace
}  // namespace elastocheck
