// Mechanisms made of named points: each program's names are understood, and the result moves as a scene
// written by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/elements.hpp"
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

TEST(Mechanism, BothWheelsAreMirrorImages) {
    for (const char* file : {"optimum_names.csv", "saved.shk"}) {
        const bool left = std::string_view(file).ends_with("csv");
        auto options = as("double_wishbone", left ? "x-forward,y-left" : "x-rearward,y-right");
        if (left) options.pushrod = "lower";
        const Scene one = made_of(file, options);
        options.both_wheels = true;
        const Scene two = made_of(file, options);
        ASSERT_EQ(two.wheels.size(), 2u);
        EXPECT_EQ(two.bodies.size(), 2 * one.bodies.size() - 1);  // one rack
        for (const char* branch : {"travel", "steering"})
            EXPECT_LT((wheel_at_end_of(one, branch).r - wheel_at_end_of(two, branch).r).norm(),
                      1e-9)
                << file << " " << branch;
        EXPECT_LT((wheel_at_end_of(one, "travel").r -
                   wheel_at_end_of(two, left ? "opposite" : "travel").r)
                      .norm(),
                  1e-9);
    }
    auto options = as("live_axle");
    options.both_wheels = true;
    EXPECT_TRUE(says(refusal_of(points_named("live_axle.csv"), "p.csv", options),
                     "--both-wheels: live_axle has both"));
}

TEST(Mechanism, DamperActsOnARockerByAPushrod) {
    auto options = as("double_wishbone");
    options.pushrod = "lower";
    const Scene scene = made_of("optimum_names.csv", options);
    EXPECT_EQ(scene.bodies.size(), 5u);
    ASSERT_EQ(scene.dampers.size(), 1u);
    EXPECT_LT((wheel_at_end_of(scene, "travel").r -
               wheel_at_end_of(by_hand("double_wishbone_rigid.yaml"), "travel").r)
                  .norm(),
              1e-9);
    // the same by --rocker, of the part on which the damper would stand
    auto rocker = as("double_wishbone");
    rocker.rocker = true;
    const std::string points = points_named("optimum_names.csv");
    EXPECT_EQ(importer::import_text(points, "p.csv", rocker).yaml,
              importer::import_text(points, "p.csv", options).yaml);
    rocker.damper = "lower";
    EXPECT_TRUE(says(refusal_of(points, "p.csv", rocker), "--damper: with a rocker the damper"));
    // without a second point the axis is across the rocker's plane: here along x as well
    std::string text = points_named("optimum_names.csv");
    text = replaced(replaced(text, "CHAS_RocAxi_L", "Other_L"), "CHAS_RocAxi_R", "Other_R");
    const auto across = importer::import_text(text, "p.csv", options);
    ASSERT_EQ(across.notes.warnings.size(), 1u);
    EXPECT_TRUE(says(across.yaml, "rocker_axis: [10, 460, 220]"));
}

// Other layouts of the same programs: groups of columns in inches, a listing with a pushrod, whole words.
TEST(Mechanism, LayoutsOfOtherExportsAreRecognised) {
    auto options = as("double_wishbone");
    options.pushrod = "upper";
    const Scene groups = made_of("optimum_groups.csv", options);
    EXPECT_EQ(groups.dampers.size(), 1u);
    EXPECT_NEAR(wheel_at_end_of(groups, "travel").r.z(), 0.203 + 0.03, 1e-4);
    options = as("double_wishbone", "x-rearward,y-left,z-up");
    options.pushrod = "lower";
    const auto listing =
        importer::import_text(points_named("listing_pushrod.shk"), "p.shk", options);
    EXPECT_TRUE(says(listing.yaml, "Point rocker_pivot: line 19, Rocker axis 1st point."));
    EXPECT_TRUE(says(listing.yaml, "Point pushrod_outer: line 11, Push rod wishbone end."));
    EXPECT_NO_THROW((void)wheel_at_end_of(parse_scene(listing.yaml, "scene"), "travel"));
    const char* words =
        "Point Name,X (m),Y (m),Z (m)\nUpper Wishbone Front Pivot FL,-0.100,0.240,0.2808\n"
        "Upper Wishbone Rear Pivot FL,0.130,0.240,0.2992\n"
        "Lower Wishbone Front Pivot FL,-0.110,0.200,0.1225\n"
        "Lower Wishbone Rear Pivot FL,0.140,0.200,0.1175\nUpper Ball Joint FL,0.012,0.540,0.300\n"
        "Lower Ball Joint FL,-0.005,0.575,0.110\nTie Rod Inboard FL,0.100,0.230,0.160\n"
        "Tie Rod Outboard FL,0.090,0.560,0.150\nWheel Center FL,0.0,0.600,0.228\n"
        "Contact Patch FL,0.0,0.605,0.0\nMystery Bracket FL,-0.1,0.2,0.3\n";
    options.pushrod.clear();
    const auto named = importer::import_text(words, "p.csv", options);
    EXPECT_TRUE(says(notes_of(named), "Left out, without a role: line 12, Mystery Bracket FL."));
    EXPECT_NO_THROW((void)wheel_at_end_of(parse_scene(named.yaml, "scene"), "steering"));
    // a left-handed file is never guessed
    options.axes = "x-rearward,y-left";
    EXPECT_TRUE(says(refusal_of(words, "p.csv", options), "x-rearward,y-left needs its z"));
}

