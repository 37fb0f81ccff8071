// Element forces of the equilibrium leg against numerical gradients of independently implemented
// energies of mechanism.hpp; and the Jacobian against differences of the residual.
#include <fmt/format.h>

#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/statement/equations.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

Pose moved(Pose pose, int coordinate, double by) {
    if (coordinate < 3)
        pose.r[coordinate] += by;
    else
        pose.p = Quaterniond(Eigen::AngleAxisd(by, Vector3d::Unit(coordinate - 3))) * pose.p;
    return pose;
}

// -∂U/∂(δr, δπ) of one body by central differences of sixth order.
template <class Move>
double slope(const Move& U, double h) {
    return (45 * (U(h) - U(-h)) - 9 * (U(2 * h) - U(-2 * h)) + (U(3 * h) - U(-3 * h))) / (60 * h);
}

OnBoth<double> on_both(const AxialSpring& spring, const Frame<double>& i, const Frame<double>& j) {
    return interaction(spring, spring.free_length, 0., by_itself, i, j);
}
OnBoth<double> on_both(const Bushing& b, const Frame<double>& i, const Frame<double>& j) {
    return interaction(b, b.preload, true, all_by_themselves, i, j);
}

// Wrench of the element on both bodies, (force; moment about the origin) each, against the
// gradient, relative to its size.
template <class Element>
double deviation_from_gradient(const Element& element, const Pose& i, const Pose& j) {
    const Frame<double> frame_i{i.r, i.p}, frame_j{j.r, j.p};
    const auto on = on_both(element, frame_i, frame_j);
    Eigen::Matrix<double, 12, 1> wrench, gradient;
    wrench << on.i.force, on.i.moment + (on.i.at - i.r).cross(on.i.force), on.j.force,
        on.j.moment + (on.j.at - j.r).cross(on.j.force);
    for (int k = 0; k < 6; ++k) {
        gradient[k] = -slope([&](double h) { return energy(element, moved(i, k, h), j); }, 1e-3);
        gradient[6 + k] =
            -slope([&](double h) { return energy(element, i, moved(j, k, h)); }, 1e-3);
    }
    return (wrench - gradient).cwiseAbs().maxCoeff() / gradient.cwiseAbs().maxCoeff();
}

TEST(EquilibriumElements, SpringForceIsTheNegativeGradientOfItsEnergy) {
    std::mt19937 random(1);
    Worst worst;
    for (int trial = 0; trial < 300; ++trial) {
        AxialSpring spring{
            {0, random_vector(random, 0.3)}, {1, random_vector(random, 0.3)}, LinearRate{3e4}, 0.4};
        const Pose i{random_vector(random, 0.3), random_turn(random)};
        const Pose j{random_vector(random, 0.3) + Vector3d(1.2, 0, 0), random_turn(random)};
        worst.see(deviation_from_gradient(spring, i, j), fmt::format("trial {}", trial));
    }
    EXPECT_TRUE(within(worst, 1e-9));
}

// Full symmetric 6×6 rates with coupling, preload, rotations from zero to 3 rad, any marker axes.
TEST(EquilibriumElements, BushingForceIsTheNegativeGradientOfItsEnergy) {
    std::mt19937 random(2);
    Worst worst;
    for (const double angle :
         {0., 1e-9, 1e-6, 1e-4, 0.01, 0.09, 0.0999, 0.1, 0.1001, 0.3, 1., 2., 3.})
        for (int trial = 0; trial < 40; ++trial) {
            Bushing b{{0, random_vector(random, 0.3), random_turn(random)},
                      {1, random_vector(random, 0.3), random_turn(random)},
                      LinearStiffness{random_stiffness(random)},
                      Vector6::Zero()};
            b.preload << random_vector(random, 500), random_vector(random, 20);
            const Pose i{random_vector(random, 0.3), random_turn(random)};
            const Quaterniond turn(Eigen::AngleAxisd(angle, random_vector(random, 1).normalized()));
            Pose j;
            j.p = i.p * b.i.A_local * turn * b.j.A_local.conjugate();
            j.r = i.r + i.p * b.i.s_local - j.p * b.j.s_local + random_vector(random, 0.05);
            worst.see(deviation_from_gradient(b, i, j),
                      fmt::format("{} rad, trial {}", angle, trial));
        }
    EXPECT_TRUE(within(worst, 1e-9));
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
    for (const auto& s :
         {rich_scene(), scene("chrono_mcpherson"), scene("pendulum"), scene("two_spring_arch")}) {
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
