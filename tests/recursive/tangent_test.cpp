// The consistent tangent against finite differences of its residual.
#include "recursive/formula/tangent.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "recursive/stepping/knots.hpp"
#include "tests/recursive/elements.hpp"

namespace elastocheck::recursive {

namespace {

using Eigen::Vector3d;
using Long = long double;

constexpr BodyId bodies = 2;
const std::vector<std::pair<BodyId, BodyId>> sides{
    {0, 1}, {1, 0}, {ground, 0}, {0, ground}, {1, ground}};

// All inputs of ∂G/∂q.
struct Case {
    Model model;
    Branch branch;
    std::vector<Pose> poses;
    Vector<double> lambda;
    double a = 0.7;
};

Case anywhere(Random& random) {
    Case c;
    c.model.bodies.resize(bodies);
    for (int b = 0; b < bodies; ++b) c.poses.push_back(random.pose());
    return c;
}

void add(Case& c, const ConstraintKind& kind, Random& random) {
    c.model.constraints.push_back({0, kind});
    c.lambda =
        Vector<double>::NullaryExpr(constraint_rows(c.model), [&] { return random(-1e3, 1e3); });
}

template <class Real>
Inputs<Real> inputs_of(const Case& c) {
    return inputs_at<Real>(c.model, c.branch, static_cast<Real>(c.a));
}

Marker marker(BodyId body, Random& random) { return {body, random.vector(), random.rotation()}; }

Bushing bushing(BodyId i, BodyId j, Random& random) {
    Bushing e{marker(i, random), marker(j, random), LinearStiffness{random.stiffness()}, {}};
    e.preload = Vector6<double>::NullaryExpr([&] { return random(-500, 500); });
    return e;
}

// Rotates body j (or body i, if j is ground) until the relative rotation of the markers is θ.
void turn_to(const Vector3d& theta, const Bushing& e, std::vector<Pose>& poses) {
    const auto of = [&](BodyId b) {
        return b == ground ? Eigen::Quaterniond::Identity() : poses[static_cast<std::size_t>(b)].p;
    };
    const Eigen::Quaterniond turn = exponential<double>(theta), I = e.i.A_local, J = e.j.A_local;
    if (e.j.body != ground)
        poses[static_cast<std::size_t>(e.j.body)].p = of(e.i.body) * I * turn * J.conjugate();
    else
        poses[static_cast<std::size_t>(e.i.body)].p = J * turn.conjugate() * I.conjugate();
}

template <class Real>
Vector<Real> G(const Case& c, const State<Real>& q) {
    Vector<Real> f, Phi(constraint_rows(c.model)), part;
    const Vector<Real> lambda = c.lambda.cast<Real>();
    elastic_force<Real>(c.model, inputs_of<Real>(c), q, f);
    constraint_force<Real>(c.model, inputs_of<Real>(c), q, lambda, part, Phi);
    f += part;
    external_force<Real>(c.model, c.branch, inputs_of<Real>(c), q, part);
    return f - part;
}

// As it is assembled for the step.
template <class Real>
Matrix<Real> tangent(const Case& c) {
    SaddleMatrix<Real> M = saddle_matrix(c.model).template cast<Real>();
    Vector<Real> Phi(constraint_rows(c.model));
    const Vector<Real> lambda = c.lambda.cast<Real>();
    const auto inputs = inputs_of<Real>(c);
    const auto q = state_of<Real>(c.poses);
    assemble_constraints<Real>(c.model, inputs, q, M, Phi);
    add_consistent_tangent<Real>(c.model, c.branch, inputs, q, lambda, M);
    return Matrix<Real>::NullaryExpr(6 * bodies, 6 * bodies, [&](Eigen::Index i, Eigen::Index j) {
        const int at = M.at(static_cast<int>(i), static_cast<int>(j));
        return at < 0 ? Real(0) : M.values[static_cast<std::size_t>(at)];
    });
}

// (8 (G(h) - G(-h)) - (G(2h) - G(-2h))) / 12h, of order h⁴.
Matrix<Long> differences(const Case& c) {
    Matrix<Long> T(6 * bodies, 6 * bodies);
    const Long h = 1e-4L;
    for (int k = 0; k < 6 * bodies; ++k) {
        const auto at = [&](Long share) {
            State<Long> q = state_of<Long>(c.poses);
            const Vector<Long> dq = share * h * Vector<Long>::Unit(6 * bodies, k);
            advance(q, dq);
            return G<Long>(c, q);
        };
        T.col(k) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
    }
    return T;
}

// Largest difference of any entry, relative to the largest entry.
double largest_difference(const Matrix<Long>& a, const Matrix<Long>& b) {
    const Long size = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    return size > 0 ? static_cast<double>((a - b).cwiseAbs().maxCoeff() / size) : 0;
}

void expect_derivative(const Case& c, const std::string& what, double limit = 1e-12) {
    Eigen::Index row = 0, column = 0;
    const Matrix<Long> T = tangent<Long>(c), D = differences(c);
    (T - D).cwiseAbs().maxCoeff(&row, &column);
    EXPECT_LE(largest_difference(T, D), limit)
        << what << ": worst at (" << row << ", " << column
        << "): " << static_cast<double>(T(row, column)) << " instead of "
        << static_cast<double>(D(row, column));
    EXPECT_LE(largest_difference(tangent<double>(c).cast<Long>(), T), 1e-11)
        << what << ": double is not the same as long double";
}

TEST(Tangent, SpringTangentIsTheDerivativeOfItsForce) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 20; ++trial) {
            Case c = anywhere(random);
            c.model.elastics.push_back(
                {"spring",
                 AxialSpring{
                     {i, random.vector()}, {j, random.vector()}, LinearRate{3e4}, random(0.1, 3)}});
            // The fifth derivative of a direction grows as ℓ⁻⁵ when the random ends come close.
            const auto& e = std::get<AxialSpring>(c.model.elastics[0].kind);
            const State<double> q = state_of<double>(c.poses);
            if ((q[i].r + q[i].lever(e.i.s_local) - q[j].r - q[j].lever(e.j.s_local)).norm() < 0.3)
                continue;
            expect_derivative(c, fmt::format("bodies {} {}", i, j));
        }
}

