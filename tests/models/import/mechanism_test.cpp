// Mechanisms made of named points move as scenes written by hand; what the command says of them is in
// tests/reports/claims/points.claims.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/comparison/elements.hpp"
#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

using namespace tests;
using namespace std::string_literals;
using Eigen::Vector3d;

std::string points_named(const std::string& name) {
    return support::text_of(import_folder / "points" / name);
}

Scene made_of(const std::string& file, const importer::Options& options) {
    return parse_scene(importer::import_text(points_named(file), file, options).yaml, "scene");
}
importer::Options as(const std::string& mechanism, const std::string& axes = "x-forward,y-left") {
    importer::Options options;
    options.axes = axes;
    options.as = mechanism;
    return options;
}
importer::Options axle_of_a_file(const char* axle, bool both_wheels = false) {
    importer::Options options;
    options.axle = axle;
    options.both_wheels = both_wheels;
    return options;
}

// The wheel at the end of a branch.
Pose wheel(const Scene& scene, const std::string& branch) {
    return solved(compile(scene), branch)
        .points.back()
        .poses[static_cast<std::size_t>(scene.wheels.at(0).body)];
}

Scene by_hand(const std::string& name) {
    const std::vector<Setting> settings{
        {"branches.travel.from", "-0.03"}, {"branches.travel.to", "0.03"},
        {"branches.travel.steps", "60"},   {"branches.steering.from", "-0.03"},
        {"branches.steering.to", "0.03"},  {"branches.steering.steps", "60"}};
    return read_scene(std::filesystem::path(ELASTOCHECK_SCENES) / name, settings);
}

// The wheel's way from `a` to `b` at the end of a branch.
double apart(const Scene& a, const Scene& b, const std::string& branch,
             const Vector3d& by = Vector3d::Zero()) {
    return (wheel(a, branch).r - wheel(b, branch).r - by).norm();
}

TEST(Mechanism, WishboneAndStrutOfPointsMoveAsTheScenesWrittenByHand) {
    const Scene wishbone = by_hand("double_wishbone_rigid.yaml");
    for (const char* branch : {"travel", "steering"}) {
        EXPECT_LT(apart(made_of("optimum_names.csv", as("double_wishbone")), wishbone, branch),
                  1e-9);
        EXPECT_LT(apart(made_of("strut.csv", as("strut")), by_hand("mcpherson_rigid.yaml"), branch),
                  1e-9);
    }
    // the right side, x to the rear: the rack's positive side is the other one
    for (const char* file : {"saved.shk", "listing.shk"}) {
        const Scene right = made_of(file, as("double_wishbone", "x-rearward,y-right"));
        EXPECT_EQ(right.wheels.at(0).side, -1);
        const Vector3d y(0, 2 * wheel(right, "travel").r.y(), 0);
        EXPECT_LT(apart(right, wishbone, "travel", y), 1e-9) << file;
    }
}

TEST(Mechanism, BothWheelsMoveAsOneWheelAndItsMirrorImage) {
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
            EXPECT_LT(apart(one, two, branch), 1e-9) << file << " " << branch;
        if (left) {
            EXPECT_LT((wheel(one, "travel").r - wheel(two, "opposite").r).norm(), 1e-9);
        }
    }
}

TEST(Mechanism, PushrodAndRockerOfADamperDoNotChangeTheMotion) {
    auto options = as("double_wishbone");
    options.pushrod = "lower";
    const Scene scene = made_of("optimum_names.csv", options);
    EXPECT_EQ(scene.bodies.size(), 5u);
    EXPECT_EQ(scene.dampers.size(), 1u);
    EXPECT_LT(apart(scene, by_hand("double_wishbone_rigid.yaml"), "travel"), 1e-9);
}

// Groups of columns in inches, a listing with a pushrod, whole words.
TEST(Mechanism, PointListsOfOtherLayoutsGiveMechanismsThatMove) {
    auto options = as("double_wishbone");
    options.pushrod = "upper";
    const Scene groups = made_of("optimum_groups.csv", options);
    EXPECT_EQ(groups.dampers.size(), 1u);
    EXPECT_NEAR(wheel(groups, "travel").r.z(), 0.203 + 0.03, 1e-4);
    options = as("double_wishbone", "x-rearward,y-left,z-up");
    EXPECT_NO_THROW((void)wheel(made_of("words.csv", options), "steering"));
    options.pushrod = "lower";
    EXPECT_NO_THROW((void)wheel(made_of("listing_pushrod.shk", options), "travel"));
}

TEST(Mechanism, AxleIsSelectedFromATableWithTwoRowsOfHeadings) {
    auto front = as("five_link"), rear = front;
    front.axle = "front", rear.axle = "rear";
    EXPECT_LT(apart(made_of("five_link.csv", front), made_of("five_link.csv", rear), "travel",
                    {2.7, 0, 0}),
              1e-9);
}

