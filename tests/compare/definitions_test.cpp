// Other definitions of figures: values by hand, and a column by another definition is recognised.
#include "compare/outputs/catalogue/catalogue.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <regex>
#include <set>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
constexpr double degrees = 180 / std::numbers::pi;

// A wheel on ground axes, turned by hand: the carrier is joined to nothing.
struct ByHand {
    Model model;
    Equilibrium state;
    std::vector<Channel> defined;

    // Steering axis from (0.02, 0.55, -0.1) to (-0.03, 0.50, 0.1), camber drawn `camber`.
    explicit ByHand(double camber) {
        Wheel wheel;
        wheel.body = 0;
        wheel.spin_axis_local = {0, std::cos(camber), -std::sin(camber)};
        wheel.contact = {wheel.body, {0, 0, -0.3}};
        wheel.steering_axis = {{0, {0.02, -0.10, -0.1}}, {0, {-0.03, -0.15, 0.1}}};
        model.bodies.push_back({.name = "wheel", .design = {{0, 0.65, 0}, {1, 0, 0, 0}}});
        model.wheels.push_back(wheel);
        state = design_state(model);
        defined = definition_channels(model);
    }
    void turn(const Vector3d& axis, double angle, const Vector3d& shift = Vector3d::Zero()) {
        state.poses[0].p = Eigen::AngleAxisd(angle, axis.normalized()) * state.poses[0].p;
        state.poses[0].r += shift;
    }
    double operator()(const std::string& name) const {
        const auto all = name.find('@') == name.npos ? channels(model) : defined;
        const int c = find_channel(all, name);
        if (c < 0) return NAN;
        return evaluate(model, std::span(&all[static_cast<std::size_t>(c)], 1), state).front();
    }
};

// In the design position of a wheel without toe: the steering axis leans by (-0.05, -0.05) over 0.2.
TEST(Definitions, SteeringAxisFiguresEqualThoseOfALineByHand) {
    const ByHand at(0.02);
    // at the road, 0.3 below the centre: 0.2 below the lower end
    EXPECT_NEAR(at("mechanical_trail@ground_axes"), 1e3 * (0.02 + 0.25 * 0.2), 1e-9);
    EXPECT_NEAR(at("scrub_radius@ground_axes"), 1e3 * (0.10 - 0.25 * 0.2), 1e-9);
    // at the centre: half way
    EXPECT_NEAR(at("mechanical_trail@centre"), 1e3 * -0.005, 1e-9);
    EXPECT_NEAR(at("scrub_radius@centre"), 1e3 * 0.125, 1e-9);
    EXPECT_NEAR(at("mechanical_trail@across_axis"),
                at("mechanical_trail") * std::cos(std::atan(0.25)), 1e-9);
    EXPECT_NEAR(at("caster@wheel_plane"), at("caster"), 1e-9) << "drawn straight ahead";
    // 70 mm along x and 50 mm along y
    EXPECT_NEAR(at("scrub_radius@distance"), std::hypot(70, 50), 1e-9);
}

Model standing(const std::string& scene) { return compile(trim(support::scene(scene)).scene); }

// Outputs, figures and their definitions on a branch, the first without a name, by the equilibrium leg.
struct Outputs {
    Model model;
    std::vector<Channel> all;
    Curve curve;

    explicit Outputs(Model of, const std::string& branch = "", int steps = 2)
        : model(std::move(of)), all(channels(model)) {
        std::ranges::move(characteristics(model), std::back_inserter(all));
        std::ranges::move(definition_channels(model), std::back_inserter(all));
        if (!branch.empty())
            std::erase_if(model.branches, [&](const Branch& b) { return b.name != branch; });
        const Branch& on = model.branches.at(0);
        const PathCurve path = solve_branch(model, all, on, sides_of(model, on, steps),
                                            {.leg = Leg::equilibrium, .every = 1});
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
        curve = path.curve;
    }
    std::vector<double> over(const std::string& name) const {
        const int c = find_channel(all, name);
        EXPECT_GE(c, 0) << name;
        return c < 0 ? std::vector<double>(curve.a.size(), NAN)
                     : curve.channel(static_cast<std::size_t>(c));
    }
    double operator()(const std::string& name) const { return over(name).at(curve.start); }
    double slope(const std::string& name) const {
        const auto values = over(name);
        return (values.back() - values.front()) / (curve.a.back() - curve.a.front());
    }
};

// Arms that swing about lateral axes move the carrier in the side view alone: there the instant centre
// of the drawing is the one of the motion.
TEST(Definitions, SideViewPlanesGiveTheAntiDiveOfArmsOnLateralAxes) {
    for (const auto& [axle, figure] : {std::pair{"front", "anti_dive"}, {"rear", "anti_squat"}}) {
        const Model model =
            compile(support::scene_of("compare/scenes/trailing_links", {{"vehicle.axle", axle}}));
        const Outputs at(model, "", 4);
        const auto motion = at.over(figure), planes = at.over(std::string(figure) + "@planes");
        for (std::size_t k = 0; k < motion.size(); ++k) {
            EXPECT_GT(std::abs(motion[k]), 1) << figure;
            EXPECT_NEAR(motion[k], planes[k], 1e-7) << figure;
        }
    }
}

