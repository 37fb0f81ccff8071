// Branches driven by lengths, offsets, angles, free lengths and preloads, alone and together,
// against closed forms.
#include <fmt/format.h>

#include <thread>

#include "models/branch.hpp"
#include "reference/equilibrium/statement/system.hpp"
#include "tests/reference/equilibrium/driven_scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

// Model on its n-th branch, solved at the points.
struct Solved {
    Model model;
    EquilibriumPath path;
    const Branch& branch() const { return model.branches[0]; }
};
Solved solved_at(const Scene& s, std::size_t n, const std::vector<double>& points) {
    const Model whole = compile(s);
    Solved result{on_branch(whole, whole.branches[n]), {}};
    result.path = solve(result.model, result.model.branches[0], points);
    return result;
}

std::size_t joint(const Model& model, const std::string& name) {
    for (std::size_t n = 0; n < model.joints.size(); ++n)
        if (model.joints[n].name == name) return n;
    ADD_FAILURE() << "no joint " << name;
    return 0;
}

std::vector<double> equally(double to, int steps) {
    std::vector<double> points;
    for (int n = 0; n <= steps; ++n) points.push_back(to * n / steps);
    return points;
}

void expect_in_balance(const Solved& solved, double limit = 1e-8) {
    Worst worst;
    for (const auto& state : solved.path.points) {
        const auto r = residuals(solved.model, solved.branch(), state);
        for (const double part : {r.length, r.direction, r.force, r.moment})
            worst.see(part, fmt::format("a = {}", state.load));
    }
    EXPECT_TRUE(within(worst, limit));
}

// ---- Mechanisms against their geometry

TEST(EquilibriumDrivers, ASliderCrankFollowsItsGeometryThroughAFullTurn) {
    const double r = 0.05, l = 0.13, e = 0.012;
    for (const double to : {2 * M_PI, -2 * M_PI, 6 * M_PI})
        for (const int steps : {1, 7, 360}) {
            const auto solved = solved_at(slider_crank(r, l, e, to), 0, equally(to, steps));
            ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
            ASSERT_EQ(solved.path.points.size(), static_cast<std::size_t>(steps) + 1);
            Worst worst;
            for (const auto& state : solved.path.points) {
                const double a = state.load;
                const Vector3d pin(r * std::cos(a), r * std::sin(a), 0);
                const Vector3d slider(pin[0] + std::sqrt(l * l - (pin[1] - e) * (pin[1] - e)), e,
                                      0);
                worst.see((position(state, {0, {r, 0, 0}}) - pin).norm() / l,
                          fmt::format("pin at {}", a));
                worst.see((state.poses[1].r - slider).norm() / l, fmt::format("slider at {}", a));
            }
            EXPECT_TRUE(within(worst, 1e-12));
        }
}

TEST(EquilibriumDrivers, AFourBarFollowsItsGeometryThroughAFullTurn) {
    // crank, coupler, rocker, ground: a + d < b + c
    const double a = 0.04, b = 0.11, c = 0.09, d = 0.12;
    for (const int steps : {1, 5, 360}) {
        const auto solved = solved_at(four_bar(a, b, c, d), 0, equally(2 * M_PI, steps));
        ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
        Worst worst;
        for (const auto& state : solved.path.points) {
            const Vector3d tip = circles_meet(
                a * Vector3d(std::cos(state.load), std::sin(state.load), 0), b, {d, 0, 0}, c);
            worst.see((position(state, {2, {c, 0, 0}}) - tip).norm() / d,
                      fmt::format("rocker at {}", state.load));
            worst.see((position(state, {1, {b, 0, 0}}) - tip).norm() / d,
                      fmt::format("coupler at {}", state.load));
        }
        EXPECT_TRUE(within(worst, 1e-12));
    }
}

