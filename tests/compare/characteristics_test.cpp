// Kinematics and compliance characteristics: closed forms by every leg, mirror image and units, and
// consistency of forces with motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/subject.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double deg = 180 / pi;
constexpr std::array all_legs{Leg::equilibrium, Leg::energy, Leg::series, Leg::recursive};

std::string point(double x, double y, double z) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x, y, z);
}
std::string point(const Vector3d& p) { return point(p.x(), p.y(), p.z()); }

Model filled(const std::string& name, const support::Places& places) {
    return compile(support::filled_scene("compare/scenes/" + name, places));
}

// Characteristics at a = 0 of a branch, the first by default, by one leg.
class Read {
  public:
    Read(const Model& model, Leg leg, const std::string& branch = "")
        : way_(way(model, branch)), channels_(characteristics(model)) {
        const auto path = settle_start(way_, leg);
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
        if (path.points.empty()) return;
        state = path.points.front();
        response = wheel_response(way_, {.leg = leg}, steering_joint(model), state);
        EXPECT_EQ(response.why_not, "") << name(leg);
        values_ = row_of(model, channels_, way_, {.leg = leg}, state).values;
    }
    double operator[](const std::string& name) const {
        const int c = find_channel(channels_, name);
        if (c < 0 || values_.empty()) {
            ADD_FAILURE() << "no " << name;
            return std::nan("");
        }
        return values_[static_cast<std::size_t>(c)];
    }
    const std::vector<double>& values() const { return values_; }
    const std::vector<Channel>& channels() const { return channels_; }

    Equilibrium state;
    WheelResponse response;

  private:
    static BranchSide way(const Model& model, const std::string& name) {
        for (const auto& branch : model.branches)
            if (name.empty() || branch.name == name) return sides_of(model, branch).front();
        throw std::logic_error("no branch " + name);
    }
    BranchSide way_;
    std::vector<Channel> channels_;
    std::vector<double> values_;
};

// Both undefined, or alike to a share of the value, at least of 1.
void expect_alike(double is, double other, double share, const std::string& where) {
    if (is == undefined) {
        EXPECT_EQ(other, undefined) << where;
    } else {
        EXPECT_NEAR(other, is, share * std::max(1.0, std::abs(is))) << where;
    }
}

// ---- One arm about a fixed axis: closed form by the velocity field ω × (p - a).

struct Arm {
    Vector3d a, b;  // of the axis
    Vector3d centre{0, 1.1, 0}, patch{0, 1.1, -0.3};
    Vector3d n() const { return (b - a).normalized(); }
    Vector3d v(const Vector3d& p) const { return n().cross(p - a); }
};
const Arm trailing{{0.5, 0.9, 0.1}, {0.5, 0.5, 0.1}};

Model arm_scene(const Arm& arm, const std::string& more = "") {
    return filled("wheel_on_an_arm", {{"A", point(arm.a)},
                                      {"B", point(arm.b)},
                                      {"C", point(arm.centre)},
                                      {"P", point(arm.patch)},
                                      {"MORE", more}});
}

