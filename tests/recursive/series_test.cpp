// The branch as a power series: coefficients, range of validity, derivatives, and singularities.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/path.hpp"
#include "recursive/series/pieces.hpp"
#include "recursive/stepping/settle.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive::series {
namespace {

// Truncated polynomials by their coefficients, for an independent expansion of the closed forms.
using Poly = std::vector<double>;
Poly times(const Poly& a, const Poly& b) {
    Poly c(a.size(), 0);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; i + j < a.size(); ++j) c[i + j] += a[i] * b[j];
    return c;
}
// y with y' = f.
Poly integral(const Poly& f) {
    Poly y(f.size(), 0);
    for (std::size_t k = 1; k < f.size(); ++k) y[k] = f[k - 1] / static_cast<double>(k);
    return y;
}

// tan θ = F / (k L) from F = 0 at fractions τ of `to`: θ = atan(c τ), tip = L (cos θ, sin θ), and
// the Gibbs vector of a rotation by -θ about y, g = -tan(θ/2).
struct PinnedBar {
    Poly half_angle_tangent;
    explicit PinnedBar(double c, std::size_t p) {
        Poly d(p + 1, 0), theta;  // θ' = c / (1 + c²τ²)
        double power = c;
        for (std::size_t k = 0; k <= p; k += 2, power *= -c * c) d[k] = power;
        theta = integral(d);
        // t = tan(θ/2): t' = (1 + t²) θ'/2, order by order.
        Poly t(p + 1, 0);
        for (std::size_t k = 1; k <= p; ++k) {
            const Poly t2 = times(t, t);
            double sum = 0;
            for (std::size_t i = 0; i < k; ++i)
                sum += ((i == 0 ? 1 : 0) + t2[i]) * d[k - 1 - i] / 2;
            t[k] = sum / static_cast<double>(k);
        }
        half_angle_tangent = t;
    }
};

TEST(Series, CoefficientsEqualTheClosedForm) {
    const Model model = compile(support::scene("pinned_bar"));
    const Branch& branch = model.branches[0];
    const int p = 20;
    const Path path = follow(model, branch, {.order = p, .last_order = p, .tolerance = 1e-9});
    ASSERT_FALSE(path.expansions.empty());
    const Expansion& first = path.expansions.front();
    const PinnedBar exact(branch.to / (20e3 * 0.5), static_cast<std::size_t>(p));
    // Coefficients of one parity vanish by the symmetry F → -F.
    for (int k = 1; k <= p; ++k) {
        const double computed = std::abs(first.x(4, k) / 2),
                     expected = std::abs(exact.half_angle_tangent[static_cast<std::size_t>(k)]);
        const double size = std::pow(0.5, k);  // typical size of this order: the radius is 2
        EXPECT_LE(std::abs(computed - expected), 1e-12 * std::max(expected, 1e-3 * size)) << k;
    }
    EXPECT_NEAR(first.singularity.radius * branch.to, 20e3 * 0.5,
                0.01 * 20e3 * 0.5);  // F = ± i k L
    EXPECT_NEAR(first.singularity.angle, std::acos(-1) / 2, 0.01);
}

