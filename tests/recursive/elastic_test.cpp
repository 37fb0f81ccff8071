// Element stiffness, eqs. (8)-(20), and the force laws.
#include "recursive/formula/elastic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include "tests/recursive/elements.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

Marker marker(BodyId body, Random& r) { return {body, r.vector(), r.rotation()}; }

Bushing random_bushing(BodyId i, BodyId j, Random& r, bool coupled = true) {
    LinearStiffness law;
    Bushing bushing{marker(i, r), marker(j, r), {}, Vector6<double>::Zero()};
    if (coupled) {
        law.K = r.stiffness();
        for (int k = 0; k < 6; ++k) bushing.preload[k] = r(-500, 500);
    } else {
        law.K.diagonal() << r(1e5, 1e6), r(1e5, 1e6), r(1e5, 1e6), r(100, 900), r(100, 900),
            r(100, 900);
    }
    bushing.law = law;
    return bushing;
}

Model model_of(const ElasticKind& element, int bodies) {
    Model model;
    model.bodies.resize(static_cast<std::size_t>(bodies));
    model.elastics.push_back({"element", element});
    return model;
}

Matrix<double> stiffness_of(const Model& model, const State<double>& q) {
    return stiffness<double>(model, inputs_as_drawn<double>(model), q);
}
Vector<double> force_of(const Model& model, const State<double>& q) {
    return elastic_force<double>(model, inputs_as_drawn<double>(model), q);
}

// A random configuration in which the element's markers coincide.
State<double> assembled(const Bushing& b, Random& random) {
    const Pose i = b.i.body == ground ? Pose{} : random.pose();
    const Eigen::Quaterniond A_j = i.p * b.i.A_local * b.j.A_local.conjugate();
    const Pose j{i.r + i.p * b.i.s_local - A_j * b.j.s_local, A_j};
    if (b.i.body == ground) return state_of<double>({j});
    return state_of<double>({i, j});
}

// Springs and bushings of every law and formulation.
TEST(Stiffness, IsSymmetricAndPositiveSemidefiniteAnywhere) {
    Random random;
    const auto expect = [](const ElasticKind& kind, const State<double>& q,
                           const std::string& what) {
        const auto K = stiffness_of(model_of(kind, 2), q);
        EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff())
            << what;
        if (const auto* b = std::get_if<Bushing>(&kind); b && axes_of(b->law)) return;  // may fall
        const Eigen::SelfAdjointEigenSolver<Matrix<double>> eigen(K);
        EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-13 * eigen.eigenvalues().maxCoeff()) << what;
    };
    for (int trial = 0; trial < 50; ++trial)
        expect(AxialSpring{{0, random.vector()}, {1, random.vector()}, LinearRate{3e4}, 0.3},
               random.state(2), "spring");
    for (const Formulation& formulation : every_formulation())
        for (const bool curves : {false, true}) {
            Bushing b = random_bushing(0, 1, random);
            if (curves) b.law = random_axes(random);
            b.formulation = formulation;
            expect(b, random.state(2), name_of(formulation));
        }
}

// A spring, and a bushing whose markers move as one body, coincident or not.
TEST(Stiffness, RigidMotionGivesNoForce) {
    Random random;
    for (const Formulation& formulation : every_formulation()) {
        Bushing bushing = random_bushing(0, 1, random);
        bushing.law = random_axes(random);
        bushing.formulation = formulation;
        const AxialSpring spring{{0, random.vector()}, {1, random.vector()}, LinearRate{3e4}, 0.3};
        const State<double> q = random.state(2);
        const Vector3d turn = random.unit(), v = random.vector(),
                       levers[] = {q[0].lever(bushing.i.s_local), q[1].lever(bushing.j.s_local)};
        Vector<double> rigid(12), attached(12);
        for (int b = 0; b < 2; ++b) {
            rigid.segment<6>(6 * b) << v + turn.cross(q[b].r), turn;
            attached.segment<6>(6 * b) << v + levers[b].cross(turn), turn;
        }
        for (const auto& [kind, dq] :
             {std::pair<ElasticKind, Vector<double>>{bushing, attached}, {spring, rigid}}) {
            const auto K = stiffness_of(model_of(kind, 2), q);
            EXPECT_LE((K * dq).cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff())
                << name_of(formulation);
        }
    }
}