TEST(Characteristics, SemiTrailingArmEqualsRotationAboutItsAxisInEveryLeg) {
    const Arm arm{{0.5, 0.9, 0.02}, {0.42, 0.5, -0.05}, {0, 1.1, 0}, {0.03, 1.12, -0.3}};
    const Model model = arm_scene(arm);
    const Vector3d v_c = arm.v(arm.centre), v_p = arm.v(arm.patch), n = arm.n(), e(0, 1, 0),
                   de = n.cross(e);
    const double dz = v_c.z();
    const Vector3d top(0.1, 1.0, 0.4), low(0.1, 1.0, 0);
    const double ratio = arm.v(low).z() / dz, k = 50e3;
    for (const Leg leg : all_legs) {
        SCOPED_TRACE(name(leg));
        const Read is(model, leg);
        EXPECT_NEAR(is["bump_steer"], deg * de.x() / dz, 1e-9);
        EXPECT_NEAR(is["bump_camber"], deg / 10 * -de.z() / dz, 1e-9);
        EXPECT_NEAR(is["track_gradient"], 100 * v_p.y() / dz, 1e-9);
        EXPECT_NEAR(is["recession_gradient"], 100 * -v_c.x() / dz, 1e-9);
        EXPECT_NEAR(is["roll_centre_height"], 1e3 * arm.patch.y() * v_p.y() / v_p.z(), 1e-6);
        // In side view the arm turns about the intersection of its axis with the wheel plane
        // y = 1.1.
        const Vector3d from_side = arm.a + n * (arm.centre.y() - arm.a.y()) / n.y();
        EXPECT_NEAR(is["side_view_swing_arm"], 1e3 * (from_side.x() - arm.centre.x()), 1e-6);
        const Vector3d from_front = arm.a + n * (arm.centre.x() - arm.a.x()) / n.x();
        EXPECT_NEAR(is["front_view_swing_arm"], 1e3 * (arm.centre.y() - from_front.y()), 1e-6);
        EXPECT_NEAR(is["coil.motion_ratio"], ratio, 1e-12);
        // Unloaded: force at the patch over travel of the centre is k (dℓ/dφ)² / (v_p v_c).
        EXPECT_NEAR(is["wheel_rate"], 1e-3 * k * std::pow(arm.v(low).z(), 2) / (v_p.z() * dz),
                    1e-9);
        EXPECT_EQ(is["lateral_stiffness"], undefined);  // rigid with the wheel held
        EXPECT_NEAR(is["lateral_force_steer"], 0, 1e-12);
    }
}

TEST(Characteristics, TrailingArmHasRollCentreOnTheRoadAndInfiniteFrontViewArm) {
    for (const Leg leg : all_legs) {
        const Read is(arm_scene(trailing), leg);
        EXPECT_NEAR(is["roll_centre_height"], 0, 1e-9);
        EXPECT_EQ(is["front_view_swing_arm"], undefined);
        EXPECT_NEAR(is["side_view_swing_arm"], 500, 1e-9);
        EXPECT_NEAR(is["bump_steer"], 0, 1e-9);
    }
}

// On an oblique slide both wheels move together: back by a quarter and across by a tenth
// of their rise.
TEST(Characteristics, FiguresOfAnAxleOnAnObliqueSlideAreThoseOfItsHeave) {
    const Model model = filled("axle_on_a_joint",
                               {{"JOINT", "type: translational, at: mid, axis: [-0.25, 0.1, 1]"}});
    for (const Leg leg : all_legs) {
        SCOPED_TRACE(name(leg));
        const Read is(model, leg);
        EXPECT_TRUE(is.response.tied);
        for (const std::string wheel : {"left.", "right."}) {
            EXPECT_NEAR(is[wheel + "recession_gradient"], 25, 1e-9);
            EXPECT_NEAR(is[wheel + "track_gradient"], wheel == "left." ? 10 : -10, 1e-9);
            EXPECT_NEAR(is[wheel + "bump_steer"], 0, 1e-12);
            EXPECT_EQ(is[wheel + "roll_steer"], undefined);
            // Half of the spring's 50 N/mm with the effect of the oblique slide: each patch
            // takes 1 N.
            EXPECT_NEAR(is[wheel + "wheel_rate"], 25, 1e-9);
            EXPECT_EQ(is[wheel + "wheel_rate_in_roll"], undefined);
        }
        EXPECT_NEAR(is["coil.motion_ratio"], 1, 1e-9);
        EXPECT_EQ(is["roll_centre_height"], undefined);
    }
}

