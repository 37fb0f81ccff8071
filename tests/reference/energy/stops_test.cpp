// Stops and curves on a branch, against closed forms, independent of the requested points.
#include <numbers>

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

constexpr int counts[] = {1, 3, 10, 57};

std::vector<double> values_to(double to, int steps) {
    std::vector<double> values;
    for (int i = 0; i <= steps; ++i) values.push_back(to * i / steps);
    return values;
}

// A block sliding along z on a spring of rate k, with a stop that closes at c above and one that
// closes at d below.
struct Block {
    double k = 25e3, c = 0.03, up = 300e3, d = 0.05, down = 120e3;

    Model model() const {
        Model model;
        model.name = "block";
        model.bodies = {{"block", {}}};
        model.joints = {{"guide", 0, ground, {0}}};
        const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
        model.constraints = {{0, PointInPlane{{0}, {ground}, {ground, X}, 0}},
                             {0, PointInPlane{{0}, {ground}, {ground, Y}, 0}},
                             {0, PerpendicularDirections{{0, Z}, {ground, X}}},
                             {0, PerpendicularDirections{{0, Z}, {ground, Y}}},
                             {0, PerpendicularDirections{{0, X}, {ground, Y}}}};
        const Point foot{ground, {0, 0, -0.4}};
        Curve stops{{-d, c}, {{{0, down, 0, 0}, {0, 0, 0, 0}, {0, up, 0, 0}}}};
        model.elastics = {{"spring", AxialSpring{foot, {0}, LinearRate{k}, 0.4}},
                          {"stops", AxialSpring{foot, {0}, stops, 0.4}}};
        return model;
    }
    // Force of the stops at z, and displacement under a force F.
    double contact(double z) const { return z > c ? up * (z - c) : z < -d ? down * (z + d) : 0; }
    double height(double F) const {
        if (F > k * c) return c + (F - k * c) / (k + up);
        if (F < -k * d) return -d + (F + k * d) / (k + down);
        return F / k;
    }
};

TEST(Stops, ContactForceIsTheHandCalculation) {
    const Block block;
    for (const double to : {3000.0, -4000.0, block.k * block.c, 750.0001, 1e5}) {
        for (const int steps : counts) {
            const Branch branch =
                load_branch("push", {{"force", DeadForce{{0}, Vector3d::UnitZ()}}}, to, steps);
            const auto path = solve(block.model(), branch, values_to(to, steps));
            ASSERT_EQ(path.outcome, Outcome::converged)
                << to << " in " << steps << ": " << path.detail;
            for (const auto& state : path.points) {
                const double z = state.poses[0].r.z();
                EXPECT_NEAR(z, block.height(state.load), 1e-12) << to << " in " << steps;
                EXPECT_NEAR(state.load - block.k * z, block.contact(block.height(state.load)), 1e-7)
                    << to;
                EXPECT_LE(largest(residuals(block.model(), branch, state)), 1e-7);
            }
        }
    }
}

// An open stop is neither an idle mode nor singular if the block is held otherwise; if not, it is
// an idle mode, and a load on it is reported.
TEST(Stops, AnOpenStopAloneHoldsNothing) {
    const Block block{.k = 0};
    const Branch branch =
        load_branch("push", {{"force", DeadForce{{0}, Vector3d::UnitZ()}}}, 3000, 4);
    const auto path = solve(block.model(), branch, values_to(3000, 4));
    EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
}

