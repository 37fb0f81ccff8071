// The recursion, eqs. (25)-(29): its limit and its order of convergence.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "tests/support/quadrature.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

Vector3d place(const Equilibrium& state, const Point& p) {
    const Pose& pose = state.poses[static_cast<std::size_t>(p.body)];
    return pose.r + pose.p * p.s_local;
}

Vector3d leading_point(const Model& model, const Equilibrium& state) {
    if (!model.wheels.empty())
        return place(state, {model.wheels[0].body, model.wheels[0].centre_local});
    return place(state, model.probes.front().at);
}

// ---- Limit of the published recursion, derived by hand. For N → ∞ the sum of K(qⁿ)Δqⁿ becomes an
// integral in ground axes along the path; the stored force is never rotated. For a single rotation
// θ it is a sum of torques K_θθ dθ.

struct OwnLimit {
    const char* scene;
    double load;
    Vector3d point;          // the first probe at full load [m]
    bool is_linear = false;  // exact with one step
};

std::vector<OwnLimit> own_limits() {
    std::vector<OwnLimit> limits;
    {  // k L² θ = F L cos θ; true: k L² sin θ = F L cos θ
        const double t =
            support::root([](double x) { return 20e3 * 0.5 * x - 5000 * std::cos(x); }, 0, 1.5);
        limits.push_back({"pinned_bar", 5000, {0.5 * std::cos(t), 0, 0.5 * std::sin(t)}});
    }
    {  // (2 k a² + 2 k_R) θ = F e cos θ; true: 2 k a² sin θ + 2 k_R θ
        const double t = support::root(
            [](double x) { return (2 * 2e5 * 0.0225 + 1000) * x - 6000 * 0.25 * std::cos(x); }, 0,
            1.5);
        limits.push_back(
            {"bushing_pair", 6000, {0.25 * std::cos(t), 0, 6000 / 4e5 + 0.25 * std::sin(t)}});
    }
    {  // k_R θ = F L cos θ: exact, no force is stored with a lever
        const double t =
            support::root([](double x) { return 600 * x - 1500 * 0.4 * std::cos(x); }, 0, 1.5);
        limits.push_back(
            {"pendulum", 1500, {0.32 * std::cos(t), 0.24 * std::cos(t), 0.4 * std::sin(t)}});
    }
    {  // F = ∫ 2k ζ²/(b²+ζ²) dζ from h to z; true: 2k (ℓ - ℓ₀) z / ℓ
        const auto F = [](double z) {
            return 2e5 * (z - 0.08 - 0.3 * (std::atan(z / 0.3) - std::atan(0.08 / 0.3)));
        };
        limits.push_back({"two_spring_arch",
                          -200,
                          {0, 0, support::root([&](double z) { return F(z) + 200; }, 0, 0.08)}});
        limits.push_back({"two_spring_arch",
                          2000,
                          {0, 0, support::root([&](double z) { return F(z) - 2000; }, 0.08, 0.5)}});
    }
    limits.push_back({"single_bushing", 4000,
                      Vector3d(0.1, 0.2, 0.3) + 4000 * Vector3d(0.6 / 2e5, 0.48 / 3e5, 0.64 / 5e5),
                      true});
    limits.push_back({"parallel_springs", 3000, {0, 0, 0.4 + 3000 / 75e3}, true});
    return limits;
}

TEST(Recursion, PublishedRecursionConvergesToItsClosedFormLimitAtFirstOrder) {
    for (const auto& limit : own_limits()) {
        const Model model = compile(support::scene(limit.scene));
        const auto branch = std::ranges::find(model.branches, limit.load, &Branch::to);
        ASSERT_NE(branch, model.branches.end()) << limit.scene;
        const auto error = [&](int steps) {
            const auto path = solve(model, *branch, {.steps = steps});
            EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
            return Vector3d(leading_point(model, path.points.back()) - limit.point);
        };
        if (limit.is_linear) {
            for (const int steps : {1, 1000}) EXPECT_LE(error(steps).norm(), 1e-12) << limit.scene;
            continue;
        }
        const Vector3d coarse = error(400), fine = error(800);
        EXPECT_NEAR(std::log2(coarse.norm() / fine.norm()), 1, 0.02) << limit.scene;
        EXPECT_LE((2 * fine - coarse).norm(), 1e-2 * fine.norm())
            << limit.scene;  // Richardson extrapolation meets the closed form
    }
}

