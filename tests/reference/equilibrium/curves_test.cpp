// Laws with knots: stops, tabulated curves, flat or falling pieces.
#include <fmt/format.h>

#include "models/branch.hpp"
#include "tests/reference/equilibrium/driven_scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

// f = 0 up to the clearance c, k (x - c) beyond; reversed for c < 0.
Curve stop(double c, double k) {
    const std::array<double, 4> open{}, closed = {0, k, 0, 0};
    return c > 0 ? Curve{{c}, {open, closed}} : Curve{{c}, {closed, open}};
}

// f and its exact slopes at the knots, cubics between, linear outside.
Curve through(const std::vector<double>& x, const std::vector<double>& f,
              const std::vector<double>& slope) {
    Curve curve{x, {{f[0], slope[0], 0, 0}}};
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
        const double h = x[k + 1] - x[k], chord = (f[k + 1] - f[k]) / h;
        curve.pieces.push_back({f[k], slope[k], (3 * chord - 2 * slope[k] - slope[k + 1]) / h,
                                (slope[k] + slope[k + 1] - 2 * chord) / (h * h)});
    }
    curve.pieces.push_back({f.back(), slope.back(), 0, 0});
    return curve;
}

// A block on a guide along z, held by springs of deformation z.
Scene block(const std::vector<ScalarLaw>& laws) {
    Scene s;
    s.name = "block";
    s.bodies = {{"block", {}}};
    s.joints = {
        {"guide", Translational{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, {0, {0, 0, 1}}, ground_z}}};
    for (const auto& law : laws)
        s.elastics.push_back({"spring", AxialSpring{{ground, {0, 0, -1}}, {0, {0, 0, 0}}, law, 1}});
    s.branches = {pull({0, {0, 0, 0}}, {0, 0, 1})};
    s.probes = {{"block", {0, {0, 0, 0}}}};
    return s;
}

void expect_heights(const Scene& s, const std::vector<double>& loads,
                    const std::function<double(double)>& z, double limit, const std::string& what) {
    const Model model = compile(s);
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::converged) << what << ": " << path.detail;
    Worst worst;
    for (const auto& state : path.points)
        worst.see(std::abs(state.poses[0].r[2] - z(state.load)),
                  fmt::format("{}, {} N", what, state.load));
    EXPECT_TRUE(within(worst, limit));
    EXPECT_EQ(path.points.size(), loads.size());
}

// Closed form: z = F / k up to the clearance, then both springs share: F = k z + k_s (z - c). Two
// stops, any number of steps (one across both knots, some ending on a knot), any order, stops from
// soft to rigid.
TEST(EquilibriumCurves, AStopCarriesWhatTheSpringDoesNot) {
    const double k = 20e3, c = 0.02, back = -0.03;
    for (const double k_s : {5e3, 300e3, 2e7, 2e9})
        for (const int steps : {1, 2, 3, 4, 7, 40}) {
            const Scene s = block({LinearRate{k}, stop(c, k_s), stop(back, k_s)});
            const auto z = [&](double F) {
                return F > k * c      ? (F + k_s * c) / (k + k_s)
                       : F < k * back ? (F + k_s * back) / (k + k_s)
                                      : F / k;
            };
            std::vector<double> loads;
            double from = 0;
            // 400 and -600 N: at a knot
            for (const double to : {800., -1500., 400., -600., 0., 3000.}) {
                for (int n = 1; n <= steps; ++n) loads.push_back(from + (to - from) * n / steps);
                from = to;
            }
            expect_heights(s, loads, z, k_s > 1e9 ? 1e-14 : 3e-15,
                           fmt::format("stop of {} N/m, {} steps", k_s, steps));
        }
}

// A stop without clearance: the design position is on the knot, and the branch may leave it to
// either side.
TEST(EquilibriumCurves, AStopThatTouchesAtTheDesignPositionOpensAndCloses) {
    const double k = 20e3, k_s = 300e3;
    const Curve touching{{0}, {{0, 0, 0, 0}, {0, k_s, 0, 0}}};
    for (const double to : {1000., -1000.})
        expect_heights(
            block({LinearRate{k}, touching}), {0, to / 3, to, -to, 0},
            [&](double F) { return F > 0 ? F / (k + k_s) : F / k; }, 3e-15, "touching");
}