// About an axis beside the right wheel the left one rises by 2.8, the right one by 1.2: each value
// is per metre of its own wheel's travel.
TEST(Characteristics, WheelsOfARigidAxleHaveTheirOwnTravel) {
    const Model model =
        filled("axle_on_a_joint", {{"JOINT", "type: revolute, at: beside, axis: x"}});
    for (const Leg leg : all_legs) {
        SCOPED_TRACE(name(leg));
        const Read is(model, leg);
        EXPECT_TRUE(is.response.tied);
        EXPECT_NEAR(is["left.bump_camber"], -deg / 10 / 2.8, 1e-9);
        EXPECT_NEAR(is["right.bump_camber"], deg / 10 / 1.2, 1e-9);
        EXPECT_NEAR(is["left.track_gradient"], 100 * 0.3 / 2.8, 1e-9);
        EXPECT_NEAR(is["right.track_gradient"], -100 * 0.3 / 1.2, 1e-9);
    }
}

// Per unit of rise the patch moves back by (0.1 + 0.3)/0.5, the centre by 0.1/0.5: the pivot is
// ahead and above.
TEST(Characteristics, AntiDiveAndAntiSquatFollowFromTheAngleOfTheArm) {
    const auto with = [](const char* axle) {
        return arm_scene(trailing,
                         fmt::format("vehicle: {{wheelbase: 2.5, cg_height: 0.5, axle: {}, "
                                     "brake_share: 0.4, drive_share: 1}}\n",
                                     axle));
    };
    const Read rear(with("rear"), Leg::equilibrium), front(with("front"), Leg::equilibrium);
    EXPECT_NEAR(rear["anti_lift"], 100 * 0.4 * 0.8 * 5, 1e-9);
    EXPECT_NEAR(rear["anti_squat"], 100 * 0.2 * 5, 1e-9);
    // A leading pivot gives negative anti-dive at the front.
    EXPECT_NEAR(front["anti_dive"], -100 * 0.4 * 0.8 * 5, 1e-9);
    EXPECT_NEAR(front["anti_lift"], -100 * 0.2 * 5, 1e-9);
}

// An unresisted motion has an undefined rate; a failed solve gives NaN, and the two
// are never confused.
TEST(Characteristics, FailedResponseIsNotReportedAsAMissingRate) {
    const Model model = arm_scene(trailing);
    Read is(model, Leg::equilibrium);
    const auto list = characteristics(model);
    const auto& rate = list[static_cast<std::size_t>(find_channel(list, "wheel_rate"))];
    const auto value = [&] {
        return value_of(model, std::get<Catalogued>(rate.reads), is.state, is.response);
    };
    EXPECT_TRUE(std::isfinite(value()));
    is.response.free.clear();
    EXPECT_TRUE(std::isnan(value()));
    is.response.nothing_resists = true;
    EXPECT_EQ(value(), undefined);
}

// ---- Two arms in the transverse plane: the wheel rotates about the intersection of their lines.

TEST(Characteristics, EqualParallelArmsHaveNoCamberGainAndInfiniteFrontViewArm) {
    // Both arms fall by 0.1 over 0.4 towards the wheel: its points move inwards by a quarter of the
    // rise; with rising arms outwards.
    for (const double fall : {0.0, 0.1, -0.1}) {
        const Model model = filled("arms_in_a_plane", {{"UI", point(0, 0.3, 0.45)},
                                                       {"UO", point(0, 0.7, 0.45 - fall)},
                                                       {"LI", point(0, 0.3, 0.15)},
                                                       {"LO", point(0, 0.7, 0.15 - fall)}});
        for (const Leg leg : all_legs) {
            const Read is(model, leg);
            EXPECT_NEAR(is["bump_camber"], 0, 1e-9) << fall;
            EXPECT_EQ(is["front_view_swing_arm"], undefined) << fall;
            EXPECT_NEAR(is["track_gradient"], 100 * fall / 0.4, 1e-9);
            EXPECT_NEAR(is["roll_centre_height"], 1e3 * 0.8 * fall / 0.4, 1e-8) << fall;
        }
    }
}

