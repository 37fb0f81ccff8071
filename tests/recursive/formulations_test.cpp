// Curves, angles and the stiffness of every formulation; forces are tested in tests/legs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "models/curve.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/stepping/knots.hpp"
#include "tests/recursive/elements.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;
using Long = long double;

// ---- Curves in long double.

Long f_of(const Curve& f, Long x) {
    std::size_t k = 0;
    while (k < f.knots.size() && static_cast<Long>(f.knots[k]) <= x) ++k;
    const Long t = x - static_cast<Long>(f.knots[k == 0 ? 0 : k - 1]);
    Long sum = 0, power = 1;
    for (const double c : f.pieces[k]) sum += static_cast<Long>(c) * power, power *= t;
    return sum;
}
// ∫₀ˣ f by Simpson's rule, which is exact for cubics, from knot to knot.
Long energy_of(const Curve& f, Long x) {
    std::vector<Long> at{0, x};
    for (const double knot : f.knots)
        if ((static_cast<Long>(knot) - 0) * (static_cast<Long>(knot) - x) < 0) at.push_back(knot);
    std::sort(at.begin(), at.end());
    Long sum = 0;
    for (std::size_t k = 1; k < at.size(); ++k) {
        const Long a = at[k - 1], b = at[k], inside = (b - a) * 1e-12L;
        sum += (b - a) / 6 * (f_of(f, a + inside) + 4 * f_of(f, (a + b) / 2) + f_of(f, b - inside));
    }
    return x < 0 ? -sum : sum;
}
// ---- Configurations.

Bushing bushing(Random& random, const Formulation& formulation, bool curves) {
    Bushing b{{0, random.vector(), random.rotation()}, {1, random.vector(), random.rotation()}, {}};
    if (curves)
        b.law = random_axes(random);
    else
        b.law = LinearStiffness{random.stiffness()};
    b.preload = Vector6<double>::NullaryExpr([&] { return random(-500, 500); });
    b.undeformed = Vector6<double>::NullaryExpr([&] { return random(-0.3, 0.3); });
    b.formulation = formulation;
    return b;
}
// Two random poses with the relative rotation B by the given angle about a random axis.
std::vector<Pose> somewhere(const Bushing& b, double angle, Random& random) {
    std::vector<Pose> poses{random.pose(), random.pose()};
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, random.unit()));
    poses[1].p = poses[0].p * b.i.A_local * turn * b.j.A_local.conjugate();
    return poses;
}
Model model_of(const ElasticKind& kind) {
    Model model;
    model.bodies.resize(2);
    model.elastics.push_back({"element", kind});
    return model;
}
TEST(Law, OfACurveIsItsPolynomialAndTheDerivativeOfIt) {
    Random random;
    const Curve f = random_curve(random, 1, 1e3);
    for (double x = -2; x < 2; x += 0.003) {
        const Long h = 1e-4L, at = x;
        EXPECT_NEAR(gradient<double>(f, x), static_cast<double>(f_of(f, at)), 1e-10);
        const bool whole =
            std::ranges::none_of(f.knots, [&](double knot) { return std::abs(knot - x) < 1e-3; });
        if (!whole) continue;
        EXPECT_NEAR(hessian<double>(f, [&] { return x; }),
                    static_cast<double>((8 * (f_of(f, at + h) - f_of(f, at - h)) -
                                         (f_of(f, at + 2 * h) - f_of(f, at - 2 * h))) /
                                        (12 * h)),
                    1e-8);
        EXPECT_NEAR(gradient<double>(f, x),
                    static_cast<double>((energy_of(f, at + h) - energy_of(f, at - h)) / (2 * h)),
                    1e-3);
    }
    for (std::size_t k = 0; k < f.knots.size(); ++k) {
        const auto piece = static_cast<Piece>(k);
        EXPECT_EQ(piece_at(f, f.knots[k]), piece + 1);  // a knot belongs to the piece behind it
        EXPECT_EQ(piece_at(f, std::nextafter(f.knots[k], -9.0)), piece);
        EXPECT_NEAR(gradient<double>(f, f.knots[k], piece),
                    gradient<double>(f, f.knots[k], piece + 1), 1e-10);
    }
}

TEST(Law, HasKinksWhereTheSlopeJumps) {
    EXPECT_EQ(kinks_of(stop(0.03, 3e5)), std::vector<double>{0.03});
    // x³ on one side of 0, zero on the other: C1, with continuous curvature. x² is C1 only.
    EXPECT_TRUE(kinks_of({{0, 1}, {{0, 0, 0, 0}, {0, 0, 1e5, 0}, {1e5, 2e5, 0, 0}}}).empty());
}

TEST(Formulation, CardanAnglesMakeTheRotation) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        const Matrix3<double> B = random.rotation(1.4).toRotationMatrix();
        const Vector3d theta = cardan<double>(B);
        const Matrix3<double> made = (Eigen::AngleAxisd(theta.x(), Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(theta.y(), Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(theta.z(), Vector3d::UnitZ()))
                                         .toRotationMatrix();
        EXPECT_LE((made - B).cwiseAbs().maxCoeff(), 1e-14);
        const Middle<double> half = middle<double>(B);
        EXPECT_LE((half.S * half.S - B).cwiseAbs().maxCoeff(), 1e-14);
        EXPECT_LE(
            (jacobian(half) * (half.S + B) - Matrix3<double>::Identity()).cwiseAbs().maxCoeff(),
            1e-14);
    }
}

TEST(Stiffness, OfEveryLawAndFormulationIsSymmetricAndHasTheFormOfThePaper) {
    Random random;
    for (const Formulation& formulation : every_formulation()) {
        const Bushing b = bushing(random, formulation, true);
        const State<double> q = state_of<double>(somewhere(b, 0.5, random));
        const Model model = model_of(b);
        const Matrix<double> K = stiffness<double>(model, inputs_as_drawn<double>(model), q);
        EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
        Vector<double> dq(
            12);  // the two attachment points moved as one body with both levers: together they strain nothing
        const Vector3d v = random.vector(), w = random.vector();
        dq << v + q[0].lever(b.i.s_local).cross(w), w, v + q[1].lever(b.j.s_local).cross(w), w;
        EXPECT_LE((K * dq).norm(), 1e-13 * K.cwiseAbs().maxCoeff()) << name_of(formulation);
    }
}

}  // namespace
}  // namespace elastocheck::recursive