TEST(Tangent, BushingTangentIsTheDerivativeOfItsForceForEveryLawAndFormulation) {
    const double at_switch = std::sqrt(1e-3);  // upper end of the small-angle series
    Random random;
    for (const Formulation& formulation : every_formulation())
        for (const bool curves : {false, true})
            for (const auto& [i, j] : sides)
                for (const double angle : {0.0, 1e-9, 1e-4, at_switch * (1 - 1e-9),
                                           at_switch * (1 + 1e-9), 0.04, 0.5, 1.3, 2.5}) {
                    if (angle > 2 && formulation.angles != Formulation::Angles::rotation_vector)
                        continue;
                    Case c = anywhere(random);
                    Bushing e = bushing(i, j, random);
                    e.formulation = formulation;
                    e.undeformed = Vector6<double>::NullaryExpr([&] { return random(-0.3, 0.3); });
                    if (curves) e.law = random_axes(random);
                    turn_to(angle * random.unit(), e, c.poses);
                    c.model.elastics.push_back({"bushing", e});
                    bool at_a_knot = false;
                    for (const auto& at : curves_of(c.model))
                        for (const double knot : at.curve->knots)
                            at_a_knot =
                                at_a_knot || std::abs(deflection(c.model, inputs_of<double>(c),
                                                                 state_of<double>(c.poses), at) -
                                                      knot) < 1e-3;
                    if (!at_a_knot)
                        expect_derivative(c, fmt::format("{}, bodies {} {}, {} rad",
                                                         name_of(formulation), i, j, angle));
                }
}