// With one rate k of both wheels in roll a couple of forces F on the track t turns the line of the wheel
// centres, c apart, by φ = 2 F / (k c):  F t / φ = k t c / 2. The roll centre of the mirrored state is the
// mirrored one.
TEST(Definitions, RollStiffnessFollowsFromWheelRatesAndRollCentreIsMirrored) {
    const Outputs at(standing("front_axle"), "roll", 4);
    const double t = 1e-3 * at("track"), c = 2e-3 * at("left.wheel_centre_y"),
                 k = 1e3 * at("left.wheel_rate_in_roll");
    EXPECT_GT(t - c, 1e-4);
    EXPECT_NEAR(at("roll_stiffness"), k * t * c / 2 / degrees, 1e-6);
    EXPECT_NEAR(at("roll_centre_lateral"), 0, 1e-6);
    const auto across = at.over("roll_centre_lateral"), height = at.over("roll_centre_height");
    EXPECT_GT(std::abs(across.front()), 1);
    EXPECT_NEAR(across.front(), -across.back(), 1e-5);
    EXPECT_NEAR(height.front(), height.back(), 1e-5);
}

// The part of an element in a stiffness is its derivative by the logarithm of the element's rate.
TEST(Definitions, PartsOfTheRollStiffnessAreItsDerivativesByTheRates) {
    Model model = standing("front_axle");
    // The roll is that of the wheel centres: the moment does work on it where its forces act there.
    for (Wheel& wheel : model.wheels) wheel.contact = {wheel.body, wheel.centre_local};
    const Outputs at(model);
    const double whole = at("roll_stiffness"), of_bar = at("roll_stiffness_of_bar");
    const auto with_bar = [&](double factor) {
        Model changed = model;
        auto& bar = *std::ranges::find(changed.elastics, "anti_roll_bar", &Elastic::name);
        std::get<LinearStiffness>(std::get<Bushing>(bar.kind).law).K *= factor;
        return Outputs(changed)("roll_stiffness");
    };
    EXPECT_NEAR((with_bar(1.001) - with_bar(0.999)) / 0.002, of_bar, 1e-5 * whole);
    EXPECT_GT(of_bar, 0.3 * whole);
    EXPECT_NEAR(of_bar + at("roll_stiffness_of_springs") + at("roll_stiffness_of_rubber"), whole,
                0.1 * whole);  // preloads turn
}

// Without preloads no element that rotates carries a force, so that the parts add up.
TEST(Definitions, PartsOfTheRollStiffnessAddUpWithoutPreloads) {
    const std::string text =
        std::regex_replace(support::text_of(std::string(ELASTOCHECK_SCENES) + "/twist_beam.yaml"),
                           std::regex("    preload: 3700\n|trim:\n(  .*\n)+"), "");
    for (const char* patch : {"0.740", "0.720"}) {  // below the wheel centre, and beside it
        const std::vector<Setting> settings{{"points.contact_left.y", patch}};
        const Outputs at(compile(parse_scene(text, "twist_beam.yaml", settings)));
        double sum = 0;
        for (const char* part : {"springs", "bar", "rubber"})
            sum += at(fmt::format("roll_stiffness_of_{}", part));
        EXPECT_GT(sum, 500);  // N·m/deg
        EXPECT_NEAR(sum, at("roll_stiffness"), 1e-9 * sum) << patch;
    }
}

TEST(Definitions, TurningCircleIsTwiceTheWheelbaseOverTheSineOfTheOuterAngle) {
    const Outputs at(standing("front_axle"), "steering", 4);
    const auto left = at.over("left.toe"), right = at.over("right.toe"),
               circle = at.over("turning_circle");
    for (const std::size_t end : {std::size_t{0}, circle.size() - 1}) {
        const double outer = std::min(std::abs(left[end]), std::abs(right[end]));
        EXPECT_NEAR(circle[end], 2e3 * at.model.vehicle->wheelbase / std::sin(outer / degrees),
                    1e-6);
    }
    EXPECT_EQ(at("turning_circle"), undefined);
}

// Steered by 20 deg about the vertical: the wheel's plane turns with the axis, so that the angles
// seen across and along the wheel stay, while those seen along the ground axes change.
TEST(Definitions, CasterInTheWheelPlaneDoesNotChangeBySteeringAboutTheVertical) {
    ByHand at(0);
    const double caster = at("caster"), kingpin = at("kingpin_inclination");
    at.turn(Vector3d::UnitZ(), 20 / degrees);
    EXPECT_NEAR(at("caster@wheel_plane"), caster, 1e-9);
    EXPECT_NEAR(at("kingpin_inclination@wheel_plane"), kingpin, 1e-9);
    EXPECT_GT(std::abs(at("caster") - caster), 1);
    EXPECT_NEAR(at("toe@lateral"), at("toe"), 1e-9) << "no camber: the axis is the spin axis";
}