// The crank's moment balances a force on the slider by virtual work: M dα + F dx = 0.
TEST(EquilibriumDrivers, TheCranksMomentIsWhatVirtualWorkSays) {
    const double r = 0.05, l = 0.13, e = 0.012, F = 300;
    Scene s = slider_crank(r, l, e, 2 * M_PI);
    s.static_loads = {{"piston", DeadForce{{1, {0, 0, 0}}, {-F, 0, 0}}}};
    const auto solved = solved_at(s, 0, equally(2 * M_PI, 72));
    ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
    Worst worst;
    for (const auto& state : solved.path.points) {
        const double a = state.load, y = r * std::sin(a) - e;
        const double dx = -r * std::sin(a) - y * r * std::cos(a) / std::sqrt(l * l - y * y);
        const auto& moment = state.reactions[joint(solved.model, "drive")].moment;
        worst.see((moment - Vector3d(0, 0, F * dx)).norm() / (F * r), fmt::format("{}", a));
    }
    EXPECT_TRUE(within(worst, 1e-12));
}

TEST(EquilibriumDrivers, AJackTakesTheArchThroughBothItsLimitPoints) {
    const double b = 0.3, h = 0.08, k = 100e3, l_0 = std::hypot(b, h), limit = 211.5166;
    Scene s = scene("two_spring_arch");
    s.joints.push_back(
        {"jack", InPlane{{0, {0, 0, 0}}, {ground, {0, 0, h}}, {ground, {0, 0, 1}}}, true});
    s.branches = {branch_of("jack", {{Motion{1}, 0, 1}}, -0.2, 100, ParameterUnit::metre)};
    for (const int steps : {1, 3, 100}) {
        const auto solved = solved_at(s, 0, equally(-0.2, steps));
        ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
        Worst worst;
        double least = 0, most = 0;
        for (const auto& state : solved.path.points) {
            const double z = h + state.load, l = std::hypot(b, z), F = 2 * k * (l - l_0) * z / l;
            const auto& jack = state.reactions[1];
            worst.see((jack.force - Vector3d(0, 0, F)).norm() / limit,
                      fmt::format("force at z = {}", z));
            worst.see((state.poses[0].r - Vector3d(0, 0, z)).norm() / b,
                      fmt::format("apex at z = {}", z));
            if (z > -h)
                least = std::min(least, jack.force[2]), most = std::max(most, jack.force[2]);
        }
        EXPECT_TRUE(within(worst, 1e-12));
        if (steps == 100) {
            EXPECT_NEAR(least, -limit, 0.1);
            EXPECT_NEAR(most, limit, 0.1);
        }
    }
}

TEST(EquilibriumDrivers, ABarThatGrowsLiftsByItsTriangle) {
    // A bar of 0.5 m hinged at the origin about y; a strut from 0.3 m below the hinge to its tip.
    Scene s = hinged_bar({0.5, 0, 0}, {0, 1, 0}, 100);
    s.joints.push_back(
        {"strut", Distance{{0, {0.5, 0, 0}}, {ground, {0, 0, -0.3}}, std::hypot(0.5, 0.3)}});
    s.branches = {branch_of("lift", {{Motion{1}, 0, 1}}, 0.2, 20, ParameterUnit::metre)};
    const auto solved = solved_at(s, 0, equally(0.2, 20));
    ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
    Worst worst;
    for (const auto& state : solved.path.points) {
        // l² = 0.5² + 0.3² + 2·0.5·0.3 sin φ, and the strut's force S has the lever 0.5·0.3 cos
        // φ / l
        const double l = std::hypot(0.5, 0.3) + state.load;
        const double phi = std::asin((l * l - 0.34) / 0.3);
        const Vector3d tip = position(state, {0, {0.5, 0, 0}});
        worst.see((tip - 0.5 * Vector3d(std::cos(phi), 0, std::sin(phi))).norm(), "tip");
        const double S = 100 * phi * l / (0.15 * std::cos(phi));
        worst.see(std::abs(state.reactions[1].force.norm() - std::abs(S)) / 1e3, "strut");
    }
    EXPECT_TRUE(within(worst, 1e-12));
}

