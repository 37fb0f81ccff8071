// Bushing formulations of the equilibrium leg: forces against numerical gradients of independently
// implemented energies, and against hand calculation where there is no energy.
#include <fmt/format.h>

#include "models/laws.hpp"
#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/statement/equations.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

using Kind = Formulation::Angles;
using On = Formulation::Frame;

const char* name(Kind kind) {
    return kind == Kind::rotation_vector ? "rotation vector"
           : kind == Kind::cardan        ? "cardan"
                                         : "projected";
}

// ---- The energies

// ∫₀ˣ f by Simpson's rule, exact for cubics, from knot to knot.
double work(const Curve& curve, double x) {
    const auto f = [&](double at) {
        std::size_t k = 0;
        while (k < curve.knots.size() && at >= curve.knots[k]) ++k;
        const auto& c = curve.pieces[k];
        const double h = at - curve.knots[k == 0 ? 0 : k - 1];
        return c[0] + c[1] * h + c[2] * h * h + c[3] * h * h * h;
    };
    std::vector<double> ends = {0, x};
    for (const double knot : curve.knots)
        if (knot > std::min(0., x) && knot < std::max(0., x)) ends.push_back(knot);
    std::ranges::sort(ends);
    double sum = 0;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double a = ends[k], b = ends[k + 1], eps = 1e-12 * (b - a);
        sum += (b - a) / 6 * (f(a) + 4 * f((a + b) / 2) + f(b - eps));
    }
    return x < 0 ? -sum : sum;
}
double work(const ScalarLaw& law, double x) {
    if (const auto* u = std::get_if<LinearRate>(&law)) return u->k * x * x / 2;
    return work(std::get<Curve>(law), x);
}
double work(const SpatialLaw& law, const Vector6& e) {
    if (const auto* u = std::get_if<LinearStiffness>(&law)) return 0.5 * e.dot(u->K * e);
    double sum = 0;
    for (std::size_t k = 0; k < 6; ++k)
        sum += work(std::get<PerAxis>(law).axis[k], e[static_cast<int>(k)]);
    return sum;
}

Vector6 deformation_of(const Bushing& b, const Pose& i, const Pose& j) {
    const Matrix3d A_i = (i.p * b.i.A_local).toRotationMatrix(),
                   A_j = (j.p * b.j.A_local).toRotationMatrix(), B = A_i.transpose() * A_j;
    const Eigen::AngleAxisd turn(B);
    Matrix3d A_f = A_i;
    if (b.formulation.frame == On::on_j) A_f = A_j;
    if (b.formulation.frame == On::middle)
        A_f = A_i * Eigen::AngleAxisd(turn.angle() / 2, turn.axis()).toRotationMatrix();
    Vector6 e;
    e.head<3>() = A_f.transpose() * (j.r + j.p * b.j.s_local - i.r - i.p * b.i.s_local);
    switch (b.formulation.angles) {
        case Kind::rotation_vector: e.tail<3>() = turn.angle() * turn.axis(); break;
        case Kind::cardan:
            e.tail<3>() << std::atan2(-B(1, 2), B(2, 2)), std::asin(B(0, 2)),
                std::atan2(-B(0, 1), B(0, 0));
            break;
        case Kind::projected:
            e.tail<3>() << std::atan2(-B(1, 2), B(2, 2)), std::atan2(B(0, 2), B(2, 2)),
                std::atan2(B(1, 0), B(0, 0));
            break;
    }
    return e;
}
double energy_of(const Bushing& b, const Pose& i, const Pose& j) {
    // A frame on j is that of the bushing with exchanged ends.
    if (b.formulation.frame == On::on_j) {
        Bushing other = b;
        std::swap(other.i, other.j);
        other.formulation.frame = On::on_i;
        const Vector6 e = -deformation_of(other, j, i);
        return work(b.law, e - b.undeformed) + b.preload.dot(e);
    }
    const Vector6 e = deformation_of(b, i, j);
    return work(b.law, e - b.undeformed) + b.preload.dot(e);
}

// ---- Forces

using Wrenches = Eigen::Matrix<double, 12, 1>;  // (force; moment about the origin) on i, then on j

Wrenches wrenches(const Bushing& b, const Pose& i, const Pose& j) {
    const auto on = interaction(b, b.preload, true, all_by_themselves, Frame<double>{i.r, i.p},
                                Frame<double>{j.r, j.p});
    Wrenches w;
    w << on.i.force, on.i.moment + (on.i.at - i.r).cross(on.i.force), on.j.force,
        on.j.moment + (on.j.at - j.r).cross(on.j.force);
    return w;
}

Pose moved(Pose pose, int coordinate, double by) {
    if (coordinate < 3)
        pose.r[coordinate] += by;
    else
        pose.p = Quaterniond(Eigen::AngleAxisd(by, Vector3d::Unit(coordinate - 3))) * pose.p;
    return pose;
}