// The matrix as printed in the paper, with the opposite sign.
Matrix<double> printed_equation_19(const ElementStiffness<double>& e) {
    const Matrix3<double> K_T = e.K.topLeftCorner<3, 3>(), K_R = e.K.bottomRightCorner<3, 3>();
    const Matrix3<double> si = tilde<double>(e.s_i), sj = tilde<double>(e.s_j);
    Matrix<double> K(12, 12);
    K << -K_T, K_T * si, K_T, -K_T * sj,                                 //
        -si * K_T, si * K_T * si - K_R, sj * K_T, -sj * K_T * sj + K_R,  //
        K_T, -K_T * si, -K_T, K_T * sj,                                  //
        sj * K_T, -sj * K_T * si + K_R, -sj * K_T, sj * K_T * sj - K_R;
    return -K;
}

TEST(Stiffness, PrintedEquation19IsNeitherSymmetricNorFreeOfForceUnderRigidMotion) {
    Random random;
    const Bushing bushing = random_bushing(0, 1, random, false);
    const State<double> q = assembled(bushing, random);
    const auto printed = printed_equation_19(element_stiffness<double>(bushing, Rest<double>{}, q));
    const auto K = stiffness_of(model_of(bushing, 2), q);
    Vector<double> dq(12);
    const Vector3d turn = random.unit();
    for (int b = 0; b < 2; ++b) dq.segment<6>(6 * b) << turn.cross(q[b].r), turn;
    EXPECT_GT((printed - printed.transpose()).cwiseAbs().maxCoeff(),
              1e-2 * K.cwiseAbs().maxCoeff());
    EXPECT_GT((printed * dq).cwiseAbs().maxCoeff(), 1e-2 * K.cwiseAbs().maxCoeff());
    // They differ in the second correction and nowhere else: block row 2, columns 3 and 4.
    Matrix<double> difference = K - printed;
    difference.block<3, 6>(3, 6).setZero();
    EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-15 * K.cwiseAbs().maxCoeff());
}

TEST(Stiffness, IsTheDerivativeOfTheLawAtAnUnloadedPosition) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        for (const BodyId first : {BodyId{0}, ground}) {
            Bushing bushing = random_bushing(first, first + 1, random);
            bushing.preload.setZero();
            const State<double> q = assembled(bushing, random);
            const Model model = model_of(bushing, first + 2);
            const auto K = stiffness_of(model, q);
            for (int c = 0; c < K.cols(); ++c) {
                constexpr double h = 1e-6;
                Vector<double> dq = Vector<double>::Zero(K.cols());
                dq[c] = h;
                State<double> plus = q, minus = q;
                advance(plus, dq);
                advance(minus, (-dq).eval());
                const Vector<double> difference =
                    (force_of(model, plus) - force_of(model, minus)) / (2 * h);
                EXPECT_LE((difference - K.col(c)).cwiseAbs().maxCoeff(),
                          1e-7 * K.cwiseAbs().maxCoeff());
            }
        }
    }
}

TEST(ElasticForce, IsRegularAtZeroRotation) {
    Random random;
    Bushing bushing = random_bushing(0, 1, random);
    const State<double> together = assembled(bushing, random);
    const auto f0 = force_of(model_of(bushing, 2), together);
    for (const double angle : {0.0, 1e-320, 1e-200, 1e-17, 1e-9}) {
        State<double> q = together;
        Vector<double> dq = Vector<double>::Zero(12);
        dq.tail<3>() = angle * random.unit();
        advance(q, dq);
        const auto f = force_of(model_of(bushing, 2), q);
        EXPECT_TRUE(f.allFinite());
        EXPECT_LE((f - f0).cwiseAbs().maxCoeff(), 1e-9 + 1e7 * angle) << angle;
    }
    // On both sides of the switch to the series.
    for (const double t : {0.99 * std::sqrt(1e-3), 1.01 * std::sqrt(1e-3)}) {
        const Vector3d theta = t * random.unit();
        const Matrix3<double> inverse = inverse_left_jacobian<double>(theta);
        Matrix3<double> J = Matrix3<double>::Identity(), power = Matrix3<double>::Identity();
        for (int k = 1; k < 12; ++k) {
            power = power * tilde<double>(theta) / (k + 1);
            J += power;
        }
        EXPECT_LE((inverse * J - Matrix3<double>::Identity()).cwiseAbs().maxCoeff(), 1e-15);
    }
}

}  // namespace
}  // namespace elastocheck::recursive
