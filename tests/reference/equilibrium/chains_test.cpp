// Beams as chains of bushings, each with its frame at the middle of its segment and the stiffness
// of the segment, against the elastica. All errors are of order n⁻² in the number of segments.
#include <fmt/format.h>

#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

constexpr double L = 1, EI = 100, EI_y = 400, GJ = 150,
                 EA = 4e6;  // [m], [N·m²], [N]: EA L² / EI of a rod 20 mm thick

// Clamped at the origin, along x; the tip is the last body. Bending in x-y has EI.
Scene cantilever(int segments) {
    Scene s;
    s.name = fmt::format("cantilever of {}", segments);
    const double h = L / segments;
    Bushing segment;
    segment.formulation.frame = Formulation::Frame::middle;
    stiffness_of(segment).K.diagonal() << EA / h, 12 * EI / (h * h * h), 12 * EI_y / (h * h * h),
        GJ / h, EI_y / h, EI / h;
    for (int k = 0; k < segments; ++k) {
        s.bodies.push_back(
            {fmt::format("node {}", k + 1), {{(k + 1) * h, 0, 0}, Quaterniond::Identity()}});
        segment.i = {k - 1, {h / 2, 0, 0}};
        segment.j = {k, {-h / 2, 0, 0}};
        s.elastics.push_back({fmt::format("segment {}", k + 1), segment});
    }
    s.probes = {{"tip", {segments - 1, {0, 0, 0}}}};
    return s;
}

Equilibrium at_full_load(const Scene& s, double load) {
    const Model model = compile(s);
    const std::vector<double> loads = {load};
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::converged) << s.name << ": " << path.detail;
    if (path.points.empty()) return {};
    const auto r = residuals(model, model.branches[0], path.points[0]);
    EXPECT_LT(std::max(r.force / EA, r.moment / EI), 1e-10) << s.name;
    return path.points[0];
}

// log₂ of the error ratio for halved segments.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

// Each segment turns by θ = M L / (n EI) without force. The nodes of this chain of chords lie on a
// circle too, of radius R (θ/2) / tan(θ/2) with R = EI / M, so it is 1 - θ²/12 of the circle, to
// the last digit.
TEST(EquilibriumChains, UnderATipMomentACantileverRollsIntoACircle) {
    std::vector<double> errors;
    for (const int n : {4, 8, 16})
        for (const double turn : {M_PI / 2, 2 * M_PI}) {
            Scene s = cantilever(n);
            s.branches = {twist(n - 1, {0, 0, 1})};
            const auto state = at_full_load(s, turn * EI / L);
            ASSERT_EQ(state.poses.size(), static_cast<std::size_t>(n));
            const double theta = turn / n, R = L / turn,
                         R_n = R * (theta / 2) / std::tan(theta / 2);
            Worst worst;
            for (int k = 0; k < n; ++k) {
                const double phi = theta * (k + 1);
                const Vector3d node = R_n * Vector3d(std::sin(phi), 1 - std::cos(phi), 0);
                worst.see((state.poses[static_cast<std::size_t>(k)].r - node).norm() / L,
                          fmt::format("{} segments, node {}", n, k + 1));
            }
            EXPECT_TRUE(within(worst, 1e-9));  // 8e-10 occurred with EA = 1e8 N and 20 segments
            const Vector3d tip = R * Vector3d(std::sin(turn), 1 - std::cos(turn), 0);
            if (turn < 2) errors.push_back((state.poses.back().r - tip).norm() / L);
        }
    for (std::size_t k = 1; k < errors.size(); ++k)
        EXPECT_NEAR(order(errors[k - 1], errors[k]), 2, 0.1) << k;
}

// The elastica: EI θ'' = -P cos θ, θ(0) = 0, θ'(L) = 0, by shooting with a fourth-order Runge-Kutta
// method.
Vector3d elastica_tip(double P) {
    constexpr int steps = 4000;
    const double h = L / steps;
    Vector3d tip;
    const auto end_curvature = [&](double kappa) {
        Eigen::Vector4d y(0, kappa, 0, 0);  // θ, θ', x, y
        const auto rate = [&](const Eigen::Vector4d& at) {
            return Eigen::Vector4d(at[1], -P / EI * std::cos(at[0]), std::cos(at[0]),
                                   std::sin(at[0]));
        };
        for (int n = 0; n < steps; ++n) {
            const Eigen::Vector4d a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b),
                                  d = rate(y + h * c);
            y += h / 6 * (a + 2 * b + 2 * c + d);
        }
        tip = {y[2], y[3], 0};
        return y[1];
    };
    // its slope at the clamp is less than that of a straight beam
    double low = 0, high = P * L / EI;
    for (int n = 0; n < 60; ++n) {
        const double middle = (low + high) / 2;
        (end_curvature(middle) > 0 ? high : low) = middle;
    }
    return tip;
}