// The file has the hand-written scene's points from the wheel centre, x inboard and with the rim's offset; its rear
// axle is that of the table, whose links have other names.
TEST(Mechanism, AssettoCorsaFileGivesTheMechanismOfItsPoints) {
    const Scene hand = by_hand("double_wishbone_rigid.yaml"),
                made = made_of("suspensions.ini", axle_of_a_file("front"));
    EXPECT_LT(apart(made, hand, "travel", made.bodies.at(2).design.r - hand.bodies.at(2).design.r),
              1e-9);
    auto table = as("five_link");
    table.axle = "front";
    EXPECT_LT(apart(made_of("suspensions.ini", axle_of_a_file("rear")),
                    made_of("five_link.csv", table), "travel"),
              1e-9);
    for (const auto& [name, axle] : {std::pair{"suspensions", "rear"}, {"strut_and_axle", "rear"}})
        expect_refusals(name, points_named(name + ".ini"s), "s.ini", [&](const std::string& text) {
            return refusal_of(text, "s.ini", axle_of_a_file(axle));
        });
}

// A strut with its spring along it, and a live axle with its anti-roll bar.
TEST(Mechanism, AssettoCorsaFileGivesSpringsAndBars) {
    const Scene pair = made_of("strut_and_axle.ini", axle_of_a_file("front", true)),
                axle = made_of("strut_and_axle.ini", axle_of_a_file("rear"));
    const auto force = [](const Scene& scene, const char* branch, const std::string& element) {
        const Model model = compile(scene);
        const std::vector<compare::Channel> channels = compare::element_channels(model);
        const auto& of = *std::ranges::find(model.branches, branch, &Branch::name);
        const auto& channel =
            channels.at(static_cast<std::size_t>(compare::find_channel(channels, element)));
        return compare::evaluate(model, of, {&channel, 1}, solved(model, branch).points.back())
            .at(0);
    };
    EXPECT_NEAR(std::abs(force(pair, "opposite", "antiroll_bar.elastic_force_z")), 720, 1e-6);
    // 30 mm each way: the bar has 8 N/mm of 60 mm, and nothing in parallel travel
    EXPECT_NEAR(std::abs(force(axle, "opposite", "antiroll_bar.elastic_force_z")), 480, 1e-6);
    EXPECT_NEAR(force(axle, "travel", "antiroll_bar.elastic_force_z"), 0, 1e-6);
    // the seats stand at 0.7 of the half track
    const Pose end = wheel(axle, "opposite");
    const Vector3d seat = end.r + end.p * Vector3d(0, -0.21, 0);
    EXPECT_NEAR(force(axle, "opposite", "left_spring.force"),
                2640 + 22e3 * (0.2 - (Vector3d(0, 0.49, 0.2) - seat).norm()), 1e-6);
    EXPECT_NEAR(std::abs(seat.z()), 0.7 * 0.03, 1e-9);
}

TEST(Mechanism, LiveAxleHasBothWheelsOnOneBody) {
    const std::string text = points_named("live_axle.csv");
    const auto axle = [&](const std::string& table) {
        return parse_scene(importer::import_text(table, "p.csv", as("live_axle")).yaml, "scene");
    };
    // links in the middle plane: no bar or Watt's linkage moves an axle sideways by symmetry
    const Scene three = axle(text);
    EXPECT_GT(std::abs(wheel(three, "travel").r.y() - 0.7), 1e-3);  // the Panhard rod does
    const std::string watt = replaced(
        replaced(text, "Panhard frame,-100,-480,60",
                 "Watt pivot,-120,0,0\nWatt upper rocker,-120,0,80\nWatt upper frame,-120,450,80"),
        "Panhard axle,-100,480,0", "Watt lower rocker,-120,0,-80\nWatt lower frame,-120,-450,-80");
    EXPECT_LT(std::abs(wheel(axle(watt), "travel").r.y() - 0.7), 1e-5);
    EXPECT_NO_THROW((void)wheel(three, "opposite"));
    // of one side, mirrored; five rigid links leave one motion
    std::string one = text;
    for (const char* line : {"RR Lower link frame,542,-559,-127\n",
                             "RR Lower link axle,0,-559,-127\n", "RR Wheel centre,0,-700,0\n"})
        one = replaced(one, line, "");
    EXPECT_LT(apart(axle(one), three, "travel"), 1e-12);
    const Scene five =
        axle(replaced(replaced(text, "Upper link frame,642,0", "LR Upper link frame,642,259"),
                      "Upper link axle,0,0",
                      "RR Upper link axle,0,-229,127\nRR Upper link frame,642,-259,100\n"
                      "LR Upper link axle,0,229"));
    EXPECT_EQ(std::ranges::count(five.branches, "opposite", &Branch::name), 0);
    EXPECT_NO_THROW((void)wheel(five, "travel"));
}

// The table has a row for each bushing and one for the springs; without its bushings the mechanism is rigid.
TEST(Mechanism, RatesOfATableAreAssignedByRole) {
    const support::Folder place;
    auto options = as("strut");
    const Scene rigid = made_of("strut.csv", options);
    options.rates = (import_folder / "points/strut_rates.csv").string();
    const Scene soft = made_of("strut.csv", options);
    EXPECT_EQ(soft.elastics.size(), 4u);
    EXPECT_GT(apart(soft, rigid, "travel"), 1e-6);
    EXPECT_LT(apart(soft, rigid, "travel"), 1e-3);
    options.rates = place.write("stiff.csv",
                                "role,x [kN/mm],y [kN/mm],z [kN/mm],rx [Nm/rad]\n"
                                "arm_front,1e6,1e6,1e6,0\narm_rear,1e6,1e6,1e6,0\n");
    EXPECT_LT(apart(made_of("strut.csv", options), rigid, "travel"), 1e-9);
}

}  // namespace
}  // namespace elastocheck