TEST(Definitions, CamberFiguresEqualThoseByHand) {
    ByHand at(-0.05);  // top inwards
    EXPECT_NEAR(at("camber@kingpin"), at("camber"), 1e-12);
    // of a left wheel inwards is to the right
    EXPECT_NEAR(at("camber@inclination"), degrees * 0.05, 1e-9);
    at.model.vehicle = Vehicle{.wheelbase = 2.8, .cg_height = 0.5, .axle = Axle::front};
    at.defined = definition_channels(at.model);
    at.turn(Vector3d::UnitX(), 0.03, {0.001, -0.004, 0.02});
    // about x all three follow the turn
    EXPECT_NEAR(at("camber"), degrees * (-0.05 - 0.03), 1e-9);
    EXPECT_NEAR(at("camber@lateral"), at("camber"), 1e-9);
    EXPECT_NEAR(at("camber@front_view"), at("camber"), 1e-9);
    EXPECT_NEAR(at("travel@patch"), 1e3 * (0.02 + 0.3 * (1 - std::cos(0.03))), 1e-9);
    EXPECT_NEAR(at("track_change@centre"), -4, 1e-9);
    EXPECT_NEAR(at("wheelbase_change@centre"), 1, 1e-9);
    // the lowest point of the wheel's circle: radius 0.3 in a plane inclined by 0.08
    EXPECT_NEAR(at("track_change@lowest"), 1e3 * (-0.004 + 0.3 * (std::sin(0.08) - std::sin(0.05))),
                1e-9);
    EXPECT_NEAR(at("travel@lowest"), 1e3 * (0.02 - 0.3 * (std::cos(0.08) - std::cos(0.05))), 1e-9);
    // steered, the front view sees e_z / e_y
    at.turn(Vector3d::UnitZ(), 0.5);
    EXPECT_NEAR(std::tan(at("camber@front_view") / degrees),
                std::tan(at("camber") / degrees) / std::cos(0.5), 1e-9);
}

// ---- Rates.

void expect_near(double a, double b, const char* what) {
    EXPECT_NEAR(a, b, 1e-9 * std::max({1., std::abs(a), std::abs(b)})) << what;
}

// Arms that are parallel and horizontal in front view: their planes meet at infinity, at the height
// of no inclination, so that the roll centre lies on the road.
TEST(Definitions, RollCentreByPlanesOfHorizontalParallelArmsIsOnTheRoad) {
    const Model model = compile(support::scene_of("compare/scenes/parallel_arms"));
    const Outputs at(model);
    EXPECT_NEAR(at("roll_centre_height@planes"), 0, 1e-9);
    // the wheel moves straight up: perpendicular to that the line through the patch lies on the
    // road, the one through the centre at its height
    EXPECT_NEAR(at("roll_centre_height"), 0, 1e-9);
    EXPECT_NEAR(at("roll_centre_height@centre"), 300, 1e-9);
}

// One wheel on an upright without toe, rigid links: every figure from another one by hand.
TEST(DefinitionRates, RatesOfAWheelOnRigidLinksEqualHandCalculation) {
    const Outputs at(standing("double_wishbone_rigid"));
    const Wheel& wheel = at.model.wheels[0];
    const auto state = design_state(at.model);
    const Pose& body = state.poses[static_cast<std::size_t>(wheel.body)];
    const Vector3d lever = body.p * (wheel.contact.s_local - wheel.centre_local);
    expect_near(at("front_view_swing_arm@patch"),
                at("front_view_swing_arm") + 1e3 * wheel.side * lever.y(), "arm to the patch");
    expect_near(at("side_view_swing_arm@patch"), at("side_view_swing_arm") - 1e3 * lever.x(),
                "arm to the patch");
    expect_near(at("front_view_swing_arm@camber"), -100 * degrees / at("bump_camber"),
                "1 / (d camber / dz) in radians");
    // of one degree of freedom with unit motion m: C = m mᵀ / k
    expect_near(at("wheel_rate@patch") * at("wheel_rate@centre"),
                at("wheel_rate") * at("wheel_rate"), "reciprocity of patch and centre");
    const double rise = std::sqrt(at("wheel_rate@centre") / at("wheel_rate@patch"));
    expect_near(at("bump_steer@patch"), at("bump_steer") / rise, "over the rise of the patch");
    for (const auto& elastic : at.model.elastics) {
        const std::string ratio = elastic.name + ".motion_ratio";
        if (find_channel(at.all, ratio) < 0) continue;
        expect_near(at(ratio) * at(ratio + "@inverse"), 1, "motion ratio and its inverse");
        expect_near(at(ratio + "@patch") * at(ratio + "@patch_inverse"), 1, "at the patch");
        expect_near(at(ratio + "@patch"), at(ratio) / rise, "over the rise of the patch");
        const double across = at("track_gradient") / 100;
        EXPECT_GE(at(ratio + "@patch_path") * at(ratio), std::hypot(rise, across) - 1e-9);
    }
    // no work of the links: the force-based roll centre is the kinematic one
    expect_near(at("roll_centre_height@forces"), at("roll_centre_height"), "virtual work");
    expect_near(at("traction_force_steer@patch"), -at("braking_force_steer"), "the same force");
}

