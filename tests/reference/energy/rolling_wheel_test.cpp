// The response of a braked rolling wheel in the energy leg. Its equilibria are in tests/legs.
#include <numbers>

#include "reference/energy/linear_response.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

// Trailing arm of length a with its pivot across, at the height of the wheel centre as drawn: its
// angle θ raises the centre by z = a sin θ, x = a cos θ behind the pivot. A braking force B with B/2
// upwards beside it pushes the patch back, R - z below the pivot, and its moment is held by the
// caliper:
//
//   k θ + M = x (P + B/2) + (R - z) B,   ∂θ/∂F = x / (k + z (P + B/2) + x B)
//
// of a vertical force F at the patch. The chart's potential alone, in which the patch turns with the
// arm, would add R B/2 to that stiffness.
TEST(RollingWheel, VerticalResponseOfABrakedWheelEqualsItsClosedForm) {
    const double a = 0.45, k = 70.6858347058 * 180 / std::numbers::pi, P = 3500, B = 4000;
    const Model model =
        compile(read_scene(std::filesystem::path(ELASTOCHECK_SCENES) /
                           "../../tests/reference/energy/trailing_arm_rolling.yaml"));
    const Branch& braking = *std::ranges::find(model.branches, "braking", &Branch::name);
    const Model standing = on_branch(model, braking);
    const auto path = solve(standing, braking, std::vector{B});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const Equilibrium& state = path.points[0];
    const Disturbance lift = UnitWrench{standing.wheels[0].contact, Vector3d::UnitZ()};
    const auto response = linear_response(standing, braking, state, std::span(&lift, 1));
    ASSERT_EQ(response.outcome, Outcome::converged) << response.detail;
    const double z = state.poses[0].r.z(), x = std::sqrt(a * a - z * z);
    EXPECT_NEAR(response.increments[0][0].dpi.y(), x / (k + z * (P + B / 2) + x * B), 1e-14);
}

}  // namespace
}  // namespace elastocheck::reference::energy