TEST(Tangent, CurveTangentIsTheDerivativeOnEveryPieceAndBeyondItsEnds) {
    Random random;
    for (Piece piece = wherever; piece < 6; ++piece) {
        Case c = anywhere(random);
        c.model.elastics.push_back({"spring", AxialSpring{{0, random.vector()},
                                                          {1, random.vector() + Vector3d(3, 0, 0)},
                                                          random_curve(random, 1, 1e3),
                                                          3}});
        const auto& spring = std::get<AxialSpring>(c.model.elastics[0].kind);
        Inputs<Long> inputs = inputs_of<Long>(c);
        inputs.rest[0].piece[0] = piece;
        const State<Long> q = state_of<Long>(c.poses);
        const Long x = deformation<Long>(spring, q).length - inputs.rest[0].free_length, h = 1e-4L;
        const auto f = [&](Long at) { return gradient<Long>(spring.law, at, piece); };
        EXPECT_NEAR(static_cast<double>(hessian<Long>(
                        spring.law, [&] { return x; }, piece)),
                    static_cast<double>(
                        (8 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12 * h)),
                    1e-6);
        expect_derivative(c, "spring with a curve");
    }
}

// Dead and follower forces and moments, as static loads and as drivers.
TEST(Tangent, LoadTangentIsTheDerivativeOfTheForce) {
    Random random;
    for (BodyId body = 0; body < bodies; ++body)
        for (const double a : {0.0, 0.7, -3000.0})
            for (const bool follow : {false, true}) {
                const auto force = [&](BodyId b, double size) -> LoadKind {
                    const Point at{b, random.vector()};
                    const Vector3d f = random.vector(size);
                    return follow ? LoadKind(FollowerForce{at, f}) : DeadForce{at, f};
                };
                const auto moment = [&](BodyId b, double size) -> LoadKind {
                    const Vector3d m = random.vector(size);
                    return follow ? LoadKind(FollowerMoment{b, m}) : DeadMoment{b, m};
                };
                Case c = anywhere(random);
                c.a = a;
                c.model.static_loads = {{"weight", force(body, 600)}, {"torque", moment(body, 50)}};
                c.branch.drivers = {{Load{"push", force(body, 1)}, 30, 1},
                                    {Load{"turn", moment(1 - body, 1)}, 0, -2}};
                expect_derivative(c, fmt::format("body {}, a = {}", body, a));
            }
}

TEST(Tangent, ConstraintTangentIsTheDerivativeOfTheReaction) {
    Random random;
    for (const auto& [i, j] : sides)
        for (int trial = 0; trial < 10; ++trial) {
            const Point at_i{i, random.vector()}, at_j{j, random.vector()};
            const Direction u_i{i, random.unit()}, u_j{j, random.unit()};
            const std::pair<const char*, ConstraintKind> kinds[] = {
                {"coincident points", CoincidentPoints{at_i, at_j}},
                {"point in plane", PointInPlane{at_i, at_j, u_j, random()}},
                {"perpendicular", PerpendicularDirections{u_i, u_j}},
                {"distance", DistanceBetween{at_i, at_j, random(0.1, 2)}},
                {"angle", DirectionAtAngle{u_i, u_j, {j, random.unit()}, random(-4, 4)}}};
            Case all = anywhere(random);
            for (const auto& [name, kind] : kinds) {
                Case c = anywhere(random);
                add(c, kind, random);
                expect_derivative(c, fmt::format("{} on {} {}", name, i, j));
                add(all, kind, random);
            }
            expect_derivative(all, fmt::format("all on {} {}", i, j));  // each with its own λ
        }
}

