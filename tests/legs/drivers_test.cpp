// Branches driven by lengths, offsets, angles, free lengths and preloads, alone and together,
// against closed forms.
#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::legs {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Drivers : LegTest {};
ELASTOCHECK_FOR(accurate_legs, Drivers);

Driver motion_of(const Scene& scene, const std::string& joint, double rate, double start = 0) {
    for (std::size_t k = 0; k < scene.joints.size(); ++k)
        if (scene.joints[k].name == joint) return {Motion{static_cast<int>(k)}, start, rate};
    throw std::out_of_range(joint);
}
Driver force_on_wheel(const Scene& scene, const Vector3d& f, double rate, double start = 0) {
    return {Load{"force", DeadForce{wheel_centre(scene), f}}, start, rate};
}
SideModel driven(Scene scene, std::vector<Driver> drivers, double to,
                 ParameterUnit unit = ParameterUnit::metre) {
    scene.branches = {branch_of(std::move(drivers), to, unit)};
    return side_of(scene);
}

// ---- Mechanisms without elasticity, in the plane x-y, driven through full turns.

// A crank r about z at the origin, along +x as drawn, a rod l, a slider on the line y = e.
struct SliderCrank {
    double r = 0.05, l = 0.13, e = 0.012;

    double height(double a) const { return r * std::sin(a) - e; }
    Vector3d pin(double a) const { return r * Vector3d(std::cos(a), std::sin(a), 0); }
    Vector3d slider(double a, double rod) const {
        return {r * std::cos(a) + std::sqrt(rod * rod - height(a) * height(a)), e, 0};
    }
    double slope(double a) const {  // of the slider's position over the crank's angle
        return -r * std::sin(a) -
               height(a) * r * std::cos(a) / std::sqrt(l * l - height(a) * height(a));
    }
    Scene scene() const {
        Scene s;
        s.bodies = {{"crank", {}}, {"slider", {slider(0, l)}}};
        s.joints = {{"pin", Revolute{{0}, {ground}, {0, Z}, ground_z}},
                    {"guide", Translational{{1}, {ground, slider(0, l)}, {1, X}, ground_x}},
                    {"rod", Distance{{0, r * X}, {1}, l}},
                    {"drive", Angle{{0, X}, ground_x, ground_y, 0}, true}};
        s.probes = {{"pin", {0, r * X}}, {"slider", {1}}};
        return s;
    }
    SideModel turned(double to) const {
        return driven(scene(), {{Motion{3}, 0, 1}}, to, ParameterUnit::radian);
    }
};

// The moment on the crank balances a force F on the slider by virtual work: M da + F dx = 0.
TEST_P(Drivers, SliderCrankFollowsItsGeometryWithTheMomentOfVirtualWork) {
    const SliderCrank crank;
    const double F = 300;
    for (const double to : {2 * pi, -2 * pi, 6 * pi})
        for (const int steps : {1, 7, 72}) {
            Scene scene = crank.scene();
            scene.static_loads = {{"piston", DeadForce{{1}, -F * X}}};
            const SideModel side = driven(scene, {{Motion{3}, 0, 1}}, to, ParameterUnit::radian);
            Worst places, moments;
            for (const auto& state : solved(leg(), side, steps).points) {
                const double a = state.load;
                places.add((position(state, scene.probes[0].at) - crank.pin(a)).norm(), a);
                places.add((state.poses[1].r - crank.slider(a, crank.l)).norm(), a);
                places.add(
                    state.poses[0].p.angularDistance(Quaterniond(Eigen::AngleAxisd(a, Z))) / 10, a);
                moments.add((state.reactions[3].moment - F * crank.slope(a) * Z).norm(), a);
            }
            EXPECT_TRUE(within(places, limit(1e-12 * crank.l)));
            EXPECT_TRUE(within(moments, limit(1e-12 * F * crank.r)));
        }
}