// ---- Travel and load reach the same states

TEST(EquilibriumDrivers, TravelAndLoadMeetAtTheSameStates) {
    Scene s = with_jack(scene("chrono_mcpherson"));
    const Vector3d design = position_in(s, s.wheels[0]);
    for (const double to : {3000., -3000.}) {
        s.branches = {
            branch_of(
                "load",
                {driven_by({"vertical",
                            DeadForce{{s.wheels[0].body, s.wheels[0].centre_local}, {0, 0, 1}}})},
                to, 30),
            branch_of("travel", {{Motion{static_cast<int>(s.joints.size()) - 1}, 0, 1}},
                      std::copysign(0.15, to), 30, ParameterUnit::metre)};
        const auto loaded = solved_at(s, 0, equally(to, 30));
        ASSERT_EQ(loaded.path.outcome, Outcome::converged) << loaded.path.detail;
        std::vector<double> travels;
        for (const auto& state : loaded.path.points)
            travels.push_back(position(state, {s.wheels[0].body, s.wheels[0].centre_local})[2] -
                              design[2]);
        const auto jacked = solved_at(s, 1, travels);
        ASSERT_EQ(jacked.path.outcome, Outcome::converged) << jacked.path.detail;
        ASSERT_EQ(jacked.path.points.size(), travels.size());
        Worst states, forces;
        for (std::size_t n = 0; n < travels.size(); ++n) {
            const auto &a = loaded.path.points[n], &b = jacked.path.points[n];
            const auto where = fmt::format("{:.1f} N, {:.3f} mm", a.load, 1e3 * b.load);
            for (std::size_t body = 0; body < 2; ++body) {  // the strut's spin is idle
                states.see((a.poses[body].r - b.poses[body].r).norm(), where);
                states.see(a.poses[body].p.angularDistance(b.poses[body].p), where);
            }
            const auto& jack = b.reactions[joint(jacked.model, "jack")];
            forces.see((jack.force - Vector3d(0, 0, a.load)).norm() / 3000, where);
            forces.see(jack.moment.norm() / 3000, where);
            EXPECT_EQ(a.reactions[joint(loaded.model, "jack")].force.norm(), 0);
        }
        EXPECT_TRUE(within(states, 1e-9));
        EXPECT_TRUE(within(forces, 1e-9));
        fmt::print("travel {:.1f} mm: states {:.1e}, jack force {:.1e} of 3000 N\n",
                   1e3 * travels.back(), states.value, forces.value);
    }
}

// ---- Work

// ∫ (driver effort) da over the branch is the stored energy.
void expect_work_is_energy(const Scene& s, double to,
                           const std::function<double(const Solved&, const Equilibrium&)>& force,
                           const std::function<void(Scene&, double)>& set) {
    const auto gauss = gauss_legendre(40);
    std::vector<double> points = {0};
    for (const auto& [x, w] : gauss) points.push_back(to * x);
    points.push_back(to);
    const auto solved = solved_at(s, 0, points);
    ASSERT_EQ(solved.path.outcome, Outcome::converged) << s.name << ": " << solved.path.detail;
    double work = 0;
    for (std::size_t n = 0; n < gauss.size(); ++n)
        work += to * gauss[n].second * force(solved, solved.path.points[n + 1]);
    Scene at_start = s, at_end = s;
    set(at_start, 0), set(at_end, to);
    const double stored = stored_energy(compile(at_end), solved.path.points.back()) -
                          stored_energy(compile(at_start), solved.path.points.front());
    EXPECT_GT(std::abs(stored), 1e-3) << s.name;
    EXPECT_LE(std::abs(work - stored), 1e-9 * std::abs(stored))
        << s.name << ": " << work << " J, " << stored << " J";
}

