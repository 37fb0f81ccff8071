#include "compare/design/fit.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "compare/design/least_squares.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double least_singular = 1e-6;  // of the largest: below, a combination is not determined
constexpr double least_part = 1e-3;      // of a number in an undetermined combination
constexpr double least_noise = 1e-9;     // of the range of a column: exact data
constexpr int reweighted = 2;

std::vector<double> sums(const VectorXd& squares, const std::vector<int>& column) {
    std::vector<double> sum(static_cast<std::size_t>(*std::ranges::max_element(column)) + 1, 0);
    for (std::size_t k = 0; k < column.size(); ++k)
        sum[static_cast<std::size_t>(column[k])] += squares[static_cast<Index>(k)];
    return sum;
}

std::vector<double> ranges(const Measured& measured, const std::vector<double>& counts) {
    std::vector<double> low(counts.size(), unlimited), high(counts.size(), -unlimited);
    for (std::size_t k = 0; k < measured.column.size(); ++k) {
        const auto c = static_cast<std::size_t>(measured.column[k]);
        low[c] = std::min(low[c], measured.value[static_cast<Index>(k)]);
        high[c] = std::max(high[c], measured.value[static_cast<Index>(k)]);
    }
    for (std::size_t c = 0; c < low.size(); ++c)
        low[c] = high[c] > low[c] ? high[c] - low[c] : std::max(std::abs(high[c]), 1.0);
    return low;
}

}  // namespace

double student_95(int freedom) {
    if (freedom < 1) return unlimited;
    // P(|T| ≤ t) by the substitution t = √ν tan θ:  ∝ ∫ cos^(ν-1) θ dθ from 0 to θ, by Simpson's
    // rule; t by bisection. Beyond ten standard deviations the density is zero.
    const double nu = freedom, end = std::min(std::numbers::pi / 2, 10 / std::sqrt(nu));
    const auto integral = [nu](double to) {
        constexpr int parts = 400;
        double sum = 0;
        for (int k = 0; k <= parts; ++k)
            sum += std::pow(std::cos(to * k / parts), nu - 1) * (k == 0 || k == parts ? 1
                                                                 : k % 2 == 1         ? 4
                                                                                      : 2);
        return sum * to / (3 * parts);
    };
    const double inside = 0.95 * integral(end);
    double low = 0, high = end;
    for (int k = 0; k < 50; ++k) {
        const double middle = (low + high) / 2;
        (integral(middle) < inside ? low : high) = middle;
    }
    return std::sqrt(nu) * std::tan(low);
}

Fitted fit(const Figures& figures, const Measured& measured) {
    const Index n = measured.start.size(), N = measured.value.size();
    const auto number_at = [&](const VectorXd& x) -> VectorXd {
        return measured.step.cwiseProduct(x);
    };
    const Box box{measured.low.cwiseQuotient(measured.step),
                  measured.high.cwiseQuotient(measured.step)};
    const std::vector<double> counts = sums(VectorXd::Ones(N), measured.column);
    const std::vector<double> range = ranges(measured, counts);
    Fitted found;
    VectorXd x = measured.start.cwiseQuotient(measured.step).cwiseMax(box.low).cwiseMin(box.high);
    const VectorXd before = figures.value(number_at(x));
    if (!before.allFinite()) {
        found.why_not = "a measured output has no value at the start";
        return found;
    }
    const auto rms = sums((before - measured.value).cwiseAbs2(), measured.column);
    for (std::size_t c = 0; c < counts.size(); ++c)
        found.rms_before.push_back(std::sqrt(rms[c] / counts[c]));

    found.noise = range;
    VectorXd weight(N);
    Minimum nearest;
    Index determined = n;
    for (int pass = 0; pass <= reweighted; ++pass) {
        for (Index k = 0; k < N; ++k)
            weight[k] =
                1 /
                found.noise[static_cast<std::size_t>(measured.column[static_cast<std::size_t>(k)])];
        const LeastSquares problem{
            [&](const VectorXd& at) -> VectorXd {
                return (figures.value(number_at(at)) - measured.value).cwiseProduct(weight);
            },
            [&](const VectorXd& at) -> MatrixXd {
                return weight.asDiagonal() * figures.gradient(number_at(at)).rate *
                       measured.step.asDiagonal();
            }};
        nearest = minimise(problem, x, box);
        x = nearest.x;
        found.iterations += nearest.iterations;
        found.calculated = nearest.residual.cwiseQuotient(weight) + measured.value;
        const auto squares = sums((found.calculated - measured.value).cwiseAbs2(), measured.column);
        const double share = 1 - static_cast<double>(n) / static_cast<double>(N);
        found.freedom = static_cast<int>(share * *std::ranges::min_element(counts));
        if (N <= n) break;
        for (std::size_t c = 0; c < counts.size(); ++c) {
            const double free = share * counts[c];
            found.noise[c] = std::max(std::sqrt(squares[c] / free), least_noise * range[c]);
        }
    }
    found.p = number_at(x).cwiseMax(measured.low).cwiseMin(measured.high);
    found.converged = nearest.converged;
    for (Index i = 0; i < n; ++i)
        found.at_limit.push_back(x[i] <= box.low[i] || x[i] >= box.high[i]);
    if (!nearest.jacobian.allFinite()) {
        found.converged = false;
        found.why_not = "a measured output has no rate at the result";
        return found;
    }

    // The covariance, of the weights of the last residuals.
    const FigureGradient gradient = figures.gradient(found.p);
    for (Index k = 0; k < N; ++k)
        weight[k] =
            1 / found.noise[static_cast<std::size_t>(measured.column[static_cast<std::size_t>(k)])];
    const MatrixXd J = weight.asDiagonal() * gradient.rate * measured.step.asDiagonal(),
                   error = weight.asDiagonal() * gradient.error * measured.step.asDiagonal();
    const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeFullV);
    found.singular_values = VectorXd::Zero(n);
    found.singular_values.head(svd.singularValues().size()) = svd.singularValues();
    const VectorXd& S = found.singular_values;
    const double least = std::max(least_singular * S[0], 3 * error.norm());
    determined = (S.array() > least).count();
    const MatrixXd V = svd.matrixV();
    found.undetermined = V.rightCols(n - determined);
    found.interval = VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
        double variance = 0;
        for (Index k = 0; k < determined; ++k) variance += std::pow(V(i, k) / S[k], 2);
        const bool open = found.undetermined.cols() > 0 &&
                          found.undetermined.row(i).cwiseAbs().maxCoeff() > least_part;
        found.interval[i] = open || found.freedom < 1 ? unlimited
                                                      : student_95(found.freedom) *
                                                            std::sqrt(variance) * measured.step[i];
    }
    return found;
}

}  // namespace elastocheck::compare