TEST(Series, CoefficientsEqualDerivativesOfTheEquilibriumLeg) {
    // Orders 1 to 3 by central differences of the other leg, at two step sizes that must
    // agree as h².
    for (const char* name :
         {"chrono_mcpherson", "chrono_mcpherson_preload", "bushing_pair", "pendulum"}) {
        const Model model = compile(support::scene(name));
        const Branch& branch = model.branches[0];
        const Path path = follow(model, branch);
        const Eigen::MatrixXd& x = path.expansions.front().x;
        const auto values = [&](double h) {
            const std::vector<double> loads{-2 * h, -h, 0, h, 2 * h};
            std::vector<Eigen::Vector3d> r;
            for (const double share : loads) {
                Branch other = branch;
                other.to = branch.to * (share == 0 ? 1e-9 : share);
                const std::vector<double> at{0, other.to};
                const auto solved = reference::equilibrium::solve(model, other, at);
                EXPECT_EQ(solved.outcome, Outcome::converged) << solved.detail;
                const std::size_t k = share == 0 ? 0 : 1;
                r.push_back(
                    k < solved.points.size()
                        ? solved.points[k].poses.front().r
                        : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
            }
            return r;
        };
        const double h = 0.02;
        const auto f = values(h);
        const Eigen::Vector3d first = (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * h),
                              second =
                                  (-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / (24 * h * h),
                              third = (-f[0] + 2 * f[1] - 2 * f[3] + f[4]) / (12 * h * h * h);
        EXPECT_LE((x.col(1).head<3>() - first).norm(), 1e-4 * first.norm() + 1e-12) << name;
        EXPECT_LE((x.col(2).head<3>() - second).norm(), 1e-3 * first.norm()) << name;
        EXPECT_LE((x.col(3).head<3>() - third).norm(), 5e-3 * first.norm()) << name;
    }
}

// Positions to 1e-9 mm, reactions, and the full equations of the other leg.
TEST(Series, EqualsTheEquilibriumLegAtEveryLoad) {
    std::mt19937 random(3);
    for (const auto& name : support::small_scene_names()) {
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            std::vector<double> loads;
            for (int k = 0; k <= 101; ++k) loads.push_back(branch.to * k / 101);
            std::uniform_real_distribution<double> between(0, branch.to);
            if (name == "chrono_mcpherson")
                for (int k = 0; k < 400; ++k) loads.push_back(between(random));
            std::ranges::sort(loads, {}, [](double a) { return std::abs(a); });
            const auto reference = reference::equilibrium::solve(model, branch, loads);
            ASSERT_EQ(reference.outcome, Outcome::converged) << reference.detail;
            const Path path = follow(model, branch);
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            double worst = 0, force = 0;
            for (std::size_t k = 0; k < loads.size(); ++k) {
                const auto place = find(path, loads[k]);
                ASSERT_TRUE(place) << name << " " << loads[k];
                const Equilibrium point = evaluate(model, branch, path, *place);
                EXPECT_NEAR(point.load, loads[k], 1e-9);
                worst = std::max(worst, distance(model, point, reference.points[k]));
                for (std::size_t j = 0; j < point.reactions.size(); ++j)
                    force = std::max(
                        force,
                        (point.reactions[j].force - reference.points[k].reactions[j].force).norm());
            }
            EXPECT_LE(worst, 1e-12) << name << " " << branch.name;
            EXPECT_LE(force, 1e-5) << name << " " << branch.name;
            const auto sampled = sample(model, path, branch, 20);
            for (std::size_t k = 0; k < sampled.points.size(); ++k) {
                const auto& point = sampled.points[k];
                EXPECT_EQ(point.load, branch.to * static_cast<double>(k) / 20);  // to the last bit
                const auto own = recursive::residuals(model, branch, point),
                           other = reference::equilibrium::residuals(model, branch, point);
                EXPECT_LE(std::max({own.force, own.moment, other.force, other.moment}), 1e-5)
                    << name;
                EXPECT_LE(std::max(own.length, other.length), 1e-12) << name;
            }
        }
    }
}

TEST(Series, ExpansionOfAnotherOrderIsWithinTheToleranceAndOfALowerOneEndsTheBranch) {
    int others = 0;
    for (const auto& name : support::small_scene_names())
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            const Path path = follow(model, branch);
            for (std::size_t k = 0; k < path.expansions.size(); ++k) {
                const Expansion& expansion = path.expansions[k];
                const int p = expansion.order();
                if (p == recursive::Series{}.order) continue;
                ++others;
                EXPECT_TRUE(p > recursive::Series{}.order || k + 1 == path.expansions.size() ||
                            expansion.knots > 0)
                    << name;
                const double last = expansion.x.col(p).head(6).norm();
                EXPECT_LE(last * std::pow(expansion.reach, p), 1e-12) << name << " " << branch.name;
            }
        }
    EXPECT_GT(others, 20);
}