// Cubic pieces between unevenly spaced knots, with slopes that jump, and more of them than points.
TEST(EquilibriumCurves, ASpringFollowsItsCurve) {
    std::mt19937 random(21);
    std::uniform_real_distribution<double> in(0.2, 1);
    for (int trial = 0; trial < 10; ++trial) {
        std::vector<double> x = {-0.05}, f = {-2000}, slope = {40e3};
        while (x.size() < 15) {
            const double dx = 0.01 * in(random), chord = 60e3 * in(random);
            x.push_back(x.back() + dx), f.push_back(f.back() + chord * dx);
            // such that f increases over the previous piece
            slope.push_back(1.5 * chord * in(random));
        }
        for (std::size_t k = 0; k + 1 < x.size(); ++k)
            slope[k] = std::min(slope[k], 1.5 * (f[k + 1] - f[k]) / (x[k + 1] - x[k]));
        const Curve curve = through(x, f, slope);
        const auto at = [&](double z) {  // closed form, piece by piece
            std::size_t k = 0;
            while (k < x.size() && z >= x[k]) ++k;
            const auto& c = curve.pieces[k];
            const double h = z - x[k == 0 ? 0 : k - 1];
            return c[0] + c[1] * h + c[2] * h * h + c[3] * h * h * h;
        };
        std::vector<double> heights = x, loads;
        for (int n = 0; n <= 7; ++n) heights.push_back(-0.07 + 0.02 * n);
        std::ranges::sort(heights);
        for (const double z : heights) loads.push_back(at(z));
        const Scene s = block({curve});
        expect_heights(
            s, loads,
            [&](double F) {
                return heights[static_cast<std::size_t>(std::ranges::find(loads, F) -
                                                        loads.begin())];
            },
            1e-14, fmt::format("trial {}", trial));
    }
}

// A bar is rotated by its drive; a stop spring between its tip and a point on ground is longest,
// r + d, where the bar points away. The clearance ends exactly there, or before: the drive effort
// is f · ∂ℓ/∂α, with ℓ² = r² + d² - 2 r d cos α.
TEST(EquilibriumCurves, AStopThatJustTouchesIsPassed) {
    const double r = 0.3, d = 0.5, k = 1e5;
    for (const double short_of : {0., 1e-15, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2})
        for (const int steps : {1, 2, 5, 30}) {
            Scene s;
            s.name = "sweep";
            s.bodies = {{"bar", {}}};
            s.joints = {
                {"hinge", Revolute{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, {0, {0, 0, 1}}, ground_z}},
                {"drive", Angle{{0, {1, 0, 0}}, ground_x, ground_y, 0}, true}};
            s.elastics = {
                {"stop",
                 AxialSpring{
                     {ground, {d, 0, 0}}, {0, {r, 0, 0}}, stop(r + d - short_of - 0.1, k), 0.1}}};
            s.branches = {
                branch_of("turn", {{Motion{1}, 0, 1}}, 2 * M_PI, 1, ParameterUnit::radian)};
            s.probes = {{"tip", {0, {r, 0, 0}}}};
            const Model whole = compile(s);
            const Model model = on_branch(whole, whole.branches[0]);
            std::vector<double> points;
            for (int n = 0; n <= steps; ++n) points.push_back(1.9 * M_PI * n / steps);
            points.push_back(M_PI);
            const auto path = solve(model, model.branches[0], points);
            const auto where = fmt::format("{} m short, {} steps", short_of, steps);
            ASSERT_EQ(path.outcome, Outcome::converged) << where << ": " << path.detail;
            Worst worst;
            for (const auto& state : path.points) {
                const double alpha = state.load,
                             l = std::sqrt(r * r + d * d - 2 * r * d * std::cos(alpha));
                const double f = std::max(0., k * (l - (r + d - short_of)));
                worst.see(std::abs(state.reactions[1].moment[2] - f * r * d * std::sin(alpha) / l),
                          fmt::format("{}, at {} rad", where, alpha));
            }
            EXPECT_TRUE(within(worst, 1e-10));
        }
}