Case everything_at_once(Random& random) {
    Case c = anywhere(random);
    for (const auto& [i, j] : sides) {
        c.model.elastics.push_back({"bushing", bushing(i, j, random)});
        c.model.elastics.push_back({"spring", AxialSpring{{i, random.vector()},
                                                          {j, random.vector() + Vector3d(9, 0, 0)},
                                                          LinearRate{3e4},
                                                          0.3}});
        const Point at_i{i, random.vector()}, at_j{j, random.vector()};
        add(c, CoincidentPoints{at_i, at_j}, random);
        add(c, PointInPlane{at_i, at_j, {j, random.unit()}}, random);
        add(c, PerpendicularDirections{{i, random.unit()}, {j, random.unit()}}, random);
        add(c, DistanceBetween{at_i, at_j, 0.7}, random);
    }
    c.model.static_loads = {{"weight", DeadForce{{0, random.vector()}, random.vector(600)}}};
    c.branch.drivers = {{Load{"push", DeadForce{{1, random.vector()}, random.vector(1e3)}}, 0, 1}};
    return c;
}

TEST(Tangent, AssembledTangentIsTheDerivativeOfTheResidual) {
    Random random;
    for (int trial = 0; trial < 10; ++trial)
        expect_derivative(everything_at_once(random), fmt::format("trial {}", trial), 1e-10);
}

// Largest entry of T - Tᵀ - blockdiag(0, G̃_π), relative to that of T.
double asymmetry(const Case& c) {
    const Vector<Long> left = G<Long>(c, state_of<Long>(c.poses));
    const Matrix<Long> T = tangent<Long>(c);
    Matrix<Long> skew = T - T.transpose();
    for (int b = 0; b < bodies; ++b) {
        const Vector3<Long> moment = left.segment<3>(6 * b + 3);
        skew.block<3, 3>(6 * b + 3, 6 * b + 3) += tilde(moment);
    }
    return static_cast<double>(skew.cwiseAbs().maxCoeff() / T.cwiseAbs().maxCoeff());
}

// For a potential V and increments Δπ in ground axes, ∂(∂V/∂π)/∂π is symmetric up to the commutator
// of two rotations, so that T - Tᵀ = blockdiag(0, G̃_π) with G_π = ∂V/∂π, which is zero in
// equilibrium. No finite differences are involved. Cardan and projected angles amplify rounding near
// gimbal lock, which random poses approach.
TEST(Tangent, AsymmetryIsTheUnbalancedMomentWhereForcesHaveAnEnergy) {
    Random random;
    for (const Formulation& formulation : every_formulation()) {
        double worst = 0;
        for (int trial = 0; trial < 20; ++trial) {
            Case c = everything_at_once(random);
            for (std::size_t k = 0; k < c.model.elastics.size(); ++k)
                if (auto* e = std::get_if<Bushing>(&c.model.elastics[k].kind)) {
                    e->formulation = formulation;
                    if (k % 4 == 0) e->law = random_axes(random);
                }
            worst = std::max(worst, asymmetry(c));
        }
        if (has_energy(formulation)) {
            EXPECT_LE(worst, formulation == Formulation{} ? 1e-16 : 1e-14) << name_of(formulation);
        } else {
            EXPECT_GT(worst, 1e-3) << name_of(formulation);
        }
    }
}

TEST(Tangent, UnloadedTangentIsThePapersStiffness) {
    Random random;
    for (const auto& [i, j] : sides) {
        Case c = anywhere(random);
        Bushing e = bushing(i, j, random);
        e.preload.setZero();
        turn_to(Vector3d::Zero(), e, c.poses);
        const State<double> q = state_of<double>(c.poses);  // move one marker onto the other
        const Vector3d D = q[j].r + q[j].lever(e.j.s_local) - q[i].r - q[i].lever(e.i.s_local);
        if (j != ground)
            c.poses[static_cast<std::size_t>(j)].r -= D;
        else
            c.poses[static_cast<std::size_t>(i)].r += D;
        c.model.elastics.push_back({"bushing", e});
        const Matrix<double> K =
            stiffness<double>(c.model, inputs_of<double>(c), state_of<double>(c.poses));
        EXPECT_LE(largest_difference(tangent<double>(c).cast<Long>(), K.cast<Long>()), 1e-13)
            << i << " " << j;
    }
}

}  // namespace
}  // namespace elastocheck::recursive