TEST(Series, TruncationErrorIsOfOrderPPlusOne) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    const Branch& branch = model.branches[0];
    const Path exact = follow(model, branch);
    for (const int p : {2, 4, 6, 8, 10}) {
        const Path path = follow(
            model, branch, {.order = p, .last_order = p, .tolerance = 1e-4, .expansions = 2000});
        ASSERT_FALSE(path.expansions.empty());
        const auto error = [&](double tau) {
            return distance(model, evaluate(model, branch, path, {0, tau}),
                            evaluate(model, branch, exact, {0, tau}));
        };
        const double tau = path.expansions.front().reach;
        const double order = std::log2(error(tau) / error(tau / 2));
        EXPECT_NEAR(order, p + 1, 0.5) << p;
    }
}

TEST(Series, RatesAreTheDerivativesOfItsStates) {
    for (const char* name : {"chrono_mcpherson", "pendulum", "chrono_mcpherson_preload"}) {
        const Model model = compile(support::scene(name));
        const Branch& branch = model.branches[0];
        const Path path = follow(model, branch);
        for (const double share : {0.0, 0.1, 0.35, 0.6, 0.9}) {
            const double h = 1e-4 * branch.to, load = branch.to * share + 2 * h;
            const auto at = [&](double a) { return evaluate(model, branch, path, *find(path, a)); };
            const auto m2 = at(load - 2 * h), m1 = at(load - h), p1 = at(load + h),
                       p2 = at(load + 2 * h);
            const Rates exact = rates(path, *find(path, load));
            for (std::size_t b = 0; b < model.bodies.size(); ++b) {
                const Eigen::Vector3d dr =
                    (m2.poses[b].r - 8 * m1.poses[b].r + 8 * p1.poses[b].r - p2.poses[b].r) /
                    (12 * h);
                EXPECT_LE((dr - exact.dr[b]).norm(), 1e-8 * (exact.dr[b].norm() + 1e-6)) << name;
                const Eigen::Vector3d omega =
                    (8 * 2 * (p1.poses[b].p * m1.poses[b].p.conjugate()).vec() -
                     2 * (p2.poses[b].p * m2.poses[b].p.conjugate()).vec()) /
                    (12 * h);
                EXPECT_LE((omega - exact.omega[b]).norm(), 1e-6 * (exact.omega[b].norm() + 1e-6))
                    << name;
            }
        }
    }
}

// F = 2 k (ℓ - ℓ₀) z / ℓ has its extrema at ℓ³ = ℓ₀ b².
double limit_of_the_arch() {
    const double b = 0.3, h = 0.08, k = 100e3, l_0 = std::hypot(b, h);
    const double z = std::sqrt(std::pow(l_0 * b * b, 2.0 / 3) - b * b), l = std::hypot(b, z);
    return 2 * k * (l - l_0) * z / l;
}

TEST(Series, LimitPointsAreLocated) {
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    for (const double to : {-250.0, -400.0, -3000.0})
        for (const int order : {8, 12, 16, 20}) {
            branch.to = to;
            const Path path = follow(model, branch, {.order = order, .last_order = order});
            EXPECT_EQ(path.outcome, Outcome::limit_point) << path.detail;
            ASSERT_EQ(path.limits.size(), 1u);
            EXPECT_NEAR(path.limits[0] / limit_of_the_arch(), 1, 1e-6) << to << " " << order;
            EXPECT_NE(path.detail.find("limit point near -211.5165"), std::string::npos)
                << path.detail;
            EXPECT_FALSE(find(path, -212));
        }
}