TEST(EquilibriumDrivers, TheWorkOfADriverIsTheEnergyStored) {
    const auto nothing = [](Scene&, double) {};
    const auto jack_force = [](const Solved& solved, const Equilibrium& state) {
        return state.reactions[joint(solved.model, "jack")].force[2];
    };
    for (const double to : {0.09, -0.1}) {
        Scene s = with_jack(scene("chrono_mcpherson"));
        s.branches = {branch_of("travel", {{Motion{static_cast<int>(s.joints.size()) - 1}, 0, 1}},
                                to, 30, ParameterUnit::metre)};
        expect_work_is_energy(s, to, jack_force, nothing);
    }
    Scene arch = scene("two_spring_arch");
    arch.joints.push_back(
        {"jack", InPlane{{0, {0, 0, 0}}, {ground, {0, 0, .08}}, {ground, {0, 0, 1}}}, true});
    arch.branches = {branch_of("jack", {{Motion{1}, 0, 1}}, -0.2, 1, ParameterUnit::metre)};
    expect_work_is_energy(arch, -0.2, jack_force, nothing);

    // ∂U/∂ℓ₀ = -u'(ℓ - ℓ₀)
    Scene coil = scene("chrono_mcpherson");
    coil.branches = {branch_of("trim", {{FreeLength{0}, 0, 1}}, 0.03, 1, ParameterUnit::metre)};
    coil.static_loads = {
        {"weight", DeadForce{{coil.wheels[0].body, coil.wheels[0].centre_local}, {0, 0, 0}}}};
    expect_work_is_energy(
        coil, 0.03,
        [](const Solved& solved, const Equilibrium& state) {
            const auto& spring = std::get<AxialSpring>(solved.model.elastics[0].kind);
            const double length = (position(state, spring.j) - position(state, spring.i)).norm();
            return -std::get<LinearRate>(spring.law).k * (length - spring.free_length - state.load);
        },
        [](Scene& s, double a) { std::get<AxialSpring>(s.elastics[0].kind).free_length += a; });

    // ∂U/∂a = directionᵀ e
    Vector6 direction;
    direction << 300, -200, 500, 10, -20, 5;
    Scene mount = scene("single_bushing");
    mount.branches = {
        branch_of("preload", {{Preload{0, direction}, 0, 1}}, 2, 1, ParameterUnit::none)};
    expect_work_is_energy(
        mount, 2,
        [=](const Solved& solved, const Equilibrium& state) {
            return direction.dot(
                deformation(std::get<Bushing>(solved.model.elastics[0].kind), state));
        },
        [=](Scene& s, double a) {
            std::get<Bushing>(s.elastics[0].kind).preload += a * direction;
        });
}

// ---- Elements

// A block on a vertical guide between two springs under its weight: k₁ (z - a) + k₂ z = -W.
TEST(EquilibriumDrivers, AFreeLengthShiftsTheBlockByItsShareOfTheRates) {
    const double k_1 = 30e3, k_2 = 12e3, W = 500;
    Scene s;
    s.bodies = {{"block", {}}};
    s.joints = {
        {"guide",
         Translational{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, {0, {0, 0, 1}}, {ground, {0, 0, 1}}}}};
    s.elastics = {
        {"lower", AxialSpring{{ground, {0, 0, -0.3}}, {0, {0, 0, 0}}, LinearRate{k_1}, 0.3}},
        {"upper", AxialSpring{{ground, {0, 0, 0.4}}, {0, {0, 0, 0}}, LinearRate{k_2}, 0.4}}};
    s.static_loads = {{"weight", DeadForce{{0, {0, 0, 0}}, {0, 0, -W}}}};
    s.probes = {{"block", {0, {0, 0, 0}}}};
    const double start = 0.01, rate = 2;
    s.branches = {branch_of("trim", {{FreeLength{0}, start, rate}}, 0.04, 8, ParameterUnit::metre)};
    const auto solved = solved_at(s, 0, equally(0.04, 8));
    ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
    Worst worst;
    for (const auto& state : solved.path.points)
        worst.see(
            std::abs(state.poses[0].r[2] - (k_1 * (start + rate * state.load) - W) / (k_1 + k_2)),
            "block");
    EXPECT_TRUE(within(worst, 1e-14));
}

