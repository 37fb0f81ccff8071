// Series coefficients of the full equations against direct evaluation.
// For any polynomial x(τ), Σ G_k τ^k and Σ Φ_k τ^k equal G and Φ at the configuration x(τ). Nothing
// is solved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/pieces.hpp"
#include "tests/recursive/random.hpp"

namespace elastocheck::recursive::series {
namespace {

constexpr BodyId bodies = 2;
const std::vector<std::pair<BodyId, BodyId>> sides{
    {0, 1}, {1, 0}, {ground, 0}, {0, ground}, {1, ground}};

struct Case {
    Model model;
    Branch branch;
    State<double> q;
};

Case anywhere(Random& random) {
    Case c;
    c.model.bodies.resize(bodies);
    c.q = random.state(bodies);
    return c;
}

// Coefficients fall as 4^-k, so that orders up to 20 are significant at τ near one.
void expect_same(const Case& c, Random& random, const std::string& what, Drive drive) {
    constexpr int p = 30;
    const int n = coordinates(c.model), m = constraint_rows(c.model);
    Vector<double> lambda(m), load(p + 1);
    for (auto& value : lambda) value = random(-1e3, 1e3);
    load[0] = random(-1, 1);
    Equations<double> e = equations<double>(c.model, c.branch, p, drive);
    for (auto& value : e.G_d) value = random(-1e3, 1e3);
    for (auto& value : e.Phi_d) value = random(-0.1, 0.1);
    begin(e, c.q, lambda, load[0]);
    evaluate(e, {0, Pass::known});
    std::vector<CurvePiece> curves = curves_of(c.model);
    for (auto& curve : curves) {
        find_piece(e, curve);
        set_piece(curve, e);
    }
    evaluate(e, {0, Pass::known});
    Matrix<double> x = Matrix<double>::Zero(n + m, p + 1), left(n + m, p + 1);
    x.col(0).tail(m) = lambda;
    left.col(0) << e.G, e.Phi;
    for (int k = 1; k <= p; ++k) {
        const double size = 0.2 * std::pow(0.25, k);
        for (int row = 0; row < n + m; ++row) x(row, k) = random(-size, size) * (row < n ? 1 : 1e3);
        load[k] = random(-size, size);
        assign(e, k, x.col(k), load[k]);
        evaluate(e, {k, Pass::known});
        left.col(k) << e.G, e.Phi;
    }
    const Inputs<double> drawn = inputs_as_drawn<double>(c.model);
    Inputs<double> inputs;
    for (const double tau : {-1.0, -0.4, 0.3, 1.0}) {
        Vector<double> at, sum, a, f, Phi(m), part;
        horner(x, tau, at);
        horner(left, tau, sum);
        horner(load.transpose(), tau, a);
        State<double> q = c.q;
        displace(c.q, at, q);
        if (drive == Drive::start)
            set_inputs<double>(c.model, c.branch, drawn, a[0], 0, inputs);
        else
            set_inputs<double>(c.model, c.branch, drawn, 1, a[0], inputs);
        for (const auto& curve : curves) set_piece(curve, inputs);
        constraint_force<double>(c.model, inputs, q, at.tail(m), f, Phi);
        elastic_force<double>(c.model, inputs, q, part);
        f += part;
        external_force<double>(c.model, c.branch, inputs, q, part);
        f -= part;
        if (drive == Drive::start) {
            f -= (1 - a[0]) * e.G_d;
            Phi -= (1 - a[0]) * e.Phi_d;
        }
        EXPECT_LE((sum.head(n) - f).norm(), 1e-12 * left.topRows(n).norm())
            << what << ", τ = " << tau;
        EXPECT_LE((sum.tail(m) - Phi).norm(), 1e-12 * (1 + left.bottomRows(m).norm()))
            << what << ", τ = " << tau;
    }
    // The agreement is significant: the last orders are not zero.
    EXPECT_GT(left.middleCols(8, 4).norm(), 0) << what;
}
void expect_same(const Case& c, Random& random, const std::string& what) {
    expect_same(c, random, what, Drive::rate);
    expect_same(c, random, what + " while settling", Drive::start);
}

Marker marker(BodyId body, Random& random) { return {body, random.vector(), random.rotation()}; }

DirectionAtAngle angle_between(const Direction& i, const Direction& x, Random& random) {
    return {i, x, {x.body, x.u_local.cross(random.unit()).normalized()}, random(-3, 3)};
}

TEST(SeriesEquations, HoldForEveryConstraintBetweenAnyBodies) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 10; ++trial) {
            const Point at_i{i, random.vector()}, at_j{j, random.vector()};
            const Direction along_i{i, random.unit()}, along_j{j, random.unit()};
            const std::vector<ConstraintKind> kinds{CoincidentPoints{at_i, at_j},
                                                    PointInPlane{at_i, at_j, along_j, random()},
                                                    PerpendicularDirections{along_i, along_j},
                                                    DistanceBetween{at_i, at_j, random(0.3, 2)},
                                                    angle_between(along_i, along_j, random)};
            for (const auto& kind : kinds) {
                Case c = anywhere(random);
                c.model.constraints.push_back({0, kind});
                expect_same(c, random,
                            fmt::format("constraint {} between {} and {}", kind.index(), i, j));
            }
        }
}