TEST(Mechanism, AxleIsSelectedFromATableWithTwoRowsOfHeadings) {
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
TEST(Mechanism, AssettoCorsaFileGivesTheMechanismOfItsPoints) {
    const std::string text = points_named("suspensions.ini");
    importer::Options options;
    EXPECT_TRUE(says(refusal_of(text, "suspensions.ini", options),
                     "--axle: choose an axle of the file: front, rear"));
    options.axle = "front";
    const auto front = importer::import_text(text, "suspensions.ini", options);
    EXPECT_EQ(front.notes.warnings.size(), 1u);  // camber
    EXPECT_TRUE(says(front.yaml, "spring: {at_wheel: true, rate: 30, preload: 0}  # line 21"));
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
    EXPECT_TRUE(says(refused("TYPE=ML", "TYPE=SOLID"), "s.ini:25: TYPE: 'SOLID' is not read"));
    EXPECT_TRUE(says(refused("JOINT3_TYRE", "JOINT9"), "REAR.JOINT3_TYRE: missing"));
    EXPECT_TRUE(says(refused("0.086,-0.156,0.0", "0.086,-0.156"),
                     "REAR.JOINT3_TYRE: expected a list of 3 numbers, found a list of 2"));
    EXPECT_TRUE(says(refused("0.086,-0.156,0.0", "0.086,x,0.0"),
                     "REAR.JOINT3_TYRE: expected a number, found 'x'"));
    EXPECT_TRUE(says(refused("TRACK=1.9", "TRACK"), "s.ini:26: expected [SECTION] or KEY=VALUE"));
}

// Another car: a strut whose spring stands along it, and a live axle with its bar.
TEST(Mechanism, AssettoCorsaFileGivesSpringsAndBars) {
    const std::string text = points_named("strut_and_axle.ini");
    importer::Options options;
    options.axle = "front";
    const auto front = importer::import_text(text, "s.ini", options);
    EXPECT_TRUE(says(front.yaml, "from: strut_lower, to: strut_top, rate: 25, preload: 2500}"));
    EXPECT_TRUE(says(notes_of(front),
                     "Warning: line 9, FRONT: 12000 N/m between both wheels is not in the scene"));
    EXPECT_TRUE(says(notes_of(front), "PROGRESSIVE_SPRING_RATE: 100, at the wheel, is not"));
    options.both_wheels = true;
    const Scene pair = parse_scene(importer::import_text(text, "s.ini", options).yaml, "scene");
    options.both_wheels = false;
    options.axle = "rear";
    const Scene axle = parse_scene(importer::import_text(text, "s.ini", options).yaml, "scene");
    Model model = compile(pair);
    const auto forces = [&](const char* branch, const std::string& spring) {
        const auto found = std::ranges::find(model.branches, branch, &Branch::name);
        const auto sides = compare::sides_of(model, *found);
        const auto path = compare::solve_branch(sides, {.leg = compare::Leg::equilibrium});
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
        const std::vector<compare::Channel> channels = compare::element_channels(model);
        const auto channel = std::ranges::find(channels, spring, &compare::Channel::name);
        EXPECT_NE(channel, channels.end()) << spring;
        if (channel == channels.end()) return std::nan("");
        return compare::evaluate(model, *found, {&*channel, 1}, path.points.back()).at(0);
    };
    EXPECT_NEAR(std::abs(forces("opposite", "antiroll_bar.elastic_force_z")), 720, 1e-6);
    model = compile(axle);
    // 30 mm each way: the bar has 8 N/mm of 60 mm, and nothing in parallel travel
    EXPECT_NEAR(std::abs(forces("opposite", "antiroll_bar.elastic_force_z")), 480, 1e-6);
    EXPECT_NEAR(forces("travel", "antiroll_bar.elastic_force_z"), 0, 1e-6);
    // the seats stand at 0.7 of the half track
    const Pose at = wheel_at_end_of(axle, "opposite");
    const Eigen::Vector3d seat = at.r + at.p * Eigen::Vector3d(0, -0.21, 0);
    EXPECT_NEAR(forces("opposite", "left_spring.force"),
                2640 + 22e3 * (0.2 - (Eigen::Vector3d(0, 0.49, 0.2) - seat).norm()), 1e-6);
    EXPECT_NEAR(std::abs(seat.z()), 0.7 * 0.03, 1e-9);
    const auto refused = [&](const std::string& what, const std::string& by) {
        return refusal_of(replaced(text, what, by), "s.ini", options);
    };
    EXPECT_TRUE(says(refused("LINK_COUNT=4", "LINK_COUNT=2"), "s.ini:31: LINK_COUNT: 2; known"));
    EXPECT_TRUE(says(refused("[AXLE]", "[OTHER]"), "[AXLE]: missing"));
}

TEST(Mechanism, LiveAxleHasBothWheelsOnOneBody) {
    const std::string text = points_named("live_axle.csv");
    const auto axle = [&](const std::string& table) {
        return importer::import_text(table, "p.csv", as("live_axle"));
    };
    const auto middle = [](const importer::Imported& imported, const char* branch) {
        return wheel_at_end_of(parse_scene(imported.yaml, "scene"), branch);
    };
    // links in the middle plane: no bar or Watt's linkage moves an axle sideways by symmetry
    const auto three = axle(text);
    EXPECT_GT(std::abs(middle(three, "travel").r.y() - 0.7), 1e-3);  // the Panhard rod does
    const std::string watt = replaced(
        replaced(text, "Panhard frame,-100,-480,60",
                 "Watt pivot,-120,0,0\nWatt upper rocker,-120,0,80\nWatt upper frame,-120,450,80"),
        "Panhard axle,-100,480,0", "Watt lower rocker,-120,0,-80\nWatt lower frame,-120,-450,-80");
    EXPECT_LT(std::abs(middle(axle(watt), "travel").r.y() - 0.7), 1e-5);
    EXPECT_NO_THROW((void)middle(three, "opposite"));
    // of one side, mirrored; five rigid links leave one motion
    std::string one = text;
    for (const char* line : {"RR Lower link frame,542,-559,-127\n",
                             "RR Lower link axle,0,-559,-127\n", "RR Wheel centre,0,-700,0\n"})
        one = replaced(one, line, "");
    EXPECT_LT((middle(axle(one), "travel").r - middle(three, "travel").r).norm(), 1e-12);
    const auto five =
        axle(replaced(replaced(text, "Upper link frame,642,0", "LR Upper link frame,642,259"),
                      "Upper link axle,0,0",
                      "RR Upper link axle,0,-229,127\nRR Upper link frame,642,-259,100\n"
                      "LR Upper link axle,0,229"));
    EXPECT_TRUE(says(notes_of(five), "leave the axle one motion"));
    EXPECT_FALSE(says(five.yaml, "opposite"));
    EXPECT_NO_THROW((void)middle(five, "travel"));
    EXPECT_TRUE(says(refusal_of(replaced(text, "LR Wheel", "XX Wheel"), "p.csv", as("live_axle")),
                     "no point for left_wheel_centre"));
}

// A row for each bushing, and one for the springs beside dampers.
TEST(Mechanism, RatesOfATableAreAssignedByRole) {
    const support::Folder place;
    auto options = as("strut");
    const std::string rates =
        "role,x [N/mm],y [N/mm],z [N/mm],rx [Nm/deg],ry [Nm/deg],rz [Nm/deg]\n"
        "strut_top,800,800,400,1.5,1.5,0.1\narm_front,8000,7000,400,5,5,1\nspring,,,40,,,\n"
        "tie_rod_inner,9000,9000,9000,0,0,0.1\n";
    options.rates = place.write("rates.csv", rates);
    const auto imported = importer::import_text(points_named("strut.csv"), "p.csv", options);
    const Scene soft = parse_scene(imported.yaml, "scene");
    EXPECT_EQ(soft.elastics.size(), 4u);
    options.rates.clear();
    const Scene rigid = made_of("strut.csv", options);
    const double apart =
        (wheel_at_end_of(soft, "travel").r - wheel_at_end_of(rigid, "travel").r).norm();
    EXPECT_GT(apart, 1e-6);
    EXPECT_LT(apart, 1e-3);
    // rigid where all is stiff
    options.rates = place.write("stiff.csv",
                                "role,x [kN/mm],y [kN/mm],z [kN/mm],rx [Nm/rad]\n"
                                "arm_front,1e6,1e6,1e6,0\narm_rear,1e6,1e6,1e6,0\n");
    EXPECT_LT((wheel_at_end_of(made_of("strut.csv", options), "travel").r -
               wheel_at_end_of(rigid, "travel").r)
                  .norm(),
              1e-9);
}

}  // namespace
}  // namespace elastocheck
