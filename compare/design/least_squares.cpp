#include "compare/design/least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_iterations = 100;
// of the largest squared column norm of J: numbers that no residual answers to keep their value
constexpr double ridge = 1e-16;
constexpr double least_decrease = 1e-13;  // of |r|²

enum class At { free, low, high };

MatrixXd columns(const MatrixXd& A, const std::vector<Index>& which) {
    MatrixXd part(A.rows(), static_cast<Index>(which.size()));
    for (Index k = 0; k < part.cols(); ++k) part.col(k) = A.col(which[static_cast<std::size_t>(k)]);
    return part;
}

// [A; √λ I]
MatrixXd damped(const MatrixXd& A, double lambda) {
    MatrixXd stacked(A.rows() + A.cols(), A.cols());
    stacked << A, std::sqrt(lambda) * MatrixXd::Identity(A.cols(), A.cols());
    return stacked;
}

}  // namespace

VectorXd bounded_least_squares(const MatrixXd& A, const VectorXd& b, const Box& box) {
    const Index n = A.cols();
    VectorXd x = VectorXd::Zero(n);
    std::vector<At> state(static_cast<std::size_t>(n), At::free);
    for (Index pass = 0; pass < 20 * (n + 1); ++pass) {
        std::vector<Index> free;
        for (Index i = 0; i < n; ++i)
            if (state[static_cast<std::size_t>(i)] == At::free) free.push_back(i);
        // To the minimum over the free x, as far as the bounds allow.
        double share = 1;
        Index stopped = -1;
        if (!free.empty()) {
            const MatrixXd part = columns(A, free);
            const VectorXd d = part.colPivHouseholderQr().solve(b - A * x);
            for (Index k = 0; k < d.size(); ++k) {
                const Index i = free[static_cast<std::size_t>(k)];
                const double room = d[k] > 0 ? box.high[i] - x[i] : box.low[i] - x[i];
                if (std::abs(d[k]) * share > std::abs(room)) share = room / d[k], stopped = i;
            }
            for (Index k = 0; k < d.size(); ++k) {
                const Index i = free[static_cast<std::size_t>(k)];
                x[i] += share * d[k];
                if (i != stopped) continue;
                const bool up = d[k] > 0;
                x[i] = up ? box.high[i] : box.low[i];
                state[static_cast<std::size_t>(i)] = up ? At::high : At::low;
            }
        }
        if (stopped >= 0) continue;
        // The bound that holds back the largest decrease.
        const VectorXd residual = b - A * x, descent = A.transpose() * residual;
        Index released = -1;
        double most = 0;
        for (Index i = 0; i < n; ++i) {
            const At at = state[static_cast<std::size_t>(i)];
            const double pull = at == At::low ? descent[i] : at == At::high ? -descent[i] : 0;
            if (pull > 1e-12 * A.col(i).norm() * residual.norm() && pull > most)
                most = pull, released = i;
        }
        if (released < 0) break;
        state[static_cast<std::size_t>(released)] = At::free;
    }
    return x;
}

Minimum minimise(const LeastSquares& problem, VectorXd start, const Box& box) {
    Minimum found;
    found.x = std::move(start);
    found.residual = problem.residual(found.x);
    found.jacobian = problem.jacobian(found.x);
    double lambda = 0;  // of the largest squared column norm of J
    while (found.iterations < most_iterations && found.residual.allFinite() &&
           found.jacobian.allFinite()) {
        const MatrixXd& J = found.jacobian;
        const double size = J.cols() > 0 ? J.colwise().squaredNorm().maxCoeff() : 0;
        if (!(size > 0)) {
            found.converged = true;
            return found;
        }
        VectorXd target = VectorXd::Zero(J.rows() + J.cols());
        target.head(J.rows()) = -found.residual;
        const VectorXd d = bounded_least_squares(damped(J, std::max(lambda, ridge) * size), target,
                                                 {box.low - found.x, box.high - found.x});
        const double before = found.residual.squaredNorm(),
                     expected = before - (found.residual + J * d).squaredNorm();
        if (!(expected > least_decrease * before)) {
            found.converged = true;
            return found;
        }
        ++found.iterations;
        // Within the box in spite of rounding.
        const VectorXd x = (found.x + d).cwiseMax(box.low).cwiseMin(box.high);
        const VectorXd residual = problem.residual(x);
        if (residual.allFinite() && residual.squaredNorm() < before) {
            found.x = x;
            found.residual = residual;
            found.jacobian = problem.jacobian(x);
            lambda = lambda > 1e-8 ? lambda / 10 : 0;
        } else {
            lambda = std::max(10 * lambda, 1e-4);
        }
    }
    return found;
}

}  // namespace elastocheck::compare