TEST(DefinitionRates, RatesOfAnAxleFollowFromHeaveRollAndSingleWheels) {
    const Outputs at(standing("front_axle"));
    const double half = at("left.wheel_centre_y") / 1e3;  // [m]
    for (const std::string side : {"left.", "right."}) {
        const auto of = [&](const char* name) { return at(side + name); };
        expect_near(of("lateral_force_steer@parallel") + of("lateral_force_steer@opposed"),
                    2 * of("lateral_force_steer@alone"), "this wheel twice, the other one not");
        expect_near(of("lateral_force_camber@parallel") + of("lateral_force_camber@opposed"),
                    2 * of("lateral_force_camber@alone"), "likewise");
        expect_near(of("aligning_torque_steer@parallel") + of("aligning_torque_steer@opposed"),
                    2 * of("aligning_torque_steer@alone"), "likewise");
        // 1 kN inwards, 30 mm behind: 30 N·m that turn the wheel towards toe-out
        expect_near(of("lateral_force_steer@trail"),
                    of("lateral_force_steer@alone") - 0.3 * of("aligning_torque_steer@alone"),
                    "a trail");
        expect_near(of("braking_force_steer@inboard"), -of("traction_force_steer@alone"),
                    "the same force");
        expect_near(1 / of("wheel_rate@alone"),
                    (1 / of("wheel_rate") + 1 / of("wheel_rate_in_roll")) / 2, "one wheel");
        expect_near(2 * of("bump_steer@alone"),
                    of("bump_steer") + of("roll_steer") / half * degrees,
                    "one wheel: half heave, half roll");
        expect_near(of("roll_camber@road"), of("roll_camber") + 1, "the body rolls too");
        for (const char* figure :
             {"caster", "kingpin_inclination", "scrub_radius", "mechanical_trail"})
            expect_near(of((std::string(figure) + "@instant_axis").c_str()),
                        of((std::string(figure) + "_steered").c_str()), figure);
    }
    expect_near(at("wheel_rate@axle"), at("left.wheel_rate") + at("right.wheel_rate"), "both");
}

// A force at the wheel centre is one at the patch of a wheel whose patch is its centre.
TEST(DefinitionRates, RatesOfAForceAtTheCentreEqualThoseAtAPatchInTheCentre) {
    const Outputs at(standing("double_wishbone"));
    Model moved = at.model;
    moved.wheels[0].contact.s_local = moved.wheels[0].centre_local;
    const Outputs there(std::move(moved));
    expect_near(at("lateral_force_steer@centre"), there("lateral_force_steer"), "steer");
    expect_near(at("braking_force_steer@inboard"), there("braking_force_steer"), "braking");
    EXPECT_GT(std::abs(at("lateral_force_steer@centre") - at("lateral_force_steer")), 1e-4);
}

Model with_tyre(const std::string& tyre) {
    return compile(support::filled_scene(
        "compare/scenes/on_a_tyre",
        {{"TYRE", tyre}, {"HOLD", tyre.starts_with("tyres") ? ", hold: {tyres.t.road: 0}" : ""}}));
}

// The slope of toe over a lateral force that is applied to the scene as it stands, inwards: -y on a left wheel.
double by_difference(const Model& model) { return -1e3 * Outputs(model).slope("toe"); }

TEST(DefinitionRates, RatesOnATyreAndAtConstantLoadEqualDifferencesOfStates) {
    const Model free = with_tyre(""),
                tyre = with_tyre(
                    "tyres: {t: {rate: 200000, preload: 3000}}\nstatic_loads: "
                    "{weight: {on: wheel, at: p, force: [0, 0, -3000]}}");
    const double at_constant_load = Outputs(free)("lateral_force_steer@constant_load"),
                 on_tyres = Outputs(tyre)("lateral_force_steer@on_tyres");
    EXPECT_NEAR(at_constant_load, by_difference(free), 1e-5 * std::abs(at_constant_load));
    EXPECT_NEAR(on_tyres, by_difference(tyre), 1e-5 * std::abs(on_tyres));
    EXPECT_GT(std::abs(on_tyres - at_constant_load), 1e-3 * std::abs(on_tyres));
    expect_near(Outputs(tyre)("lateral_force_steer@constant_load"), at_constant_load,
                "the tyre takes no part");
}

// On a branch at 0 from solved states at ± `half` [SI].
Outputs beside(Model model, const std::string& branch, double half) {
    auto& on = *std::ranges::find(model.branches, branch, &Branch::name);
    on.from = -half, on.to = half, on.steps = 2;
    return Outputs(std::move(model), branch);
}

// Both wheels driven or braked: the toe of solved states under these forces.
TEST(DefinitionRates, RatesOfForcesOnBothWheelsEqualDifferencesOfStates) {
    const Model model = standing("front_axle");
    const Outputs at(model);
    for (const auto& [branch, figure] : {std::pair{"traction", "traction_force_steer@both"},
                                         {"braking", "braking_force_steer@both"}}) {
        const Outputs solved = beside(model, branch, 10);
        for (const std::string side : {"left.", "right."}) {
            const double value = at(side + figure);  // deg/kN
            EXPECT_NEAR(value, 1e3 * solved.slope(side + "toe"), 1e-5 * std::abs(value))
                << side << figure;
            EXPECT_GT(std::abs(value - at(side + std::string(figure).replace(
                                                     std::string(figure).find('@'), 5, "@alone"))),
                      1e-3 * std::abs(value))
                << "the other wheel matters";
        }
    }
}