Wrenches negative_gradient(const Bushing& b, const Pose& i, const Pose& j) {
    const auto slope = [](const auto& U) {
        const double h = 5e-4;
        return (45 * (U(h) - U(-h)) - 9 * (U(2 * h) - U(-2 * h)) + (U(3 * h) - U(-3 * h))) /
               (60 * h);
    };
    Wrenches w;
    for (int k = 0; k < 6; ++k) {
        w[k] = -slope([&](double h) { return energy_of(b, moved(i, k, h), j); });
        w[6 + k] = -slope([&](double h) { return energy_of(b, i, moved(j, k, h)); });
    }
    return w;
}

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

struct Poses {
    Pose i, j;
};
// Marker j rotated against marker i by `turn`, with a small offset.
Poses some_poses(std::mt19937& random, const Bushing& b, const Quaterniond& turn) {
    const Pose i{random_vector(random, 0.3), random_turn(random)};
    Pose j;
    j.p = i.p * b.i.A_local * turn * b.j.A_local.conjugate();
    j.r = i.r + i.p * b.i.s_local - j.p * b.j.s_local + random_vector(random, 0.05);
    return {i, j};
}
Quaterniond turn_by(std::mt19937& random, double angle) {
    return Quaterniond(Eigen::AngleAxisd(angle, random_vector(random, 1).normalized()));
}

TEST(EquilibriumFormulations, ForcesAreTheNegativeGradientOfTheEnergyWhereThereIsOne) {
    std::mt19937 random(41);
    Worst worst;
    for (const On frame : {On::on_i, On::middle})
        for (const Kind angles : {Kind::rotation_vector, Kind::cardan, Kind::projected})
            for (const bool per_axis : {false, true})
                for (const double angle : {0., 1e-9, 1e-4, 0.05, 0.3, 1.})
                    for (int trial = 0; trial < 20; ++trial) {
                        Bushing b = some_bushing(random, per_axis);
                        b.formulation = {frame, angles};
                        const auto [i, j] = some_poses(random, b, turn_by(random, angle));
                        const Wrenches by_hand = negative_gradient(b, i, j);
                        worst.see(
                            (wrenches(b, i, j) - by_hand).cwiseAbs().maxCoeff() /
                                by_hand.cwiseAbs().maxCoeff(),
                            fmt::format("{}, frame {}, {} rad", name(angles),
                                        frame == On::middle ? "in the middle" : "on i", angle));
                    }
    EXPECT_TRUE(within(worst, 2e-9));
}

// markers_swapped() converts a frame on j to one on i.
TEST(EquilibriumFormulations, AFrameOnJIsAFrameOnIOfTheBushingTurnedRound) {
    std::mt19937 random(42);
    Worst worst;
    for (const Kind angles : {Kind::rotation_vector, Kind::cardan, Kind::projected})
        for (int trial = 0; trial < 40; ++trial) {
            Bushing b = some_bushing(random, trial % 2 == 1);
            b.formulation = {On::on_j, angles};
            const auto [i, j] = some_poses(random, b, turn_by(random, 0.7));
            Wrenches turned = wrenches(markers_swapped(b), j, i),
                     by_hand = negative_gradient(b, i, j);
            const Vector6 on_j = turned.head<6>();
            turned.head<6>() = turned.tail<6>().eval();
            turned.tail<6>() = on_j;
            worst.see((turned - by_hand).cwiseAbs().maxCoeff() / by_hand.cwiseAbs().maxCoeff(),
                      fmt::format("{}, trial {}", name(angles), trial));
        }
    EXPECT_TRUE(within(worst, 2e-9));
}

// A frame in the middle is symmetric in both ends.
TEST(EquilibriumFormulations, InTheMiddleABushingIsItselfTurnedRound) {
    std::mt19937 random(43);
    Worst worst;
    for (int trial = 0; trial < 100; ++trial) {
        Bushing b = some_bushing(random, trial % 2 == 1);
        b.formulation.frame = On::middle;
        const auto [i, j] = some_poses(random, b, turn_by(random, 0.03 * trial));
        const Wrenches here = wrenches(b, i, j), there = wrenches(markers_swapped(b), j, i);
        worst.see(std::max((here.head<6>() - there.tail<6>()).cwiseAbs().maxCoeff(),
                           (here.tail<6>() - there.head<6>()).cwiseAbs().maxCoeff()) /
                      here.cwiseAbs().maxCoeff(),
                  fmt::format("trial {}", trial));
    }
    EXPECT_TRUE(within(worst, 1e-12));
}

// The three angle conventions agree for a rotation about one axis, and differ by the square of
// small angles.
TEST(EquilibriumFormulations, SmallAnglesAreTheSameInAllFormulations) {
    std::mt19937 random(44);
    for (const double angle : {1e-2, 1e-3, 1e-4}) {
        Worst worst;
        for (int trial = 0; trial < 30; ++trial) {
            Bushing b = some_bushing(random, false);
            b.preload.setZero(), b.undeformed.setZero();
            const auto [i, j] = some_poses(random, b, turn_by(random, angle));
            const Wrenches one = wrenches(b, i, j);
            for (const Kind angles : {Kind::cardan, Kind::projected}) {
                b.formulation.angles = angles;
                worst.see((wrenches(b, i, j) - one).norm() / one.norm() / angle,
                          fmt::format("{} rad, {}", angle, name(angles)));
            }
        }
        EXPECT_TRUE(within(worst, 3));
    }
}