// Eq. (28) as printed: keeps the sum of all K(qᵏ)Δqᵏ, and applies the whole load.
std::vector<State<double>> equation_28(const Model& model, const Branch& branch, int N) {
    State<double> q = design_state<double>(model);
    const int n = coordinates(model), m = constraint_rows(model);
    const Inputs<double> drawn = inputs_as_drawn<double>(model);
    Vector<double> stored = elastic_force<double>(model, drawn, q), f(n);
    std::vector<State<double>> path{q};
    for (int k = 0; k < N; ++k) {
        SaddleMatrix<double> kept = saddle_matrix(model);
        Vector<double> Phi(m);
        assemble<double>(model, drawn, q, kept, Phi);
        const Matrix<double> M = sparse(kept);
        external_force<double>(model, branch,
                               inputs_at<double>(model, branch, branch.to * (k + 1) / N), q, f);
        Vector<double> rhs = Vector<double>::Zero(n + m);
        rhs.head(n) = f - stored;
        const Vector<double> x = M.partialPivLu().solve(rhs);
        stored += M.topLeftCorner(n, n) * x.head(n);
        advance(q, x.head(n));
        path.push_back(q);
    }
    return path;
}

TEST(Recursion, Equation29EqualsEquation28ForAMovingLoadLever) {
    for (const char* name : {"pinned_bar", "bushing_pair", "pendulum", "two_spring_arch",
                             "single_bushing", "parallel_springs"}) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches) {
            const auto path = solve(model, branch, {.steps = 25});
            const auto expected = equation_28(model, branch, 25);
            double worst = 0;
            for (std::size_t k = 0; k < expected.size(); ++k)
                worst = std::max({worst, (path.points[k].poses[0].r - expected[k][0].r).norm(),
                                  path.points[k].poses[0].p.angularDistance(expected[k][0].p)});
            EXPECT_LE(worst, 1e-9) << name << " " << branch.name;
        }
    }
}

TEST(Recursion, PapersSixHundredStepsAreThreeHundredOfTenNewtonPerSide) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    ASSERT_EQ(model.branches.size(), 2u);
    for (const auto& branch : model.branches) {
        EXPECT_EQ(branch.steps, 300);
        EXPECT_EQ(std::abs(branch.to) / branch.steps, 10);
        const auto path = solve(model, branch);
        EXPECT_EQ(path.counts.factorisations, 300);  // one a step, none to start: λ⁻¹ = 0
    }
}

TEST(Recursion, BalancedSceneStartsFromItsReactionsAndAnUnbalancedOneSettlesFirst) {
    for (const double more : {0., 75.}) {  // [N] on 75 N/mm
        Scene scene = support::scene("parallel_springs");
        auto& weight = std::get<DeadForce>(scene.static_loads[0].kind).f;
        weight.z() -= more;
        weight.x() = 250;  // carried by the guide, also at full load
        const Model model = compile(scene);
        const auto path = solve(model, model.branches[0], {.steps = 10});
        EXPECT_LE(
            (leading_point(model, path.points.front()) - Vector3d(0, 0, 0.4 - more / 75e3)).norm(),
            1e-12);
        for (const auto& point : path.points) {
            EXPECT_NEAR(point.reactions[0].force.x(), -250, 1e-9);
            EXPECT_LE(residuals(model, model.branches[0], point).force, 1e-9);
        }
        // the first shows whether it is at rest, ten settle, ten load
        if (more > 0) {
            EXPECT_EQ(path.counts.factorisations, 21);
        }
    }
}

TEST(Outcome, NamesAreDistinct) {
    std::vector<std::string> names;
    for (int k = 0; k <= static_cast<int>(Outcome::outside_table); ++k)
        names.emplace_back(name(static_cast<Outcome>(k)));
    std::ranges::sort(names);
    EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace elastocheck::recursive