// The motion ratios of springs and dampers, by their definitions from solved states ± 0.1 mm.
TEST(DefinitionRates, MotionRatiosEqualDifferencesOfStates) {
    for (const char* scene : {"double_wishbone_rigid", "multi_link"}) {
        Model model = standing(scene);
        // a contact patch beside the wheel, which rises otherwise than the centre
        model.wheels[0].contact.s_local += Vector3d(0.1, 0.2, 0);
        const Outputs at(model), near_design = beside(model, "travel", 1e-4);
        const auto solved = [&](const std::string& output) { return near_design.slope(output); };
        int elements = 0;
        for (const std::string name : {"coil", "damper"}) {
            const double shorter = solved(name + ".compression") / solved("travel"),
                         rise = solved("contact_patch_z") / solved("travel"),
                         path = Vector3d(solved("contact_patch_x"), solved("contact_patch_y"),
                                         solved("contact_patch_z"))
                                    .norm() /
                                solved("travel");
            const std::string ratio = name + ".motion_ratio";
            const auto near = [&](const char* definition, double expected) {
                EXPECT_NEAR(at(ratio + definition), expected, 1e-5 * std::abs(expected))
                    << scene << " " << ratio << definition;
            };
            near("", shorter);
            near("@inverse", 1 / shorter);
            near("@patch", shorter / rise);
            near("@patch_inverse", rise / shorter);
            near("@patch_path", path / shorter);
            elements += std::abs(rise - 1) > 1e-3 && std::abs(path / rise - 1) > 1e-4;
        }
        EXPECT_EQ(elements, 2) << "the definitions differ in " << scene;
    }
}

// Milliken's anti-dive by hand from the swing arm, with brakes and drives inboard and outboard, and as a share of all forces.
// The patch is 0.3 m below the centre, and moves forward by 0.3 / arm less per travel.
TEST(DefinitionRates, AntiDiveFiguresEqualThoseByHand) {
    const Model model = with_tyre(
        "vehicle: {wheelbase: 2.7, cg_height: 0.55, axle: front, brake_share: 0.7, drive_share: "
        "0.4}");
    const Outputs at(model);
    const double of_arm = 100 * 2.7 / 0.55 * 300 / at("side_view_swing_arm");
    expect_near(at("anti_dive@inboard") - at("anti_dive"), 0.7 * of_arm,
                "brakes: patch and centre");
    expect_near(at("anti_lift") - at("anti_lift@outboard"), 0.4 * of_arm,
                "drive: centre and patch");
    expect_near(0.7 * at("anti_dive@whole"), at("anti_dive"), "of all braking");
    EXPECT_GT(std::abs(of_arm), 0.1);
    const Model rear = with_tyre(
        "vehicle: {wheelbase: 2.7, cg_height: 0.55, axle: rear, brake_share: 0.3, drive_share: "
        "0.6}");
    const Outputs behind(rear);
    expect_near(behind("anti_lift@inboard") - behind("anti_lift"), -0.3 * of_arm, "rear brakes");
    expect_near(behind("anti_squat") - behind("anti_squat@outboard"), -0.6 * of_arm, "rear drive");
    expect_near(0.3 * behind("anti_lift@whole"), behind("anti_lift"), "of all braking");
    expect_near(0.6 * behind("anti_squat@whole"), behind("anti_squat"), "of all driving");
}

// Two wheels turned by hand; l / j = 2.
TEST(DefinitionRates, AckermannFiguresEqualThoseByHand) {
    Model model;
    for (const int side : {1, -1}) {
        Wheel wheel;
        wheel.name = side > 0 ? "left" : "right";
        wheel.body = static_cast<BodyId>(model.bodies.size());
        wheel.side = side;
        wheel.spin_axis_local = {0, double(side), 0};
        wheel.contact = {wheel.body, {0, 0, -0.3}};
        model.bodies.push_back({.name = wheel.name, .design = {{0, 0.7 * side, 0}, {1, 0, 0, 0}}});
        model.wheels.push_back(wheel);
    }
    model.vehicle = Vehicle{.wheelbase = 2.8, .cg_height = 0.5, .axle = Axle::front};
    const auto all = definition_channels(model);
    const auto turned = [&](double left, double right) {
        Equilibrium state = design_state(model);
        state.poses[0].p = Eigen::AngleAxisd(left, Vector3d::UnitZ());
        state.poses[1].p = Eigen::AngleAxisd(right, Vector3d::UnitZ());
        std::map<std::string, double> values;
        const auto found = evaluate(model, all, state);
        for (std::size_t c = 0; c < all.size(); ++c) values[all[c].name] = found[c];
        return values;
    };
    const double inner = 20 / degrees, outer = std::atan(1 / (1 / std::tan(inner) + 0.5));
    for (const bool to_the_left : {true, false}) {
        auto at = to_the_left ? turned(inner, outer) : turned(-outer, -inner);
        EXPECT_NEAR(at.at("ackermann@error"), 0, 1e-9);
        EXPECT_NEAR(at.at("ackermann@outer"), 100, 1e-9);
        EXPECT_NEAR(at.at("ackermann@inner"), 100, 1e-9);
        EXPECT_NEAR(at.at("left.toe@steer"), degrees * (to_the_left ? inner : -outer), 1e-9);
        EXPECT_NEAR(at.at("right.toe@steer"), degrees * (to_the_left ? outer : -inner), 1e-9);
        // to the left the left wheel toes out, the right one in
        EXPECT_NEAR(at.at("toe@axle"), -degrees * std::abs(inner - outer), 1e-9);
        at = to_the_left ? turned(inner, inner) : turned(-inner, -inner);
        EXPECT_NEAR(at.at("ackermann@error"), degrees * (inner - outer), 1e-9) << "too much";
        EXPECT_NEAR(at.at("ackermann@outer"), 0, 1e-9);
        EXPECT_NEAR(at.at("ackermann@inner"), 0, 1e-9);
        // half of the difference that the inner angle asks for
        at =
            to_the_left ? turned(inner, (inner + outer) / 2) : turned(-(inner + outer) / 2, -inner);
        EXPECT_NEAR(at.at("ackermann@outer"), 50, 1e-9);
    }
    EXPECT_EQ(turned(0, 0).at("ackermann@error"), undefined);
}

