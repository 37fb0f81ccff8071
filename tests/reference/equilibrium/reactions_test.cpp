// Joint reactions against statics by hand, and residuals() of states.
#include <fmt/format.h>

#include <chrono>

#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

Equilibrium solved(const Model& model, const Branch& branch, double load) {
    const std::vector<double> loads = {load};
    const auto path = solve(model, branch, loads);
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return path.points.empty() ? Equilibrium{} : path.points[0];
}

// A bracket welded to ground carries a force at p and a moment: the weld exerts the opposite of
// both, about its own point, and the wrench is the one on body i, which may be the bracket or
// ground.
TEST(EquilibriumReactions, AWeldAnswersAForceAndAMoment) {
    const Vector3d at(0.1, -0.2, 0.3), p(0.5, 0.4, -0.1), f(3, -2, 7), m(0.5, 0.25, -1);
    for (const bool ground_first : {false, true}) {
        const BodyId i = ground_first ? ground : 0, j = ground_first ? 0 : ground;
        Scene s;
        s.bodies = {{"bracket", {}}};
        s.joints = {{"weld", Fixed{{i, at},
                                   {j, at},
                                   {i, {1, 0, 0}},
                                   {i, {0, 1, 0}},
                                   {j, {1, 0, 0}},
                                   {j, {0, 1, 0}}}}};
        s.branches = {branch_of(
            "both", {driven_by({"f", DeadForce{{0, p}, f}}), driven_by({"m", DeadMoment{0, m}})}, 1,
            1)};
        s.probes = {{"p", {0, p}}};
        const Model model = compile(s);
        const double a = 250, sign = ground_first ? -1 : 1;  // the wrench on ground is the opposite
        const auto state = solved(model, model.branches[0], a);
        EXPECT_LE((state.reactions.at(0).force + sign * a * f).norm(), 1e-11);
        EXPECT_LE((state.reactions.at(0).moment + sign * a * (m + (p - at).cross(f))).norm(),
                  1e-11);
    }
}

// The same weld on a block on a bushing: the wrench is about the displaced weld.
TEST(EquilibriumReactions, AWeldOnABodyThatMovesAnswersWhereItIsNow) {
    const Vector3d at(0.2, 0.1, 0), p(0.5, -0.2, 0.3);
    Scene s;
    s.bodies = {{"block", {}}, {"bracket", {{0.2, 0, 0}, Quaterniond::Identity()}}};
    const Vector3d at_bracket = at - s.bodies[1].design.r, p_bracket = p - s.bodies[1].design.r;
    s.joints = {{"weld", Fixed{{1, at_bracket},
                               {0, at},
                               {1, {1, 0, 0}},
                               {1, {0, 1, 0}},
                               {0, {1, 0, 0}},
                               {0, {0, 1, 0}}}}};
    Bushing mount;
    mount.j.body = 0;
    stiffness_of(mount).K.diagonal() << 2e4, 3e4, 4e4, 600, 500, 400;
    s.elastics = {{"mount", mount}};
    s.branches = {pull({1, p_bracket}, {0.36, 0.48, 0.8})};
    s.probes = {{"p", {1, p_bracket}}};
    const Model model = compile(s, Detail::everything);
    const auto state = solved(model, model.branches[0], 400);
    const Vector3d f = 400 * Vector3d(0.36, 0.48, 0.8);
    const Vector3d arm = position(state, {1, p_bracket}) - position(state, {0, at});
    EXPECT_GT((arm - (p - at)).norm(), 0.01);
    EXPECT_LE((state.reactions.at(0).force + f).norm(), 1e-10);
    EXPECT_LE((state.reactions.at(0).moment + arm.cross(f)).norm(), 1e-10);
}