TEST(Characteristics, RollCentreLiesOnTheLineFromThePatchToTheInstantCentre) {
    const Model model = filled("arms_in_a_plane", {{"UI", "[0, 0.35, 0.42]"},
                                                   {"UO", "[0, 0.68, 0.46]"},
                                                   {"LI", "[0, 0.3, 0.18]"},
                                                   {"LO", "[0, 0.72, 0.14]"}});
    // Where the lines z = 0.42 + 0.04/0.33 (y - 0.35) and z = 0.18 - 0.04/0.42 (y - 0.3) meet.
    const double m = 0.04 / 0.33, n = -0.04 / 0.42,
                 y = (0.18 - n * 0.3 - 0.42 + m * 0.35) / (m - n), z = 0.42 + m * (y - 0.35);
    for (const Leg leg : all_legs) {
        const Read is(model, leg);
        EXPECT_NEAR(is["front_view_swing_arm"], 1e3 * (0.8 - y), 1e-6);
        EXPECT_NEAR(is["roll_centre_height"], 1e3 * z * 0.8 / (0.8 - y), 1e-6);
        EXPECT_NEAR(is["bump_camber"], deg / 10 * -1 / (0.8 - y), 1e-9);
    }
}

// ---- Steering.

// A carrier on two balls, held to the ground: it rotates about the line through them when the rack
// pushes its arm. The line passes the wheel centre, whose height steering then keeps.
TEST(Characteristics, SteeringAxisPassesThroughBothBallJoints) {
    struct Line {
        // slopes: dx/dz, dy/dz to the top; of the wheel centre [m]
        double caster, inclination, inboard;
    };
    // A vertical line may lie beside the wheel centre, whose height is constant as well.
    for (const auto& [caster, inclination, inboard] : {Line{0.1, 0.2, 0}, Line{0, 0, 0.08}})
        for (const int side : {1, -1}) {
            const auto at = [&](double x, double y, double z) { return point(x, side * y, z); };
            const Model model = filled(
                "steered_by_a_rack",
                {{"TOP", at(-0.2 * caster, 0.8 - inboard - 0.2 * inclination, 0.5)},
                 {"LOW", at(0.2 * caster, 0.8 - inboard + 0.2 * inclination, 0.1)},
                 {"C", at(0, 0.8, 0.3)},
                 {"P", at(0, 0.8, 0)},
                 {"OUTER", at(-0.15, 0.75, 0.3)},
                 {"INNER", at(-0.15, 0.4, 0.3)},
                 {"ABOVE", at(0, 0.5, 0.9)},
                 {"SIDE", side > 0 ? "spin_axis: y, side: left" : "spin_axis: -y, side: right"}});
            for (const Leg leg : all_legs) {
                const Read is(model, leg);
                EXPECT_NEAR(is["caster_steered"], deg * std::atan(caster), 1e-8) << name(leg);
                EXPECT_NEAR(is["kingpin_inclination_steered"], deg * std::atan(inclination), 1e-8);
                EXPECT_NEAR(is["mechanical_trail_steered"], 1e3 * 0.3 * caster, 1e-7);
                // 0.3 below the wheel centre the axis is further out by 0.3 · 0.2:
                // beyond the patch.
                EXPECT_NEAR(is["scrub_radius_steered"], 1e3 * (inboard - 0.3 * inclination), 1e-7);
            }
        }
}

// About a vertical kingpin the distance of patch and axis across and along the wheel is the same at
// every angle.
TEST(Characteristics, ScrubAndTrailAreMeasuredInAxesOfTheSteeredWheel) {
    for (const int side : {1, -1})
        for (const double steered : {0.0, 0.9, -0.4}) {
            const auto turned = [&](double x, double y) {
                return Vector3d(std::cos(steered) * x - std::sin(steered) * side * y,
                                std::sin(steered) * x + std::cos(steered) * side * y, 0);
            };
            const auto at = [&](double x, double y, double z) {  // from the kingpin
                return point(turned(x, y) + Vector3d(0, side * 0.7, z));
            };
            const Model model = filled("steered_about_a_kingpin",
                                       {{"LOW", at(0, 0, -0.1)},
                                        {"UP", at(0, 0, 0.2)},
                                        {"C", at(0, 0.05, 0)},
                                        {"P", at(-0.03, 0.1, -0.3)},
                                        {"AXIS", point(turned(0, 1))},
                                        {"SIDE", side > 0 ? "side: left" : "side: right"}});
            const Read is(model, Leg::equilibrium);
            EXPECT_NEAR(is["scrub_radius_steered"], 100, 1e-6) << side << " " << steered;
            EXPECT_NEAR(is["mechanical_trail_steered"], 30, 1e-6) << side << " " << steered;
        }
}