// ---- Judgement.

// Far below what tells definitions apart, and above the accuracy of the references.
constexpr Tolerance tight{.mm = 1e-6, .deg = 1e-6, .share = 1e-6};

struct Judged {
    Model model;
    Comparison comparison;
    std::vector<Channel> defined;
    // of a branch by the equilibrium leg: parameter in its unit, outputs of the comparison,
    // then of `defined`
    std::string branch;
    std::vector<double> a;
    std::vector<std::vector<double>> values;

    Judged(Model of_scene, const std::string& of_branch)
        : model(std::move(of_scene)), branch(of_branch) {
        std::erase_if(model.branches, [&](const Branch& b) { return b.name != branch; });
        Options options;
        options.prove = false;
        comparison = compare(model, options);
        defined = definition_channels(model);
        auto all = comparison.channels;
        all.insert(all.end(), defined.begin(), defined.end());
        const Branch& of = model.branches.front();
        const PathCurve path =
            solve_branch(model, all, of, sides_of(model, of, 12), {.leg = Leg::equilibrium});
        a = path.curve.a;
        for (std::size_t c = 0; c < all.size(); ++c) values.push_back(path.curve.channel(c));
    }
    CandidateJudgement judge(std::size_t channel, const std::vector<double>& column) const {
        Candidate candidate;
        candidate.points.a = a;
        candidate.points.branch.assign(a.size(), branch);
        candidate.points.columns.push_back({.channel = channel, .values = column});
        return judge_candidate(model, comparison, candidate, tight);
    }
    // The figure by another definition.
    const std::vector<double>& by(const Channel& other) const {
        const auto d = static_cast<std::size_t>(find_channel(defined, other.name));
        return values[comparison.channels.size() + d];
    }
};

// Each definition in turn is the column of its figure, unchanged and with a sign, a unit or an offset, and is named among
// the explanations, unless it differs from the figure by nothing, a sign or an offset, which are simpler explanations.
TEST(Definitions, OtherDefinitionInAColumnIsNamedWithSignUnitAndOffset) {
    std::set<std::string> recognised;
    std::map<std::string, std::string> else_as;
    std::vector<std::pair<Model, std::string>> runs;
    for (const auto& [scene, branch] : {std::pair{"double_wishbone_rigid", "steering"},
                                        {"double_wishbone_rigid", "travel"},
                                        {"front_axle", "steering"},
                                        {"front_axle", "opposite"},
                                        {"multi_link", "travel"}})
        runs.emplace_back(standing(scene), branch);
    runs.emplace_back(with_tyre("tyres: {t: {rate: 200000}}"), "side");
    // drawn with 3 deg of camber and 2 deg of toe, which an axis without them does not have
    Model drawn = standing("double_wishbone_rigid");
    drawn.wheels[0].spin_axis_local = Vector3d(0.035, 1, 0.052).normalized();
    runs.emplace_back(std::move(drawn), "steering");
    for (auto& [model, branch] : runs) {
        const Judged at(std::move(model), branch);
        for (std::size_t c = 0; c < at.comparison.channels.size(); ++c)
            for (const Channel& other :
                 definitions_of(at.defined, at.comparison.channels[c].name)) {
                const std::string name =
                    figure_of(other.name) + other.name.substr(other.name.find('@'));
                if (recognised.contains(name)) continue;
                // undefined values are not given
                std::vector<double> column = at.by(other);
                for (double& v : column)
                    if (!std::isfinite(v)) v = NAN;
                const CandidateJudgement plain = at.judge(c, column);
                // a rate is explained where it is off by a thousandth of its range
                double off = 0, low = INFINITY, high = -INFINITY;
                for (std::size_t k = 0; k < column.size(); ++k) {
                    const double reference = at.values[c][k];
                    if (!std::isfinite(column[k]) || !std::isfinite(reference)) continue;
                    off = std::max(off, std::abs(column[k] - reference));
                    low = std::min(low, reference);
                    high = std::max(high, reference);
                }
                if (plain.verdict == Grade::pass || !(off > 1e-3 * (high - low))) {
                    else_as[name] = "the figure itself";
                    continue;
                }
                // nothing of it moves, or the figure has no value: not judged
                if (plain.verdict == Grade::not_judged) continue;
                ASSERT_FALSE(plain.explanations.empty()) << other.name << " in " << branch;
                if (plain.explanations.front().kind != Explanation::Kind::definition) {
                    else_as[name] = "a simpler cause";
                    continue;
                }
                recognised.insert(name);
                struct Change {
                    double factor, offset;
                };
                for (const Change by : {Change{1, 0}, {-1, 0}, {60, 0}, {1, 7.5}}) {
                    std::vector<double> changed = column;
                    for (double& v : changed) v = by.factor * v + by.offset;
                    const auto judged = at.judge(c, changed);
                    EXPECT_EQ(judged.verdict, Grade::fail) << other.name;
                    ASSERT_FALSE(judged.explanations.empty()) << other.name << " " << by.factor;
                    const auto& e = judged.explanations.front();
                    EXPECT_TRUE(e.kind == Explanation::Kind::definition &&
                                std::ranges::any_of(e.definitions,
                                                    [&](const std::string& named) {
                                                        return named.starts_with(other.name);
                                                    }))
                        << other.name << " · " << by.factor << " + " << by.offset << ": "
                        << judged.hints.front();
                }
            }
    }
    // In every scene these are the figure with a sign, a factor or an offset, which are simpler
    // causes, or the figure itself; an Ackermann figure has no value straight ahead, and is not
    // compared on a branch through there.
    const std::set<std::string> never{
        "toe@steer", "camber@inclination", "anti_dive@whole", "anti_lift@whole", "anti_squat@whole",
        "roll_camber@road", "ackermann@error", "ackermann@outer", "ackermann@inner",
        // over a patch that stays below the wheel centre the figure itself
        "side_view_swing_arm@patch",
        // no built-in scene has a driven rear axle of two wishbones
        "anti_squat@planes",
        // of every axle the figure itself
        "braking_force_steer@both", "braking_force_camber@both", "traction_force_steer@both",
        "longitudinal_stiffness@both", "longitudinal_stiffness_at_centre@both"};
    for (const Entry* definition : definitions())
        EXPECT_NE(recognised.contains(definition->name), never.contains(definition->name))
            << definition->name << " is " << else_as[definition->name];
}

