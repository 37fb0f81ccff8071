// Joint reactions against statics by hand, and residuals() of right and wrong states.
#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::legs {
namespace {

struct Reactions : LegTest {};
ELASTOCHECK_FOR(accurate_legs, Reactions);

Scene swapped_joint(Scene s, std::size_t j) {
    std::visit(
        [](auto& k) {
            if constexpr (requires { k.length; }) std::swap(k.i, k.j);
            if constexpr (requires { k.axis_i, k.axis_j; })
                std::swap(k.i, k.j), std::swap(k.axis_i, k.axis_j);
            if constexpr (requires { k.x_i; })
                std::swap(k.i, k.j), std::swap(k.x_i, k.x_j), std::swap(k.y_i, k.y_j);
        },
        s.joints[j].kind);
    return s;
}

// A turned block welded to ground carries a force at p and a moment: the weld exerts the opposite
// of both, about its own point, on its body i, which may be the block or ground.
TEST_P(Reactions, WeldExertsTheOppositeForceAndMoment) {
    Random random;
    for (int trial = 0; trial < 4; ++trial) {
        const Vector3d r(1, 2, 3), weld(0.2, -0.1, 0.4), p(-0.3, 0.5, 0.1), f(100, -200, 300),
            m(7, 8, -9);
        const Quaterniond A = random.rotation(), B = A.conjugate();
        Scene s;
        s.bodies = {{"block", {r, A}}};
        s.joints = {
            {"weld",
             Fixed{{0, weld}, {ground, r + A * weld}, {0, B * X}, {0, B * Y}, ground_x, ground_y}}};
        s.branches = {branch_of(
            {{Load{"f", DeadForce{{0, p}, f}}, 0, 1}, {Load{"m", DeadMoment{0, m}}, 0, 1}}, 3)};
        s.probes = {{"p", {0, p}}};
        for (const double sign : {-1., 1.}) {
            const Model model = compile(sign < 0 ? s : swapped_joint(s, 0), Detail::everything);
            for (const auto& state : solved(leg(), side_of(model), 3).points) {
                const double a = sign * state.load;
                EXPECT_LE((state.reactions[0].force - a * f).norm(), 1e-9);
                EXPECT_LE((state.reactions[0].moment - a * (m + (A * (p - weld)).cross(f))).norm(),
                          1e-9);
            }
        }
    }
}

// A bracket welded to a block on a bushing: the wrench is about the displaced weld.
TEST_P(Reactions, WeldOnAMovingBodyActsAtItsPresentPosition) {
    const Vector3d at(0.2, 0.1, 0), p(0.3, -0.2, 0.3), f = 400 * Vector3d(0.36, 0.48, 0.8);
    Scene s;
    s.bodies = {{"block", {}}, {"bracket", {0.2 * X}}};
    s.joints = {{"weld", Fixed{{1, at - 0.2 * X}, {0, at}, {1, X}, {1, Y}, {0, X}, {0, Y}}}};
    s.elastics = {{"mount", bushing({ground}, {0}, {2e4, 3e4, 4e4}, {600, 500, 400})}};
    s.branches = {load_branch(DeadForce{{1, p}, f}, 1)};
    s.probes = {{"p", {1, p}}};
    const auto state = solved(leg(), side_of(compile(s, Detail::everything)), 1).points.back();
    const Vector3d arm = position(state, {1, p}) - position(state, {0, at});
    EXPECT_GT((arm - (p + 0.2 * X - at)).norm(), 0.01) << "it does move";
    EXPECT_LE((state.reactions[0].force + f).norm(), 1e-8);
    EXPECT_LE((state.reactions[0].moment + arm.cross(f)).norm(), 1e-8);
}

// A jib hinged at the origin about y, held at 2 m by a stay to a point 1.5 m above the hinge, loaded
// at 3 m: the stay by Σ M_y = 0, the hinge by Σ F = 0.
TEST_P(Reactions, CraneReactionsFollowFromStatics) {
    const Vector3d foot(2, 0, 0), head(0, 0, 1.5), hook(3, 0.4, 0);
    Scene s = hinged_bar(hook, Y, 0);
    s.elastics.clear();
    s.joints.push_back({"stay", Distance{{0, foot}, {ground, head}, 2.5}});
    s.branches = {load_branch(DeadForce{{0, hook}, -Z}, 1000)};
    const double P = 1000, S = P * 3 / (2 * 1.5 / 2.5);
    const Vector3d stay = S * (head - foot) / 2.5, load = -P * Z,
                   moment = -hook.cross(load) - foot.cross(stay);
    EXPECT_NEAR(moment.y(), 0, 1e-10);
    for (const double sign : {1., -1.}) {
        const Scene now = sign > 0 ? s : swapped_joint(swapped_joint(s, 0), 1);
        const auto state =
            solved(leg(), side_of(compile(now, Detail::everything)), 3).points.back();
        EXPECT_LE((sign * state.reactions[1].force - stay).norm(), 1e-8);
        EXPECT_LE(state.reactions[1].moment.norm(), 1e-8);
        EXPECT_LE((sign * state.reactions[0].force + stay + load).norm(), 1e-8);
        EXPECT_LE((sign * state.reactions[0].moment - moment).norm(), 1e-8);
    }
}

// The pin of the pinned bar carries the bushing's force, k times the tip's displacement, and the
// load; the guide of the plate the moment of an eccentric load, whose force the springs carry.
TEST_P(Reactions, PinnedBarAndGuideCarryTheRemainingLoad) {
    const Scene bar = support::scene("pinned_bar");
    for (const double sign : {1., -1.})
        for (const auto& state :
             solved(leg(), side_of(sign > 0 ? bar : swapped_joint(bar, 0)), 20).points) {
            const Vector3d stretch = position(state, bar.probes[0].at) - 0.5 * X;
            EXPECT_LE((sign * state.reactions[0].force - 20e3 * stretch + state.load * Z).norm(),
                      1e-6);
            EXPECT_LE(state.reactions[0].moment.norm(), 1e-6);
        }
    Scene plate = support::scene("parallel_springs");
    auto& load = std::get<DeadForce>(std::get<Load>(plate.branches[0].drivers[0].what).kind);
    load.at.s_local = Vector3d(0.1, 0.05, 0);
    for (const auto& state : solved(leg(), side_of(plate), 20).points) {
        const double z = state.load / 75e3;
        const Vector3d springs =
            -0.2 * X.cross((600 - 30e3 * z) * Z) + 0.3 * X.cross(-45e3 * z * Z);
        EXPECT_LE(state.reactions[0].force.norm(), 1e-6);
        EXPECT_LE(
            (state.reactions[0].moment + springs + load.at.s_local.cross(state.load * Z)).norm(),
            1e-6);
    }
}

// Every kind of joint between two bodies on bushings, in both orders: in balance, with wrenches that
// it can transmit, as judged by the leg's residuals in solved().
TEST_P(Reactions, EveryKindOfJointIsInBalance) {
    Random random;
    const Vector3d at(0.2, 0.1, -0.1), far(0.35, 0.2, 0.15);
    for (const bool swapped : {false, true}) {
        const BodyId a = swapped ? 1 : 0, b = 1 - a;
        const std::pair<JointKind, int> kinds[] = {
            {Spherical{{a, at}, {b, at}}, 3},
            {Revolute{{a, at}, {b, at}, {a, Y}, {b, Y}}, 5},
            {Universal{{a, at}, {b, at}, {a, Y}, {b, Z}}, 4},
            {Cylindrical{{a, at}, {b, at}, {a, X}, {b, X}}, 4},
            {Translational{{a, at}, {b, at}, {a, Z}, {b, Z}}, 5},
            {Planar{{a, at}, {b, at}, {a, Z}, {b, Z}}, 3},
            {Fixed{{a, at}, {b, at}, {a, X}, {a, Y}, {b, X}, {b, Y}}, 6},
            {Distance{{a, at}, {b, far}, (far - at).norm()}, 1},
            {InPlane{{a, at}, {b, at}, {b, X}}, 1},
            {InLine{{a, at}, {b, at}, {b, X}}, 2},
            {Perpendicular{{a, X}, {b, Y}}, 1},
            {Parallel{{a, X}, {b, X}}, 2}};
        for (const auto& [kind, rows] : kinds) {
            Scene s;
            s.bodies = {{"a", {}}, {"b", {}}};
            s.joints = {{"joint", kind}};
            s.branches = {branch_of({}, 500)};
            for (const BodyId body : {0, 1}) {
                Marker marker{ground, random.vector(0.2), random.rotation()};
                Bushing mount{marker, marker, LinearStiffness{random.stiffness()}};
                mount.j.body = body;
                s.elastics.push_back({"mount", mount});
                auto& drivers = s.branches[0].drivers;
                drivers.push_back(
                    {Load{"f", DeadForce{{body, random.vector(0.3)}, random.vector()}}, 0, 1});
                drivers.push_back({Load{"m", DeadMoment{body, random.vector(0.05)}}, 0, 1});
            }
            s.probes = {{"a", {0, at}}, {"b", {1, at}}};
            const Model model = compile(s, Detail::everything);
            ASSERT_EQ(constraint_rows(model), rows) << kind.index();
            double carried = 0;
            for (const auto& state : solved(leg(), side_of(model), 10, 1e-7).points)
                carried = std::max(
                    carried, state.reactions[0].force.norm() + state.reactions[0].moment.norm());
            EXPECT_GT(carried, 1) << kind.index();
        }
    }
}

// Free-body diagram of the McPherson wheel: four joints, the coil and the load; and members carry
// only what their kind can.
TEST_P(Reactions, McPhersonWheelIsInBalance) {
    const Scene scene = support::scene("chrono_mcpherson");
    const auto& coil = std::get<AxialSpring>(scene.elastics[0].kind);
    for (std::size_t n = 0; n < scene.branches.size(); ++n) {
        const SideModel side = side_of(scene, n);
        const BodyId wheel = side.model.wheels[0].body;
        ASSERT_EQ(coil.i.body, wheel);
        const auto path = solve(leg(), side, 60);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        double worst = 0;
        for (const auto& state : path.points) {
            const Vector3d centre = state.poses[static_cast<std::size_t>(wheel)].r;
            Vector3d force = state.load * Z, moment = Vector3d::Zero();
            for (std::size_t j = 0; j < side.model.joints.size(); ++j) {
                const auto& joint = side.model.joints[j];
                const Wrench& w = state.reactions[j];
                const double sign = joint.i == wheel ? 1 : joint.j == wheel ? -1 : 0;
                force += sign * w.force;
                moment += sign * (w.moment + (position(state, joint.at) - centre).cross(w.force));
                if (joint.name != "strut_tube") {
                    EXPECT_LE(w.moment.norm(), 1e-9) << joint.name;
                }
                if (joint.name == "fore_aft") {
                    EXPECT_LE(w.force.cross(X).norm(), 1e-9);
                }
                if (joint.name == "tie_rod") {
                    const Vector3d rod = position(state, joint.at) - Vector3d(-0.3, 0.52, -0.059);
                    EXPECT_LE(w.force.cross(rod.normalized()).norm(), 1e-8);
                }
            }
            const Vector3d lower = position(state, coil.i), D = position(state, coil.j) - lower;
            const Vector3d pull =
                std::get<LinearRate>(coil.law).k * (D.norm() - coil.free_length) * D.normalized();
            force += pull;
            moment += (lower - centre).cross(pull);
            worst = std::max({worst, force.norm(), moment.norm()});
        }
        EXPECT_LE(worst, leg().exact() ? 1e-7 : 1e-4);
    }
}

// ---- Residuals of a state.

struct Residual : LegTest {
    SideModel side = side_of(support::scene("chrono_mcpherson"));
    Equilibrium state;
    void SetUp() override {
        side.branch.to = 1000;
        side.model.branches = {side.branch};
        state = solved(leg(), side, 1).points.back();
    }
    Residuals judged(const std::function<void(Equilibrium&)>& spoil) const {
        Equilibrium spoiled = state;
        spoil(spoiled);
        return residuals(leg(), side, spoiled);
    }
    static bool finite(const Residuals& r) {
        return std::isfinite(r.length) && std::isfinite(r.direction) && std::isfinite(r.force) &&
               std::isfinite(r.moment);
    }
    // The energy leg computes its own multipliers and does not read the reactions.
    bool reads_reactions() const { return leg().kind != Leg::energy; }
};
ELASTOCHECK_FOR(exact_legs, Residual);

TEST_P(Residual, EquilibriumHasAResidualOfRounding) {
    const Residuals r = judged([](Equilibrium&) {});
    EXPECT_LE(std::max(r.length, r.direction), 1e-14);
    EXPECT_LE(std::max(r.force, r.moment), 1e-8);
}

TEST_P(Residual, WrongLoadOfAMicronewtonIsVisible) {
    SideModel pair = side_of(support::scene("bushing_pair"));
    Equilibrium at = solved(leg(), pair, 1).points.back();
    at.load += 1e-6;
    EXPECT_NEAR(residuals(leg(), pair, at).force, 1e-6, 2e-8);
    EXPECT_GE(judged([](Equilibrium& s) { s.load += 1e-6; }).force,
              10 * judged([](Equilibrium&) {}).force);
}

TEST_P(Residual, AnyBodyDisplacedByAMicrometreIsVisible) {
    for (std::size_t b = 0; b < side.model.bodies.size(); ++b) {
        const Residuals shifted = judged([&](Equilibrium& s) { s.poses[b].r[0] += 1e-6; });
        EXPECT_TRUE(shifted.length > 1e-8 || shifted.force > 1e-3) << b;
        const Residuals turned = judged([&](Equilibrium& s) {
            s.poses[b].p = Eigen::AngleAxisd(1e-6, Vector3d(0.6, 0, 0.8)) * s.poses[b].p;
        });
        EXPECT_TRUE(turned.length > 1e-8 || turned.direction > 1e-8 || turned.moment > 1e-5) << b;
    }
    EXPECT_NEAR(judged([](Equilibrium& s) { s.poses[0].r.y() += 1e-6; }).length, 1e-6, 1e-12);
}

TEST_P(Residual, AnyWrongReactionIsVisible) {
    if (!reads_reactions()) GTEST_SKIP();
    for (std::size_t n = 0; n < side.model.joints.size(); ++n)
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(judged([&](Equilibrium& s) { s.reactions[n].force[k] += 0.1; }).force, 0.05)
                << side.model.joints[n].name;
            EXPECT_GE(judged([&](Equilibrium& s) { s.reactions[n].moment[k] += 0.1; }).moment, 0.05)
                << side.model.joints[n].name;
        }
}