TEST(SeriesEquations, HoldForABushingWithoutMoments) {
    Random random;
    for (const auto& [i, j] : sides) {
        Case c = anywhere(random);
        Matrix6<double> K = Matrix6<double>::Zero();
        K.topLeftCorner<3, 3>() = random.stiffness().topLeftCorner<3, 3>();
        c.model.elastics.push_back({"mount", Bushing{marker(i, random), marker(j, random),
                                                     LinearStiffness{K}, Vector6<double>::Zero()}});
        expect_same(c, random, fmt::format("mount between {} and {}", i, j));
        // Until a driver adds a moment.
        Preload preload{0, Vector6<double>::Zero()};
        preload.direction.tail<3>() = random.vector(50);
        c.branch.drivers.push_back({preload, random(), random()});
        expect_same(c, random, fmt::format("twisted mount between {} and {}", i, j));
    }
}

// Three knots, four arbitrary polynomial pieces: the equations do not require continuity.
Curve curve(Random& random, double size, double force) {
    Curve f;
    for (int k = 0; k < 3; ++k) f.knots.push_back(size * (k - 1 + random(-0.3, 0.3)));
    for (int k = 0; k < 4; ++k) {
        f.pieces.emplace_back();
        double unit = force;
        for (auto& c : f.pieces.back()) {
            c = unit * random();
            unit /= size;
        }
    }
    f.pieces.front()[2] = f.pieces.front()[3] = f.pieces.back()[2] = f.pieces.back()[3] = 0;
    return f;
}
Bushing any_bushing(BodyId i, BodyId j, double angle, const State<double>& q, Random& random) {
    Bushing e{marker(i, random), marker(j, random), LinearStiffness{random.stiffness()}};
    e.preload = Vector6<double>::NullaryExpr([&] { return random(-500, 500); });
    e.undeformed = Vector6<double>::NullaryExpr([&] { return random(-0.3, 0.3); });
    e.j.A_local =
        q[j].p.conjugate() * q[i].p * e.i.A_local * exponential<double>(angle * random.unit());
    return e;
}

TEST(SeriesEquations, HoldForASpringOnAnyPieceOfACurve) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 20; ++trial) {
            Case c = anywhere(random);
            const AxialSpring e{{i, random.vector()},
                                {j, random.vector()},
                                curve(random, 0.5, 1e4),
                                random(0.1, 3)};
            if ((c.q[i].r + c.q[i].lever(e.i.s_local) - c.q[j].r - c.q[j].lever(e.j.s_local))
                    .norm() < 1)
                continue;
            c.model.elastics.push_back({"spring", e});
            c.branch.drivers.push_back({FreeLength{0}, random(), random()});
            expect_same(c, random, fmt::format("curve between {} and {}", i, j));
        }
}

TEST(SeriesEquations, HoldForEveryFormulationOfABushing) {
    Random random;
    using Frame = Formulation::Frame;
    using Angles = Formulation::Angles;
    int formulations = 0;
    for (const Frame frame : {Frame::on_i, Frame::middle})
        for (const Angles angles : {Angles::rotation_vector, Angles::cardan, Angles::projected})
            for (const bool conjugate : {true, false})
                for (const bool offset_moment : {true, false}) {
                    if (!conjugate && frame != Frame::on_i) continue;
                    ++formulations;
                    for (const auto& [i, j] : sides)
                        for (const double angle : {0.0, 1e-9, 1e-4, 0.04, 0.3, 0.9, 2.0}) {
                            if (angle > 1 && angles != Angles::rotation_vector) continue;
                            Case c = anywhere(random);
                            Bushing e = any_bushing(i, j, angle, c.q, random);
                            e.formulation = {frame, angles, conjugate, offset_moment};
                            c.model.elastics.push_back({"bushing", e});
                            Preload preload{0, Vector6<double>::Zero()};
                            for (auto& value : preload.direction) value = random(-500, 500);
                            c.branch.drivers.push_back({preload, random(), random()});
                            const std::string what = fmt::format(
                                "frame {}, angles {}, conjugate {}, offset moment {}: {} to {} at "
                                "{} rad",
                                static_cast<int>(frame), static_cast<int>(angles), conjugate,
                                offset_moment, i, j, angle);
                            expect_same(c, random, what);
                            PerAxis law;
                            for (auto& axis : law.axis) axis = curve(random, 0.5, 1e3);
                            law.axis[1] = LinearRate{3e5};
                            law.axis[4] = LinearRate{70};
                            std::get<Bushing>(c.model.elastics[0].kind).law = law;
                            expect_same(c, random, what + " on curves");
                            for (int k = 3; k < 6; ++k)
                                law.axis[static_cast<std::size_t>(k)] = LinearRate{0};
                            std::get<Bushing>(c.model.elastics[0].kind).law = law;
                            std::get<Bushing>(c.model.elastics[0].kind).preload.tail<3>().setZero();
                            c.branch.drivers.clear();
                            expect_same(c, random, what + " without moments");
                        }
                }
    EXPECT_EQ(formulations, 18);  // 2 frames, 3 angles, 2 offsets; on i also not conjugate
}