// A nearly constant column fits every curve with a small factor and an offset, so that it identifies none.
TEST(Definitions, NearlyConstantColumnIsNotExplainedByAScaledDefinition) {
    ColumnWithReference b;
    for (int k = 0; k <= 20; ++k) {
        const double x = 0.1 * (k - 10);
        b.reference.push_back(14 + 4 * x + x * x);
        b.definitions.resize(1);
        b.definitions[0].push_back(3 + 5 * x * x * x);
        b.candidate.push_back(k < 7 ? 16.06 : 16.05);  // as printed
        b.begin.push_back(14);
        b.at.push_back(x);
        b.branch.push_back("travel");
    }
    b.definition_names = {"scrub_radius@other"};
    b.tolerance = 0.01;
    const auto found = explain(b);
    EXPECT_FALSE(found) << static_cast<int>(found->kind) << " · " << found->factor << " + "
                        << found->offset;
    // a column of the same values in metres moves, though by little
    for (std::size_t k = 0; k < b.candidate.size(); ++k) b.candidate[k] = 1e-3 * b.reference[k];
    const auto metres = explain(b);
    ASSERT_TRUE(metres);
    EXPECT_EQ(metres->kind, Explanation::Kind::factor);
    EXPECT_DOUBLE_EQ(metres->factor, 1e-3);
}

// ---- The page.

// The tables of figures, definitions and sets, as in README.md beside catalogue.hpp.
std::string table_of_definitions() {
    const auto cell = [](std::string text) {
        for (std::size_t k = 0; (k = text.find('|', k)) != text.npos; k += 2) text.insert(k, "\\");
        return text;
    };
    const auto row = [&](const Entry& entry) {
        std::string definition = entry.definition;
        if (const auto at = definition.find(" '{}'"); at != definition.npos)
            definition.erase(at, 5);
        return fmt::format("| `{}` | {} | {} | {} |\n", entry.name, symbol(entry.unit),
                           cell(definition), cell(entry.properties.sources));
    };
    std::string text =
        "| output | unit | definition | formula; sources, and what others call it |\n"
        "|---|---|---|---|\n";
    for (const Entry& entry : catalogue())
        if (!entry.on_request) text += row(entry);
    text += "\n| output | unit | definition | found in; names elsewhere |\n|---|---|---|---|\n";
    for (const Entry* entry : definitions())
        if (entry->on_request) text += row(*entry);
    text += "\n| set | source | outputs |\n|---|---|---|\n";
    for (const DefinitionSet& set : definition_sets()) {
        std::string members;
        for (const auto& member : set.members)
            members += (members.empty() ? "`" : ", `") + member + "`";
        text += fmt::format("| `{}` | {} | {} |\n", set.name, set.source, members);
    }
    return text;
}

