// Convergence across knots of force curves, and event location in `adaptive`.
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "models/laws.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/stepping/knots.hpp"
#include "tests/recursive/elements.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

Method method_called(const char* name) { return *find_method(name); }

// An arm of 1 m along x, hinged at the origin about y, on a spring of 20 kN/m (plus the curve along
// the same line) from 0.6 m out on the arm to the ground 0.5 m below. A load, up to -`to`, acts on
// its end.
struct Arm {
    Curve curve;
    double to = -1500;

    static constexpr double out = 0.6, below = 0.5, rate = 20e3;

    Model model() const {
        Scene scene;
        scene.name = "arm";
        scene.bodies = {{"arm", {}}};
        scene.joints = {{"hinge", Revolute{{ground, Vector3d::Zero()},
                                           {0, Vector3d::Zero()},
                                           {ground, Vector3d::UnitY()},
                                           {0, Vector3d::UnitY()}}}};
        const Point foot{ground, Vector3d(out, 0, -below)}, head{0, Vector3d(out, 0, 0)};
        scene.elastics = {{"coil", AxialSpring{foot, head, LinearRate{rate}, below}},
                          {"stop", AxialSpring{foot, head, curve, below}}};
        scene.branches = {{"press",
                           0,
                           to,
                           100,
                           ParameterUnit::newton,
                           {{Load{"weight", DeadForce{{0, {1, 0, 0}}, Vector3d::UnitZ()}}, 0, 1}}}};
        scene.probes = {{"end", {0, {1, 0, 0}}}};
        return compile(scene);
    }
    // Moment about y on the arm at the angle φ: -∂V/∂φ, decreasing with the load.
    double imbalance(double phi, double load) const {
        const double x = out * std::cos(phi), z = -out * std::sin(phi);  // of the head
        const double length = std::hypot(x - out, z + below), stretch = length - below;
        const double f = rate * stretch + gradient<double>(curve, stretch);
        const double slope =
            ((x - out) * -out * std::sin(phi) + (z + below) * -out * std::cos(phi)) / length;
        return f * slope + load * std::cos(phi);  // ∂V/∂φ, V = u - load z_end, z_end = -sin φ
    }
    // Its zero, by bisection.
    double angle(double load) const {
        double low = -0.9, high = 0.65;  // beyond, the spring's line passes the level of the hinge
        const bool rises = imbalance(high, 0) > 0;
        for (int k = 0; k < 200; ++k) {
            const double middle = (low + high) / 2;
            ((imbalance(middle, load) > 0) == rises ? high : low) = middle;
        }
        return (low + high) / 2;
    }
};

double angle_of(const Equilibrium& point) {
    const Vector3d end = point.poses[0].p * Vector3d::UnitX();
    return std::atan2(-end.z(), end.x());
}

// Errors of the angle: the largest of all points, and the last.
struct Errors {
    double worst = 0, last = 0;
};
Errors errors(const Arm& arm, const Method& method, int steps) {
    const Model model = arm.model();
    const auto path = solve(model, model.branches[0], {.method = method, .steps = steps});
    EXPECT_EQ(path.outcome, Outcome::converged)
        << method.name << " " << steps << ": " << path.detail;
    Errors e;
    for (const auto& point : path.points) {
        e.last = std::abs(angle_of(point) - arm.angle(point.load));
        e.worst = std::max(e.worst, e.last);
    }
    return e;
}
// A knot lies anywhere within a step: the worst over several step counts near one.
Errors errors_near(const Arm& arm, const Method& method, int steps) {
    Errors all;
    for (int more = 0; more < 8; ++more) {
        const Errors e = errors(arm, method, steps + more * steps / 40);
        all.worst = std::max(all.worst, e.worst);
        all.last = std::max(all.last, e.last);
    }
    return all;
}

const Arm none{Curve{{0}, {{0, 0, 0, 0}, {0, 0, 0, 0}}, true}};
// Closes after 20 mm, five times as stiff as the parallel spring.
const Arm with_stop{reversed(stop(0.02, 100e3))};
// Also starts at 20 mm, quadratically: only the curvature jumps.
const Arm with_curve{
    reversed(Curve{{0.02, 0.2}, {{0, 0, 0, 0}, {0, 0, 1e6, 0}, {32400, 3.6e5, 0, 0}}, true})};

