// Bushing formulations of the equilibrium leg: singular angles, derivatives, misuse.
#include <fmt/format.h>

#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/statement/equations.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

using Kind = Formulation::Angles;
using On = Formulation::Frame;

// Smooth over ±1: rising cubics between knots at ±1.5, other slopes outside.
Curve some_curve(std::mt19937& random, double rate) {
    std::uniform_real_distribution<double> in(0.3, 1);
    const double c_1 = rate * in(random), c_2 = 0.3 * rate * in(random), c_3 = rate * in(random),
                 w = 1.5;
    // about 0: c_1 x + c_2 x² + c_3 x³, expanded about -w
    const auto f = [&](double x) { return c_1 * x + c_2 * x * x + c_3 * x * x * x; };
    return {{-w, w},
            {{f(-w), rate, 0, 0},
             {f(-w), c_1 - 2 * c_2 * w + 3 * c_3 * w * w, c_2 - 3 * c_3 * w, c_3},
             {f(w), rate, 0, 0}}};
}

Bushing some_bushing(std::mt19937& random, bool per_axis) {
    Bushing b{{0, random_vector(random, 0.3), random_turn(random)},
              {1, random_vector(random, 0.3), random_turn(random)},
              LinearStiffness{random_stiffness(random)}};
    if (per_axis) {
        PerAxis law;
        for (std::size_t k = 0; k < 6; ++k)
            law.axis[k] = k % 3 == 1 ? ScalarLaw{LinearRate{k < 3 ? 2e5 : 800.}}
                                     : ScalarLaw{some_curve(random, k < 3 ? 2e5 : 800.)};
        b.law = law;
    }
    b.preload << random_vector(random, 500), random_vector(random, 20);
    b.undeformed << random_vector(random, 0.01), random_vector(random, 0.1);
    return b;
}

Quaterniond turn_by(std::mt19937& random, double angle) {
    return Quaterniond(Eigen::AngleAxisd(angle, random_vector(random, 1).normalized()));
}

// ---- Singularities of the angles

TEST(EquilibriumFormulations, WhereAnAngleHasNoValueThereIsNoNumber) {
    const auto turn = [](double angle, const Vector3d& axis) {
        return Quaterniond(Eigen::AngleAxisd(angle, axis));
    };
    const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
    const auto any_nan = [](const Angles<double>& a) {
        return !(a.theta.allFinite() && a.a[0].allFinite() && a.a[1].allFinite() &&
                 a.a[2].allFinite());
    };
    for (const double off : {0., 1e-8, -1e-8}) {
        EXPECT_TRUE(any_nan(angles_of(Kind::cardan, turn(M_PI / 2 + off, y))));
        EXPECT_TRUE(
            any_nan(angles_of(Kind::projected, turn(M_PI / 2 + off, x) * turn(M_PI / 2, y))));
        for (const Vector3d& axis : {x, y, z})
            for (const Kind kind : {Kind::rotation_vector, Kind::projected}) {
                if (kind == Kind::projected && axis == y) continue;
                EXPECT_TRUE(any_nan(angles_of(kind, turn(M_PI + off, axis)))) << axis.transpose();
            }
        EXPECT_TRUE(std::isnan(half_turn(turn(M_PI + off, Vector3d(0.6, 0, 0.8))).t[0]));
    }
    for (const double angle : {1.5, -1.5, 3., -3.})
        for (const Vector3d& axis : {x, z})
            for (const Kind kind : {Kind::rotation_vector, Kind::projected, Kind::cardan}) {
                // In the projection along y, z of j points backwards after a quarter turn about x:
                // θ_y is half a turn.
                if (kind == Kind::projected && axis == x && std::abs(angle) > 2) continue;
                EXPECT_NEAR(angles_of(kind, turn(angle, axis)).theta.dot(axis), angle, 1e-14);
            }
}

// ---- In a scene

