// Axles: mirrored definition, rack, and several drivers on one branch.
#include <gtest/gtest.h>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"

namespace elastocheck::compare {
namespace {

// The McPherson strut of models/scenes/chrono_mcpherson.yaml on both sides of a rack.
constexpr const char* axle = R"(
elastocheck: 1
name: McPherson axle with a rack
units: {length: mm, angle: deg, force: N, moment: N·m}
mirror: left -> right
points:
  arm_front_left: [220, 520, -156]
  arm_rear_left: [-300, 507, -137]
  ball_left: [-21.65371, 940.57703, -174.02826]
  tie_inner_left: [-300, 520, -59]
  tie_outer_left: [-237.3756, 894.95045, -16.05418]
  top_left: [-115, 785, 579]
  lower_left: [-74.02507, 853.2915, 248.4536]
  centre_left: [-40, 1100, -26]
  rack_centre: [-300, 0, -59]
bodies:
  arm_left: {origin: ball_left}
  wheel_left: {origin: centre_left}
  strut_left: {origin: top_left}
  rack: {origin: rack_centre}
joints:
  ball_left: {type: spherical, bodies: [arm_left, wheel_left], at: ball_left}
  tube_left: {type: cylindrical, bodies: [wheel_left, strut_left], at: lower_left, axis: [lower_left, top_left]}
  tie_left: {type: distance, bodies: [wheel_left, rack], from: tie_outer_left, to: tie_inner_left}
  rack: {type: translational, bodies: [rack, ground], at: rack_centre, axis: y, held: true}
springs:
  coil_left: {bodies: [wheel_left, strut_left], from: lower_left, to: top_left, rate: 30}
bushings:
  mount_left: {bodies: [strut_left, ground], at: top_left, frame: {z: [lower_left, top_left]}, rates: [1200, 1200, 2000]}
  front_left: {bodies: [arm_left, ground], at: arm_front_left, frame: {x: [arm_rear_left, arm_front_left]},
               rates: [1500, 12000, 12000], rotational_rates: [3, 10, 10]}
  rear_left: {bodies: [arm_left, ground], at: arm_rear_left, frame: {x: [arm_rear_left, arm_front_left]},
              rates: [600, 2500, 2500], rotational_rates: [2, 6, 6]}
loads:
  drag_left: {on: wheel_left, at: centre_left, force: [-1, 0, 0]}
branches:
  parallel: {drive: [left.travel, right.travel], from: -60, to: 60, steps: 12}
  roll: {drive: {left.travel: 1, right.travel: -1}, from: -40, to: 40, steps: 8}
  steer_low: {drive: joints.rack, from: -40, to: 40, steps: 8, hold: {left.travel: -30, right.travel: -30}}
  steer_mid: {drive: joints.rack, from: -40, to: 40, steps: 8, hold: {left.travel: 0, right.travel: 0}}
  steer_high: {drive: joints.rack, from: -40, to: 40, steps: 8, hold: {left.travel: 30, right.travel: 30}}
  braked: {drive: [left.travel, right.travel], to: 60, steps: 6, static_loads: {drag_left: 400, drag_right: 400}}
wheels:
  left: {body: wheel_left, centre: centre_left, spin_axis: y, side: left}
)";

struct Solved {
    Comparison comparison;

    Solved() {
        Options options;
        options.recursion.method = recursive::find_method("series").value();
        comparison = compare(compile(parse_scene(axle, "axle.yaml")), options);
    }
    const Curve& curve(std::string_view branch, Leg leg) const {
        for (const auto& b : comparison.branches)
            if (b.branch == branch) return b.runs[static_cast<std::size_t>(leg)].curve;
        throw std::logic_error("no such branch");
    }
    std::vector<double> channel(std::string_view branch, std::string_view name, Leg leg) const {
        return curve(branch, leg)
            .channel(static_cast<std::size_t>(find_channel(comparison.channels, name)));
    }
};
const Solved& solved() {
    static const Solved all;
    return all;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size() || a.empty()) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        if (!(std::abs(a[k] - b[k]) <= worst)) worst = std::abs(a[k] - b[k]);
    return worst;
}
std::vector<double> backwards(std::vector<double> x) {
    std::ranges::reverse(x);
    return x;
}

TEST(Axle, EveryBranchIsConclusiveAndTheSeriesMeetsTheReferences) {
    const auto& all = solved().comparison;
    EXPECT_TRUE(all.conclusive());
    EXPECT_EQ(all.branches.size(), 6u);
    for (const auto& branch : all.branches) {
        for (const auto& why : branch.inconclusive.texts())
            ADD_FAILURE() << branch.branch << ": " << why;
        for (std::size_t c = 0; c < all.channels.size(); ++c)
            if (all.channels[c].main && all.channels[c].kinematic()) {
                EXPECT_LE(branch.deviation.equal_parameter.channels[c].max, 1e-9)
                    << branch.branch << " " << all.channels[c].name;
            }
    }
}

TEST(Axle, ParallelTravelIsSymmetricAndRollAntisymmetric) {
    for (const Leg leg : legs)
        for (const char* what : {"toe", "camber", "wheel_centre_x", "jack.drive_force"}) {
            const std::string left = std::string("left.") + what,
                              right = std::string("right.") + what;
            const double bound = std::string_view(what) == "jack.drive_force" ? 1e-5 : 1e-8;
            EXPECT_LE(largest_difference(solved().channel("parallel", left, leg),
                                         solved().channel("parallel", right, leg)),
                      bound)
                << name(leg) << " " << what;
            EXPECT_LE(largest_difference(solved().channel("roll", left, leg),
                                         backwards(solved().channel("roll", right, leg))),
                      bound)
                << name(leg) << " " << what;
        }
}

TEST(Axle, SteeringTurnsBothWheelsAndTheHeldHeightsAreHeld) {
    for (const auto& [branch, height] :
         {std::pair{"steer_low", -30.0}, {"steer_mid", 0.0}, {"steer_high", 30.0}})
        for (const Leg leg : legs) {
            for (const char* side : {"left.travel", "right.travel"})
                for (const double travel : solved().channel(branch, side, leg))
                    EXPECT_NEAR(travel, height, 1e-9) << branch << " " << name(leg);
            const auto left = solved().channel(branch, "left.toe", leg),
                       right = solved().channel(branch, "right.toe", leg);
            EXPECT_GT(std::abs(left.back() - left.front()), 10);
            EXPECT_LE(largest_difference(left, backwards(right)), 1e-8)
                << branch << " " << name(leg);
            const auto force = solved().channel(branch, "rack.drive_force", leg);
            std::vector<double> opposite = backwards(force);
            for (double& f : opposite) f = -f;
            EXPECT_LE(largest_difference(force, opposite), 1e-5) << branch << " " << name(leg);
        }
}

TEST(Axle, ABrakingForceIsHeldAlongTheTravel) {
    const auto plain = solved().channel("parallel", "left.wheel_centre_x", Leg::equilibrium),
               braked = solved().channel("braked", "left.wheel_centre_x", Leg::equilibrium);
    EXPECT_LT(braked.front(), plain[6] - 0.1);  // at the design height: pulled back
}

}  // namespace
}  // namespace elastocheck::compare
