#include "recursive/stepping/stiffness.hpp"

#include <Eigen/Eigenvalues>

#include "models/eigen/dense.hpp"

namespace elastocheck::recursive::detail {

void orthonormalise(const Vector<double>& weight, Matrix<double>& U) {
    constexpr double zero_tolerance = 1e-9;
    const auto W2 = weight.head(U.rows()).array().square();
    Eigen::Index kept = 0;
    for (Eigen::Index c = 0; c < U.cols(); ++c) {
        Vector<double> u = U.col(c);
        const double whole = std::sqrt((u.array().square() * W2).sum());
        for (int pass = 0; pass < 2; ++pass)
            for (Eigen::Index k = 0; k < kept; ++k) {
                const double part = (U.col(k).array() * W2 * u.array()).sum();
                u -= part * U.col(k);
            }
        const double size = std::sqrt((u.array().square() * W2).sum());
        if (size > zero_tolerance * whole) U.col(kept++) = u / size;
    }
    U.conservativeResize(Eigen::NoChange, kept);
}

LeastStiffness min_of(const Eigen::MatrixXd& H) {
    // If K is symmetric, H is nearly so: each θ of H = S + N is within |N| of one of S (Bauer and
    // Fike 1960).
    constexpr double rounding = 1e-6, may_matter = 1e-3;
    if (H.size() == 0 || !H.allFinite()) return {std::numeric_limits<double>::quiet_NaN(), true};
    const Eigen::MatrixXd S = (H + H.transpose()) / 2;
    const double size = H.norm(), skew = (H - S).norm();
    if (!(skew <= may_matter * size)) return {1 / eigenvalues_of(H).cwiseAbs().maxCoeff(), false};
    const Eigen::VectorXd theta =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues();
    const bool negative = theta[0] < -std::max(rounding * size, 2 * skew);
    return {1 / (negative ? theta[0] : theta[theta.size() - 1]), true};
}

}  // namespace elastocheck::recursive::detail

namespace elastocheck::recursive {

LeastStiffness min_stiffness(SteppingState& s, Matrix<double>& U) {
    constexpr int vectors = 3, first_iterations = 5, iterations = 2;
    if (s.setup.free <= 0) return {};
    const int n = s.n();
    const auto W2 = s.system.weight.head(n).array().square();
    const bool first = U.cols() == 0;
    if (first) {
        U.resize(n, std::min(vectors, s.setup.free));
        for (Eigen::Index c = 0; c < U.cols(); ++c)
            for (Eigen::Index k = 0; k < n; ++k)
                U(k, c) = scattered(k + c * n) / s.system.weight[k];
        detail::orthonormalise(s.system.weight, U);
    }
    Eigen::MatrixXd H;
    s.work.lower.setZero();
    for (int iteration = first ? first_iterations : iterations; iteration > 0; --iteration) {
        Matrix<double> V(n, U.cols());
        for (Eigen::Index c = 0; c < U.cols(); ++c) {
            s.work.upper = U.col(c).array() * W2;
            back_substitute(s.system, s.work.upper, s.work.lower,
                            s.work.x);  // a check only: not counted
            V.col(c) = s.work.x.head(n);
        }
        H = (U.transpose() * W2.matrix().asDiagonal() * V).cast<double>();
        U = V;
        detail::orthonormalise(s.system.weight, U);
    }
    return detail::min_of(H);
}

}  // namespace elastocheck::recursive