// A block on six bushings, one of each kind, with a follower and a stop: automatic differentiation
// of all of them against differences.
TEST(EquilibriumFormulations, TheJacobianIsTheDerivativeOfTheResidual) {
    std::mt19937 random(46);
    Scene s;
    s.name = "all";
    s.bodies = {{"a", {{0.1, 0, 0}, random_turn(random)}},
                {"b", {{-0.1, 0.1, 0}, random_turn(random)}}};
    int n = 0;
    for (const On frame : {On::on_i, On::middle})
        for (const Kind angles : {Kind::rotation_vector, Kind::cardan, Kind::projected})
            for (const bool conjugate : {true, false})
                for (const bool offset : {true, false}) {
                    if (frame == On::middle && !conjugate) continue;
                    Bushing b = some_bushing(random, ++n % 2 == 1);
                    b.formulation = {frame, angles, conjugate, offset};
                    b.i.body = n % 3 == 0 ? ground : 0;
                    b.j.body = 1;
                    const auto axes = [&](const Marker& m) {
                        return m.body == ground
                                   ? m.A_local
                                   : s.bodies[static_cast<std::size_t>(m.body)].design.p *
                                         m.A_local;
                    };
                    b.j.A_local =
                        s.bodies[1].design.p.conjugate() * axes(b.i) * turn_by(random, 0.4);
                    s.elastics.push_back({fmt::format("bushing {}", n), b});
                }
    s.elastics.push_back(
        {"stop", AxialSpring{{0, {0.2, 0, 0}}, {ground, {1, 0, 0}}, some_curve(random, 3e5), 0.5}});
    s.branches = {branch_of("follow",
                            {driven_by({"f", FollowerForce{{0, {0.1, 0.2, 0.3}}, {1, 2, 3}}}),
                             driven_by({"m", FollowerMoment{1, {0.1, -0.2, 0.3}}})},
                            1000, 1)};
    s.probes = {{"a", {0, {0, 0, 0}}}};
    const Model model = compile(s);
    const std::vector<double> loads = {1000};
    const System system = make_system(model, model.branches[0], loads);
    EXPECT_FALSE(system.conservative);
    Worst worst;
    for (const double away : {0., 1e-3, 0.1}) {
        const Eigen::VectorXd off =
            away * Eigen::VectorXd::NullaryExpr(
                       12, [&] { return std::uniform_real_distribution<double>(-1, 1)(random); });
        const Eigen::VectorXd x = equilibrium::moved(system, design_unknowns(system), off);
        Counts counts;
        const Eigen::MatrixXd J = derivatives(system, {700}, x, counts).J;
        for (int k = 0; k < 12; ++k) {
            const auto E = [&](double h) {
                return residual(system, {700},
                                equilibrium::moved(system, x, h * Eigen::VectorXd::Unit(12, k)));
            };
            const double h = 5e-4;
            const Eigen::VectorXd differences =
                (45 * (E(h) - E(-h)) - 9 * (E(2 * h) - E(-2 * h)) + (E(3 * h) - E(-3 * h))) /
                (60 * h);
            worst.see((J.col(k) - differences).cwiseAbs().maxCoeff() / J.cwiseAbs().maxCoeff(),
                      fmt::format("{} away, column {}", away, k));
        }
    }
    EXPECT_TRUE(within(worst, 1e-9));
}

// A formulation that compile() never passes to a leg is misuse.
TEST(EquilibriumFormulations, AFrameThatThisLegHasNoLawForIsMisuse) {
    Scene s = hinged_bar({0.3, 0, 0}, {0, 1, 0}, 100);
    s.branches = {twist(0, {0, 1, 0})};
    Model model = compile(s);
    auto& formulation = std::get<Bushing>(model.elastics[0].kind).formulation;
    const std::vector<double> loads = {0};
    for (const Formulation& none :
         {Formulation{On::on_j}, Formulation{On::middle, Kind::projected, false}}) {
        formulation = none;
        EXPECT_THROW(solve(model, model.branches[0], loads), std::invalid_argument);
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