// On one bushing the only equilibrium is K e = -preload.
TEST(EquilibriumDrivers, APreloadIsAnsweredByItsBushing) {
    std::mt19937 random(5);
    Worst worst;
    for (int trial = 0; trial < 10; ++trial) {
        Scene s = scene("single_bushing");
        auto& bushing = std::get<Bushing>(s.elastics[0].kind);
        stiffness_of(bushing).K = random_stiffness(random);
        Vector6 start, rate;
        start << random_vector(random, 300), random_vector(random, 5);
        rate << random_vector(random, 600), random_vector(random, 20);
        s.branches = {branch_of("preload", {{Preload{0, start}, 1, 0}, {Preload{0, rate}, 0, 1}}, 2,
                                8, ParameterUnit::none)};
        const auto solved = solved_at(s, 0, equally(2, 8));
        ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
        for (const auto& state : solved.path.points) {
            const Vector6 e = deformation(bushing, state);
            const Vector6 expected =
                -stiffness_of(bushing).K.ldlt().solve(start + state.load * rate);
            worst.see((e - expected).norm() / expected.norm(),
                      fmt::format("trial {}, a = {}", trial, state.load));
        }
    }
    EXPECT_TRUE(within(worst, 1e-11));
}

// ---- Steering, and drivers together

TEST(EquilibriumDrivers, AHeldRackIsGround) {
    const Scene held = with_rack(scene("chrono_mcpherson"));
    const auto with = solved_at(held, 0, {1000, 3000}),
               without = solved_at(scene("chrono_mcpherson"), 0, {1000, 3000});
    ASSERT_EQ(with.path.outcome, Outcome::converged) << with.path.detail;
    Worst worst;
    for (std::size_t n = 0; n < 2; ++n)
        for (std::size_t body = 0; body < 2; ++body) {
            const auto &a = with.path.points[n].poses[body],
                       &b = without.path.points[n].poses[body];
            worst.see((a.r - b.r).norm(), "position");
            worst.see(a.p.angularDistance(b.p), "turn");
        }
    EXPECT_TRUE(within(worst, 1e-11));
}

// The rack follows its drive at every held wheel height; its force is the tie rod's component along
// the rack.
TEST(EquilibriumDrivers, ARackSweepAtEachOfThreeHeights) {
    for (const double height : {-0.05, 0., 0.05})
        for (const double to : {0.03, -0.03}) {
            Scene s = with_jack(with_rack(scene("chrono_mcpherson")));
            const int jack = static_cast<int>(s.joints.size()) - 1, rack = jack - 1;
            s.branches = {branch_of("steer", {{Motion{rack}, 0, 1}, {Motion{jack}, height, 0}}, to,
                                    12, ParameterUnit::metre)};
            const auto solved = solved_at(s, 0, equally(to, 12));
            ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
            Worst geometry, force;
            const auto& wheel = s.wheels[0];
            const auto& tie = std::get<Distance>(s.joints[2].kind);
            double least = 10, most = -10;
            for (const auto& state : solved.path.points) {
                const Vector3d centre = position(state, {wheel.body, wheel.centre_local});
                geometry.see(std::abs(centre[2] - position_in(s, wheel)[2] - height), "height");
                geometry.see(std::abs(state.poses[3].r[1] - s.bodies[3].design.r[1] - state.load),
                             "rack");
                const Vector3d rod = position(state, tie.i) - position(state, tie.j);
                geometry.see(std::abs(rod.norm() - tie.length), "tie rod");
                const auto& on_wheel = state.reactions[joint(solved.model, "tie_rod")].force;
                const auto& drive = state.reactions[joint(solved.model, "rack")].force;
                force.see((drive - Vector3d(0, on_wheel[1], 0)).norm() / 1e3, "rack force");
                const Vector3d spin =
                    state.poses[static_cast<std::size_t>(wheel.body)].p * wheel.spin_axis_local;
                const double toe = std::atan2(spin[0], spin[1]);
                least = std::min(least, toe), most = std::max(most, toe);
            }
            EXPECT_TRUE(within(geometry, 1e-14));
            EXPECT_TRUE(within(force, 1e-11));
            EXPECT_GT(most - least, 0.1);  // it steers
            expect_in_balance(solved);
        }
}