// The rocker's pin is the intersection of two circles on the side where it is drawn. The coupler is
// a distance, a body whose joints are independent, or a body with redundant joints.
TEST_P(Drivers, FourBarFollowsItsGeometryThroughAFullTurn) {
    const double a = 0.1, b = 0.35, c = 0.25, d = 0.4;  // crank, coupler, rocker, ground
    const auto tip = [&](double angle) -> Vector3d {
        const Vector3d pin = a * Vector3d(std::cos(angle), std::sin(angle), 0), way = d * X - pin;
        const double s = way.norm(), along = (s * s + b * b - c * c) / (2 * s);
        return pin + along * way / s +
               std::sqrt(b * b - along * along) * Vector3d(-way.y(), way.x(), 0) / s;
    };
    for (const int kind : {0, 1, 2}) {
        Scene s;
        s.bodies = {{"crank", {}}, {"rocker", {d * X}}};
        const Point crank_pin{0, a * X}, rocker_pin{1, tip(0) - d * X};
        s.joints = {{"crank", Revolute{{0}, {ground}, {0, Z}, ground_z}},
                    {"rocker", Revolute{{1}, {ground, d * X}, {1, Z}, ground_z}}};
        if (kind == 0) {
            s.joints.push_back({"coupler", Distance{crank_pin, rocker_pin, b}});
        } else {
            s.bodies.push_back({"coupler", {a * X}});
            const Point end{2, tip(0) - a * X};
            s.joints.push_back({"big end", Revolute{{2}, crank_pin, {2, Z}, {0, Z}}});
            s.joints.push_back(kind == 1 ? Joint{"small end", InLine{end, rocker_pin, {1, Z}}}
                                         : Joint{"small end", Spherical{end, rocker_pin}});
        }
        s.joints.push_back({"drive", Angle{{0, X}, ground_x, ground_y, 0}, true});
        s.probes = {{"pin", rocker_pin}};
        const SideModel side = driven(s, {motion_of(s, "drive", 1)}, 2 * pi, ParameterUnit::radian);
        for (const int steps : {1, 5, 60}) {
            Worst worst;
            for (const auto& state : solved(leg(), side, steps).points)
                worst.add((position(state, rocker_pin) - tip(state.load)).norm(), state.load);
            EXPECT_TRUE(within(worst, limit(1e-12 * d))) << kind;
        }
    }
}

// l² = 0.5² + 0.3² + 2·0.5·0.3 sin φ, and the strut's force has the lever 0.5·0.3 cos φ / l.
TEST_P(Drivers, DrivenStrutLengthLiftsABarByTrigonometry) {
    const double l_0 = std::hypot(0.5, 0.3);
    Scene s = hinged_bar(0.5 * X, Y, 100);
    s.joints.push_back({"strut", Distance{{0, 0.5 * X}, {ground, -0.3 * Z}, l_0}});
    Worst worst;
    for (const auto& state : solved(leg(), driven(s, {{Motion{1}, 0, 1}}, 0.2), 20).points) {
        const double l = l_0 + state.load, phi = std::asin((l * l - 0.34) / 0.3);
        worst.add(
            (position(state, s.probes[0].at) - 0.5 * Vector3d(std::cos(phi), 0, std::sin(phi)))
                .norm(),
            state.load);
        const double force = 100 * phi * l / (0.15 * std::cos(phi));
        worst.add(std::abs(state.reactions[1].force.norm() - std::abs(force)) / 1e3, state.load);
    }
    EXPECT_TRUE(within(worst, limit(1e-12)));
}

// ---- Values held at a = 0 are settled first.

TEST_P(Drivers, BodySettlesToItsHeldAngleFromAnyDesignAngle) {
    const SliderCrank crank;
    for (const double start : {-9., -2.9, -2., -0.5, 0.5, 1.7, 3., 7.}) {
        const SideModel side =
            driven(crank.scene(), {{Motion{3}, start, 1}}, 1, ParameterUnit::radian);
        for (const auto& state : solved(leg(), side, 1).points) {
            const double a = start + state.load;
            EXPECT_LE((state.poses[1].r - crank.slider(a, crank.l)).norm(), limit(1e-12 * crank.l))
                << start;
            EXPECT_LE((position(state, {0, crank.r * X}) - crank.pin(a)).norm(),
                      limit(1e-12 * crank.l))
                << start;
        }
    }
}