TEST(Series, ArcLengthPassesLimitPoints) {
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    branch.to = -400;
    for (const int order : {8, 12, 16, 20}) {
        const Path path =
            follow(model, branch, {.order = order, .last_order = order, .arc_length = true});
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        ASSERT_EQ(path.limits.size(), 2u);  // down, and back up on the other side
        EXPECT_NEAR(path.limits[0], limit_of_the_arch(), 1e-9);
        EXPECT_NEAR(path.limits[1], -limit_of_the_arch(), 1e-9);
        const auto sampled = sample(model, path, branch, 50);
        ASSERT_EQ(sampled.points.size(), 51u);
        EXPECT_NEAR(sampled.points.back().load, -400, 1e-9);
        const double b = 0.3, k = 100e3, l_0 = std::hypot(b, 0.08);
        for (const auto& point : sampled.points) {  // on the closed form everywhere
            const double z = point.poses[0].r.z(), l = std::hypot(b, z);
            EXPECT_NEAR(2 * k * (l - l_0) * z / l, point.load, 1e-8);
        }
    }
}

TEST(Series, EachTurningPointIsRecordedOnce) {
    // Many tolerances, so that some expansions end near a limit point and some are shortened.
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    branch.to = -400;
    int rejected = 0;
    for (int order = 4; order <= 16; ++order)
        for (int k = 0; k < 400; ++k) {
            const double tolerance = std::pow(10, -3 - k / 100.0);
            const Path path = follow(
                model, branch,
                {.order = order, .last_order = order, .tolerance = tolerance, .arc_length = true});
            ASSERT_EQ(path.outcome, Outcome::converged)
                << order << " " << tolerance << " " << path.detail;
            ASSERT_EQ(path.limits.size(), 2u) << order << " " << tolerance;
            rejected += path.rejected;
        }
    EXPECT_GT(rejected, 0);
}

TEST(Series, ArcLengthAndLoadParametersGiveTheSameBranch) {
    for (const char* name :
         {"chrono_mcpherson", "pinned_bar", "pendulum", "chrono_mcpherson_preload"}) {
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            const Path by_load = follow(model, branch),
                       by_arc = follow(model, branch, {.arc_length = true});
            ASSERT_EQ(by_arc.outcome, Outcome::converged) << by_arc.detail;
            EXPECT_TRUE(by_arc.limits.empty());
            for (int k = 0; k <= 16; ++k) {
                const double load = branch.to * k / 16;
                ASSERT_TRUE(find(by_arc, load)) << name << " " << load;
                EXPECT_LE(distance(model, evaluate(model, branch, by_load, *find(by_load, load)),
                                   evaluate(model, branch, by_arc, *find(by_arc, load))),
                          2e-12)
                    << name << " " << load;
            }
        }
    }
}

TEST(Series, ErrorStaysWithinTheRequestedTolerance) {
    for (const auto& name : support::small_scene_names()) {
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            const Path exact = follow(model, branch, {.order = 20, .last_order = 20});
            for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10})
                for (const int order : {6, 10, 16}) {
                    const Path path =
                        follow(model, branch,
                               {.order = order, .last_order = order, .tolerance = tolerance});
                    ASSERT_EQ(path.outcome, Outcome::converged) << name << " " << path.detail;
                    double worst = 0;
                    for (int k = 0; k <= 97; ++k) {
                        const double load = branch.to * k / 97;
                        worst = std::max(
                            worst, distance(model, evaluate(model, branch, path, *find(path, load)),
                                            evaluate(model, branch, exact, *find(exact, load))));
                    }
                    EXPECT_LE(worst, tolerance)
                        << name << " " << branch.name << " " << order << " " << tolerance;
                    for (const auto& expansion : path.expansions)
                        EXPECT_LE(expansion.certificate.error_end, 10 * tolerance) << name;
                }
        }
    }
}

