// Rotations of the equilibrium leg, and its Jacobian against differences of the residual.
#include <fmt/format.h>

#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/statement/equations.hpp"
#include "tests/reference/equilibrium/scenes.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

// Derivative at zero by central differences of sixth order.
template <class Move>
double slope(const Move& U, double h) {
    return (45 * (U(h) - U(-h)) - 9 * (U(2 * h) - U(-2 * h)) + (U(3 * h) - U(-3 * h))) / (60 * h);
}

TEST(EquilibriumElements, LogarithmInvertsTheExponentialFromNothingToNearlyHalfATurn) {
    std::mt19937 random(3);
    Worst worst;
    for (double angle = 1e-14; angle < 3.1415; angle = angle < 0.5 ? 2 * angle : angle + 0.01) {
        const Vector3d u = random_vector(random, 1).normalized();
        const Quaterniond p(Eigen::AngleAxisd(angle, u));
        for (const double sign : {1., -1.}) {
            const auto log = logarithm(Quaterniond(sign * p.coeffs()));
            worst.see((log.theta - angle * u).norm() / angle, fmt::format("{} rad", angle));
        }
    }
    EXPECT_TRUE(within(worst, 2e-15 * 4));
}

// The logarithm jumps at half a turn. Close to it the result is NaN.
TEST(EquilibriumElements, HalfATurnIsNotANumber) {
    for (const double short_of : {0., 1e-9, 1e-7})
        for (const double sign : {1., -1.}) {
            const auto log = logarithm(
                Quaterniond(Eigen::AngleAxisd(sign * (M_PI - short_of), Vector3d(0.6, 0, 0.8))));
            EXPECT_TRUE(std::isnan(log.theta[0]) && std::isnan(log.c)) << short_of;
        }
}

// Automatic differentiation against differences, at design poses (θ = 0, where series replace 0/0)
// and away from them.
TEST(EquilibriumElements, JacobianIsTheDerivativeOfTheResidual) {
    std::mt19937 random(4);
    Worst worst;
    for (const auto& s : {support::rich_scene(), scene("chrono_mcpherson"), scene("pendulum"),
                          scene("two_spring_arch")}) {
        const Model model = compile(s);
        const std::vector<double> loads = {1000};
        const System system = make_system(model, model.branches[0], loads);
        const int n = system.equations();
        for (const double away : {0., 1e-9, 1e-3, 0.3}) {
            const Eigen::VectorXd off =
                away * Eigen::VectorXd::NullaryExpr(n, [&] {
                    return std::uniform_real_distribution<double>(-1, 1)(random);
                });
            const Eigen::VectorXd x = equilibrium::moved(system, design_unknowns(system), off);
            Counts counts;
            const Eigen::MatrixXd J = derivatives(system, {700}, x, counts).J;
            for (int k = 0; k < n; ++k) {
                Eigen::VectorXd differences(n);
                for (int row = 0; row < n; ++row)
                    differences[row] = slope(
                        [&](double h) {
                            return residual(system, {700},
                                            equilibrium::moved(
                                                system, x, h * Eigen::VectorXd::Unit(n, k)))[row];
                        },
                        2e-3);
                worst.see((J.col(k) - differences).cwiseAbs().maxCoeff() / J.cwiseAbs().maxCoeff(),
                          fmt::format("{}, {} away, column {}", s.name, away, k));
            }
        }
    }
    EXPECT_TRUE(within(worst, 1e-9));
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