double order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(Knots, StopCostsOneFirstOrderStepAndLaterStepsKeepTheOrderOfTheMethod) {
    // Without a knot each method has the order in the table of recursive_method.hpp ...
    for (const auto& method : methods) {
        if (!has_steps(method)) continue;
        const Errors coarse = errors_near(none, method, 200), fine = errors_near(none, method, 400);
        EXPECT_NEAR(order(coarse.worst, fine.worst), method.formal_order, 0.05) << method.name;
    }
    // ... and with a stop the point behind the knot has the error of the overshoot.
    for (const auto& method : methods) {
        if (!has_steps(method)) continue;
        const Errors coarse = errors_near(with_stop, method, 400),
                     fine = errors_near(with_stop, method, 800);
        EXPECT_NEAR(order(coarse.worst, fine.worst), 1, 0.1) << method.name;
        if (method.formal_order > 0) {
            EXPECT_NEAR(order(coarse.last, fine.last), method.formal_order, 0.05) << method.name;
        } else {  // a sum keeps the error
            EXPECT_GT(fine.last, fine.worst / 2) << method.name;
        }
    }
}

TEST(Knots, StepAcrossAKnotHasSecondOrderOrThirdWithACorrection) {
    for (const auto& [name, behind] : {std::pair{"tangent", 2}, {"midpoint", 2}, {"chord", 3}}) {
        const Method method = method_called(name);
        const Errors coarse = errors_near(with_curve, method, 400),
                     fine = errors_near(with_curve, method, 800);
        EXPECT_NEAR(order(coarse.worst, fine.worst), behind, 0.25) << name;
        EXPECT_NEAR(order(coarse.last, fine.last), method.formal_order, 0.05) << name;
    }
}

TEST(Knots, AdaptiveStepsEndOnKnotsAndKeepTheTolerance) {
    for (const auto& [name, arm, most] :
         {std::tuple{"stop", with_stop, 16}, {"curve", with_curve, 50}})
        for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7}) {
            Method method = method_called("adaptive");
            method.kind = Adaptive{tolerance, tolerance};
            const Model model = arm.model();
            const auto path = solve(model, model.branches[0], {.method = method, .steps = 100});
            const Errors e = errors(arm, method, 100);
            EXPECT_LE(e.worst, tolerance) << name;
            // A fourth-order method needs 10^¼ times as many steps for a tenth of the tolerance.
            EXPECT_LE(path.counts.factorisations,
                      most * std::pow(1e-5 / std::min(tolerance, 1e-5), 0.25))
                << name;
        }
}

TEST(Knots, AdaptiveReachesTheEndOverATableOfManyPoints) {
    // f = 1000 sinh(20 x) as a Hermite table every 10 mm with exact slopes: C1, and
    // its curvature jumps.
    const auto at = [](double x) { return 1e3 * std::sinh(20 * x); };
    const auto slope = [](double x) { return 2e4 * std::cosh(20 * x); };
    Curve f;
    for (int k = 0; k < 20; ++k) f.knots.push_back(-0.003 + 0.01 * k);
    f.pieces.push_back({at(f.knots[0]), slope(f.knots[0]), 0, 0});
    for (const double x : f.knots) {
        const double h = 0.01, rise = (at(x + h) - at(x)) / h;
        f.pieces.push_back({at(x), slope(x), (3 * rise - 2 * slope(x) - slope(x + h)) / h,
                            (slope(x) + slope(x + h) - 2 * rise) / (h * h)});
    }
    f.pieces.back()[2] = f.pieces.back()[3] = 0;
    const Arm arm{reversed(f)};
    const Model model = arm.model();
    const auto path =
        solve(model, model.branches[0], {.method = method_called("adaptive"), .steps = 100});
    EXPECT_LE(errors(arm, method_called("adaptive"), 100).worst, 1e-5);
    const auto knots = std::ranges::count_if(f.knots, [&](double knot) {
        const double end = -Arm::out * std::sin(arm.angle(arm.to));
        return knot > 0 && knot < -end;
    });
    EXPECT_GE(knots, 3);
    EXPECT_TRUE(kinks_of(f).empty());
    EXPECT_LE(path.counts.factorisations, 20 + 12 * knots) << knots << " knots";
}