// A crane: a horizontal jib hinged at the origin about y, held at 2 m by a stay to a point 1.5 m
// above the hinge, load at 3 m. Statically determinate: stay force S from Σ M_y = 0, hinge from Σ
// F = 0.
TEST(EquilibriumReactions, ACraneIsInBalanceByHand) {
    for (const bool ground_first : {false, true}) {
        const BodyId i = ground_first ? ground : 0, j = ground_first ? 0 : ground;
        const Vector3d foot(2, 0, 0), head(0, 0, 1.5), hook(3, 0.4, 0);
        Scene s;
        s.bodies = {{"jib", {}}};
        s.joints = {
            {"hinge", Revolute{{i, {0, 0, 0}}, {j, {0, 0, 0}}, {i, {0, 1, 0}}, {j, {0, 1, 0}}}},
            {"stay",
             Distance{{i, ground_first ? head : foot}, {j, ground_first ? foot : head}, 2.5}}};
        s.branches = {pull({0, hook}, {0, 0, -1})};
        s.probes = {{"hook", {0, hook}}};
        const Model model = compile(s);
        const double P = 1000, S = P * 3 / (2 * 1.5 / 2.5), sign = ground_first ? -1 : 1;
        const auto state = solved(model, model.branches[0], P);
        const Vector3d stay = S * (head - foot) / 2.5, load(0, 0, -P);
        const Vector3d moment = -hook.cross(load) - foot.cross(stay);  // on the jib about the hinge
        EXPECT_LE((sign * state.reactions.at(1).force - stay).norm(), 1e-10);
        EXPECT_LE(state.reactions.at(1).moment.norm(), 1e-10);
        EXPECT_LE((sign * state.reactions.at(0).force + stay + load).norm(), 1e-10);
        EXPECT_LE((sign * state.reactions.at(0).moment - moment).norm(), 1e-10);
        EXPECT_NEAR(moment[1], 0, 1e-10);
        EXPECT_LE((state.poses[0].r).norm(), 1e-14);
    }
}

// The pin of the pinned bar carries the sum of the bushing force (k times the tip's displacement)
// and the load, along the whole branch.
TEST(EquilibriumReactions, ThePinOfTheBarCarriesTheRest) {
    const Model model = compile(scene("pinned_bar"));
    Worst worst;
    for (const auto& branch : model.branches)
        for (const auto& state : solve(model, branch, every_load(branch)).points) {
            const Vector3d tip = position(state, model.probes[0].at);
            const Vector3d rest =
                -state.load * Vector3d::UnitZ() + 20e3 * (tip - Vector3d(0.5, 0, 0));
            worst.see((state.reactions.at(0).force - rest).norm(), fmt::format("{} N", state.load));
            worst.see(state.reactions.at(0).moment.norm(), fmt::format("{} N, moment", state.load));
        }
    EXPECT_TRUE(within(worst, 1e-9));
}

// Every kind of joint between two bodies on bushings, in both orders: in balance, and only
// transmissible wrenches.
TEST(EquilibriumReactions, EveryKindOfJointIsInBalanceAndTransmitsWhatItCan) {
    std::mt19937 random(31);
    const Vector3d at(0.2, 0.1, -0.1), to(0.35, 0.2, 0.15), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (const bool swapped : {false, true}) {
        const BodyId a = swapped ? 1 : 0, b = swapped ? 0 : 1;
        const std::vector<std::pair<JointKind, int>> kinds = {
            {Spherical{{a, at}, {b, at}}, 3},
            {Revolute{{a, at}, {b, at}, {a, y}, {b, y}}, 5},
            {Universal{{a, at}, {b, at}, {a, y}, {b, z}}, 4},
            {Cylindrical{{a, at}, {b, at}, {a, x}, {b, x}}, 4},
            {Translational{{a, at}, {b, at}, {a, z}, {b, z}}, 5},
            {Planar{{a, at}, {b, at}, {a, z}, {b, z}}, 3},
            {Fixed{{a, at}, {b, at}, {a, x}, {a, y}, {b, x}, {b, y}}, 6},
            {Distance{{a, at}, {b, to}, (to - at).norm()}, 1},
            {InPlane{{a, at}, {b, at}, {b, x}}, 1},
            {InLine{{a, at}, {b, at}, {b, x}}, 2},
            {Perpendicular{{a, x}, {b, y}}, 1},
            {Parallel{{a, x}, {b, x}}, 2},
        };
        for (const auto& [kind, count] : kinds) {
            Scene s;
            s.name = fmt::format("kind {}{}", kind.index(), swapped ? " swapped" : "");
            s.bodies = {{"a", {}}, {"b", {}}};
            s.joints = {{"joint", kind}};
            for (const BodyId body : {0, 1}) {
                Bushing mount{{ground, random_vector(random, 0.2), random_turn(random)},
                              {},
                              LinearStiffness{random_stiffness(random)},
                              Vector6::Zero()};
                mount.j = mount.i;
                mount.j.body = body;
                s.elastics.push_back({"mount", mount});
                s.branches.resize(1);
                s.branches[0].name = "any";
                s.branches[0].drivers.push_back(
                    driven_by({"f", DeadForce{{body, random_vector(random, 0.3)},
                                              random_vector(random, 1)}}));
                s.branches[0].drivers.push_back(
                    driven_by({"m", DeadMoment{body, random_vector(random, 0.05)}}));
            }
            s.probes = {{"a", {0, at}}, {"b", {1, at}}};
            const Model model = compile(s, Detail::everything);
            ASSERT_EQ(constraint_rows(model), count) << s.name;
            std::vector<double> loads;
            for (int n = -10; n <= 10; ++n) loads.push_back(50 * n);
            std::stable_sort(loads.begin(), loads.end(),
                             [](double l, double r) { return std::abs(l) < std::abs(r); });
            const auto path = solve(model, model.branches[0], loads);
            ASSERT_EQ(path.outcome, Outcome::converged) << s.name << ": " << path.detail;
            Worst worst;
            double carried = 0;
            for (const auto& state : path.points) {
                const auto r = residuals(model, model.branches[0], state);
                for (const double part : {r.length, r.direction, r.force, r.moment})
                    worst.see(part, s.name);
                carried = std::max(
                    carried, state.reactions[0].force.norm() + state.reactions[0].moment.norm());
            }
            EXPECT_TRUE(within(worst, 5e-9));
            EXPECT_GT(carried, 1) << s.name;
        }
    }
}