TEST(Series, ReachingTheExpansionLimitIsReported) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    const Path path =
        follow(model, model.branches[0], {.order = 2, .last_order = 2, .expansions = 5});
    EXPECT_EQ(path.outcome, Outcome::iteration_limit);
    EXPECT_EQ(path.expansions.size(), 5u);
    EXPECT_NE(path.detail.find("5 expansions were not enough"), std::string::npos) << path.detail;
    const Path first_order = follow(model, model.branches[0], {.order = 1, .last_order = 1});
    EXPECT_EQ(first_order.outcome, Outcome::iteration_limit);
    EXPECT_NE(first_order.detail.find("200 expansions were not enough"), std::string::npos);
}

TEST(Series, LinearPartOfTheEquationsEqualsTheTangentTimesTheCoefficient) {
    // The second pass, linear in x_k, against the matrix of the solve: G_k with x_k
    // inserted must vanish.
    for (const auto& name : support::small_scene_names()) {
        const auto [model, branch] = all_sides(compile(support::scene(name))).front();
        SteppingState s(model, branch, analyse(model));
        ASSERT_EQ(settle(s), Outcome::converged);
        s.work.applied = Vector<double>::Zero(s.n());
        ASSERT_EQ(factorise_at(s, s.q, s.lambda), Outcome::converged);
        Equations<double> e = equations<double>(model, branch, 8);
        std::vector<CurvePiece> curves = curves_of(model);
        begin(e, s.q, s.lambda, 0);
        evaluate(e, {0, Pass::known});
        for (CurvePiece& curve : curves) find_piece(e, curve), set_piece(curve, e);
        Coefficients<double> c = reserve_coefficients<double>(s.n() + s.m(), 8);
        expand(s, e, c, {.a_1 = branch.to}, Vector<double>::Zero(s.n() + s.m()));
        // All coefficients are set: a `known` pass then gives G_k and Φ_k.
        for (int k = 1; k <= 7; ++k) {
            evaluate(e, {k, Pass::known});
            const Matrix<double> M = sparse(s.system.M);
            const Vector<double> elastic = M.topLeftCorner(s.n(), s.n()) * c.x.col(k).head(s.n()),
                                 reaction = M.topRightCorner(s.n(), s.m()) * c.x.col(k).tail(s.m());
            const double size = elastic.lpNorm<Eigen::Infinity>() +
                                reaction.lpNorm<Eigen::Infinity>() + std::abs(c.load[k]) +
                                1e-3 * std::abs(branch.to);
            EXPECT_LE(e.G.cwiseAbs().maxCoeff(), 1e-10 * size) << name << " " << k;
            if (s.m() > 0) {
                EXPECT_LE(e.Phi.cwiseAbs().maxCoeff(), 1e-12 * c.x.col(k).norm() + 1e-16)
                    << name << " " << k;
            }
        }
    }
}

TEST(Series, LogarithmFunctionsAreAccurateAtAndAwayFromZero) {
    for (const double s_0 : {0.0, 1e-30, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 1.0, 3.0, 30.0}) {
        std::vector<double> f1(13), f3(13);
        taylor_of_F(1, s_0, f1);
        taylor_of_F(3, s_0, f3);
        const auto exact_1 = [](double s) {
            return s == 0 ? 1 : std::atan(std::sqrt(s)) / std::sqrt(s);
        };
        EXPECT_NEAR(f1[0], exact_1(s_0), 4e-16) << s_0;
        if (s_0 >= 1e-3) {
            EXPECT_NEAR(f3[0], (1 - exact_1(s_0)) / s_0, 4e-16 / s_0) << s_0;
        }
        // Value at another point: the radius is 1 + s_0, the distance to the nearest singularity.
        const double sigma = 0.05 * (1 + s_0);
        double sum = 0;
        for (std::size_t n = f1.size(); n-- > 0;) sum = sum * sigma + f1[n];
        EXPECT_NEAR(sum, exact_1(s_0 + sigma), 1e-15) << s_0;
    }
}

}  // namespace
}  // namespace elastocheck::recursive::series