TEST(EquilibriumChains, UnderATipForceACantileverFollowsTheElastica) {
    for (const double alpha : {1., 3.}) {  // P L² / EI: the tip moves by 0.30 and 0.60 L
        const double P = alpha * EI / (L * L);
        const Vector3d exact = elastica_tip(P);
        std::vector<double> errors;
        for (const int n : {4, 8, 16}) {
            Scene s = cantilever(n);
            s.branches = {pull({n - 1, {0, 0, 0}}, {0, 1, 0})};
            const auto state = at_full_load(s, P);
            ASSERT_FALSE(state.poses.empty());
            errors.push_back((state.poses.back().r - exact).norm() / L);
        }
        for (std::size_t k = 1; k < errors.size(); ++k)
            EXPECT_NEAR(order(errors[k - 1], errors[k]), 2, 0.3)
                << alpha << ": " << errors[k - 1] << " to " << errors[k];
        EXPECT_LT(errors.back(), 5e-3) << alpha;
    }
}

// Load at which the straight chain becomes singular, by bisection, against π² EI / (4 L²).
TEST(EquilibriumChains, AStraightChainIsSingularAtEulersLoad) {
    const double euler = M_PI * M_PI * EI / (4 * L * L);
    std::vector<double> errors;
    for (const int n : {4, 8, 16}) {
        Scene s = cantilever(n);
        s.branches = {pull({n - 1, {0, 0, 0}}, {-1, 0, 0})};
        const Model model = compile(s);
        double low = 0.5 * euler, high = 2 * euler;
        while (high - low > 1e-5 * euler) {
            const std::vector<double> loads = {(low + high) / 2};
            const auto path = solve(model, model.branches[0], loads);
            if (path.outcome == Outcome::converged) {
                low = loads[0];
            } else {
                ASSERT_EQ(path.outcome, Outcome::bifurcation_point) << path.detail;
                high = loads[0];
            }
        }
        errors.push_back(std::abs(low / euler - 1));
    }
    for (std::size_t k = 1; k < errors.size(); ++k)
        EXPECT_NEAR(order(errors[k - 1], errors[k]), 2, 0.1)
            << errors[k - 1] << " to " << errors[k];
    EXPECT_LT(errors.back(), 0.02);
}

// Second variation of a straight chain under N (models/reader/definitions/beams.hpp), with nodes rotated by
// φ_k = sin(α k), α = π / (2n), clamped at one end and free at the other: the segments' κ² and φ²
// sum to 4 sin²(α/2) : cos²(α/2), so that
//
//   4 tan²(α/2) (½ k_r + ⅛ N ℓ) + ½ N ℓ - ½ N² (1/k_y - 1/k_x) = 0
//
// is its singularity: under compression, Euler's load for n elements; under tension, never below
// N = k_y ℓ = 12 EI / ℓ², where the beam theory does not apply.
TEST(EquilibriumChains, AStraightChainIsSingularInTensionWhereItsSegmentsEnd) {
    for (const int n : {1, 2, 4}) {
        const double l = L / n, k_x = EA / l, k_y = 12 * EI / (l * l * l), k_r = EI / l,
                     T = 4 * std::pow(std::tan(M_PI / (4 * n)), 2);
        // a N² - b N - c
        const double a = (1 / k_y - 1 / k_x) / 2, b = l / 2 + T * l / 8, c = T * k_r / 2;
        const double root = std::sqrt(b * b + 4 * a * c), tension = (b + root) / (2 * a),
                     compression = (b - root) / (2 * a);
        EXPECT_GT(tension, k_y * l) << n;
        EXPECT_NEAR(compression * L * L / EI, -M_PI * M_PI / 4, 1. / (n * n)) << n;
        for (const double N : {tension, compression}) {
            Scene s = cantilever(n);
            s.branches = {pull({n - 1, {0, 0, 0}}, {N > 0 ? 1. : -1., 0, 0})};
            const Model model = compile(s);
            const auto outcome = [&](double share) {
                const std::vector<double> loads = {share * std::abs(N)};
                return solve(model, model.branches[0], loads).outcome;
            };
            EXPECT_EQ(outcome(1 - 1e-4), Outcome::converged) << n << " segments, " << N << " N";
            EXPECT_EQ(outcome(1 + 1e-4), Outcome::bifurcation_point)
                << n << " segments, " << N << " N";
        }
    }
}

// M_x L / GJ, shared by all segments; and a tension P L / EA, small compared with 12 EI n² / L².
TEST(EquilibriumChains, AChainTwistsAndStretchesAsTheWholeBar) {
    for (const int n : {1, 7}) {
        Scene s = cantilever(n);
        s.branches = {twist(n - 1, {1, 0, 0})};
        const double M = 0.8 * GJ / L;
        const auto twisted = at_full_load(s, M);
        ASSERT_FALSE(twisted.poses.empty());
        const Quaterniond by(Eigen::AngleAxisd(0.8, Vector3d::UnitX()));
        EXPECT_LT(twisted.poses.back().p.angularDistance(by), 1e-10) << n;
        s.branches = {pull({n - 1, {0, 0, 0}}, {1, 0, 0})};
        const auto pulled = at_full_load(s, 500);
        ASSERT_FALSE(pulled.poses.empty());
        EXPECT_NEAR(pulled.poses.back().r[0], L * (1 + 500 / EA), 1e-13) << n;
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