TEST(EquilibriumReactions, McPhersonIsInBalanceToRoundOffForHardlyMoreThanOneIterationAPoint) {
    const Model model = compile(scene("chrono_mcpherson"));
    for (const auto& branch : model.branches) {
        const auto loads = every_load(branch);
        ASSERT_EQ(loads.size(), 301u);
        const auto before = std::chrono::steady_clock::now();
        const auto path = solve(model, branch, loads);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        Worst constraints, balance;
        for (const auto& state : path.points) {
            const auto r = residuals(model, branch, state);
            constraints.see(std::max({r.length, r.direction, state.constraint_error}),
                            fmt::format("{} N", state.load));
            balance.see(std::max(r.force, r.moment), fmt::format("{} N", state.load));
        }
        EXPECT_TRUE(within(constraints, 2e-15));
        EXPECT_TRUE(within(balance, 1e-8));
        EXPECT_LE(path.counts.iterations, 2 * 301);
        const double travel =
            position(path.points.back(), {model.wheels[0].body, model.wheels[0].centre_local})[2] +
            0.026;
        EXPECT_GT(travel * branch.to, 0);
        fmt::print(
            "{}: {:.1f} mm, constraints {:.1e} m, balance {:.1e} N, {:.0f} µs and {:.2f} "
            "iterations a "
            "point\n",
            branch.name, 1e3 * travel, constraints.value, balance.value, 1e6 * took.count() / 301,
            static_cast<double>(path.counts.iterations) / 301);
    }
}

// ---- Residuals

struct Judged : ::testing::Test {
    Model model = compile(rich_scene());
    Branch branch = model.branches[0];
    Equilibrium state = solved(model, branch, 1000);
    Residuals judged(const std::function<void(Equilibrium&)>& spoil) {
        Equilibrium spoiled = state;
        spoil(spoiled);
        return residuals(model, branch, spoiled);
    }
    std::size_t joint(const std::string& name) const {
        for (std::size_t n = 0; n < model.joints.size(); ++n)
            if (model.joints[n].name == name) return n;
        ADD_FAILURE() << name;
        return 0;
    }
};
using EquilibriumResiduals = Judged;

TEST_F(EquilibriumResiduals, AreRoundOffForAnEquilibrium) {
    const auto r = judged([](Equilibrium&) {});
    EXPECT_LE(r.length, 1e-15);
    EXPECT_LE(r.direction, 1e-15);
    EXPECT_LE(r.force, 1e-9);
    EXPECT_LE(r.moment, 1e-9);
}