// Two joints between one body and ground can exchange a moment without an imbalance; a ball joint
// and the axis of a hinge cannot carry it.
TEST_P(Residual, WrenchThatAJointCannotTransmitIsVisible) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "the recursion does not judge this";
    if (!reads_reactions()) GTEST_SKIP();
    Scene s = hinged_bar(0.5 * X, Y, 100);
    s.joints.push_back({"ball", Spherical{{0, 0.2 * Y}, {ground, 0.2 * Y}}});
    s.branches = {load_branch(DeadForce{{0, 0.5 * X}, Z}, 50)};
    side = side_of(compile(s, Detail::everything));
    state = solved(leg(), side, 1).points.back();
    EXPECT_LE(judged([](Equilibrium&) {}).moment, 1e-9);
    for (const auto& [traded, moment] :
         {std::pair{Vector3d(3, 0, 4), 4.}, {Vector3d(0, 2, 0), 2.}}) {
        const Residuals r = judged([&](Equilibrium& e) {
            e.reactions[0].moment += traded;
            e.reactions[1].moment -= traded;
        });
        EXPECT_NEAR(r.moment, moment, 1e-8);
    }
}

TEST_P(Residual, SignOfAQuaternionChangesNothingAndANonUnitQuaternionIsVisible) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "the recursion does not judge this";
    EXPECT_NEAR(judged([](Equilibrium& s) { s.poses[1].p.coeffs() *= 1.001; }).direction, 1e-3,
                2e-6);
    const Residuals r = judged([](Equilibrium& s) {
        for (auto& pose : s.poses) pose.p.coeffs() *= -1;
    });
    EXPECT_LE(r.force, 2e-8);
}