TEST(Definitions, ReadmeOfTheCatalogueHasTheTableOfItsDefinitions) {
    std::ifstream file(ELASTOCHECK_DEFINITIONS "/README.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    const std::string table = table_of_definitions();
    EXPECT_NE(page.find(table), page.npos)
        << "compare/outputs/catalogue/README.md has to contain\n\n"
        << table;
    // members exist, and a name is defined once
    std::set<std::string> names;
    for (const Entry* d : definitions())
        // of springs and of dampers
        EXPECT_TRUE(names.insert(d->name).second || figure_of(d->name) == "motion_ratio")
            << d->name;
    for (const DefinitionSet& set : definition_sets())
        for (const auto& member : set.members) EXPECT_TRUE(names.contains(member)) << member;
}

// `count` points of output `c` of a branch, evenly spaced, with the figure by other definitions.
ColumnWithReference few_points(const Judged& at, std::size_t c, std::size_t count) {
    ColumnWithReference b;
    const auto taken = [&](const std::vector<double>& values) {
        std::vector<double> few;
        for (std::size_t k = 0; k < count; ++k)
            few.push_back(values[k * (values.size() - 1) / (count - 1)]);
        return few;
    };
    b.reference = taken(at.values[c]);
    b.at = taken(at.a);
    b.begin.assign(count, at.values[c][at.a.size() / 2]);
    b.branch.assign(count, at.branch);
    for (const Channel& other : definitions_of(at.defined, at.comparison.channels[c].name)) {
        b.definitions.push_back(taken(at.by(other)));
        b.definition_names.push_back(other.name);
    }
    for (std::size_t o = 0; o < at.comparison.channels.size(); ++o)
        if (o != c && at.comparison.channels[o].unit == at.comparison.channels[c].unit) {
            b.others.push_back(taken(at.values[o]));
            b.other_channels.push_back(o);
        }
    return b;
}

// Of 1000 wrong columns each, straight, smooth, without order or beside the reference by a smooth deviation, judged to
// a hundredth of the range of the reference, at most 1 % are explained by anything.
TEST(Definitions, AtMostOnePercentOfWrongColumnsAreExplained) {
    const Judged at(standing("double_wishbone_rigid"), "steering");
    std::mt19937 random(11);
    std::uniform_real_distribution<double> in(-1, 1);
    for (const std::size_t count : {std::size_t{3}, std::size_t{4}, std::size_t{5}, at.a.size()})
        for (const int shape : {1, 2, 3, 4}) {
            int explained = 0, tried = 0;
            std::string last;
            while (tried < 1000)
                for (std::size_t c = 0; c < at.comparison.channels.size() && tried < 1000; ++c) {
                    ColumnWithReference b = few_points(at, c, count);
                    const auto [low, high] = std::ranges::minmax(b.reference);
                    const double range = high - low;
                    if (b.definitions.empty() || !(range > 1e-9)) continue;
                    b.tolerance = 0.01 * range;
                    const double from = in(random), slope = in(random), bend = in(random);
                    for (std::size_t k = 0; k < count; ++k) {
                        const double x = b.at[k] / std::abs(b.at.back()),
                                     straight = from + slope * x, smooth = straight + bend * x * x;
                        b.candidate.push_back(
                            shape == 4 ? b.reference[k] + range * (smooth + std::sin(3 * x))
                                       : low + range * (0.5 + (shape == 1   ? straight
                                                               : shape == 2 ? smooth
                                                                            : in(random))));
                    }
                    const auto found = explain(b);
                    if (found && found->kind != Explanation::Kind::from_there_on) {
                        ++explained;
                        last = fmt::format("{} as kind {} · {} + {}, {}",
                                           at.comparison.channels[c].name,
                                           static_cast<int>(found->kind), found->factor,
                                           found->offset, fmt::join(found->definitions, " "));
                    }
                    ++tried;
                }
            EXPECT_LE(explained, 10) << count << " points, shape " << shape << ": " << last;
        }
}

// The straight rest of a trail, 5.3 times as steep as the reference, is a slope that could be anything;
// what is planted is found with three points too.
TEST(Definitions, PlantedTransformationIsFoundInAColumnOfFewPoints) {
    const Judged at(standing("double_wishbone_rigid"), "steering");
    int definitions_found = 0;
    for (const std::size_t count : {3, 4, 5})
        for (std::size_t c = 0; c < at.comparison.channels.size(); ++c) {
            ColumnWithReference b = few_points(at, c, count);
            const auto [low, high] = std::ranges::minmax(b.reference);
            const double range = high - low;
            if (b.definitions.empty() || !(range > 1e-6)) continue;
            const std::string& name = at.comparison.channels[c].name;
            b.tolerance = 1e-4 * range;
            const auto kind_of = [&](double factor, double offset, const std::vector<double>& of) {
                b.candidate = of;
                for (double& v : b.candidate) v = factor * v + offset;
                const auto found = explain(b);
                return found ? std::optional(found->kind) : std::nullopt;
            };
            using Kind = Explanation::Kind;
            EXPECT_EQ(kind_of(1, 0.5 * range, b.reference), Kind::offset) << name << " " << count;
            const auto turned = kind_of(-1, 0, b.reference), unit = kind_of(60, 0, b.reference);
            EXPECT_TRUE(turned == Kind::sign || turned == Kind::offset ||
                        turned == Kind::definition)
                << name << " " << count;
            EXPECT_TRUE(unit == Kind::factor) << name << " " << count;
            for (const auto& definition : b.definitions) {
                const double off = [&] {
                    double worst = 0;
                    for (std::size_t k = 0; k < count; ++k)
                        worst = std::max(worst, std::abs(definition[k] - b.reference[k]));
                    return worst;
                }();
                if (std::isfinite(off) && off > 0.05 * range)
                    definitions_found += kind_of(1, 0, definition) == Kind::definition;
            }
        }
    EXPECT_GE(definitions_found, 20);

    // numbers of a manufacturer's table against the reference, tests/outside
    ColumnWithReference b;
    b.candidate = {145.42, 144.80, 144.19};
    b.reference = {143.92, 143.80, 143.68};
    b.begin = {143.57, 143.57, 143.57};
    b.at = {-30, -20, -10};
    b.branch.assign(3, "bump");
    b.tolerance = 0.01;
    EXPECT_FALSE(explain(b));
}

}  // namespace
}  // namespace elastocheck::compare