TEST_F(EquilibriumResiduals, ShowAWrongLoadInFull) {
    const auto r = judged([](Equilibrium& s) { s.load += 1; });
    EXPECT_NEAR(r.force, 1, 1e-8);  // the load's largest component
}

TEST_F(EquilibriumResiduals, ShowEveryMisplacedBody) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const auto shifted = judged([&](Equilibrium& s) { s.poses[b].r[0] += 1e-6; });
        EXPECT_TRUE(shifted.length > 1e-8 || shifted.force > 1e-3) << model.bodies[b].name;
        const auto turned = judged([&](Equilibrium& s) {
            s.poses[b].p =
                Quaterniond(Eigen::AngleAxisd(1e-6, Vector3d(0.6, 0, 0.8))) * s.poses[b].p;
        });
        EXPECT_TRUE(turned.length > 1e-8 || turned.direction > 1e-8 || turned.moment > 1e-5)
            << model.bodies[b].name;
    }
}

TEST_F(EquilibriumResiduals, ShowEveryWrongReaction) {
    for (std::size_t n = 0; n < model.joints.size(); ++n)
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(judged([&](Equilibrium& s) { s.reactions[n].force[k] += 0.1; }).force, 0.05)
                << model.joints[n].name;
            EXPECT_GE(judged([&](Equilibrium& s) { s.reactions[n].moment[k] += 0.1; }).moment, 0.05)
                << model.joints[n].name;
        }
}

// Two joints between one body and ground can exchange a moment without an imbalance; a ball joint
// cannot carry it.
TEST_F(EquilibriumResiduals, ShowAWrenchThatTheJointCannotTransmit) {
    Scene s = hinged_bar({0.5, 0, 0}, {0, 1, 0}, 100);
    s.joints.push_back({"ball", Spherical{{0, {0, 0.2, 0}}, {ground, {0, 0.2, 0}}}});
    s.branches = {pull({0, {0.5, 0, 0}}, {0, 0, 1})};
    model = compile(s);
    branch = model.branches[0];
    state = solved(model, branch, 50);
    EXPECT_LE(judged([](Equilibrium&) {}).moment, 1e-10);
    const auto trade = judged([](Equilibrium& e) {
        e.reactions[0].moment += Vector3d(3, 0, 4);
        e.reactions[1].moment -= Vector3d(3, 0, 4);
    });
    EXPECT_NEAR(trade.moment, 4, 1e-9);
    const auto about_axis = judged([](Equilibrium& e) {
        e.reactions[0].moment[1] += 2;
        e.reactions[1].moment[1] -= 2;
    });
    EXPECT_NEAR(about_axis.moment, 2, 1e-9);
}

TEST_F(EquilibriumResiduals, ShowAQuaternionOffTheUnitSphere) {
    EXPECT_NEAR(judged([](Equilibrium& s) { s.poses[1].p.coeffs() *= 1.001; }).direction, 1e-3,
                1e-12);
}

TEST_F(EquilibriumResiduals, NeverPassANaN) {
    const double bad = std::numeric_limits<double>::quiet_NaN();
    const auto passes = [](const Residuals& r) {
        for (const double part : {r.length, r.direction, r.force, r.moment})
            if (!(std::isfinite(part) && part <= 1e300)) return false;
        return true;
    };
    EXPECT_TRUE(passes(judged([](Equilibrium&) {})));
    EXPECT_FALSE(passes(judged([&](Equilibrium& s) { s.load = bad; })));
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        EXPECT_FALSE(passes(judged([&](Equilibrium& s) { s.poses[b].r[1] = bad; })));
        EXPECT_FALSE(passes(judged([&](Equilibrium& s) { s.poses[b].p.z() = bad; })));
    }
    for (std::size_t n = 0; n < model.joints.size(); ++n) {
        EXPECT_FALSE(passes(judged([&](Equilibrium& s) { s.reactions[n].force[0] = bad; })));
        EXPECT_FALSE(passes(judged([&](Equilibrium& s) { s.reactions[n].moment[2] = bad; })));
    }
    EXPECT_FALSE(passes(judged([](Equilibrium& s) { s.poses.pop_back(); })));
    EXPECT_FALSE(passes(judged([](Equilibrium& s) { s.reactions.clear(); })));
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