// An equilibrium is independent of the order of two drivers, and of which one was held from the
// start.
TEST(EquilibriumDrivers, TheOrderOfDriversDoesNotMatter) {
    const Vector3d brake(-1500, 0, 0);
    const auto build = [&](bool steer_last) {
        Scene s = with_jack(with_rack(scene("chrono_mcpherson")));
        s.static_loads.push_back(
            {"side", DeadForce{{s.wheels[0].body, s.wheels[0].centre_local}, {0, 400, 0}}});
        const int jack = static_cast<int>(s.joints.size()) - 1, rack = jack - 1;
        const Load braking{"brake",
                           DeadForce{{s.wheels[0].body, s.wheels[0].contact_local}, brake}};
        const double now = steer_last ? 1 : 0;
        s.branches = {branch_of("both",
                                {{Motion{rack}, 0.02 * (1 - now), 0.02 * now},
                                 {Motion{jack}, 0.04 * now, 0.04 * (1 - now)},
                                 {braking, now, 1 - now}},
                                1, 10, ParameterUnit::none)};
        return solved_at(s, 0, {0, 1});
    };
    const auto a = build(true), b = build(false);
    ASSERT_EQ(a.path.outcome, Outcome::converged) << a.path.detail;
    ASSERT_EQ(b.path.outcome, Outcome::converged) << b.path.detail;
    Worst worst;
    for (const std::size_t body : {0u, 1u, 3u}) {
        const auto &at_a = a.path.points[1].poses[body], &at_b = b.path.points[1].poses[body];
        worst.see((at_a.r - at_b.r).norm(), a.model.bodies[body].name);
        worst.see(at_a.p.angularDistance(at_b.p), a.model.bodies[body].name);
    }
    for (std::size_t n = 0; n < a.model.joints.size(); ++n)
        worst.see(
            (a.path.points[1].reactions[n].force - b.path.points[1].reactions[n].force).norm() /
                3000,
            a.model.joints[n].name);
    EXPECT_TRUE(within(worst, 1e-10));
    expect_in_balance(a);
}

// Two drivers of one joint add up.
TEST(EquilibriumDrivers, DriversOfOneJointAddUp) {
    Scene s = slider_crank(0.05, 0.13, 0.012, 1);
    const auto once = solved_at(s, 0, {1});
    const int drive = std::get<Motion>(s.branches[0].drivers[0].what).joint;
    s.branches[0].drivers = {{Motion{drive}, 0.25, 0.5}, {Motion{drive}, 0, 0.25}};
    const auto twice = solved_at(s, 0, {1});
    ASSERT_EQ(twice.path.outcome, Outcome::converged) << twice.path.detail;
    EXPECT_LE((once.path.points[0].poses[1].r - twice.path.points[0].poses[1].r).norm(), 1e-15);
}

// ---- Values held at a = 0 are settled first

TEST(EquilibriumDrivers, HeldValuesAreSettledHoweverFarTheyAreFromTheDrawing) {
    const double r = 0.05, l = 0.13, e = 0.012;
    for (const double start : {-9., -3., 0.5, 3., 7.}) {
        Scene s = slider_crank(r, l, e, 1);
        s.branches[0].drivers[0].start = start;
        const auto solved = solved_at(s, 0, {0, 1});
        ASSERT_EQ(solved.path.outcome, Outcome::converged) << start << ": " << solved.path.detail;
        for (const auto& state : solved.path.points) {
            const double a = start + state.load, y = r * std::sin(a) - e;
            EXPECT_LE(
                (state.poses[1].r - Vector3d(r * std::cos(a) + std::sqrt(l * l - y * y), e, 0))
                    .norm(),
                1e-12 * l);
        }
    }
}

