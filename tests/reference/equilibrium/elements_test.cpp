// Rotations and singular angles of the equilibrium leg, its Jacobian against differences of the
// residual, and misuse.
#include <fmt/format.h>

#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/statement/equations.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

TEST(EquilibriumElements, LogarithmInvertsTheExponentialUpToHalfATurn) {
    Random random;
    Worst worst;
    for (double angle = 1e-14; angle < 3.1415; angle = angle < 0.5 ? 2 * angle : angle + 0.01) {
        const Vector3d u = random.unit();
        const Quaterniond p(Eigen::AngleAxisd(angle, u));
        for (const double sign : {1., -1.}) {
            const auto log = logarithm(Quaterniond(sign * p.coeffs()));
            worst.add((log.theta - angle * u).norm() / angle, fmt::format("{} rad", angle));
        }
    }
    EXPECT_TRUE(within(worst, 2e-15 * 4));
}

TEST(EquilibriumElements, AnglesAtTheirSingularityAreNaN) {
    const auto turn = [](double angle, const Vector3d& axis) {
        return Quaterniond(Eigen::AngleAxisd(angle, axis));
    };
    using Kind = Formulation::Angles;
    const auto any_nan = [](const Angles<double>& a) {
        return !(a.theta.allFinite() && a.a[0].allFinite() && a.a[1].allFinite() &&
                 a.a[2].allFinite());
    };
    for (const double off : {0., 1e-8, -1e-8}) {
        EXPECT_TRUE(any_nan(angles_of(Kind::cardan, turn(M_PI / 2 + off, Y))));
        EXPECT_TRUE(
            any_nan(angles_of(Kind::projected, turn(M_PI / 2 + off, X) * turn(M_PI / 2, Y))));
        for (const Vector3d& axis : {X, Y, Z})
            for (const Kind kind : {Kind::rotation_vector, Kind::projected}) {
                if (kind == Kind::projected && axis == Y) continue;
                EXPECT_TRUE(any_nan(angles_of(kind, turn(M_PI + off, axis)))) << axis.transpose();
            }
        EXPECT_TRUE(std::isnan(half_turn(turn(M_PI + off, Vector3d(0.6, 0, 0.8))).t[0]));
    }
    for (const double angle : {1.5, -1.5, 3., -3.})
        for (const Vector3d& axis : {X, Z})
            for (const Kind kind : {Kind::rotation_vector, Kind::projected, Kind::cardan}) {
                // In the projection along y, z of j points backwards after a quarter turn about x:
                // θ_y is half a turn.
                if (kind == Kind::projected && axis == X && std::abs(angle) > 2) continue;
                EXPECT_NEAR(angles_of(kind, turn(angle, axis)).theta.dot(axis), angle, 1e-14);
            }
}

// Two blocks on a bushing of every formulation, with curves for every other, followers, a brake, a
// road and a stop.
Scene every_formulation(Random& random) {
    // A rising cubic between knots at ±1.5.
    const auto curve = [&](double rate) {
        return hermite({-1.5, 1.5}, {-1.5 * rate, 2 * rate}, {random(0.5, 0.8) * rate, rate});
    };
    Scene s;
    s.name = "every formulation";
    s.bodies = {{"a", {0.1 * X, random.rotation()}}, {"b", {{-0.1, 0.1, 0}, random.rotation()}}};
    int n = 0;
    using Frame = Formulation::Frame;
    using Angles = Formulation::Angles;
    for (const Frame frame : {Frame::on_i, Frame::middle})
        for (const Angles angles : {Angles::rotation_vector, Angles::cardan, Angles::projected})
            for (const bool conjugate : {true, false})
                for (const bool offset : {true, false}) {
                    if (frame == Frame::middle && !conjugate) continue;
                    Bushing b{{++n % 3 == 0 ? ground : 0, random.vector(0.3), random.rotation()},
                              {1, random.vector(0.3)},
                              LinearStiffness{random.stiffness()}};
                    if (n % 2 == 1) {
                        PerAxis law;
                        for (std::size_t k = 0; k < 6; ++k)
                            law.axis[k] = k % 3 == 1 ? ScalarLaw{LinearRate{k < 3 ? 2e5 : 800.}}
                                                     : ScalarLaw{curve(k < 3 ? 2e5 : 800.)};
                        b.law = law;
                    }
                    b.preload = random.wrench(500, 20);
                    b.undeformed = random.wrench(0.01, 0.1);
                    b.formulation = {frame, angles, conjugate, offset};
                    const Quaterniond i =
                        b.i.body == ground ? b.i.A_local : s.bodies[0].design.p * b.i.A_local;
                    b.j.A_local = s.bodies[1].design.p.conjugate() * i *
                                  Eigen::AngleAxisd(0.4, random.unit());
                    s.elastics.push_back({fmt::format("bushing {}", n), b});
                }
    s.elastics.push_back({"stop", AxialSpring{{0, 0.2 * X}, {ground, X}, curve(3e5), 0.5}});
    s.branches = {branch_of({{Load{"f", FollowerForce{{0, {0.1, 0.2, 0.3}}, {1, 2, 3}}}, 0, 1},
                             {Load{"m", FollowerMoment{1, {0.1, -0.2, 0.3}}}, 0, 1},
                             {Load{"brake", BrakeForce{{0, {0.3, 0, -0.2}}, 1, {1, 2, -3}}}, 0, 1},
                             {FreeLength{0}, 1e-3, 2e-5}},
                            1000)};
    s.probes = {{"a", {0}}};
    return s;
}

