// Condition number κ₂ of eq. (24) by Lanczos iteration on the matrix and on its inverse.
//
// For A = S M S, with S = I for the raw matrix and S = D for the equilibrated one
// (saddle_point.hpp), the null space is S⁻¹ Z with Z the idle and redundant directions. On its
// complement A is regular. With the factors of M, bordered so that Z is held,
//
//   A⁺ f = P S⁻¹ M⁻¹ S⁻¹ P f        P = I - N (Nᵀ N)⁻¹ Nᵀ,  N = S⁻¹ Z .
//
// Eigenvalues have both signs; κ₂ is the largest modulus over the smallest.
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>
#include <random>

#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/diagnosis/loops.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "recursive/linear_algebra/saddle_point.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::VectorXd;
using Columns = Eigen::SparseMatrix<double>;

// Projects the null space out of a vector.
struct Complement {
    Columns N;
    Eigen::SimplicialLDLT<Columns> gram;

    explicit Complement(const Columns& null_space) : N(null_space) {
        if (N.cols() > 0) gram.compute(Columns(N.transpose() * N));
    }
    VectorXd operator()(const VectorXd& f) const {
        if (N.cols() == 0) return f;
        return f - N * VectorXd(gram.solve(N.transpose() * f));
    }
};

// Largest eigenvalue in modulus of a symmetric operator on the range of P. No reorthogonalisation:
// its loss only duplicates eigenvalues, which does not affect the largest. Where many eigenvalues
// lie close to the largest, the last digits are not converged; two digits are shown.
template <class Operator>
double largest_eigenvalue(Eigen::Index size, const Complement& P, const Operator& A) {
    constexpr double accuracy = 1e-10;
    const Eigen::Index max_steps = std::min<Eigen::Index>(4 * size, 256);
    std::mt19937 random(1);  // the same sequence on every platform
    VectorXd v(size), previous = VectorXd::Zero(size), alpha(max_steps), beta(max_steps);
    for (auto& entry : v) entry = static_cast<double>(random()) / 4294967296.0 - 0.5;
    v = P(v).normalized();
    double largest = 0;
    // The tridiagonal matrix T of step k has the diagonal alpha and the off-diagonal beta. Its eigenvalues
    // are computed at steps that grow by half.
    for (Eigen::Index k = 0, next_check = 8; k < max_steps; ++k) {
        VectorXd w = A(v);
        alpha[k] = v.dot(w);
        w -= alpha[k] * v;
        if (k > 0) w -= beta[k - 1] * previous;
        beta[k] = w.norm();
        const bool is_last =
            k + 1 == max_steps || !(beta[k] > accuracy * alpha.head(k + 1).cwiseAbs().maxCoeff());
        if (is_last || k + 1 == next_check) {
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> T;
            T.computeFromTridiagonal(alpha.head(k + 1), beta.head(k), Eigen::EigenvaluesOnly);
            const double estimate = T.eigenvalues().cwiseAbs().maxCoeff();
            if (is_last || std::abs(estimate - largest) <= accuracy * estimate) return estimate;
            largest = estimate;
            next_check += next_check / 2;
        }
        previous = v;
        v = w / beta[k];
    }
    return largest;
}

}  // namespace

Conditioning conditioning(const Model& model, const Diagnosis& diagnosis) {
    const int n = diagnosis.coordinates, m = diagnosis.rows;
    if (constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        std::isnan(diagnosis.constraint_error))
        return {nan, nan};
    if (n + m <= diagnosis.null_space.cols()) return {1, 1};
    SaddlePoint<double> system;
    system.n = n;
    system.m = m;
    system.M = saddle_matrix(model);
    system.weight.setOnes(n + m);
    for (int b = 0; b < n / 6; ++b)
        system.weight.segment(6 * b + 3, 3).setConstant(diagnosis.length);
    VectorXd Phi(m);
    assemble<double>(model, inputs_as_drawn<double>(model), design_state<double>(model), system.M,
                     Phi);
    analyse(system, static_cast<int>(diagnosis.idle.size()), diagnosis.null_space, pattern(model),
            loops(model));
    factorise(system);
    const Columns M = sparse(system.M);
    const auto condition_of = [&](const VectorXd& S) {
        const VectorXd inverse = S.cwiseInverse();
        const Complement P(inverse.asDiagonal() * diagnosis.null_space);
        VectorXd x(n + m);
        // A
        const auto matrix = [&](const VectorXd& v) -> VectorXd {
            return S.asDiagonal() * (M * (S.asDiagonal() * v).eval());
        };
        // A⁺
        const auto pseudoinverse = [&](const VectorXd& v) -> VectorXd {
            const VectorXd f = inverse.asDiagonal() * P(v);
            back_substitute<double>(system, f.head(n), f.tail(m), x);
            return P(inverse.asDiagonal() * x);
        };
        return largest_eigenvalue(n + m, P, matrix) * largest_eigenvalue(n + m, P, pseudoinverse);
    };
    return {condition_of(VectorXd::Ones(n + m)), condition_of(system.scale)};
}

}  // namespace elastocheck::recursive