TEST(SeriesEquations, HoldForFollowers) {
    Random random;
    for (BodyId body = 0; body < bodies; ++body) {
        Case c = anywhere(random);
        const Load force{"force", FollowerForce{{body, random.vector()}, random.vector(1e3)}},
            moment{"moment", FollowerMoment{body, random.vector(1e3)}};
        c.model.static_loads = {force, moment};
        for (const auto& load : {force, moment, force})
            c.branch.drivers.push_back({load, random(), random()});
        expect_same(c, random, fmt::format("followers on {}", body));
    }
}

TEST(SeriesEquations, HoldForStaticAndDrivenLoads) {
    Random random;
    for (BodyId body = 0; body < bodies; ++body) {
        Case c = anywhere(random);
        const Load force{"force", DeadForce{{body, random.vector()}, random.vector(1e3)}},
            moment{"moment", DeadMoment{body, random.vector(1e3)}};
        c.model.static_loads = {force, moment};
        for (const auto& load : {force, moment, force})
            c.branch.drivers.push_back({load, random(), random()});
        expect_same(c, random, fmt::format("loads on {}", body));
    }
}

TEST(SeriesEquations, HoldForEveryDrivenOffset) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 10; ++trial) {
            const Point at_i{i, random.vector()}, at_j{j, random.vector()};
            const Direction along_i{i, random.unit()}, along_j{j, random.unit()};
            const std::vector<ConstraintKind> kinds{PointInPlane{at_i, at_j, along_j, random()},
                                                    DistanceBetween{at_i, at_j, random(2, 4)},
                                                    angle_between(along_i, along_j, random)};
            for (const auto& kind : kinds) {
                Case c = anywhere(random);
                c.model.joints.push_back({.name = "joint", .at = {}, .driven = 0});
                c.model.constraints.push_back({0, kind});
                // Two drivers of one joint are added.
                for (int k = 0; k < 2; ++k)
                    c.branch.drivers.push_back({Motion{0}, random(0, 0.3), random(0, 0.3)});
                expect_same(c, random,
                            fmt::format("offset {} between {} and {}", kind.index(), i, j));
            }
        }
}

TEST(SeriesEquations, HoldForDrivenFreeLengthsAndPreloads) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 10; ++trial) {
            Case c = anywhere(random);
            const AxialSpring spring{
                {i, random.vector()}, {j, random.vector()}, LinearRate{3e4}, random(0.1, 3)};
            if ((c.q[i].r + c.q[i].lever(spring.i.s_local) - c.q[j].r -
                 c.q[j].lever(spring.j.s_local))
                    .norm() < 1)
                continue;
            c.model.elastics.push_back({"spring", spring});
            Bushing bushing{marker(i, random), marker(j, random),
                            LinearStiffness{random.stiffness()}, Vector6<double>::Zero()};
            bushing.j.A_local = c.q[j].p.conjugate() * c.q[i].p * bushing.i.A_local *
                                exponential<double>(random(0, 1.5) * random.unit());
            c.model.elastics.push_back({"bushing", bushing});
            c.branch.drivers.push_back({FreeLength{0}, random(), random()});
            Preload preload{1, Vector6<double>::Zero()};
            for (auto& value : preload.direction) value = random(-500, 500);
            c.branch.drivers.push_back({preload, random(), random()});
            expect_same(c, random, fmt::format("moving elements between {} and {}", i, j));
        }
}

}  // namespace
}  // namespace elastocheck::recursive::series
