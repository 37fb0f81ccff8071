#include "compare/design/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/SpecialFunctions>

#include "compare/design/least_squares.hpp"
#include "models/eigen/dense.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Formulas and symbols: fit.hpp.
constexpr double unlimited = std::numeric_limits<double>::infinity();
// A combination of numbers is not determined below this singular value, as a share of the largest; a number with
// a smaller part than min_part in each such combination is determined.
constexpr double min_singular_share = 1e-6, min_part = 1e-3;
// Least s_c as a share of the range of the column, for exact data.
constexpr double min_noise = 1e-9;
constexpr int noise_updates = 2;  // estimates of s_c after the first fit
constexpr int max_robust_passes = 60;
constexpr double robust_tolerance = 1e-6;  // change of a number at which robust passes end [steps]
constexpr double cauchy_width = 2.385;     // c
constexpr double normal_median = 1.4826;   // standard deviation over median |.| if normal

double root_mean_square(const VectorXd& values) {
    return values.norm() / std::sqrt(static_cast<double>(values.size()));
}
double median_magnitude(VectorXd values) {
    values = values.cwiseAbs();
    const auto middle = values.begin() + values.size() / 2;
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}
double range_of(const VectorXd& values) {
    const double range = values.maxCoeff() - values.minCoeff();
    return range > 0 ? range : std::max(std::abs(values[0]), 1.0);
}

// √(ψ(u) / u) per value: the factor of a residual whose square is weighted by ψ(u) / u.
VectorXd loss_weights(const VectorXd& u) {
    return (1 + (u / cauchy_width).array().square()).rsqrt();
}
// Factor K² [Σ ψ² / (N - n)] / [mean ψ']² of the covariance of a robust fit, with
//
//   v = (u/c)²,   ψ = u / (1 + v),   ψ' = (1 - v) / (1 + v)²   (`slope`)
//
// NaN where mean ψ' ≤ 0: the loss does not determine the numbers.
double robust_factor(const VectorXd& u, Index n) {
    const double N = static_cast<double>(u.size());
    const Eigen::ArrayXd v = (u / cauchy_width).array().square();
    const Eigen::ArrayXd psi = u.array() / (1 + v), slope = (1 - v) / (1 + v).square();
    const double mean = slope.mean(), variance = (slope - mean).square().mean();
    if (!(mean > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double K = 1 + static_cast<double>(n) / N * variance / (mean * mean);
    return K * K * psi.square().sum() / (N - static_cast<double>(n)) / (mean * mean);
}

// The undetermined combinations of numbers (S_k ≤ 1e-6 S_1), and the intervals t √C_ii `step` of
// the others. J [values × numbers]: ∂u/∂x.
void set_intervals(const MatrixXd& J, const VectorXd& u, const Measured& measured, Fitted& fitted) {
    const Index n = J.cols();
    const Svd svd = svd_of(J, Eigen::ComputeFullV);
    VectorXd& S = fitted.singular_values = VectorXd::Zero(n);
    S.head(svd.values.size()) = svd.values;
    const Index determined = (S.array() > min_singular_share * S[0]).count();
    fitted.undetermined = svd.V.rightCols(n - determined);
    const VectorXd variance =
        (svd.V.leftCols(determined) * S.head(determined).cwiseInverse().asDiagonal())
            .rowwise()
            .squaredNorm();
    const double factor = measured.robust && fitted.freedom > 0 ? robust_factor(u, determined) : 1;
    fitted.interval =
        student_95(fitted.freedom) * (factor * variance).cwiseSqrt().cwiseProduct(measured.step);
    for (Index i = 0; i < n; ++i)
        if (fitted.freedom < 1 || !std::isfinite(factor) ||
            (fitted.undetermined.array().row(i).abs() > min_part).any())
            fitted.interval[i] = unlimited;
}

}  // namespace

double student_95(int freedom) {
    if (freedom < 1) return unlimited;
    // P(|T| > t) = I_x(ν/2, 1/2), x = ν / (ν + t²), of the incomplete beta function I; by bisection
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
        const double x = (low + high) / 2;
        (Eigen::numext::betainc(freedom / 2.0, 0.5, x) < 0.05 ? low : high) = x;
    }
    return std::sqrt(freedom * (1 / low - 1));
}