// An arm at a driven angle α; its tip, at height R sin α, lifts the block through a stop of
// clearance c: z = up (R sin α - c)/(k + up) where positive. The stop closes, opens again, or just
// touches at α = π/2.
TEST(Stops, AStopThatClosesOpensAgainOrJustTouchesIsPassed) {
    const double R = 0.3, pi = std::numbers::pi;
    for (const double c : {0.1, 0.29, R - 1e-6, R - 1e-12, R, R + 1e-12}) {
        const Block block;
        Model model = block.model();
        model.elastics.pop_back();
        model.bodies.push_back({"arm", {}});
        model.joints.push_back({"pin", 1, ground, {1}});
        const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
        model.constraints.push_back({1, CoincidentPoints{{1}, {ground}}});
        model.constraints.push_back({1, PerpendicularDirections{{1, Y}, {ground, X}}});
        model.constraints.push_back({1, PerpendicularDirections{{1, Y}, {ground, Z}}});
        model.joints.push_back(
            {"crank", 1, ground, {1}, static_cast<int>(model.constraints.size())});
        model.constraints.push_back({2, DirectionAtAngle{{1, X}, {ground, X}, {ground, Z}, 0}});
        PerAxis law;
        law.axis[2] = stop(c, block.up);
        model.elastics.push_back({"lift", Bushing{{0}, {1, R * X}, law}});
        const Branch branch{.name = "turn",
                            .to = 0.95 * pi,
                            .steps = 10,
                            .unit = ParameterUnit::radian,
                            .drivers = {{Motion{2}, 0, 1}}};
        for (const int steps : counts) {
            const auto path = solve(model, branch, values_to(branch.to, steps));
            ASSERT_EQ(path.outcome, Outcome::converged)
                << c << " in " << steps << ": " << path.detail;
            for (const auto& state : path.points) {
                const double gap = R * std::sin(state.load) - c;
                EXPECT_NEAR(state.poses[0].r.z(),
                            block.up * std::max(0.0, gap) / (block.k + block.up), 1e-12)
                    << c << " at " << state.load;
            }
        }
    }
}

// A strut that meets its bump stop within the branch: unchanged up to contact, and the same end for
// any steps.
TEST(Stops, ABumpStopInAStrutIsPassedByAnySteps) {
    const Model free = compile(scene_named("mcpherson"));
    Model stopped = free;
    for (const auto& elastic : free.elastics)
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            AxialSpring bump = *spring;
            // Curves are functions of the extension: the bump stop closes where the spring is
            // short.
            bump.law = Curve{{-0.03}, {{{0, 300e3, 0, 0}, {0, 0, 0, 0}}}};
            stopped.elastics.push_back({"bump stop", bump});
            break;
        }
    ASSERT_GT(stopped.elastics.size(), free.elastics.size());
    const Branch branch = free.branches[0];
    std::vector<Vector3d> ends;
    for (const int steps : counts) {
        const auto path = solve(stopped, branch, values_to(branch.to, steps));
        ASSERT_EQ(path.outcome, Outcome::converged) << steps << ": " << path.detail;
        for (const auto& state : path.points)
            EXPECT_LE(largest(residuals(stopped, branch, state)), 1e-7)
                << steps << " at " << state.load;
        ends.push_back(path.points.back().poses[0].r);
        EXPECT_LE((ends.back() - ends.front()).norm(), 1e-12) << steps;
    }
    const double end[] = {branch.to};
    // the stop did close
    EXPECT_GT((solve(free, branch, end).points.at(0).poses[0].r - ends[0]).norm(), 1e-3);
}

// A table of many knots with continuous slope: the force at every height is that of the table.
TEST(Stops, AProgressiveCurveIsFollowedThroughItsKnots) {
    const Block block;
    Model model = block.model();
    std::vector<double> x, f, slope;
    for (int i = -6; i <= 6; ++i) {
        x.push_back(0.01 * i);
        f.push_back(2e4 * x.back() + 8e6 * x.back() * x.back() * x.back());
        slope.push_back(2e4 + 24e6 * x.back() * x.back());
    }
    std::get<AxialSpring>(model.elastics[1].kind).law = hermite(x, f, slope);
    for (const double to : {4000.0, -4000.0}) {
        const Branch branch =
            load_branch("push", {{"force", DeadForce{{0}, Vector3d::UnitZ()}}}, to, 1);
        for (const int steps : counts) {
            const auto path = solve(model, branch, values_to(to, steps));
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            for (const auto& state : path.points) {
                const double z = state.poses[0].r.z();  // within the table: the cubic
                EXPECT_LT(std::abs(z), 0.06);
                EXPECT_NEAR((block.k + 2e4) * z + 8e6 * z * z * z, state.load, 1e-7);
            }
        }
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
