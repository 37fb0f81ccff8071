// Curves and angles of the formulations; forces are tested in tests/legs.
#include <gtest/gtest.h>

#include "recursive/stepping/knots.hpp"
#include "tests/recursive/elements.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

// The force and its slope are tested in tests/legs (Elements) and in tangent_test.cpp.
TEST(CurveLaw, CurveIsContinuousAndAKnotBelongsToTheNextPiece) {
    Random random;
    const Curve f = random_curve(random, 1, 1e3);
    for (std::size_t k = 0; k < f.knots.size(); ++k) {
        const auto piece = static_cast<Piece>(k);
        EXPECT_EQ(piece_at(f, f.knots[k]), piece + 1);
        EXPECT_EQ(piece_at(f, std::nextafter(f.knots[k], -9.0)), piece);
        EXPECT_NEAR(gradient<double>(f, f.knots[k], piece),
                    gradient<double>(f, f.knots[k], piece + 1), 1e-10);
    }
}

TEST(CurveLaw, KinksAreKnotsWhereTheSlopeJumps) {
    EXPECT_EQ(kinks_of(stop(0.03, 3e5)), std::vector<double>{0.03});
    // x³ on one side of 0, zero on the other: C1, with continuous curvature. x² is C1 only.
    EXPECT_TRUE(kinks_of({{0, 1}, {{0, 0, 0, 0}, {0, 0, 1e5, 0}, {1e5, 2e5, 0, 0}}}).empty());
}

TEST(Formulation, CardanAnglesComposeToTheRotation) {
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
        EXPECT_LE((middle_jacobian(half) * (half.S + B) - Matrix3<double>::Identity())
                      .cwiseAbs()
                      .maxCoeff(),
                  1e-14);
    }
}

}  // namespace
}  // namespace elastocheck::recursive