TEST_P(Drivers, RodSettlesToItsStatedLength) {
    const SliderCrank crank;
    for (const double rod : {0.07, 0.1, 0.2, 0.5}) {
        Scene scene = crank.scene();
        std::get<Distance>(scene.joints[2].kind).length = rod;
        const SideModel side = driven(scene, {{Motion{3}, 0, 1}}, 2 * pi, ParameterUnit::radian);
        for (const auto& state : solved(leg(), side, 36).points)
            EXPECT_LE((state.poses[1].r - crank.slider(state.load, rod)).norm(),
                      limit(1e-12 * rod));
    }
    // With elasticity: a tie rod longer than drawn equals one that a branch has lengthened.
    const Scene strut = support::scene("chrono_mcpherson");
    for (const double longer : {0.003, -0.02}) {
        const auto lengthened =
            solved(leg(), driven(strut, {motion_of(strut, "tie_rod", 1)}, longer), 1);
        Scene other = strut;
        std::get<Distance>(other.joints[2].kind).length += longer;
        const auto drawn = solved(leg(), side_of(other), 1);
        EXPECT_LE(distance(lengthened.points[1], drawn.points[0], 2), 1e-9) << longer;
        EXPECT_GT(distance(lengthened.points[0], drawn.points[0], 2), 1e-3) << longer;
    }
}

// In the design position a hinge that is held at an angle is off its axis, and a bar is 10 mm too short.
TEST_P(Drivers, GapsOfJointsInTheDesignPositionAreClosed) {
    Scene scene;
    scene.bodies = {{"crank", {}}};
    const Vector3d at(0.01, -0.02, 0.03);
    const double angle = leg().kind == Leg::recursive ? 0.9 : 2.5;  // it does not turn past pi/2
    scene.joints = {{"pivot", Revolute{{0}, {ground, at}, {0, Z}, ground_z}},
                    {"stand", Angle{{0, X}, ground_x, ground_y, angle}}};
    scene.probes = {{"crank", {0}}};
    scene.branches = {load_branch(DeadForce{{0}, X}, 1)};
    const auto stood = solved(leg(), side_of(scene), 1);
    EXPECT_LE((stood.points[0].poses[0].r - at).norm(), 1e-13);
    EXPECT_LE(stood.points[0].poses[0].p.angularDistance(Quaterniond(Eigen::AngleAxisd(angle, Z))),
              1e-12);
    Scene bar = hinged_bar(0.5 * X, Y, 100);
    bar.joints.push_back({"bar", Distance{{0, 0.5 * X}, {ground, {0.5, 0, 0.3}}, 0.29}});
    bar.branches = {load_branch(DeadForce{{0, 0.5 * X}, Z}, 100)};
    const auto closed = solved(leg(), side_of(bar), 1);
    EXPECT_NEAR((position(closed.points[1], bar.probes[0].at) - Vector3d(0.5, 0, 0.3)).norm(), 0.29,
                1e-12);
}

// ---- Elastic scenes on a jack.

