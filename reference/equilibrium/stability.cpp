#include "reference/equilibrium/stability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <optional>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Of Φ_q, whose rows have sizes of order one: less is a redundant row.
constexpr double rank_threshold = 1e-10;

// What round-off leaves of an eigenvalue, over the largest entry of ∂(balance)/∂q.
constexpr double eigenvalue_round_off = 1e-13;

// How far below its least node the parabola may go before the step is halved.
constexpr double deepest_dip = 0.5;

MatrixXd null_space(const MatrixXd& A) {
    if (A.rows() == 0) return MatrixXd::Identity(A.cols(), A.cols());
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    qr.setThreshold(rank_threshold);
    qr.compute(A.transpose());
    const MatrixXd Q = qr.householderQ();
    return Q.rightCols(Q.cols() - qr.rank());
}

// The least eigenvalue of a matrix that is nearly symmetric: each of S + N, S symmetric, is within |N| of one of S
// (Bauer and Fike). Several times cheaper than to ask the matrix itself, which is done where N may matter.
std::optional<double> least_if_symmetric(const MatrixXd& M) {
    constexpr double may_matter = 1e-3;
    const MatrixXd S = (M + M.transpose()) / 2;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(S, Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success) return std::nullopt;
    const double least = solver.eigenvalues()[0];
    if (!((M - S).norm() <= may_matter * std::abs(least))) return std::nullopt;
    return least;
}

int sign_of_determinant(const MatrixXd& A) {
    const Eigen::PartialPivLU<MatrixXd> lu(A);
    int sign = static_cast<int>(lu.permutationP().determinant());
    for (Index k = 0; k < A.rows(); ++k) {
        const double pivot = lu.matrixLU()(k, k);
        sign *= pivot > 0 ? 1 : pivot < 0 ? -1 : 0;
    }
    return sign;
}

}  // namespace

Stiffness stiffness(const System& system, const MatrixXd& J, const NullSpaces& idle) {
    const Index n = 6 * system.bodies;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!J.allFinite()) return {nan, nan};
    if (n == 0) return {};
    const MatrixXd Z = null_space(J.bottomLeftCorner(system.constraint_rows, n));
    if (Z.cols() == 0) return {};

    const double size = J.topLeftCorner(n, n).cwiseAbs().maxCoeff();
    MatrixXd M = -Z.transpose() * J.topLeftCorner(n, n) * Z;
    // Idle modes are held as stiffly as anything else, and drop out of the question.
    const MatrixXd held = Z.transpose() * idle.right.topRows(n);
    M += std::max(size, 1.0) * held * held.transpose();

    const double round_off = eigenvalue_round_off * size;
    if (system.conservative)
        if (const auto least = least_if_symmetric(M)) return {*least, round_off};
    const Eigen::EigenSolver<MatrixXd> solver(M, false);
    if (solver.info() != Eigen::Success) return {nan, nan};
    double least = std::numeric_limits<double>::infinity(), modulus = least;
    int negative = 0;
    for (const auto& mu : solver.eigenvalues()) {
        const bool real = mu.imag() == 0;
        least = std::min(least, real ? mu.real() : std::abs(mu));
        modulus = std::min(modulus, std::abs(mu));
        negative += real && mu.real() < 0;
    }
    if (system.conservative) return {least, round_off};
    return {negative % 2 == 0 ? modulus : -modulus, round_off, negative};
}

bool constraints_keep_their_side(const System& system, const MatrixXd& J_from, const MatrixXd& J_to) {
    const Index n = 6 * system.bodies, m = system.constraint_rows;
    if (m == 0) return true;
    const MatrixXd Phi_q = J_from.bottomLeftCorner(m, n);
    const MatrixXd Z = null_space(Phi_q), U = null_space(Phi_q.transpose());
    if (m + Z.cols() != n + U.cols()) return false;  // at the singular point itself, by round-off
    const auto bordered = [&](const MatrixXd& J) {
        MatrixXd B = MatrixXd::Zero(m + Z.cols(), n + U.cols());
        B.topLeftCorner(m, n) = J.bottomLeftCorner(m, n);
        B.topRightCorner(m, U.cols()) = U;
        B.bottomLeftCorner(Z.cols(), n) = Z.transpose();
        return B;
    };
    return sign_of_determinant(bordered(J_from)) == sign_of_determinant(bordered(J_to));
}

// With s from 0 to 1, λ(s) = λ₀ + b s + c s²,  b = -3 λ₀ + 4 λ_m - λ₁,  c = 2 (λ₀ - 2 λ_m + λ₁),  has its
// least value λ₀ - b² / 4c where 0 < -b / 2c < 1.
Stability over_step(const Stiffness& from, const Stiffness& middle, const Stiffness& to) {
    const double l_0 = from.least, l_m = middle.least, l_1 = to.least;
    const double round_off = std::max({from.round_off, middle.round_off, to.round_off});
    const double least = std::min({l_0, l_m, l_1});
    if (!(std::isfinite(l_0) && std::isfinite(l_m) && std::isfinite(l_1)) || least < -round_off)
        return Stability::lost;
    // A pair of eigenvalues that became negative: through zero together, or round it as a complex pair. Where they
    // went round, the least modulus is not small, and hardly changes over a step that is short enough.
    constexpr double hardly = 0.25;
    const bool pair = from.negative != to.negative || from.negative != middle.negative;
    if (pair && std::max({l_0, l_m, l_1}) > (1 + hardly) * least) return Stability::uncertain;
    const double b = -3 * l_0 + 4 * l_m - l_1, c = 2 * (l_0 - 2 * l_m + l_1);
    const bool dips = c > 0 && b < 0 && -b < 2 * c;
    if (dips && l_0 - b * b / (4 * c) < deepest_dip * least - round_off) return Stability::uncertain;
    return Stability::kept;
}

}  // namespace elastocheck::reference::equilibrium