TEST(EquilibriumDrivers, ARodOfAnotherLengthThanDrawnIsSettledToItsOwn) {
    const double r = 0.05, l = 0.13, e = 0.012;
    for (const double other : {0.07, 0.1, 0.2, 0.5}) {
        Scene s = slider_crank(r, l, e, 2 * M_PI);
        std::get<Distance>(s.joints[2].kind).length = other;
        const auto solved = solved_at(s, 0, equally(2 * M_PI, 36));
        ASSERT_EQ(solved.path.outcome, Outcome::converged) << other << ": " << solved.path.detail;
        for (const auto& state : solved.path.points) {
            const double y = r * std::sin(state.load) - e;
            EXPECT_LE((state.poses[1].r -
                       Vector3d(r * std::cos(state.load) + std::sqrt(other * other - y * y), e, 0))
                          .norm(),
                      1e-12 * other);
        }
    }
}

// The row of an angle is a sine and is zero in the opposite direction too; the residuals
// distinguish it.
TEST(EquilibriumDrivers, AnOppositeDirectionIsNotTheAngle) {
    Scene s = slider_crank(0.05, 0.13, 0, 1);
    const auto solved = solved_at(s, 0, {0});
    ASSERT_EQ(solved.path.outcome, Outcome::converged) << solved.path.detail;
    expect_in_balance(solved);
    Equilibrium turned = solved.path.points[0];
    turned.poses[0].p = Quaterniond(Eigen::AngleAxisd(M_PI, Vector3d::UnitZ()));
    turned.poses[1].r[0] = -0.05 + 0.13;
    const auto r = residuals(solved.model, solved.branch(), turned);
    EXPECT_LE(r.length, 1e-15);
    EXPECT_GE(r.direction, 1);
}

// ---- Failures

TEST(EquilibriumDrivers, WhatCannotBeClosedIsNamed) {
    Scene s = slider_crank(0.05, 0.13, 0.012, 2 * M_PI);
    // closes at first, but not over the full turn
    std::get<Distance>(s.joints[2].kind).length = 0.03;
    s.bodies[1].design.r = {0.08, 0.012, 0};
    std::get<Translational>(s.joints[1].kind).j.s_local = {0.08, 0.012, 0};
    for (const int steps : {5, 20}) {
        const auto solved = solved_at(s, 0, equally(2 * M_PI, steps));
        EXPECT_EQ(solved.path.outcome, Outcome::inconsistent_constraints) << solved.path.detail;
        EXPECT_NE(solved.path.detail.find("'rod'"), std::string::npos) << solved.path.detail;
        EXPECT_NE(solved.path.detail.find(" deg"), std::string::npos) << solved.path.detail;
        EXPECT_NEAR(static_cast<double>(solved.path.points.size()),
                    1 + std::floor(steps * 57.14 / 360), 0.1);
        expect_in_balance(solved);
    }
    // held beyond its reach from the start
    s.branches[0].drivers[0].start = 2;
    const auto solved = solved_at(s, 0, {0, 1});
    EXPECT_EQ(solved.path.outcome, Outcome::inconsistent_constraints) << solved.path.detail;
    EXPECT_NE(solved.path.detail.find("'rod'"), std::string::npos) << solved.path.detail;
    EXPECT_TRUE(solved.path.points.empty());
}