// The jack's force at the height z of the apex is the arch's load there, past both limit points of
// ∓ 211.5166 N, and its work is the energy stored.
TEST_P(Drivers, JackDrivesTheArchThroughBothLimitPoints) {
    const double b = 0.3, h = 0.08, k = 1e5, l_0 = std::hypot(b, h), limit = 211.5166;
    Scene s = support::scene("two_spring_arch");
    s.joints.push_back({"jack", InPlane{{0}, {ground}, ground_z, h}, true});
    const SideModel side = driven(s, {motion_of(s, "jack", 1)}, -0.2);
    for (const int steps : {1, 3, 100}) {
        Worst worst;
        double least = 0, most = 0;
        for (const auto& state : solved(leg(), side, steps).points) {
            const double z = h + state.load, l = std::hypot(b, z), F = 2 * k * (l - l_0) * z / l;
            const Wrench& jack = state.reactions.back();
            worst.add((jack.force - F * Z).norm() / limit, z);
            worst.add((state.poses[0].r - z * Z).norm() / b, z);
            if (z < -h) continue;
            least = std::min(least, jack.force.z());
            most = std::max(most, jack.force.z());
        }
        EXPECT_TRUE(within(worst, leg().kind == Leg::equilibrium ? 1e-12
                                  : leg().exact()                ? 1e-9
                                                                 : 1e-8))
            << steps;
        if (steps < 100) continue;
        EXPECT_NEAR(least, -limit, 0.1);
        EXPECT_NEAR(most, limit, 0.1);
    }
}

TEST_P(Drivers, DrivenTravelAndDrivenLoadGiveTheSameStates) {
    const Scene s = with_jack(support::scene("chrono_mcpherson"));
    for (const double to : {0.08, -0.08}) {
        const SideModel travel = driven(s, {motion_of(s, "jack", 1)}, to);
        const Equilibrium lifted = solved(leg(), travel, 6).points.back();
        const double force = lifted.reactions.back().force.z();
        EXPECT_GT(force * to, 1000 * std::abs(to));
        const SideModel load = driven(s, {force_on_wheel(s, Z, 1)}, force, ParameterUnit::newton);
        const Equilibrium pushed = solved(leg(), load, 6).points.back();
        EXPECT_LE(distance(lifted, pushed, 2), 1e-9);
        // The jack is no joint of the model where no branch drives it, or one without a force.
        for (std::size_t j = 0; j < pushed.reactions.size(); ++j)
            EXPECT_LE(
                ((j + 1 < lifted.reactions.size() ? lifted.reactions[j].force : Vector3d::Zero()) -
                 pushed.reactions[j].force)
                    .norm(),
                1e-9 * std::abs(force));
    }
}

// ---- Elements. That the work of a driver is the energy stored: tests/compare/virtual_work_test.cpp.

// Two springs in line under a weight: k₁ (z - a) + k₂ z = -W.
TEST_P(Drivers, DrivenFreeLengthShiftsABlockByTheRatioOfTheRates) {
    const double k_1 = 30e3, k_2 = 12e3, W = 500, start = 0.01, rate = 2;
    Scene s = block({});
    s.elastics = {{"lower", AxialSpring{{ground, -0.3 * Z}, {0}, LinearRate{k_1}, 0.3}},
                  {"upper", AxialSpring{{ground, 0.4 * Z}, {0}, LinearRate{k_2}, 0.4}}};
    s.static_loads = {{"weight", DeadForce{{0}, -W * Z}}};
    for (const auto& state :
         solved(leg(), driven(s, {{FreeLength{0}, start, rate}}, 0.04), 8).points)
        EXPECT_NEAR(state.poses[0].r.z(), (k_1 * (start + rate * state.load) - W) / (k_1 + k_2),
                    limit(1e-14));
}

