// Laws with knots: stops, tabulated curves, flat or falling pieces, independent of
// the requested points.
#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::legs {
namespace {

struct Stops : LegTest {
    void expect_heights(const Scene& scene, double to, int steps,
                        const std::function<double(double)>& z, double limit = 1e-14) const {
        SideModel side = side_of(scene);
        side.branch.to = to;
        side.model.branches = {side.branch};
        Worst worst;
        for (const auto& state : solved(leg(), side, steps, 1e-6).points)
            worst.add(std::abs(state.poses[0].r.z() - z(state.load)), state.load);
        EXPECT_TRUE(within(worst, leg().kind == Leg::recursive ? 100 * limit : limit))
            << "to " << to << " in " << steps;
    }
};
ELASTOCHECK_FOR(exact_legs, Stops);

constexpr int step_counts[] = {1, 2, 3, 7, 40};

// z = F / k up to the clearance, then both springs share: F = k z + k_s (z - c). Soft to rigid
// stops, any number of steps; 400 and -600 N are the loads at the knots.
TEST_P(Stops, StopCarriesTheLoadBeyondTheSpring) {
    const double k = 20e3, c = 0.02, back = -0.03;
    for (const double k_s : {5e3, 300e3, 2e7, 2e9})
        for (const double to : {800., -1500., 400., -600., 3000., 1e5})
            for (const int steps : step_counts)
                expect_heights(block({LinearRate{k}, stop(c, k_s), stop(back, k_s)}), to, steps,
                               [&](double F) {
                                   return F > k * c      ? (F + k_s * c) / (k + k_s)
                                          : F < k * back ? (F + k_s * back) / (k + k_s)
                                                         : F / k;
                               });
}

// The design position is on the knot; the branch leaves it to either side.
TEST_P(Stops, StopWithoutClearanceOpensAndCloses) {
    const double k = 20e3, k_s = 300e3;
    for (const double to : {1000., -1000.})
        for (const int steps : step_counts)
            expect_heights(block({LinearRate{k}, stop(0, k_s)}), to, steps,
                           [&](double F) { return F > 0 ? F / (k + k_s) : F / k; });
}

TEST_P(Stops, OpenStopAloneIsAnIdleMode) {
    SideModel side = side_of(block({stop(0.03, 300e3)}));
    side.branch.to = 3000;
    side.model.branches = {side.branch};
    EXPECT_EQ(solve(leg(), side, 4).outcome, Outcome::loaded_idle_mode);
}

// Cubics between unevenly spaced knots with slopes that jump: f(z) = F.
TEST_P(Stops, SpringForceEqualsItsCurve) {
    Random random;
    for (int trial = 0; trial < 6; ++trial) {
        std::vector<double> x{-0.05}, f{-2000}, slope{40e3};
        while (x.size() < 15) {
            const double dx = 0.01 * random(0.2, 1), chord = 60e3 * random(0.2, 1);
            x.push_back(x.back() + dx), f.push_back(f.back() + chord * dx);
            slope.push_back(1.5 * chord * random(0.2, 1));
        }
        for (std::size_t k = 0; k + 1 < x.size(); ++k)  // f increases over every piece
            slope[k] = std::min(slope[k], 1.5 * (f[k + 1] - f[k]) / (x[k + 1] - x[k]));
        const Curve curve = hermite(x, f, slope);
        const auto force = [&](double z) { return stated_force(curve, z); };
        Scene scene = block({curve});
        for (const double to : {force(0.07), force(-0.07)})
            expect_heights(
                scene, to, 20,
                [&](double F) {
                    double low = -1, high = 1;
                    for (int i = 0; i < 80; ++i) {
                        const double middle = (low + high) / 2;
                        (force(middle) < F ? low : high) = middle;
                    }
                    return low;
                },
                1e-11);
    }
}

// A bar is turned by its drive; a stop between its tip and a point on ground is longest, r + d,
// where the bar points away. The clearance ends exactly there, or before; the effort of the drive is
// f · ∂ℓ/∂α, with ℓ² = r² + d² - 2 r d cos α.
TEST_P(Stops, BranchPassesAStopThatTouchesOrReopens) {
    const double r = 0.3, d = 0.5, k = 1e5;
    for (const double short_of : {0., 1e-15, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2})
        for (const int steps : {2, 5, 30}) {
            Scene s = hinged_bar(r * X, Z, 0);
            s.joints.push_back({"drive", Angle{{0, X}, ground_x, ground_y, 0}, true});
            s.elastics = {
                {"stop",
                 AxialSpring{{ground, d * X}, {0, r * X}, stop(r + d - short_of - 0.1, k), 0.1}}};
            s.branches = {motion_branch(1, 1.9 * M_PI, ParameterUnit::radian)};
            Worst worst;
            for (const auto& state : solved(leg(), side_of(s), steps).points) {
                const double a = state.load, l = std::sqrt(r * r + d * d - 2 * r * d * std::cos(a)),
                             f = std::max(0., k * (l - (r + d - short_of)));
                worst.add(std::abs(state.reactions[1].moment.z() - f * r * d * std::sin(a) / l), a);
            }
            EXPECT_TRUE(within(worst, 1e-9)) << short_of << " " << steps;
        }
}

// In parallel with a regular spring a law may be flat or fall; alone it ends the branch.
TEST_P(Stops, SofteningLawIsPassedBesideASpringAndEndsTheBranchAlone) {
    const double k = 20e3, k_t = 60e3, c = 0.01;
    for (const double after : {0., -15e3}) {
        const Curve tired{{c}, {{k_t * c, k_t, 0, 0}, {k_t * c, after, 0, 0}}};
        for (const int steps : step_counts)
            expect_heights(block({LinearRate{k}, tired}), 1500, steps, [&](double F) {
                return F > (k + k_t) * c ? c + (F - (k + k_t) * c) / (k + after) : F / (k + k_t);
            });
        for (const int steps : {1, 2, 7, 100}) {
            SideModel side = side_of(block({tired}));
            side.branch.to = 601;  // k_t c = 600 N
            side.model.branches = {side.branch};
            const auto path = solve(leg(), side, steps);
            EXPECT_NE(path.outcome, Outcome::converged) << after;
            EXPECT_FALSE(path.detail.empty());
            EXPECT_EQ(path.points.size(), static_cast<std::size_t>(steps)) << path.detail;
        }
    }
}

// A McPherson strut on a bump stop and a rebound stop: the ends do not depend on the points.
TEST_P(Stops, EndStatesOfAStrutOnStopsDoNotDependOnTheNumberOfPoints) {
    const Scene free = support::scene("mcpherson");
    Scene s = free;
    for (const auto& elastic : free.elastics)
        if (const auto* coil = std::get_if<AxialSpring>(&elastic.kind)) {
            AxialSpring stops = *coil;
            stops.free_length = (drawn_position(s, stops.j) - drawn_position(s, stops.i)).norm();
            stops.law = Curve{{-0.03, 0.02}, {{0, 200e3, 0, 0}, {0, 0, 0, 0}, {0, 200e3, 0, 0}}};
            s.elastics.push_back({"stops", stops});
        }
    ASSERT_GT(s.elastics.size(), free.elastics.size());
    for (std::size_t n = 0; n < s.branches.size(); ++n) {
        const Equilibrium end = solved(leg(), side_of(s, n), 40).points.back();
        for (const int steps : {1, 3, 7})
            EXPECT_LE(distance(solved(leg(), side_of(s, n), steps).points.back(), end, 2), 1e-11);
    }
    EXPECT_GT(distance(solved(leg(), side_of(free), 1).points.back(),
                       solved(leg(), side_of(s), 1).points.back(), 2),
              1e-3)
        << "the stop did close";
}

// A point may be predicted almost on the knot; the next step must still end on the knot.
TEST_P(Stops, KnotsOfCurvesArePassedWithAnyNumberOfSteps) {
    const Scene s = support::scene("mcpherson_strut");
    for (const std::size_t n : {0u, 1u}) {
        const SideModel side = side_of(s, n);
        const Equilibrium end = solved(leg(), side, 1).points.back();
        for (int steps = 2; steps <= 40; ++steps) {
            SCOPED_TRACE(fmt::format("{} in {} steps", side.branch.name, steps));
            EXPECT_LE(distance(solved(leg(), side, steps).points.back(), end, 2), 1e-11);
        }
    }
}

}  // namespace
}  // namespace elastocheck::legs