TEST(EquilibriumDrivers, DrivingWhatAnotherJointHoldsIsAContradiction) {
    Scene s = slider_crank(0.05, 0.13, 0.012, 1);
    s.joints.push_back({"lock", Distance{{0, {0.05, 0, 0}}, {ground, {0.05, -0.1, 0}}, 0.1}});
    const auto solved = solved_at(s, 0, {0, 1});
    EXPECT_EQ(solved.path.outcome, Outcome::inconsistent_constraints) << solved.path.detail;
    EXPECT_NE(solved.path.detail.find("'lock'"), std::string::npos) << solved.path.detail;
    EXPECT_NE(solved.path.detail.find("'drive'"), std::string::npos) << solved.path.detail;
}

TEST(EquilibriumDrivers, MessagesSpeakOfTheParameterInItsUnit) {
    const auto said = [](ParameterUnit unit) {
        const Branch branch = branch_of("b", {}, 1, 1, unit);
        return parameter(branch, 0.25);
    };
    EXPECT_EQ(said(ParameterUnit::newton), "0.25 N");
    EXPECT_EQ(said(ParameterUnit::newton_metre), "0.25 N·m");
    EXPECT_EQ(said(ParameterUnit::metre), "250 mm");
    EXPECT_EQ(said(ParameterUnit::radian), "14.323945 deg");
    EXPECT_EQ(said(ParameterUnit::none), "0.25");
}

TEST(EquilibriumDrivers, AModelThatDoesNotStandOnTheBranchIsMisuse) {
    Scene s = with_jack(scene("chrono_mcpherson"));
    s.branches.push_back(branch_of("travel",
                                   {{Motion{static_cast<int>(s.joints.size()) - 1}, 0, 1}}, 0.1, 1,
                                   // otherwise the model would have no jack
                                   ParameterUnit::metre));
    const Model model = compile(s);
    const std::vector<double> points = {0, 1};
    // the jack is not driven
    EXPECT_THROW(solve(model, model.branches[0], points), std::invalid_argument);
    Equilibrium state;
    state.poses.resize(model.bodies.size());
    state.reactions.resize(model.joints.size());
    EXPECT_THROW(residuals(model, model.branches[0], state), std::invalid_argument);

    const Model plain = compile(scene("chrono_mcpherson"));
    const auto with = [&](Driven what) { return branch_of("b", {{what, 0, 1}}, 1, 1); };
    Branch two_ways = plain.branches[0];
    two_ways.from = -1;
    EXPECT_THROW(solve(plain, two_ways, points), std::invalid_argument);
    EXPECT_THROW(solve(plain, with(Motion{0}), points), std::invalid_argument);      // a ball joint
    EXPECT_THROW(solve(plain, with(FreeLength{1}), points), std::invalid_argument);  // a bushing
    // a spring
    EXPECT_THROW(solve(plain, with(Preload{0, Vector6::Ones()}), points), std::invalid_argument);
}

TEST(EquilibriumDrivers, ADriverThatIsNotFiniteNeverConverges) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
        for (const bool start : {true, false}) {
            Scene s = slider_crank(0.05, 0.13, 0.012, 1);
            (start ? s.branches[0].drivers[0].start : s.branches[0].drivers[0].rate) = bad;
            const auto solved = solved_at(s, 0, {0, 1});
            EXPECT_EQ(solved.path.outcome, Outcome::not_finite) << solved.path.detail;
        }
}

TEST(EquilibriumDrivers, SolvesOfOneModelAtTheSameTimeAgreeToTheBit) {
    const Scene s = with_rack(scene("chrono_mcpherson"));
    const Model model = compile(s);
    const std::vector<double> points = equally(3000, 10);
    std::vector<EquilibriumPath> paths(4);
    std::vector<std::thread> threads;
    for (auto& path : paths)
        threads.emplace_back([&] { path = solve(model, model.branches[0], points); });
    for (auto& thread : threads) thread.join();
    for (const auto& path : paths) {
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (std::size_t n = 0; n < points.size(); ++n)
            EXPECT_EQ(path.points[n].poses[1].r, paths[0].points[n].poses[1].r);
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
