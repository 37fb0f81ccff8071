#include "reference/energy/potential/rotation.hpp"

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond turned_by(const Vector3d& phi) {
    return phi.norm() > 0 ? Quaterniond(AngleAxisd(phi.norm(), phi.normalized()))
                          : Quaterniond::Identity();
}

TEST(Rotation, MatrixAndQuaternionOfARotationVectorAreTheSameRotation) {
    Random random;
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vector3d phi = random.unit() * std::pow(10, random(-9, 0.5));
        const Quaterniond q = turned_by(phi), dq = quaternion_minus_one(phi);
        worst = std::max(
            worst, (rotation_minus_one(phi) + Matrix3d::Identity() - q.toRotationMatrix()).norm());
        worst =
            std::max(worst, (dq.coeffs() + Quaterniond::Identity().coeffs() - q.coeffs()).norm());
    }
    EXPECT_LE(worst, 4e-15);
}

TEST(Rotation, RotationMatrixMinusOneIsExactForTheSmallestAngles) {
    const Vector3d phi(3e-200, -4e-200, 0);
    EXPECT_LE((rotation_minus_one(phi) - skew(phi)).norm(), 1e-15 * phi.norm());
    EXPECT_TRUE(turn_jacobian(Vector3d::Zero()).isIdentity(0));
    EXPECT_TRUE(inverse_turn_jacobian(Vector3d::Zero()).isIdentity(0));
}

// exp(φ + h δ) exp(φ)⁻¹ = exp(h J δ) + O(h²)
TEST(Rotation, JacobianIsTheDerivativeOfTheExponential) {
    Random random;
    for (int i = 0; i < 200; ++i) {
        const Vector3d phi = random.unit() * random(0, 3), delta = random.unit();
        double error[2];
        for (int k = 0; k < 2; ++k) {
            const double h = 1e-3 / (1 << k);
            const Quaterniond q = turned_by(phi + h * delta) * turned_by(phi).conjugate();
            error[k] = (rotation_vector(q) - h * turn_jacobian(phi) * delta).norm();
        }
        EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1) << phi.transpose();
    }
}

TEST(Rotation, InverseJacobianInverts) {
    Random random;
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vector3d theta = random.unit() * std::pow(10, random(-9, 0.49));
        worst = std::max(
            worst,
            (inverse_turn_jacobian(theta) * turn_jacobian(theta) - Matrix3d::Identity()).norm());
    }
    EXPECT_LE(worst, 1e-14);
}

TEST(Rotation, LogInvertsTheExponentialUpToHalfATurn) {
    Random random;
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vector3d theta = random.unit() * random(0, 3.14159);
        worst = std::max(worst, (rotation_vector(turned_by(theta)) - theta).norm());
    }
    EXPECT_LE(worst, 1e-14);
}

TEST(Rotation, ChangeOfTheLogAgreesWithTheDifference) {
    Random random;
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vector3d theta = random.unit() * random(0, 1.5), phi = random.unit() * random(0, 1.5);
        const Quaterniond q_c = turned_by(theta), q = turned_by(phi) * q_c;
        Quaterniond dq = quaternion_minus_one(phi);
        dq = dq * q_c;
        const LogChange change = log_change(q_c, dq);
        worst = std::max(worst, (change.theta_c - theta).norm());
        worst = std::max(worst, (change.theta_c + change.dtheta - rotation_vector(q)).norm());
    }
    EXPECT_LE(worst, 2e-14);
}

// dθ = J⁻¹(θ) δ + O(δ²): for δ down to 1e-14 the change
// is right to 1e-12 of itself, which a difference could not be.
TEST(Rotation, ChangeOfTheLogKeepsItsRelativeAccuracy) {
    Random random;
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector3d theta =
            random.unit() * (i % 4 == 0 ? std::pow(10, random(-12, 0)) : random(0, 3.1));
        const Vector3d delta = random.unit() * 1e-14;
        const Quaterniond q_c = turned_by(theta), dq = quaternion_minus_one(delta) * q_c;
        const Vector3d expected = inverse_turn_jacobian(theta) * delta;
        worst = std::max(worst, (log_change(q_c, dq).dtheta - expected).norm() / expected.norm());
    }
    EXPECT_LE(worst, 1e-12);
}

}  // namespace
}  // namespace elastocheck::reference::energy
