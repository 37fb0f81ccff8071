// The coefficients of the full equations against the equations themselves: whatever polynomial x(τ) is put
// in, Σ G_k τ^k and Σ Φ_k τ^k are what G and Φ are at the configuration x(τ) leads to. Nothing is solved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recursive/assembly.hpp"
#include "recursive/series/expand.hpp"
#include "tests/recursive/random.hpp"

namespace elastocheck::recursive::series {
namespace {

constexpr BodyId bodies = 2;
const std::vector<std::pair<BodyId, BodyId>> sides{{0, 1}, {1, 0}, {ground, 0}, {0, ground}, {1, ground}};

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

// Coefficients that fall as 4^-k, so that orders up to 20 count at τ near one.
void expect_same(const Case& c, Random& random, const std::string& what) {
    constexpr int p = 30;
    const int n = coordinates(c.model), m = constraint_rows(c.model);
    Vector<double> lambda(m), load(p + 1);
    for (auto& value : lambda) value = random(-1e3, 1e3);
    load[0] = random(-1, 1);
    Equations e = equations(c.model, c.branch, p);
    begin(e, c.model, c.branch, c.q, lambda, load[0]);
    evaluate(e, c.model, c.branch, {0, Pass::known});
    Matrix<double> x = Matrix<double>::Zero(n + m, p + 1), left(n + m, p + 1);
    x.col(0).tail(m) = lambda;
    left.col(0) << e.G, e.Phi;
    for (int k = 1; k <= p; ++k) {
        const double size = 0.2 * std::pow(0.25, k);
        for (int row = 0; row < n + m; ++row) x(row, k) = random(-size, size) * (row < n ? 1 : 1e3);
        load[k] = random(-size, size);
        assign(e, k, x.col(k), load[k]);
        evaluate(e, c.model, c.branch, {k, Pass::known});
        left.col(k) << e.G, e.Phi;
    }
    for (const double tau : {-1.0, -0.4, 0.3, 1.0}) {
        Vector<double> at, sum, a, f, Phi(m), part;
        horner(x, tau, at);
        horner(left, tau, sum);
        horner(load.transpose(), tau, a);
        State<double> q = c.q;
        displace(c.q, at, q);
        constraint_force<double>(c.model, q, at.tail(m), f, Phi);
        elastic_force<double>(c.model, q, part);
        f += part;
        external_force<double>(c.model, c.branch, a[0], q, part);
        f -= part;
        EXPECT_LE((sum.head(n) - f).norm(), 1e-12 * left.topRows(n).norm()) << what << ", τ = " << tau;
        EXPECT_LE((sum.tail(m) - Phi).norm(), 1e-12 * (1 + left.bottomRows(m).norm()))
            << what << ", τ = " << tau;
    }
    // Order by order that is no accident: the last orders are there, and count.
    EXPECT_GT(left.middleCols(8, 4).norm(), 0) << what;
}

Marker marker(BodyId body, Random& random) { return {body, random.vector(), random.rotation()}; }

TEST(SeriesEquations, HoldForEveryConstraintBetweenAnyBodies) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 10; ++trial) {
            const Point at_i{i, random.vector()}, at_j{j, random.vector()};
            const Direction along_i{i, random.unit()}, along_j{j, random.unit()};
            const std::vector<ConstraintKind> kinds{
                CoincidentPoints{at_i, at_j}, PointInPlane{at_i, at_j, along_j},
                PerpendicularDirections{along_i, along_j}, DistanceBetween{at_i, at_j, random(0.3, 2)}};
            for (const auto& kind : kinds) {
                Case c = anywhere(random);
                c.model.constraints.push_back({0, kind});
                expect_same(c, random, fmt::format("constraint {} between {} and {}", kind.index(), i, j));
            }
        }
}

TEST(SeriesEquations, HoldForASpringBetweenAnyBodies) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 20; ++trial) {
            Case c = anywhere(random);
            const AxialSpring e{{i, random.vector()}, {j, random.vector()}, 3e4, random(0.1, 3)};
            // Near to ends that meet the force is not analytic.
            if ((c.q[i].r + c.q[i].lever(e.i.s_local) - c.q[j].r - c.q[j].lever(e.j.s_local)).norm() < 1)
                continue;
            c.model.elastics.push_back({"spring", e});
            expect_same(c, random, fmt::format("spring between {} and {}", i, j));
        }
}

TEST(SeriesEquations, HoldForAnyBushingBetweenAnyBodiesAtAnyAngle) {
    // Rates that couple, different about every axis, with preload.
    Random random;
    for (const auto& [i, j] : sides)
        for (const double angle : {0.0, 1e-9, 1e-4, 0.04, 0.3, 1.0, 2.0}) {
            Case c = anywhere(random);
            Bushing e{marker(i, random), marker(j, random), random.stiffness(), {}};
            e.preload = Vector6<double>::NullaryExpr([&] { return random(-500, 500); });
            const Eigen::Quaterniond turn = exponential<double>(angle * random.unit());
            e.j.A_local = c.q[j].p.conjugate() * c.q[i].p * e.i.A_local * turn;
            c.model.elastics.push_back({"bushing", e});
            expect_same(c, random, fmt::format("bushing between {} and {} at {} rad", i, j, angle));
        }
}

TEST(SeriesEquations, HoldForForcesAndMomentsOfBothKindsOfLoad) {
    Random random;
    for (BodyId body = 0; body < bodies; ++body) {
        Case c = anywhere(random);
        for (auto* loads : {&c.model.static_loads, &c.branch.loads}) {
            loads->push_back({"force", DeadForce{{body, random.vector()}, random.vector(1e3)}});
            loads->push_back({"moment", DeadMoment{body, random.vector(1e3)}});
        }
        expect_same(c, random, fmt::format("loads on {}", body));
    }
}

}  // namespace
}  // namespace elastocheck::recursive::series
