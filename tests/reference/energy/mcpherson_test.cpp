// The McPherson strut of the paper, by the energy leg: both branches, 301 points each.
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

// At the design position, from strut top to lower mount.
const Vector3d strut_axis = Vector3d(0.04097493, 0.0682915, -0.3305464).normalized();

struct Solved {
    Scene scene = scene_named("chrono_mcpherson");
    Model model = compile(scene);
    std::vector<EquilibriumPath> paths;
};

const Solved& solved() {
    static const Solved all = [] {
        Solved s;
        for (const auto& branch : s.model.branches)
            s.paths.push_back(solve(s.model, branch, sweep(branch)));
        return s;
    }();
    return all;
}

// Path independence: the same equilibrium in 3 or 300 steps, upwards or on the way back.
TEST(McPherson, EquilibriumDoesNotDependOnTheWayThere) {
    const Solved& s = solved();
    double worst_r = 0, worst_p = 0;
    for (std::size_t b = 0; b < s.paths.size(); ++b) {
        const Branch& branch = s.model.branches[b];
        const double a = branch.to;
        const double loads[] = {a, a / 3, 0, 2 * a / 3, a};
        const int index[] = {300, 100, 0, 200, 300};
        const EquilibriumPath path = solve(s.model, branch, loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (std::size_t k = 0; k < path.points.size(); ++k) {
            const auto& fine = s.paths[b].points[static_cast<std::size_t>(index[k])];
            for (std::size_t body = 0; body < fine.poses.size(); ++body) {
                // The strut spins freely: its axis is compared, not its rotation.
                const bool strut = s.model.bodies[body].name == "strut";
                const auto& p = path.points[k].poses[body].p;
                worst_r =
                    std::max(worst_r, (path.points[k].poses[body].r - fine.poses[body].r).norm());
                worst_p = std::max(worst_p,
                                   strut ? (p * strut_axis - fine.poses[body].p * strut_axis).norm()
                                         : p.angularDistance(fine.poses[body].p));
            }
        }
    }
    EXPECT_LE(worst_r, 1e-11);  // [m]
    EXPECT_LE(worst_p, 1e-10);  // [rad]
}

// Between points the strut rotates only across its axis; the spin is of second order in the step.
TEST(McPherson, IdleStrutDoesNotSpin) {
    const Solved& s = solved();
    const auto strut = std::find_if(s.model.bodies.begin(), s.model.bodies.end(),
                                    [](const Body& body) { return body.name == "strut"; });
    const auto b = static_cast<std::size_t>(strut - s.model.bodies.begin());
    double worst = 0, turned = 0;
    for (const auto& path : s.paths) {
        for (std::size_t k = 1; k < path.points.size(); ++k) {
            const auto &p = path.points[k - 1].poses[b].p, &q = path.points[k].poses[b].p;
            const Eigen::AngleAxisd turn(q * p.conjugate());
            worst = std::max(worst, std::abs(turn.angle() * turn.axis().dot(q * strut_axis)));
            turned = std::max(turned, turn.angle());
        }
    }
    EXPECT_GT(turned, 1e-4);  // [rad] per step
    EXPECT_LE(worst, 1e-6);
}

// Cost: warm-started points take one chart and few evaluations (36 of them for the Hessian, twice).
TEST(McPherson, WarmStartedPointsAreCheap) {
    for (const auto& path : solved().paths) {
        EXPECT_LE(path.counts.iterations, 310);
        EXPECT_LE(path.counts.evaluations, 100 * 301);
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
