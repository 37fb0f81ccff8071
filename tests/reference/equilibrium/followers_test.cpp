// Follower loads.
#include <fmt/format.h>

#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

Branch follow(const LoadKind& load) {
    return branch_of("follow", {driven_by({"follower", load})}, 1, 1);
}

// A force that stays perpendicular to the bar: θ = F L / k, whereas a dead force gives F L cos
// θ = k θ.
TEST(EquilibriumFollowers, AForceAcrossABarTurnsItByFLOverK) {
    const double k = 150, L = 0.4;
    Scene s = hinged_bar({L, 0, 0}, {0, 1, 0}, k);
    s.branches = {follow(FollowerForce{{0, {L, 0, 0}}, {0, 0, 1}})};
    const Model model = compile(s);
    Worst worst;
    for (const int steps : {1, 3, 30}) {
        std::vector<double> loads;
        for (int n = 0; n <= steps; ++n) loads.push_back(1150. * n / steps);  // to 3.07 rad
        const auto path = solve(model, model.branches[0], loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& state : path.points) {
            const Quaterniond turned(Eigen::AngleAxisd(-state.load * L / k, Vector3d::UnitY()));
            worst.see(state.poses[0].p.angularDistance(turned), fmt::format("{} N", state.load));
            // The hinge reaction is opposite to the current force.
            const Vector3d left =
                state.reactions[0].force + state.load * (turned * Vector3d::UnitZ());
            worst.see(left.norm() / 1150, fmt::format("reaction, {} N", state.load));
        }
    }
    EXPECT_TRUE(within(worst, 1e-12));
}

// With equal rates about all axes the axis is constant, in the body and in ground, and θ = m / k,
// for any body axes.
TEST(EquilibriumFollowers, ACoupleTurnsAnIsotropicBushingByMOverK) {
    std::mt19937 random(31);
    Worst worst;
    for (int trial = 0; trial < 10; ++trial) {
        const double k = 250;
        const Vector3d axis = random_vector(random, 1).normalized();
        Scene s = hinged_bar({0.3, 0, 0}, axis, k);
        const Quaterniond drawn = random_turn(random);
        s.bodies[0].design.p = drawn;
        s.joints = {{"ball", Spherical{{0, {0, 0, 0}}, {ground, {0, 0, 0}}}}};
        auto& bushing = std::get<Bushing>(s.elastics[0].kind);
        bushing.i.A_local = drawn.conjugate();
        s.branches = {follow(FollowerMoment{0, drawn.conjugate() * axis})};
        const Model model = compile(s);
        std::vector<double> loads;
        for (int n = 0; n <= 10; ++n) loads.push_back(k * 3 * n / 10);
        const auto path = solve(model, model.branches[0], loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& state : path.points)
            worst.see(state.poses[0].p.angularDistance(
                          Quaterniond(Eigen::AngleAxisd(state.load / k, axis)) * drawn),
                      fmt::format("trial {}, {} N·m", trial, state.load));
    }
    EXPECT_TRUE(within(worst, 1e-12));
}

// Two bars in a line with torsion springs c, a force along the upper one (Ziegler's column): with
// M = [2c - P L, -c + P L; -c, c] the determinant is c² at any load, so no other equilibrium passes
// through the straight one. It flutters above a load that depends on its masses; the statics branch
// continues.
TEST(EquilibriumFollowers, AColumnUnderAFollowerForceNeverDiverges) {
    const double c = 1000, L = 0.5;
    Scene s = hinged_bar({0, 0, L}, {0, 1, 0}, c);
    s.bodies.push_back({"upper", {{0, 0, L}, Quaterniond::Identity()}});
    s.joints.push_back(
        {"middle", Revolute{{1, {0, 0, 0}}, {0, {0, 0, L}}, {1, {0, 1, 0}}, {0, {0, 1, 0}}}});
    Bushing torsion = std::get<Bushing>(s.elastics[0].kind);
    torsion.i = {1, {0, 0, 0}};
    torsion.j = {0, {0, 0, L}};
    s.elastics.push_back({"upper torsion", torsion});
    s.probes.push_back({"top", {1, {0, 0, L}}});
    for (const bool follows : {true, false}) {
        s.branches = {follows ? follow(FollowerForce{{1, {0, 0, L}}, {0, 0, -1}})
                              : follow(DeadForce{{1, {0, 0, L}}, {0, 0, -1}})};
        const Model model = compile(s);
        for (const int steps : {1, 7, 100}) {
            std::vector<double> loads;
            for (int n = 0; n <= steps; ++n) loads.push_back(10 * c / L * n / steps);
            const auto path = solve(model, model.branches[0], loads);
            EXPECT_EQ(path.outcome, follows ? Outcome::converged : Outcome::bifurcation_point)
                << steps << ": " << path.detail;
        }
    }
}

// Where only part of the force follows, det M reaches zero and the branch ends there: one bar on a
// torsion spring under a dead weight D and a follower force P along it, M = k - D L for any P.
TEST(EquilibriumFollowers, DivergenceUnderADeadWeightIsNotHiddenByAFollower) {
    const double k = 1000, L = 0.5;
    Scene s = hinged_bar({0, 0, L}, {0, 1, 0}, k);
    s.static_loads = {{"follower", FollowerForce{{0, {0, 0, L}}, {0, 0, -5000}}}};
    s.branches = {pull({0, {0, 0, L}}, {0, 0, -1})};
    const Model model = compile(s);
    for (const int steps : {1, 3, 40}) {
        std::vector<double> loads;
        for (int n = 0; n <= steps; ++n) loads.push_back(3929.4 * n / steps);
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << path.detail;
        EXPECT_EQ(path.points.size(), static_cast<std::size_t>(std::ranges::count_if(
                                          loads, [&](double D) { return D < k / L; })));
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
