// Invariance of the equilibrium leg: unit of length, ground frame, order, body axes, mirror image,
// number of steps, repetition.
#include <fmt/format.h>

#include "models/branch.hpp"
#include "tests/reference/equilibrium/driven_scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

// Inverse transform from the other scene's ground axes and units.
struct Back {
    std::function<Vector3d(const Vector3d&)> point = [](const Vector3d& v) { return v; };
    std::function<Vector3d(const Vector3d&)> vector = [](const Vector3d& v) {
        return v;
    };  // forces, directions
    std::function<Vector3d(const Vector3d&)> moment = [](const Vector3d& v) { return v; };
};

// Compares both scenes along both first branches: wheel centre, contact, spin axis and all
// reactions at every point, relative to the size of the scene (1 m) and to the largest reaction.
void expect_same(const Scene& a, const Scene& b, const Back& back, double limit = 1e-9) {
    const Model whole_a = compile(a), whole_b = compile(b);
    Worst worst;
    for (std::size_t n = 0; n < whole_a.branches.size(); ++n) {
        const Model model_a = on_branch(whole_a, whole_a.branches[n]),
                    model_b = on_branch(whole_b, whole_b.branches[n]);
        const auto loads = every_load(model_a.branches[0]);
        const auto path_a = solve(model_a, model_a.branches[0], loads),
                   path_b = solve(model_b, model_b.branches[0], every_load(model_b.branches[0]));
        ASSERT_EQ(path_a.outcome, Outcome::converged) << a.name << ": " << path_a.detail;
        ASSERT_EQ(path_b.outcome, Outcome::converged) << b.name << ": " << path_b.detail;
        double force = 1, moment = 1;
        for (const auto& state : path_a.points)
            for (const auto& wrench : state.reactions) {
                force = std::max(force, wrench.force.norm());
                moment = std::max(moment, wrench.moment.norm());
            }
        for (std::size_t k = 0; k < loads.size(); ++k) {
            const auto &at_a = path_a.points[k], &at_b = path_b.points[k];
            const auto where = [&](const std::string& what) {
                return fmt::format("{}: {}, branch '{}', {}", a.name, what,
                                   model_a.branches[0].name, loads[k]);
            };
            const Wheel &w_a = model_a.wheels[0], &w_b = model_b.wheels[0];
            worst.see((position(at_a, {w_a.body, w_a.centre_local}) -
                       back.point(position(at_b, {w_b.body, w_b.centre_local})))
                          .norm(),
                      where("wheel centre"));
            worst.see((position(at_a, {w_a.body, w_a.contact_local}) -
                       back.point(position(at_b, {w_b.body, w_b.contact_local})))
                          .norm(),
                      where("contact"));
            worst.see((at_a.poses[static_cast<std::size_t>(w_a.body)].p * w_a.spin_axis_local -
                       back.vector(at_b.poses[static_cast<std::size_t>(w_b.body)].p *
                                   w_b.spin_axis_local))
                          .norm(),
                      where("spin axis"));
            for (std::size_t j = 0; j < model_a.joints.size(); ++j)
                for (std::size_t i = 0; i < model_b.joints.size(); ++i) {
                    if (model_a.joints[j].name != model_b.joints[i].name) continue;
                    worst.see(
                        (at_a.reactions[j].force - back.vector(at_b.reactions[i].force)).norm() /
                            force,
                        where("force of " + model_a.joints[j].name));
                    worst.see(
                        (at_a.reactions[j].moment - back.moment(at_b.reactions[i].moment)).norm() /
                            moment,
                        where("moment of " + model_a.joints[j].name));
                }
        }
    }
    EXPECT_TRUE(within(worst, limit));
    ::testing::Test::RecordProperty("worst_deviation", fmt::format("{:.1e}", worst.value));
}

// Every kind of driver, alone and with others: a rack held off centre under a load, a jack with a
// preload, a free length.
Scene driven_scene() {
    Scene s = with_jack(with_rack(scene("chrono_mcpherson")));
    s.name = "driven";
    const int jack = static_cast<int>(s.joints.size()) - 1, rack = jack - 1;
    Vector6 preload;
    preload << 900, -400, 300, 4, 7, -3;
    const Driver braking = {
        Load{"brake", DeadForce{{s.wheels[0].body, s.wheels[0].contact_local}, {-1, .3, 0}}}, 900,
        0};
    s.branches = {
        branch_of("load", {{s.branches[0].drivers[0].what, 0, 1}, {Motion{rack}, 0.015, 0}}, 2000,
                  8),
        branch_of("travel", {{Motion{jack}, 0, 1}, {Preload{2, preload}, 1, 0}, braking}, -0.08, 8,
                  ParameterUnit::metre),
        branch_of("steer", {{Motion{rack}, 0, 1}, {Motion{jack}, 0.02, 0.5}}, 0.02, 8,
                  ParameterUnit::metre),
        branch_of("trim", {{FreeLength{0}, 0.005, 1}}, 0.02, 8, ParameterUnit::metre)};
    return s;
}

std::vector<Scene> scenes() { return {scene("chrono_mcpherson"), rich_scene(), driven_scene()}; }

TEST(EquilibriumInvariance, UnitOfLength) {
    for (const auto& s : scenes())
        for (const double c : {1000., 1e-3, 39.37})
            expect_same(s, with_length_unit(s, c),
                        {[c](const Vector3d& v) { return Vector3d(v / c); },
                         [](const Vector3d& v) { return v; },
                         [c](const Vector3d& v) { return Vector3d(v / c); }});
}

