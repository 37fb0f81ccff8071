// Residuals of the energy leg, for its own states and those of other legs.
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

struct Judged {
    Model model;
    Equilibrium state;
    Residuals now() const { return residuals(model, model.branches[0], state); }
};

Judged solved_at(const std::string& name, double load) {
    Judged judged{compile(scene_named(name)), {}};
    const double loads[] = {load};
    judged.state = solve(judged.model, judged.model.branches[0], loads).points.at(0);
    return judged;
}

TEST(Residuals, AMicronewtonIsSeenAtTenKilonewtons) {
    Judged pair = solved_at("bushing_pair", 1e4);
    EXPECT_LE(largest(pair.now()), 1e-8);
    pair.state.load += 1e-6;
    EXPECT_NEAR(pair.now().force, 1e-6, 1e-8);

    Judged strut = solved_at("chrono_mcpherson", 1e4);
    const double before = strut.now().force;
    EXPECT_LE(before, 5e-8);
    strut.state.load += 1e-6;
    EXPECT_GE(strut.now().force, 10 * before);
}

TEST(Residuals, AMovedBodyIsSeenAsAConstraintError) {
    Judged strut = solved_at("chrono_mcpherson", 1000);
    EXPECT_LE(strut.now().length, 1e-15);
    strut.state.poses[0].r.y() += 1e-6;  // the arm, off its ball joint
    EXPECT_NEAR(strut.now().length, 1e-6, 1e-12);
    strut = solved_at("chrono_mcpherson", 1000);
    strut.state.poses[2].p =
        Eigen::AngleAxisd(1e-6, Vector3d::UnitX()) * strut.state.poses[2].p;  // out of its tube
    EXPECT_GE(strut.now().direction, 1e-7);
    EXPECT_LE(strut.now().direction, 2e-6);
}

TEST(Residuals, AMovedBodyIsSeenAsAnImbalance) {
    Judged block = solved_at("single_bushing", 1000);
    block.state.poses[0].r += Vector3d(1e-9, 0, 0);
    EXPECT_NEAR(block.now().force, 2e5 * 1e-9, 1e-7);
    block = solved_at("pendulum", 1000);
    const Vector3d axis(0.6, -0.8, 0);
    auto& pose = block.state.poses[0];
    const Eigen::AngleAxisd turn(1e-6, axis);          // about the pivot
    const double stiffness = 600 + 1000 * pose.r.z();  // k_R + F L sin θ [N·m/rad]
    pose = {turn * pose.r, turn * pose.p};
    // About the tip, with the pivot's force still free: a moment of at most stiffness · 1e-6; a
    // force may carry part of it.
    EXPECT_LE(block.now().moment, stiffness * 1e-6);
    EXPECT_GE(block.now().moment + block.now().force, 0.1 * stiffness * 1e-6);
}

TEST(Residuals, StatesThatAreNoNumbersAreNoGoodStates) {
    const Judged good = solved_at("chrono_mcpherson", 1000);
    for (std::size_t b = 0; b < 3; ++b) {
        Judged bad = good;
        bad.state.poses[b].r.z() = NAN;
        EXPECT_FALSE(std::isfinite(largest(bad.now())));
        EXPECT_FALSE(std::isfinite(bad.now().force));
        bad = good;
        bad.state.poses[b].p.w() = INFINITY;
        EXPECT_FALSE(std::isfinite(largest(bad.now())));
    }
    Judged bad = good;
    bad.state.load = NAN;
    EXPECT_FALSE(std::isfinite(bad.now().force));
    bad = good;
    bad.state.poses.pop_back();
    EXPECT_FALSE(std::isfinite(largest(bad.now())));
}

TEST(Residuals, OrientationMustBeAUnitQuaternion) {
    Judged strut = solved_at("chrono_mcpherson", 1000);
    strut.state.poses[1].p.coeffs() *= 1.001;
    EXPECT_NEAR(strut.now().direction, 1e-3, 1e-12);
}

TEST(Residuals, SignOfAQuaternionDoesNotMatter) {
    Judged strut = solved_at("chrono_mcpherson", 1000);
    const double before = strut.now().force;
    for (auto& pose : strut.state.poses) pose.p.coeffs() *= -1;
    EXPECT_LE(strut.now().force, before + 1e-9);
}

}  // namespace
}  // namespace elastocheck::reference::energy