// ---- Compliance.

// One body on one bushing: closed form of the response to a wrench at a point at r, from r and K.
TEST(Characteristics, ComplianceOfOneBushingIsItsInverseStiffnessAtTheWheel) {
    const Model model = compile(support::scene_of("compare/scenes/wheel_on_a_bushing"));
    const Vector3d lever = Vector3d(0, 1, 0) - Vector3d(0.1, 0.7, 0.4);
    const auto tilde = [](const Vector3d& v) {
        Eigen::Matrix3d m;
        m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
        return m;
    };
    Matrix6 A = Matrix6::Identity();  // the wrench about the bushing of a unit wrench at the patch
    A.bottomLeftCorner<3, 3>() = tilde(lever);
    const Vector6 flexible =
        (Vector6() << 1 / 2e6, 1 / 5e6, 1 / 4e6, 1 / 9e3, 1 / 7e3, 1 / 8e3).finished();
    const Matrix6 expected = A.transpose() * flexible.asDiagonal() * A;
    for (const Leg leg : all_legs) {
        const Read is(model, leg);
        const Eigen::MatrixXd C = compliance(model, WheelPoint::patch, is.state, is.response);
        ASSERT_EQ(C.rows(), 6);
        EXPECT_LE((C - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff())
            << name(leg) << "\n"
            << C;
        EXPECT_LE(reciprocity(model, C), 1e-13);
        EXPECT_NEAR(is["wheel_rate"],
                    1e-3 / compliance(model, WheelPoint::centre, is.state, is.response)(2, 2),
                    1e-6);
        // With the wheel's height held: the compliance minus the part of the jack.
        Matrix6 at_centre = compliance(model, WheelPoint::centre, is.state, is.response);
        const Vector6 z = at_centre.col(2);
        at_centre -= z * z.transpose() / z[2];
        EXPECT_NEAR(is["longitudinal_stiffness_at_centre"], 1e-3 / at_centre(0, 0), 1e-6);
        // The patch is below the centre, so the jack has the same effect. Inwards is -y, backwards
        // -x, and towards toe-in of a left wheel -z.
        Matrix6 held = C;
        held -= C.col(2) * C.row(2) / C(2, 2);
        EXPECT_NEAR(is["lateral_force_steer"], 1e3 * deg * held(5, 1), 1e-9);
        EXPECT_NEAR(is["braking_force_steer"], 1e3 * deg * held(5, 0), 1e-9);
        EXPECT_NEAR(is["lateral_force_camber"], 1e3 * deg * held(3, 1), 1e-9);
        EXPECT_NEAR(is["lateral_stiffness"], 1e-3 / held(1, 1), 1e-6);
        EXPECT_NEAR(is["aligning_torque_steer"], 100 * deg * at_centre(5, 5), 1e-12);
        EXPECT_NEAR(is["traction_force_steer"], 1e3 * deg * -at_centre(5, 0), 1e-9);
    }
}

// A jack and a tyre act as the dead force they exert: the response equals that under this force at
// the same place.
TEST(Characteristics, WheelOnAJackOrTyreRespondsAsUnderTheForceTheyExert) {
    const auto rates_at_end = [&](const Model& model, const std::string& force) {
        const auto all = characteristics(model);
        const BranchSide way = sides_of(model, model.branches[0]).front();
        const SolverSettings solver{.leg = Leg::equilibrium};
        const auto path = solve_branch(way, solver);
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
        auto told = channels(model);
        std::ranges::move(element_channels(model), std::back_inserter(told));
        const int c = find_channel(told, force);
        const auto values = evaluate(way.model, way.branch, told, path.points.back());
        return std::pair{row_of(model, all, way, solver, path.points.back()).values,
                         c < 0 ? 0.0 : values[static_cast<std::size_t>(c)]};
    };
    const std::string dead = "branches: {up: {load: up, to: 500, steps: 2}}";
    std::string text = support::scene_text("compare/scenes/wheel_on_an_arm");
    for (const auto& [word, by] : {std::pair{"$A", trailing.a},
                                   {"$B", trailing.b},
                                   {"$C", trailing.centre},
                                   {"$P", trailing.patch}})
        text = support::replaced(text, word, point(by));
    const auto scene = [&](const std::string& branches, const std::string& more,
                           const std::string& at = "p") {
        std::string edited = support::replaced(text, dead, branches);
        edited = support::replaced(edited, "at: p, force", "at: " + at + ", force");
        return compile(parse_scene(support::replaced(edited, "$MORE", more), "arm"));
    };
    struct Case {
        std::string branches, more, force, at;
    };
    for (const Case& held :
         {Case{"branches: {t: {drive: travel, to: 0.08, steps: 2}}", "", "jack.drive_force", "c"},
          Case{"branches: {t: {drive: tyres.front.road, to: 0.1, steps: 2}}",
               "tyres: {front: {rate: 200e3, preload: 0}}\n", "front.force", "p"}}) {
        const auto [by_holding, force] = rates_at_end(scene(held.branches, held.more), held.force);
        ASSERT_GT(force, 1000) << held.force;
        const auto by_load =
            rates_at_end(
                scene(fmt::format("branches: {{t: {{load: up, to: {:.17g}, steps: 2}}}}", force),
                      held.more, held.at),
                "")
                .first;
        ASSERT_EQ(by_load.size(), by_holding.size());
        for (std::size_t c = 0; c < by_load.size(); ++c)
            expect_alike(by_load[c], by_holding[c], 1e-7, fmt::format("{} {}", held.force, c));
    }
}

// ---- Built-in suspensions.

// Trimmed where the scene requests it.
Model standing(const Scene& scene) { return compile(trim(scene).scene); }

TEST(Characteristics, LegsAgreeAndCompliancesAreReciprocalOnEverySuspension) {
    for (const char* scene :
         {"mcpherson", "mcpherson_strut", "double_wishbone", "double_wishbone_rigid", "multi_link",
          "semi_trailing_arm", "twist_beam", "solid_axle", "front_axle"}) {
        SCOPED_TRACE(scene);
        const Model model = standing(support::scene(scene));
        const Read truth(model, Leg::equilibrium), second(model, Leg::energy),
            series(model, Leg::series);
        for (std::size_t c = 0; c < truth.values().size(); ++c)
            for (const Read* other : {&second, &series})
                expect_alike(truth.values()[c], other->values()[c], 1e-6, truth.channels()[c].name);
        for (const Read* leg : {&truth, &second, &series}) {
            const auto C = compliance(model, WheelPoint::centre, leg->state, leg->response);
            EXPECT_LE(reciprocity(model, C), 1e-8);
        }
    }
}

TEST(Characteristics, MirrorImageAndUnitsDoNotChangeTheFigures) {
    for (const char* name : {"double_wishbone", "semi_trailing_arm", "front_axle"}) {
        const Scene scene = support::scene(name);
        const Read is(standing(scene), Leg::equilibrium),
            other(standing(support::mirrored(scene)), Leg::equilibrium),
            units(standing(support::in_millimetres_and_kilonewtons(name)), Leg::equilibrium);
        for (std::size_t c = 0; c < is.values().size(); ++c) {
            const auto& channel = is.channels()[c];
            const std::string where = std::string(name) + " " + channel.name;
            for (const Read* same : {&other, &units})
                expect_alike(is.values()[c], same->values()[c], 1e-7, where);
            // Left and right values of an axle are equal, but for the steer gradient: one rack
            // steers one wheel in and the other out.
            if (channel.name.starts_with("left.") && is.values()[c] != undefined &&
                !channel.name.ends_with("steer_gradient"))
                expect_alike(is.values()[c], is["right." + channel.name.substr(5)], 1e-7, where);
        }
    }
}

// Virtual work: the lateral movement of the patch per wheel rise equals the jack force per lateral
// force. The first is a motion, the second a force, from independent curves.
TEST(Characteristics, RollCentreFromJackForceEqualsThatFromPatchMotion) {
    for (const char* name :
         {"double_wishbone", "mcpherson_strut", "multi_link", "semi_trailing_arm"}) {
        Scene scene = support::scene(name);
        for (auto& branch : scene.branches)
            if (branch.name == "lateral") branch.from = -1, branch.to = 1, branch.steps = 2;
        const Model model = standing(scene);
        const auto& lateral = *std::ranges::find(model.branches, "lateral", &Branch::name);
        const auto force = run(model, lateral, Leg::equilibrium);
        const auto jack =
            static_cast<std::size_t>(find_channel(channels(model), "jack.drive_force"));
        const double per_newton =
            (force.curve.values.back()[jack] - force.curve.values.front()[jack]) / 2;
        const Read is(model, Leg::equilibrium, "lateral");
        const Point& patch = model.wheels[0].contact;
        const double y = position(is.state.poses, patch).y();
        // The jack acts at the centre; the rise of the patch differs slightly with camber.
        const double rises =
            Subject::displacement(is.response.travel[0], Subject{model, &is.state}.placed(patch))
                .z();
        EXPECT_NEAR(is["roll_centre_height"], -1e3 * y * per_newton / rises, 1e-3) << name;
    }
}

// Rates equal the slopes of the curves, by central differences.
TEST(Characteristics, RatesAreTheDerivativesOfTheCurves) {
    Scene scene = support::scene("double_wishbone");
    const double step = 1e-4;
    for (auto& branch : scene.branches)
        if (branch.name == "travel") branch.from = -step, branch.to = step, branch.steps = 2;
    const Model model = standing(scene);
    const auto& travel = *std::ranges::find(model.branches, "travel", &Branch::name);
    const auto curve = run(model, travel, Leg::equilibrium).curve;
    const auto slope = [&](const char* channel) {
        const auto c = static_cast<std::size_t>(find_channel(channels(model), channel));
        return (curve.values.back()[c] - curve.values.front()[c]) / (2e3 * step);
    };
    const Read is(model, Leg::equilibrium, "travel");
    EXPECT_NEAR(is["bump_steer"], 1e3 * slope("toe"), 1e-4);
    EXPECT_NEAR(is["bump_camber"], 1e2 * slope("camber"), 1e-4);
    EXPECT_NEAR(is["recession_gradient"], -1e2 * slope("wheel_centre_x"), 1e-4);
}

// The published matrix contains no spring force: its wheel rate is that of the unloaded suspension.
TEST(Characteristics, WheelRateOfThePublishedTangentOmitsTheEffectOfPreload) {
    const Model unloaded = arm_scene(trailing),
                loaded = arm_scene(
                    trailing, "static_loads: {weight: {on: arm, at: p, force: [0, 0, 2000]}}\n");
    const double published = Read(loaded, Leg::recursive)["wheel_rate"],
                 truth = Read(loaded, Leg::equilibrium)["wheel_rate"];
    EXPECT_GT(std::abs(published - truth), 0.01 * truth);
    EXPECT_NEAR(Read(unloaded, Leg::recursive)["wheel_rate"],
                Read(unloaded, Leg::equilibrium)["wheel_rate"], 1e-9);
}

}  // namespace
}  // namespace elastocheck::compare
