// The contact of a rolling wheel in the energy leg, against closed forms.
#include <fstream>
#include <numbers>
#include <sstream>

#include "reference/energy/linear_response.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

// Trailing arm of length a with its pivot across, at the height of the wheel centre as drawn: its
// angle θ raises the centre by a sin θ. A vertical force F acts below the centre, not at the point of
// the arm that touched the road as drawn; a braking force B pushes the patch back, with the lever
// R - a sin θ from the pivot down to the patch, and its moment is held by the caliper:
//
//   k θ + M = a cos θ F + (R - a sin θ) B
//
// The load `brake` is B with F = B/2 beside it.
constexpr double a = 0.45, R = 0.32, M = 1575, k = 70.6858347058 * 180 / std::numbers::pi,
                 k_t = 200e3, P = 3500;

double angle_where(const std::function<double(double)>& moment) {
    double low = -1, high = 1;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (k * middle + M < moment(middle) ? low : high) = middle;
    }
    return low;
}

double tyre_force(double theta, double road) {
    return std::max(0., P - k_t * (a * std::sin(theta) - road));
}

struct TrailingArm : testing::Test {
    Scene scene = read_scene(std::filesystem::path(ELASTOCHECK_SCENES) /
                             "../../tests/reference/energy/trailing_arm_rolling.yaml");
    Model model = compile(scene);

    const Branch& named(const std::string& name) const {
        return *std::ranges::find(model.branches, name, &Branch::name);
    }
    // Each state has the arm's angle at which the moments balance, and its own residuals vanish.
    void expect(const std::string& name, const std::function<double(double, double)>& moment) {
        for (const Branch& side : ways(named(name))) {
            const Model standing = on_branch(model, side);
            const auto path = solve(standing, side, every_point(side, side.steps));
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            for (const auto& state : path.points) {
                const double theta = angle_where([&](double t) { return moment(t, state.load); });
                EXPECT_NEAR(state.poses[0].r.z(), a * std::sin(theta), 1e-12) << state.load;
                EXPECT_LE(largest(residuals(standing, side, state)), 1e-7) << state.load;
            }
        }
    }
};

TEST_F(TrailingArm, IsLoadedBelowItsWheelCentre) {
    expect("up", [](double t, double F) { return a * std::cos(t) * F; });
}

// The tyre lifts off at -188 mm; from there the arm hangs.
TEST_F(TrailingArm, StandsOnATyreThatOnlyPushes) {
    expect("road", [](double t, double road) { return a * std::cos(t) * tyre_force(t, road); });
    const double on_top =
        angle_where([](double t) { return a * std::cos(t) * tyre_force(t, 0.1); });
    EXPECT_NEAR(tyre_force(on_top, 0.1), 5430, 1);
}

TEST_F(TrailingArm, IsBrakedAtItsCaliper) {
    expect("braking", [](double t, double B) {
        return a * std::cos(t) * (P + B / 2) + (R - a * std::sin(t)) * B;
    });
}

// ∂θ/∂F = a cos θ / (k + a sin θ F + a cos θ B). That of the chart's potential alone would have
// R B/2 more below: there the patch turns with the arm.
TEST_F(TrailingArm, RespondsWithTheStiffnessOfItsBrake) {
    const Branch& braking = named("braking");
    const Model standing = on_branch(model, braking);
    const double B = 4000;
    const auto path = solve(standing, braking, std::vector{B});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const Equilibrium& state = path.points[0];
    const Disturbance lift = UnitWrench{standing.wheels[0].contact, Vector3d::UnitZ()};
    const auto response = linear_response(standing, braking, state, std::span(&lift, 1));
    ASSERT_EQ(response.outcome, Outcome::converged) << response.detail;
    const double z = state.poses[0].r.z(), theta = std::asin(z / a), x = a * std::cos(theta);
    EXPECT_NEAR(response.increments[0][0].dpi.y(), x / (k + z * (P + B / 2) + x * B), 1e-14);
}

// p = c - R (n - (n·e) e)/|n - (n·e) e| wherever toe, camber and caster of a wheel change.
TEST(RollingWheel, TouchesTheRoadAtTheLowestPointOfItsDisc) {
    std::ifstream file(std::filesystem::path(ELASTOCHECK_SCENES) / "double_wishbone.yaml");
    std::stringstream text;
    text << file.rdbuf();
    std::string rolling = text.str();
    const std::string field = "contact_patch:";
    ASSERT_NE(rolling.find(field), std::string::npos);
    rolling.replace(rolling.find(field), 0, "contact: rolling, ");
    const Model model = compile(parse_scene(rolling, "double_wishbone"));
    const Wheel& wheel = model.wheels[0];
    ASSERT_TRUE(wheel.rolls());
    int states = 0;
    for (const Branch& branch : model.branches)
        for (const Branch& side : ways(branch)) {
            const Model standing = on_branch(model, side);
            const auto path = solve(standing, side, every_point(side, 4));
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            for (const auto& state : path.points) {
                const auto place = [&](BodyId body, const Vector3d& s) -> Vector3d {
                    const Pose& pose = state.poses[static_cast<std::size_t>(body)];
                    return pose.r + pose.p * s;
                };
                const Vector3d c = place(wheel.body, wheel.centre_local),
                               e = place(wheel.body, wheel.centre_local + wheel.spin_axis_local) -
                                   c,
                               n = Vector3d::UnitZ();
                const Vector3d p = place(wheel.contact.body, wheel.contact.s_local);
                const double radius = wheel.contact.s_local.norm();
                EXPECT_LE((p - (c - radius * (n - n.dot(e) * e).normalized())).norm(), 1e-12);
                ++states;
            }
        }
    EXPECT_GE(states, 20);
}

}  // namespace
}  // namespace elastocheck::reference::energy