// In parallel with a regular spring, a law may be flat or fall.
TEST(EquilibriumCurves, AFlatOrFallingPieceIsPassedWhereTheRestHolds) {
    const double k = 20e3, k_t = 60e3, c = 0.01;
    for (const double after : {0., -15e3}) {
        const Curve tired{{c}, {{k_t * c, k_t, 0, 0}, {k_t * c, after, 0, 0}}};
        expect_heights(
            block({LinearRate{k}, tired}), {0, 300, 800, 801, 1500, 799, -200, 1500},
            [&](double F) {
                return F > (k + k_t) * c ? c + (F - (k + k_t) * c) / (k + after) : F / (k + k_t);
            },
            1e-14, fmt::format("then {} N/m", after));
    }
}

// Alone it ends the branch there, for any number of points.
TEST(EquilibriumCurves, ALawThatFallsEndsTheBranchAtItsKnot) {
    const double k = 60e3, c = 0.01;
    for (const double after : {0., -15e3})
        for (const int steps : {1, 2, 7, 100}) {
            const Model model =
                compile(block({Curve{{c}, {{k * c, k, 0, 0}, {k * c, after, 0, 0}}}}));
            std::vector<double> loads;
            for (int n = 0; n <= steps; ++n) loads.push_back(1001. * n / steps);
            const auto path = solve(model, model.branches[0], loads);
            EXPECT_NE(path.outcome, Outcome::converged);
            EXPECT_NE(path.detail, "") << after;
            EXPECT_EQ(path.points.size(), static_cast<std::size_t>(std::ranges::count_if(
                                              loads, [&](double F) { return F < k * c; })))
                << path.detail;
        }
}

// A McPherson strut with a bump stop and a rebound stop on the coil, and a curve by axis in a
// bushing. The states are independent of the points, and in balance.
TEST(EquilibriumCurves, AStrutOnItsStopsDoesNotDependOnThePoints) {
    Scene s = scene("mcpherson");
    bool has_coil = false;
    for (std::size_t e = 0; e < s.elastics.size() && !has_coil; ++e)
        if (const auto* coil = std::get_if<AxialSpring>(&s.elastics[e].kind)) {
            has_coil = true;
            AxialSpring stops = *coil;
            Equilibrium design;
            for (const auto& body : s.bodies) design.poses.push_back(body.design);
            stops.free_length = (position(design, stops.j) - position(design, stops.i)).norm();
            const double k = 200e3;
            stops.law = Curve{{-0.03, 0.02}, {{0, k, 0, 0}, {0, 0, 0, 0}, {0, k, 0, 0}}};
            s.elastics.push_back({"stops", stops});
        }
    ASSERT_TRUE(has_coil);
    const Model model = compile(s);
    for (const auto& branch : model.branches) {
        const auto every = every_load(branch);
        const auto path = solve(model, branch, every);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        Worst balance, apart;
        for (const auto& state : path.points) {
            const auto r = residuals(model, branch, state);
            balance.see(std::max({r.length, r.direction, r.force, r.moment}),
                        fmt::format("{}, {}", branch.name, state.load));
        }
        // [N]; 2e-9 without the stops too: round-off of 3 kN over the rates
        EXPECT_TRUE(within(balance, 1e-8));
        for (const std::size_t stride : {every.size() - 1, std::size_t{50}, std::size_t{7}}) {
            std::vector<double> some;
            for (std::size_t n = 0; n < every.size(); n += stride) some.push_back(every[n]);
            const auto coarse = solve(model, branch, some);
            ASSERT_EQ(coarse.outcome, Outcome::converged) << stride << ": " << coarse.detail;
            for (std::size_t n = 0; n < some.size(); ++n)
                for (std::size_t b = 0; b < model.bodies.size(); ++b)
                    apart.see(
                        (coarse.points[n].poses[b].r - path.points[n * stride].poses[b].r).norm(),
                        fmt::format("{}, {}, stride {}", branch.name, some[n], stride));
        }
        EXPECT_TRUE(within(apart, 1e-12));
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
