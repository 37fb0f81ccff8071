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
constexpr int most_robust_passes = 60;
constexpr double numbers_stay = 1e-6;     // in steps, from one robust pass to the next
constexpr double cauchy_width = 2.385;    // c
constexpr double normal_median = 1.4826;  // standard deviation over median |.|

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

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

// s_c of the columns; `share` of the values are free, 1 - n/N.
std::vector<double> noise_of(const VectorXd& residual, const Measured& measured,
                             const std::vector<double>& counts, double share) {
    std::vector<double> noise(counts.size());
    if (measured.robust) {
        std::vector<std::vector<double>> sizes(counts.size());
        for (std::size_t k = 0; k < measured.column.size(); ++k)
            sizes[static_cast<std::size_t>(measured.column[k])].push_back(
                std::abs(residual[static_cast<Index>(k)]));
        for (std::size_t c = 0; c < counts.size(); ++c)
            noise[c] = normal_median * median_of(sizes[c]) / std::sqrt(share);
        return noise;
    }
    const auto squares = sums(residual.cwiseAbs2(), measured.column);
    for (std::size_t c = 0; c < counts.size(); ++c)
        noise[c] = std::sqrt(squares[c] / (share * counts[c]));
    return noise;
}

// √(ψ(u) / u) per value; without the robust loss one.
VectorXd loss_weights(const VectorXd& u, bool robust) {
    if (!robust) return VectorXd::Ones(u.size());
    return (1 + (u / cauchy_width).array().square()).rsqrt();
}

// Factor of the covariance of a robust fit; NaN where the loss does not determine the numbers.
double robust_factor(const VectorXd& u, Index n) {
    const double N = static_cast<double>(u.size());
    const Eigen::ArrayXd v = (u / cauchy_width).array().square();
    const Eigen::ArrayXd psi = u.array() / (1 + v), slope = (1 - v) / (1 + v).square();
    const double mean = slope.mean(), variance = (slope - mean).square().mean();
    if (!(mean > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double K = 1 + static_cast<double>(n) / N * variance / (mean * mean);
    return K * K * psi.square().sum() / (N - static_cast<double>(n)) / (mean * mean);
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
    const auto noise_at = [&](Index k) {
        return found.noise[static_cast<std::size_t>(measured.column[static_cast<std::size_t>(k)])];
    };
    VectorXd weight(N), loss = VectorXd::Ones(N), residual(N), u(N);
    Minimum nearest;
    Index determined = n;
    bool stays = !measured.robust;
    const int passes = measured.robust ? most_robust_passes : reweighted;
    for (int pass = 0; pass <= passes; ++pass) {
        for (Index k = 0; k < N; ++k) weight[k] = loss[k] / noise_at(k);
        const LeastSquares problem{
            [&](const VectorXd& at) -> VectorXd {
                return (figures.value(number_at(at)) - measured.value).cwiseProduct(weight);
            },
            [&](const VectorXd& at) -> MatrixXd {
                return weight.asDiagonal() * figures.gradient(number_at(at)).rate *
                       measured.step.asDiagonal();
            }};
        const VectorXd before_pass = x;
        nearest = minimise(problem, x, box);
        x = nearest.x;
        found.iterations += nearest.iterations;
        residual = nearest.residual.cwiseQuotient(weight);
        found.calculated = residual + measured.value;
        const double share = 1 - static_cast<double>(n) / static_cast<double>(N);
        found.freedom = static_cast<int>(share * *std::ranges::min_element(counts));
        if (N <= n) break;
        if (measured.robust && pass > reweighted &&
            (x - before_pass).cwiseAbs().maxCoeff() <= numbers_stay) {
            stays = true;
            break;
        }
        found.noise = noise_of(residual, measured, counts, share);
        for (std::size_t c = 0; c < counts.size(); ++c)
            found.noise[c] = std::max(found.noise[c], least_noise * range[c]);
        for (Index k = 0; k < N; ++k) u[k] = residual[k] / noise_at(k);
        loss = loss_weights(u, measured.robust);
    }
    found.outliers.assign(counts.size(), 0);
    for (Index k = 0; N > n && k < N; ++k) {
        u[k] = residual[k] / noise_at(k);
        if (std::abs(u[k]) > outlying)
            ++found
                  .outliers[static_cast<std::size_t>(measured.column[static_cast<std::size_t>(k)])];
    }
    found.p = number_at(x).cwiseMax(measured.low).cwiseMin(measured.high);
    found.converged = nearest.converged && (stays || N <= n);
    for (Index i = 0; i < n; ++i)
        found.at_limit.push_back(x[i] <= box.low[i] || x[i] >= box.high[i]);
    if (!nearest.jacobian.allFinite()) {
        found.converged = false;
        found.why_not = "no rate at the result: " + figures.gradient(found.p).why_not;
        return found;
    }

    // The covariance, of the weights of the last residuals.
    const FigureGradient gradient = figures.gradient(found.p);
    for (Index k = 0; k < N; ++k) weight[k] = 1 / noise_at(k);
    const MatrixXd J = weight.asDiagonal() * gradient.rate * measured.step.asDiagonal();
    const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeFullV);
    found.singular_values = VectorXd::Zero(n);
    found.singular_values.head(svd.singularValues().size()) = svd.singularValues();
    const VectorXd& S = found.singular_values;
    determined = (S.array() > least_singular * S[0]).count();
    const MatrixXd V = svd.matrixV();
    found.undetermined = V.rightCols(n - determined);
    found.interval = VectorXd::Zero(n);
    const double factor = measured.robust && found.freedom > 0 ? robust_factor(u, determined) : 1;
    for (Index i = 0; i < n; ++i) {
        double variance = 0;
        for (Index k = 0; k < determined; ++k) variance += std::pow(V(i, k) / S[k], 2);
        const bool open = found.undetermined.cols() > 0 &&
                          found.undetermined.row(i).cwiseAbs().maxCoeff() > least_part;
        const bool none = open || found.freedom < 1 || !std::isfinite(factor);
        found.interval[i] =
            none ? unlimited
                 : student_95(found.freedom) * std::sqrt(factor * variance) * measured.step[i];
    }
    return found;
}

std::vector<Proposal> proposals(const FigureGradient& gradient, const VectorXd& value,
                                const VectorXd& extent, const VectorXd& step,
                                const MatrixXd& undetermined) {
    std::vector<Proposal> all;
    for (Index k = 0; k < undetermined.cols(); ++k) {
        const VectorXd change =
            step.cwiseProduct(undetermined.col(k)) / undetermined.col(k).cwiseAbs().maxCoeff();
        const VectorXd movement = gradient.rate * change;
        Proposal best;
        for (Index j = 0; j < movement.size(); ++j) {
            const double size = std::abs(movement[j]), rounding = 1e-10 * (1 + std::abs(value[j]));
            if (!std::isfinite(size) || !(extent[j] > rounding) || !(size > rounding) ||
                !(size / extent[j] > best.share))
                continue;
            best = {.figure = j, .movement = movement[j], .share = size / extent[j]};
        }
        all.push_back(best);
    }
    return all;
}

}  // namespace elastocheck::compare