// The only equilibrium of one bushing is K e = -preload.
TEST_P(Drivers, PreloadOfABushingIsBalancedByItsDeformation) {
    Random random;
    for (int trial = 0; trial < 10; ++trial) {
        Scene s = support::scene("single_bushing");
        Bushing& b = bushing_of(s.elastics[0]);
        stiffness_of(b) = random.stiffness();
        const Vector6 start = random.wrench(300, 5), rate = random.wrench(600, 20);
        const SideModel side = driven(s, {{Preload{0, start}, 1, 0}, {Preload{0, rate}, 0, 1}}, 2,
                                      ParameterUnit::none);
        Worst worst;
        for (const auto& state : solved(leg(), side, 8).points) {
            const Vector6 e = -stiffness_of(b).ldlt().solve(start + state.load * rate);
            // e = (d, θ) in the axes of the marker on ground
            Equilibrium expected = state;
            const double theta = e.tail<3>().norm();
            Pose& pose = expected.poses[0];
            ASSERT_EQ(b.i.body, ground);
            pose.p = b.i.A_local * Eigen::AngleAxisd(theta, e.tail<3>() / theta) *
                     b.j.A_local.conjugate();
            pose.r = b.i.s_local + b.i.A_local * e.head<3>() - pose.p * b.j.s_local;
            worst.add(distance(state, expected) / e.norm(), state.load);
        }
        EXPECT_TRUE(within(worst, limit(1e-11))) << trial;
    }
}

// ---- Several drivers.

TEST_P(Drivers, HeldRackActsAsGround) {
    Scene scene = support::scene("chrono_mcpherson");
    const auto with = solved(leg(), side_of(with_rack(scene)), 3),
               without = solved(leg(), side_of(scene), 3);
    for (std::size_t n = 0; n < with.points.size(); ++n)
        for (std::size_t b : {0u, 1u}) {
            const Pose &p = with.points[n].poses[b], &q = without.points[n].poses[b];
            EXPECT_LE((p.r - q.r).norm() + p.p.angularDistance(q.p), limit(1e-11));
        }
}

// The rack follows its drive at every held height of the wheel; its force is the tie rod's
// component along it.
TEST_P(Drivers, RackAndWheelFollowTheirDrivesAtThreeHeldHeights) {
    const Scene s = with_jack(with_rack(support::scene("chrono_mcpherson")));
    const auto& tie = std::get<Distance>(s.joints[2].kind);
    for (const double height : {-0.05, 0., 0.05})
        for (const double to : {0.03, -0.03}) {
            const SideModel side =
                driven(s, {motion_of(s, "rack", 1), motion_of(s, "jack", 0, height)}, to);
            Worst geometry, force;
            double least = 10, most = -10;
            for (const auto& state : solved(leg(), side, 12).points) {
                const Vector3d moved =
                    position(state, wheel_centre(s)) - drawn_position(s, wheel_centre(s));
                geometry.add(std::abs(moved.z() - height), "height");
                geometry.add(std::abs(state.poses[3].r.y() - s.bodies[3].design.r.y() - state.load),
                             "rack");
                geometry.add(
                    std::abs((position(state, tie.i) - position(state, tie.j)).norm() - tie.length),
                    "tie rod");
                const auto& rod = state.reactions[joint_named(side.model, "tie_rod")].force;
                const auto& rack = state.reactions[joint_named(side.model, "rack")].force;
                force.add((rack - rod.y() * Y).norm() / 1e3, state.load);
                const Vector3d spin = state.poses[static_cast<std::size_t>(s.wheels[0].body)].p *
                                      s.wheels[0].spin_axis_local;
                least = std::min(least, std::atan2(spin.x(), spin.y()));
                most = std::max(most, std::atan2(spin.x(), spin.y()));
            }
            EXPECT_TRUE(within(geometry, limit(1e-14)));
            EXPECT_TRUE(within(force, limit(1e-11)));
            EXPECT_GT(most - least, 0.1) << "it steers";
        }
}