TEST_P(Residual, NonFiniteOrForeignStateNeverPasses) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "the recursion does not judge this";
    EXPECT_TRUE(finite(judged([](Equilibrium&) {})));
    for (const double bad : {std::nan(""), double(INFINITY)}) {
        EXPECT_FALSE(finite(judged([&](Equilibrium& s) { s.load = bad; })));
        for (std::size_t b = 0; b < side.model.bodies.size(); ++b) {
            EXPECT_FALSE(finite(judged([&](Equilibrium& s) { s.poses[b].r[1] = bad; })));
            EXPECT_FALSE(finite(judged([&](Equilibrium& s) { s.poses[b].p.z() = bad; })));
        }
        for (std::size_t n = 0; reads_reactions() && n < side.model.joints.size(); ++n) {
            EXPECT_FALSE(finite(judged([&](Equilibrium& s) { s.reactions[n].force[0] = bad; })));
            EXPECT_FALSE(finite(judged([&](Equilibrium& s) { s.reactions[n].moment[2] = bad; })));
        }
    }
    EXPECT_FALSE(finite(judged([](Equilibrium& s) { s.poses.pop_back(); })));
    if (reads_reactions()) {
        EXPECT_FALSE(finite(judged([](Equilibrium& s) { s.reactions.clear(); })));
    }
}

}  // namespace
}  // namespace elastocheck::legs