Fitted fit(const Figures& figures, const Measured& measured, const SearchRange& range) {
    const Index n = range.start.size(), N = measured.value.size();
    std::vector<std::vector<Index>> rows_of_column;
    for (std::size_t k = 0; k < measured.column.size(); ++k) {
        const auto c = static_cast<std::size_t>(measured.column[k]);
        rows_of_column.resize(std::max(rows_of_column.size(), c + 1));
        rows_of_column[c].push_back(static_cast<Index>(k));
    }
    const auto number_at = [&](const VectorXd& x) -> VectorXd {
        return within({range.low, range.high}, measured.step.cwiseProduct(x));
    };
    // For each value: s_c, √(ψ(u) / u), f - y and u.
    VectorXd noise(N), loss_weight = VectorXd::Ones(N), residual(N), u = VectorXd::Zero(N);
    LeastSquares problem{
        [&](const VectorXd& x) -> VectorXd {
            return (figures.value(number_at(x)) - measured.value)
                .cwiseProduct(loss_weight)
                .cwiseQuotient(noise);
        },
        [&](const VectorXd& x) -> MatrixXd {
            return loss_weight.cwiseQuotient(noise).asDiagonal() * figures.gradient(number_at(x)) *
                   measured.step.asDiagonal();
        },
        {range.low.cwiseQuotient(measured.step), range.high.cwiseQuotient(measured.step)}};
    problem.centre = within(problem.box, range.start.cwiseQuotient(measured.step));
    Fitted fitted{.p = range.start};
    const VectorXd before = figures.value(number_at(problem.centre));
    if (!before.allFinite()) {
        fitted.why_not = "the start";
        return fitted;
    }
    // Degrees of freedom of a column: N_c - n N_c / N = share N_c.
    const double share = 1 - static_cast<double>(n) / static_cast<double>(N);
    fitted.freedom = std::numeric_limits<int>::max();
    for (const auto& rows : rows_of_column) {
        const VectorXd values = measured.value(rows);
        noise(rows).setConstant(range_of(values));
        fitted.columns.push_back(
            {0, root_mean_square(before(rows) - values), static_cast<int>(rows.size())});
        fitted.freedom =
            std::min(fitted.freedom, static_cast<int>(share * static_cast<double>(rows.size())));
    }

    Minimum nearest{.x = problem.centre};
    // A robust fit repeats until the numbers change no more. Else there is a fit with s_c from the range, and two
    // with estimates of s_c.
    bool is_settled = !measured.robust || N <= n;
    for (int pass = 0; pass <= (measured.robust ? max_robust_passes : noise_updates); ++pass) {
        const VectorXd last = nearest.x;
        nearest = minimise(problem, last);
        residual = nearest.residual.cwiseProduct(noise).cwiseQuotient(loss_weight);
        if (N <= n) break;
        is_settled = is_settled || (pass > noise_updates &&
                                    (nearest.x - last).cwiseAbs().maxCoeff() <= robust_tolerance);
        if (measured.robust && is_settled) break;
        for (const auto& rows : rows_of_column) {
            const VectorXd deviation = residual(rows);
            noise(rows).setConstant(
                std::max(min_noise * range_of(measured.value(rows)),
                         (measured.robust ? normal_median * median_magnitude(deviation)
                                          : root_mean_square(deviation)) /
                             std::sqrt(share)));
        }
        if (measured.robust) loss_weight = loss_weights(residual.cwiseQuotient(noise));
    }
    if (N > n) u = residual.cwiseQuotient(noise);
    for (std::size_t c = 0; c < rows_of_column.size(); ++c) {
        fitted.columns[c].noise = noise[rows_of_column[c].front()];
        fitted.columns[c].outliers =
            static_cast<int>((u(rows_of_column[c]).array().abs() > outlying).count());
    }
    fitted.p = number_at(nearest.x);
    fitted.converged = nearest.converged && is_settled;
    for (Index i = 0; i < n; ++i)
        fitted.at_limit.push_back(nearest.x[i] <= problem.box.low[i] ||
                                  nearest.x[i] >= problem.box.high[i]);
    const MatrixXd rate = figures.gradient(fitted.p);
    if (rate.allFinite()) {
        set_intervals(noise.cwiseInverse().asDiagonal() * rate * measured.step.asDiagonal(), u,
                      measured, fitted);
        return fitted;
    }
    fitted.converged = false;
    fitted.why_not = "the result";
    return fitted;
}

Proposal proposal(const MatrixXd& gradient, const VectorXd& extent, const VectorXd& combination) {
    const VectorXd movement = gradient * combination / combination.cwiseAbs().maxCoeff();
    Proposal best;
    for (Index j = 0; j < movement.size(); ++j)
        if (const double share = std::abs(movement[j]) / extent[j];
            std::isfinite(share) && share > best.share)
            best = {j, movement[j], share};
    return best;
}

}  // namespace elastocheck::compare