TEST(Knots, KnotAtTheStartOfABranchIsPassed) {
    // A stop without clearance: the design position is on the knot. Or the weight acts as drawn: the
    // stop closes while settling.
    for (const auto& method : methods) {
        if (std::holds_alternative<Series>(method.kind)) continue;
        for (const double to : {-1500., 600.}) {
            if (method.formal_order == 0) continue;
            const Errors e = errors({reversed(stop(0, 100e3)), to}, method, 400);
            EXPECT_LE(e.worst, 5e-4) << method.name << " " << to;
            EXPECT_LE(e.last, 1e-4) << method.name << " " << to;
        }
        Model model = with_stop.model();
        model.branches[0].drivers[0].start = -1000;
        model.branches[0].to = -500;
        const auto path = solve(model, model.branches[0], {.method = method, .steps = 200});
        ASSERT_EQ(path.outcome, Outcome::converged) << method.name << " " << path.detail;
        EXPECT_LE(std::abs(angle_of(path.points.back()) - with_stop.angle(-1500)),
                  method.formal_order > 0 ? 1e-4 : 5e-3)
            << method.name;
    }
}

TEST(Knots, PathThatTurnsBackAtAKnotEndsThere) {
    // Beyond 20 mm the curve falls more steeply than the spring rises: the load has
    // its maximum there.
    const Arm arm{reversed(stop(0.02, -100e3))};
    const Model model = arm.model();
    const double phi = std::asin(0.02 / Arm::out);  // nearly: the spring leans a little
    for (const auto& method : methods) {
        if (std::holds_alternative<Series>(method.kind) ||
            std::holds_alternative<Linear>(method.kind))
            continue;
        const auto path = solve(model, model.branches[0], {.method = method, .steps = 300});
        EXPECT_EQ(path.outcome, Outcome::limit_point) << method.name << " " << path.detail;
        ASSERT_FALSE(path.points.empty());
        EXPECT_NEAR(angle_of(path.points.back()), phi, 2e-3) << method.name;
    }
}

// ---- Followers and formulations.

TEST(Follower, DrivenFollowerMissingFromTheAnalysedModelIsRejected) {
    Scene scene;  // a block on a spring: nothing but the follower couples force and rotation
    scene.bodies = {{"block", {}}};
    scene.elastics = {{"spring", AxialSpring{{ground, Vector3d::UnitX()}, {0}, LinearRate{1}, 1}}};
    scene.probes = {{"block", {0}}};
    const Model model = compile(scene);
    const Load pull{"pull", FollowerForce{{0, Vector3d(0.4, 0, 0)}, Vector3d::UnitZ()}};
    const Branch branch{"pull", 0, 1, 1, ParameterUnit::newton, {{pull, 0, 1}}};
    EXPECT_THROW((void)solve(model, branch, {}, analyse(model)), std::invalid_argument);
}

TEST(Formulation, MethodsKeepTheirOrderUnderEveryBushingFormulation) {
    // A block on one bushing, pushed and turned by followers: large offsets and angles at once.
    for (const Formulation& formulation : every_formulation()) {
        Scene scene;
        scene.name = "block";
        scene.bodies = {{"block", {}}};
        Bushing bushing{{ground, Vector3d::Zero()}, {0, Vector3d(0.02, -0.03, 0.01)}, {}};
        LinearStiffness law;
        law.K.diagonal() << 4e4, 6e4, 5e4, 700, 900, 800;
        bushing.law = law;
        bushing.formulation = formulation;
        scene.elastics = {{"mount", bushing}};
        scene.branches = {
            {"push",
             0,
             1,
             100,
             ParameterUnit::none,
             {{Load{"force", FollowerForce{{0, Vector3d(0.1, 0.05, 0)}, Vector3d(900, 500, 1200)}},
               0, 1},
              {Load{"moment", DeadMoment{0, Vector3d(120, -60, 200)}}, 0, 1}}}};
        scene.probes = {{"p", {0, Vector3d(0.1, 0.05, 0)}}};
        const Model model = compile(scene);
        const auto last = [&](const char* name, int steps) {
            const auto path = solve(model, model.branches[0],
                                    {.method = method_called(name), .steps = steps, .record = 1});
            EXPECT_EQ(path.outcome, Outcome::converged)
                << name_of(formulation) << " " << name << ": " << path.detail;
            return path.points.back().poses[0];
        };
        const Pose exact = last("series", 1);
        for (const auto& [name, p] :
             {std::pair{"balanced", 1}, {"tangent", 2}, {"chord", 3}, {"midpoint", 3}}) {
            const auto error = [&](int steps) {
                const Pose pose = last(name, steps);
                return (pose.r - exact.r).norm() + pose.p.angularDistance(exact.p);
            };
            const double coarse = error(200), fine = error(400);
            EXPECT_NEAR(order(coarse, fine), p, 0.12)
                << name_of(formulation) << " " << name << ": " << coarse << " " << fine;
        }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