// Nor does it depend on which of the drivers is constant, or on whether a constant load is written as a static load.
TEST_P(Drivers, OrderOfDriversDoesNotChangeTheEquilibrium) {
    const Vector3d brake(-1500, 0, 0);
    const Scene s = with_jack(with_rack(support::scene("chrono_mcpherson")));
    const auto end = [&](double steer, double lift, double push) {
        const SideModel side = driven(s,
                                      {motion_of(s, "rack", 0.02 * steer, 0.02 * (1 - steer)),
                                       motion_of(s, "jack", 0.04 * lift, 0.04 * (1 - lift)),
                                       force_on_wheel(s, brake, push, 1 - push)},
                                      1, ParameterUnit::none);
        return solved(leg(), side, 1).points.back();
    };
    const Equilibrium together = end(1, 1, 1);
    Scene loaded = s;
    loaded.static_loads = {{"brake", DeadForce{wheel_centre(s), brake}}};
    const SideModel at_static_load = driven(
        loaded, {motion_of(s, "rack", 0.02), motion_of(s, "jack", 0.04)}, 1, ParameterUnit::none);
    for (const Equilibrium& other : {end(1, 0, 0), end(0, 1, 1), end(0.5, 0, 1),
                                     solved(leg(), at_static_load, 1).points.back()}) {
        EXPECT_LE(distance(together, other, 2), 1e-10);
        for (std::size_t j = 0; j < other.reactions.size(); ++j)
            EXPECT_LE((together.reactions[j].force - other.reactions[j].force).norm(), 3e-7);
    }
}

TEST_P(Drivers, DriversOfOneJointAddUp) {
    const SliderCrank crank;
    const auto once = solved(leg(), crank.turned(1), 1);
    const auto twice = solved(leg(),
                              driven(crank.scene(), {{Motion{3}, 0.25, 0.5}, {Motion{3}, 0, 0.25}},
                                     1, ParameterUnit::radian),
                              1);
    EXPECT_LE((once.points[1].poses[1].r - twice.points[1].poses[1].r).norm(),
              leg().kind == Leg::equilibrium ? 1e-15 : 1e-13);
}

// ---- Judgements and failures.

// The sine of an angle is zero in the opposite direction too; the residuals tell them apart.
TEST_P(Drivers, OppositeDirectionDoesNotSatisfyAnAngle) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "its residuals do not tell them apart";
    const SliderCrank crank{.e = 0};
    const SideModel side = crank.turned(1);
    Equilibrium turned = solved(leg(), side, 1).points[0];
    turned.poses[0].p = Eigen::AngleAxisd(pi, Z);
    turned.poses[1].r.x() = -crank.r + crank.l;
    const Residuals left = residuals(leg(), side, turned);
    EXPECT_LE(left.length, 1e-15);
    EXPECT_GE(left.direction, 1);
}

// A rod that is too short to close over the full turn, and a state that is out of reach
// from the start.
TEST_P(Drivers, JointsThatCannotBeClosedEndTheBranch) {
    SliderCrank crank{.l = 0.03};
    Scene s = crank.scene();
    for (const int steps : {5, 20}) {
        const auto path =
            solve(leg(), driven(s, {{Motion{3}, 0, 1}}, 2 * pi, ParameterUnit::radian), steps);
        EXPECT_NE(path.outcome, Outcome::converged);
        for (const auto& state : path.points)  // r sin a - e = l
            EXPECT_LE(state.load, std::asin((crank.l + crank.e) / crank.r));
        if (leg().kind == Leg::recursive) continue;
        EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
        EXPECT_TRUE(contains(path.detail, "joint") && contains(path.detail, "'")) << path.detail;
        EXPECT_EQ(path.points.size(), 1 + static_cast<std::size_t>(steps * 57.14 / 360));
    }
    const auto held = solve(leg(), driven(s, {{Motion{3}, 2, 1}}, 1, ParameterUnit::radian), 1);
    EXPECT_NE(held.outcome, Outcome::converged) << held.detail;
    EXPECT_TRUE(held.points.empty());
}

TEST_P(Drivers, DrivingACoordinateHeldByAnotherJointIsInconsistent) {
    const SliderCrank crank;
    Scene s = crank.scene();
    s.joints.push_back({"lock", Distance{{0, crank.r * X}, {ground, {crank.r, -0.1, 0}}, 0.1}});
    const auto path = solve(leg(), driven(s, {{Motion{3}, 0, 1}}, 1, ParameterUnit::radian), 1);
    EXPECT_NE(path.outcome, Outcome::converged) << path.detail;
    EXPECT_LE(path.points.size(), 1u);
    if (leg().kind == Leg::recursive) return;
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    for (const char* name : {"'lock'", "'drive'"})
        EXPECT_TRUE(contains(path.detail, leg().kind == Leg::energy ? "joint '" : name))
            << path.detail;
}

