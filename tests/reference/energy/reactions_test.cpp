// Joint reactions of statically determinate systems.
#include "models/lowering.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

void expect_near(const Vector3d& computed, const Vector3d& expected, double tolerance,
                 const std::string& what) {
    EXPECT_LE((computed - expected).norm(), tolerance)
        << what << ": " << computed.transpose() << " instead of " << expected.transpose();
}

// A body held by one joint under a force and a moment: the joint exerts the opposite, about its own
// point. With ground as body i the wrench is the one on ground, about the same point.
TEST(Reactions, OneJointCarriesWhatTheBodyPassesOn) {
    const Vector3d r(1, 2, 3), joint(0.2, -0.1, 0.4), handle(-0.3, 0.5, 0.1), f(100, -200, 300),
        m(7, 8, -9);
    Random random;
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Eigen::Quaterniond p = random.rotation();
        for (const bool ground_first : {false, true}) {
            Model model;
            model.bodies = {{"block", {r, p}}};
            const Point on_body{0, joint}, on_ground{ground, r + p * joint};
            const auto d = [&](const Vector3d& u) {
                return std::pair<Direction, Direction>{{0, p.conjugate() * u}, {ground, u}};
            };
            const auto x = d(Vector3d::UnitX()), y = d(Vector3d::UnitY());
            const Fixed weld =
                ground_first ? Fixed{on_ground, on_body, x.second, y.second, x.first, y.first}
                             : Fixed{on_body, on_ground, x.first, y.first, x.second, y.second};
            model.joints = {{"weld", ground_first ? ground : 0, ground_first ? 0 : ground,
                             ground_first ? on_ground : on_body}};
            for (const auto& kind : lower(weld, model.bodies))
                model.constraints.push_back({0, kind});
            const Branch branch = load_branch(
                "pull", {{"f", DeadForce{{0, handle}, f}}, {"m", DeadMoment{0, m}}}, 3, 3);
            const auto path = solve(model, branch, sweep(branch));
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            for (const auto& state : path.points) {
                const double sign = ground_first ? 1 : -1, scale = 1000 * 3;
                const Vector3d lever = p * (handle - joint);
                expect_near(state.reactions[0].force, sign * state.load * f, 1e-9 * scale, "force");
                expect_near(state.reactions[0].moment, sign * state.load * (m + lever.cross(f)),
                            1e-9 * scale, "moment");
            }
        }
    }
}

// The bar of the scene: its pin carries the load minus the bushing force, and no moment about its
// own axis. The bushing frame is on the bar but isotropic, so its force on the tip is -k
// (tip - foot).
TEST(Reactions, PinnedBarsPinCarriesLoadAndBushing) {
    for (const bool ground_first : {false, true}) {
        Scene scene = scene_named("pinned_bar");
        auto& pin = std::get<Revolute>(scene.joints[0].kind);
        if (ground_first) {
            std::swap(pin.i, pin.j);
            std::swap(pin.axis_i, pin.axis_j);
        }
        const auto path = solve(scene, 0, sweep(scene.branches[0]));
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& state : path.points) {
            const Vector3d stretch = position(state, scene.probes[0].at) - Vector3d(0.5, 0, 0);
            const Vector3d on_bar = 20e3 * stretch - state.load * Vector3d::UnitZ();
            expect_near(state.reactions[0].force, ground_first ? -on_bar : on_bar, 1e-6, "force");
            expect_near(state.reactions[0].moment, Vector3d::Zero(), 1e-6, "moment");
        }
    }
}

// The guide of the plate carries the moment of an eccentric load; the springs carry the load.
TEST(Reactions, GuideCarriesTheMomentOfAnOffsetLoad) {
    Scene scene = scene_named("parallel_springs");
    auto& load = std::get<DeadForce>(std::get<Load>(scene.branches[0].drivers[0].what).kind);
    load.at.s_local = Vector3d(0.1, 0.05, 0);
    const auto path = solve(scene, 0, sweep(scene.branches[0]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points) {
        const double z = state.load / 75e3;
        const Vector3d up = Vector3d::UnitZ();
        const Vector3d springs = Vector3d(-0.2, 0, 0).cross((600 - 30e3 * z) * up) +
                                 Vector3d(0.3, 0, 0).cross(-45e3 * z * up);
        expect_near(state.reactions[0].force, Vector3d::Zero(), 1e-6, "force");
        expect_near(state.reactions[0].moment, -springs - load.at.s_local.cross(state.load * up),
                    1e-6, "moment");
    }
}

// Free-body diagram of the McPherson wheel: four joints, the coil and the load, forces and moments.
TEST(Reactions, WheelIsInBalance) {
    const Scene scene = scene_named("chrono_mcpherson");
    const Model model = compile(scene);
    const auto path = solve(model, model.branches[0], sweep(model.branches[0]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const BodyId wheel = model.wheels[0].body;
    double worst = 0;
    for (const auto& state : path.points) {
        const Vector3d centre = state.poses[static_cast<std::size_t>(wheel)].r;
        Vector3d force = state.load * Vector3d::UnitZ(), moment = Vector3d::Zero();
        for (std::size_t j = 0; j < model.joints.size(); ++j) {
            const double sign = model.joints[j].i == wheel   ? 1
                                : model.joints[j].j == wheel ? -1
                                                             : 0;
            const Vector3d lever = position(state, model.joints[j].at) - centre;
            force += sign * state.reactions[j].force;
            moment += sign * (state.reactions[j].moment + lever.cross(state.reactions[j].force));
        }
        const auto& coil = std::get<AxialSpring>(scene.elastics[0].kind);
        ASSERT_EQ(coil.i.body, wheel);
        const Vector3d lower = position(state, coil.i), D = position(state, coil.j) - lower;
        const Vector3d pull = rate_of(coil) * (D.norm() - coil.free_length) * D.normalized();
        force += pull;
        moment += (lower - centre).cross(pull);
        worst = std::max({worst, force.norm(), moment.norm()});
    }
    EXPECT_LE(worst, 1e-7);
}

// A two-force member transmits a force along itself and no moment; the ball joint and the in-plane
// constraint likewise.
TEST(Reactions, MembersCarryWhatTheirKindCanCarry) {
    const Model model = compile(scene_named("chrono_mcpherson"));
    const auto path = solve(model, model.branches[1], sweep(model.branches[1]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points) {
        for (std::size_t j = 0; j < model.joints.size(); ++j) {
            const Wrench& w = state.reactions[j];
            const std::string& name = model.joints[j].name;
            if (name != "strut_tube") expect_near(w.moment, Vector3d::Zero(), 1e-9, name);
            if (name == "fore_aft")
                expect_near(w.force.cross(Vector3d::UnitX()), Vector3d::Zero(), 1e-9, name);
            if (name == "tie_rod") {
                const Vector3d rod =
                    position(state, model.joints[j].at) - Vector3d(-0.300, 0.520, -0.059);
                expect_near(w.force.cross(rod.normalized()), Vector3d::Zero(), 1e-9, name);
            }
        }
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