// Automatic differentiation against central differences of sixth order, at design poses (θ = 0,
// where series replace 0/0) and away from them.
TEST(EquilibriumElements, JacobianIsTheDerivativeOfTheResidual) {
    Random random;
    Worst worst;
    for (const auto& s : {rich_scene(), every_formulation(random), scene("chrono_mcpherson"),
                          scene("pendulum"), scene("two_spring_arch")}) {
        const Model model = compile(s);
        const std::vector<double> loads = {1000};
        const System system = make_system(model, model.branches[0], loads);
        EXPECT_EQ(system.conservative, s.name != "every formulation");
        const int n = system.equations();
        const double h = system.conservative ? 2e-3 : 5e-4;
        for (const double away : {0., 1e-9, 1e-3, system.conservative ? 0.3 : 0.1}) {
            const Eigen::VectorXd x =
                equilibrium::moved(system, design_unknowns(system), random.many(n, away));
            Counts counts;
            const Derivatives found = derivatives(system, {700, 0, 1}, x, counts);
            const Eigen::MatrixXd J = found.J;
            const auto over_a = [&](double a) { return residual(system, {a}, x); };
            const Eigen::VectorXd E_rate =
                (8 * (over_a(701) - over_a(699)) - (over_a(702) - over_a(698))) / 12;
            worst.add((found.E_rate - E_rate).cwiseAbs().maxCoeff(),
                      s.name + " over the parameter");
            for (int k = 0; k < n; ++k) {
                const auto E = [&](double by) {
                    return residual(
                        system, {700},
                        equilibrium::moved(system, x, by * h * Eigen::VectorXd::Unit(n, k)));
                };
                const Eigen::VectorXd differences =
                    (45 * (E(1) - E(-1)) - 9 * (E(2) - E(-2)) + (E(3) - E(-3))) / (60 * h);
                worst.add((J.col(k) - differences).cwiseAbs().maxCoeff() / J.cwiseAbs().maxCoeff(),
                          fmt::format("{}, {} away, column {}", s.name, away, k));
            }
        }
    }
    EXPECT_TRUE(within(worst, 1e-9));
}

// A formulation that compile() never passes to a leg is misuse.
TEST(EquilibriumElements, UnsupportedFormulationIsRejected) {
    Scene s = hinged_bar(0.3 * X, Y, 100);
    s.branches = {twist(0, Y)};
    Model model = compile(s);
    auto& formulation = std::get<Bushing>(model.elastics[0].kind).formulation;
    const std::vector<double> loads = {0};
    for (const Formulation& none :
         {Formulation{Formulation::Frame::on_j},
          Formulation{Formulation::Frame::middle, Formulation::Angles::projected, false}}) {
        formulation = none;
        EXPECT_THROW(solve(model, model.branches[0], loads), std::invalid_argument);
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