TEST_P(Drivers, ALengthDrivenBelowZeroOrOutOfReachIsInconsistent) {
    Scene s = hinged_bar(0.5 * X, Y, 100);
    s.joints.push_back({"rod", Distance{{0, 0.5 * X}, {ground, -Z}, std::hypot(0.5, 1)}});
    // The tip is at most 1.5 m from the foot of the rod.
    for (const int steps : {1, 4, 50}) {
        const auto path = solve(leg(), driven(s, {motion_of(s, "rod", 1)}, 1), steps);
        EXPECT_NE(path.outcome, Outcome::converged);
        for (const auto& state : path.points) EXPECT_LE(state.load, 1.5 - std::hypot(0.5, 1));
    }
    for (const Driver& beyond : {motion_of(s, "rod", 0, 1), motion_of(s, "rod", 0, -2)}) {
        const auto path = solve(leg(), driven(s, {beyond}, 1), 1);
        EXPECT_NE(path.outcome, Outcome::converged);
        EXPECT_TRUE(path.points.empty());
    }
    if (leg().kind == Leg::recursive) return;
    const auto negative = solve(leg(), driven(s, {motion_of(s, "rod", -1)}, 2), 1);
    EXPECT_EQ(negative.outcome, Outcome::inconsistent_constraints) << negative.detail;
    EXPECT_TRUE(contains(negative.detail, "'rod'")) << negative.detail;
}

TEST_P(Drivers, BranchOfAnotherModelIsRejected) {
    Scene s = with_jack(support::scene("chrono_mcpherson"));
    s.branches.push_back(branch_of({motion_of(s, "jack", 1)}, 0.1, ParameterUnit::metre));
    const Model with = compile(s), plain = compile(support::scene("chrono_mcpherson"));
    const auto misuse = [&](const Model& model, Branch branch) {
        EXPECT_THROW(solve(leg(), {model, branch}, 1), std::invalid_argument);
    };
    misuse(with, with.branches[0]);  // the jack is active and not driven
    Equilibrium state;
    state.poses.resize(with.bodies.size());
    state.reactions.resize(with.joints.size());
    EXPECT_THROW(residuals(leg(), {with, with.branches[0]}, state), std::invalid_argument);
    Branch two_sides = plain.branches[0];
    two_sides.from = -1;
    misuse(plain, two_sides);
    // A ball joint has no offset, a spring no preload vector.
    for (const Driven& what : {Driven{Motion{0}}, Driven{Preload{0, Vector6::Ones()}}}) {
        if (leg().kind == Leg::energy) continue;  // checks the branch only
        misuse(plain, branch_of({{what, 0, 1}}, 1));
    }
}

TEST_P(Drivers, NonFiniteDriverNeverConverges) {
    const Scene strut = with_jack(support::scene("chrono_mcpherson"));
    for (const double bad : {std::nan(""), double(INFINITY)}) {
        const Driver drivers[] = {
            motion_of(strut, "jack", bad),    motion_of(strut, "jack", 1, bad),
            motion_of(strut, "tie_rod", bad), Driver{FreeLength{0}, 0, bad},
            Driver{FreeLength{0}, bad, 1},    Driver{Preload{1, Vector6::Constant(bad)}, 0, 1}};
        for (const auto& driver : drivers) {
            const auto path = solve(leg(), driven(strut, {driver}, 0.01), 1);
            EXPECT_NE(path.outcome, Outcome::converged);
            EXPECT_FALSE(path.detail.empty());
            EXPECT_LE(path.points.size(), 1u);
        }
    }
}

}  // namespace
}  // namespace elastocheck::legs