// The commercial code's law by hand calculation: B = R_x(0.2) R_y(0.3), so z of j in axes of i is
// (sin 0.3, -sin 0.2 cos 0.3, cos 0.2 cos 0.3) and x of j is
// (cos 0.3, sin 0.2 sin 0.3, -cos 0.2 sin 0.3).
TEST(EquilibriumFormulations, TheCommercialLawIsItsFormula) {
    Bushing b{{0, {0.1, 0, 0}, Quaterniond::Identity()},
              {1, {0, 0, 0}, Quaterniond::Identity()},
              LinearStiffness{}};
    stiffness_of(b).K.diagonal() << 1e5, 2e5, 3e5, 100, 200, 300;
    b.preload << 10, 20, 30, 1, 2, 3;
    const Quaterniond B =
        Eigen::AngleAxisd(0.2, Vector3d::UnitX()) * Eigen::AngleAxisd(0.3, Vector3d::UnitY());
    const Pose i, j{{0.11, -0.02, 0.03}, B};
    const Vector3d force(1e5 * 0.01 + 10, -2e5 * 0.02 + 20, 3e5 * 0.03 + 30);
    const Vector3d angles(0.2, std::atan(std::tan(0.3) / std::cos(0.2)),
                          std::atan(std::sin(0.2) * std::tan(0.3)));
    const Vector3d moment(100 * angles[0] + 1, 200 * angles[1] + 2, 300 * angles[2] + 3);
    for (const bool offset : {true, false}) {
        b.formulation = {On::on_i, Kind::projected, false, offset};
        Wrenches by_hand;
        const Vector3d acts_at = offset ? j.r : Vector3d(0.1, 0, 0);
        // j's marker is its origin
        by_hand << force, moment + acts_at.cross(force), -force, -moment;
        const Wrenches w = wrenches(b, i, j);
        EXPECT_LT((w - by_hand).cwiseAbs().maxCoeff(), 1e-10) << w.transpose() << "\n"
                                                              << by_hand.transpose();
    }
}

// For any formulation and frame both forces are opposite; with the offset moment both moments about
// any point too, without it they differ by D × F.
TEST(EquilibriumFormulations, OnlyWithoutTheOffsetMomentIsThePairOutOfBalance) {
    std::mt19937 random(45);
    Worst worst;
    for (const On frame : {On::on_i, On::middle})
        for (const Kind angles : {Kind::rotation_vector, Kind::cardan, Kind::projected})
            for (const bool conjugate : {true, false})
                for (const bool offset : {true, false})
                    for (int trial = 0; trial < 20; ++trial) {
                        if (frame == On::middle && !conjugate) continue;
                        Bushing b = some_bushing(random, trial % 2 == 1);
                        b.formulation = {frame, angles, conjugate, offset};
                        const auto [i, j] = some_poses(random, b, turn_by(random, 0.8));
                        const Wrenches w = wrenches(b, i, j);
                        const Vector3d f = w.head<3>(), sum = f + w.segment<3>(6);
                        Vector3d moments =
                            w.segment<3>(3) + i.r.cross(f) + w.tail<3>() - j.r.cross(f);
                        const Vector3d D = j.r + j.p * b.j.s_local - i.r - i.p * b.i.s_local;
                        if (!offset) moments += D.cross(f);
                        worst.see((sum.norm() + moments.norm()) / w.norm(), name(angles));
                        EXPECT_TRUE(offset || D.cross(f).norm() > 1e-6 * w.norm());
                    }
    EXPECT_TRUE(within(worst, 1e-13));
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

// θ_y = M / k up to 90° and no further.
TEST(EquilibriumFormulations, CardanAnglesEndTheBranchAtAQuarterTurn) {
    Scene s = hinged_bar({0.3, 0, 0}, {0, 1, 0}, 100);
    std::get<Bushing>(s.elastics[0].kind).formulation.angles = Kind::cardan;
    s.branches = {twist(0, {0, 1, 0})};
    const Model model = compile(s);
    std::vector<double> loads;
    for (int n = 0; n <= 100; ++n) loads.push_back(4 * n);
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::branch_lost) << path.detail;
    EXPECT_NE(path.detail.find("'torsion' is turned to the end of its angles"), std::string::npos)
        << path.detail;
    ASSERT_EQ(path.points.size(), 40u);  // up to 156 N·m < 50 π
    for (const auto& state : path.points)
        EXPECT_NEAR(state.poses[0].p.angularDistance(Quaterniond::Identity()), state.load / 100,
                    1e-10);
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