// The same scene file in millimetres and in metres.
TEST(EquilibriumInvariance, UnitOfTheFile) {
    const char* text = R"(
elastocheck: 1
name: bar
units: {{length: {0}, angle: deg, force: N}}
points: {{pin: [0, 0, 0], tip: [{1}, 0, 0], top: [{1}, 0, {2}]}}
bodies: {{bar: {{origin: pin}}}}
joints: {{pin: {{type: revolute, bodies: [bar, ground], at: pin, axis: y}}}}
springs: {{coil: {{bodies: [bar, ground], from: tip, to: top, rate: {3}, preload: 100}}}}
bushings: {{torsion: {{bodies: [bar, ground], at: pin, rates: [0, 0, 0], rotational_rates: [0, {4}, 0]}}}}
loads: {{lift: {{on: bar, at: tip, force: [0, 0, 1]}}}}
branches: {{lift: {{load: lift, to: 2000, steps: 20}}}}
wheel: {{body: bar, centre: tip, spin_axis: y, side: left}}
)";
    const auto mm = parse_scene(fmt::format(fmt::runtime(text), "mm", 500, 300, 25, 4000), "mm");
    const auto m = parse_scene(fmt::format(fmt::runtime(text), "m", 0.5, 0.3, 25e3, 4), "m");
    expect_same(mm, m, {});
}

TEST(EquilibriumInvariance, GroundFrame) {
    std::mt19937 random(21);
    for (const auto& s : scenes())
        for (int trial = 0; trial < 4; ++trial) {
            const Quaterniond Q = random_turn(random);
            const Vector3d t = random_vector(random, trial < 2 ? 1 : 100);
            const auto turn_back = [Q](const Vector3d& v) { return Vector3d(Q.conjugate() * v); };
            expect_same(s, moved_with_ground(s, Q, t),
                        {[=](const Vector3d& v) { return Vector3d(Q.conjugate() * (v - t)); },
                         turn_back, turn_back});
        }
}

TEST(EquilibriumInvariance, OrderOfBodiesJointsAndElements) {
    for (const auto& s : scenes()) expect_same(s, reversed(s), {});
}

TEST(EquilibriumInvariance, BodyFrames) {
    std::mt19937 random(22);
    for (const auto& s : scenes())
        for (int trial = 0; trial < 4; ++trial) {
            std::vector<Quaterniond> Q;
            std::vector<Vector3d> c;
            for (std::size_t b = 0; b < s.bodies.size(); ++b) {
                Q.push_back(random_turn(random));
                c.push_back(random_vector(random, 0.3));
            }
            expect_same(s, with_body_frames(s, Q, c), {});
        }
}

TEST(EquilibriumInvariance, MirroredSide) {
    const Matrix3d S = Vector3d(1, -1, 1).asDiagonal();
    const auto mirror = [S](const Vector3d& v) { return Vector3d(S * v); };
    for (const auto& s : scenes())
        expect_same(s, mirrored(s),
                    {mirror, mirror, [S](const Vector3d& v) { return Vector3d(-S * v); }});
}

// An equilibrium is independent of the preceding steps.
TEST(EquilibriumInvariance, NumberOfSteps) {
    for (const auto& s : scenes()) {
        const Model whole = compile(s);
        for (const auto& way : whole.branches) {
            const Model model = on_branch(whole, way);
            const Branch& branch = model.branches[0];
            Worst worst;
            const auto fine = solve(model, branch, every_load(branch));
            ASSERT_EQ(fine.outcome, Outcome::converged) << fine.detail;
            for (const int steps : {1, 2, 7, 1000}) {
                std::vector<double> loads;
                for (int n = 1; n <= steps; ++n) loads.push_back(branch.to * n / steps);
                const auto other = solve(model, branch, loads);
                ASSERT_EQ(other.outcome, Outcome::converged) << other.detail;
                const auto body = static_cast<std::size_t>(model.wheels[0].body);
                worst.see(
                    (other.points.back().poses[body].r - fine.points.back().poses[body].r).norm(),
                    fmt::format("{} steps", steps));
                worst.see(other.points.back().poses[body].p.angularDistance(
                              fine.points.back().poses[body].p),
                          fmt::format("{} steps", steps));
            }
            EXPECT_TRUE(within(worst, 1e-11)) << s.name;
        }
    }
}

TEST(EquilibriumInvariance, TheRun) {
    for (const auto& s : scenes()) {
        const Model whole = compile(s), model = on_branch(whole, whole.branches[0]);
        const auto& branch = model.branches[0];
        const auto loads = every_load(branch);
        const auto a = solve(model, branch, loads), b = solve(model, branch, loads);
        ASSERT_EQ(a.points.size(), b.points.size());
        EXPECT_EQ(a.counts.factorisations, b.counts.factorisations);
        EXPECT_EQ(a.counts.iterations, b.counts.iterations);
        EXPECT_EQ(a.counts.evaluations, b.counts.evaluations);
        for (std::size_t n = 0; n < a.points.size(); ++n) {
            EXPECT_EQ(a.points[n].constraint_error, b.points[n].constraint_error);
            for (std::size_t k = 0; k < a.points[n].poses.size(); ++k) {
                EXPECT_EQ(a.points[n].poses[k].r, b.points[n].poses[k].r);
                EXPECT_EQ(a.points[n].poses[k].p.coeffs(), b.points[n].poses[k].p.coeffs());
            }
            for (std::size_t k = 0; k < a.points[n].reactions.size(); ++k) {
                EXPECT_EQ(a.points[n].reactions[k].force, b.points[n].reactions[k].force);
                EXPECT_EQ(a.points[n].reactions[k].moment, b.points[n].reactions[k].moment);
            }
        }
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
