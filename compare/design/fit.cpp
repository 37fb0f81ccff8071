#include "compare/design/fit.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/SpecialFunctions>

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

// The values of each column.
std::vector<VectorXd> columns_of(const VectorXd& values, const std::vector<int>& column) {
    std::vector<VectorXd> all(1 + static_cast<std::size_t>(*std::ranges::max_element(column)));
    for (std::size_t k = 0; k < column.size(); ++k) {
        VectorXd& of = all[static_cast<std::size_t>(column[k])];
        of.conservativeResize(of.size() + 1);
        of[of.size() - 1] = values[static_cast<Index>(k)];
    }
    return all;
}
// Per value, the number of its column.
VectorXd per_value(const std::vector<double>& of_column, const std::vector<int>& column) {
    VectorXd all(std::ssize(column));
    for (std::size_t k = 0; k < column.size(); ++k)
        all[static_cast<Index>(k)] = of_column[static_cast<std::size_t>(column[k])];
    return all;
}

double root_mean_square(const VectorXd& values) {
    return values.norm() / std::sqrt(static_cast<double>(values.size()));
}
double median_size(VectorXd values) {
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

// The undetermined combinations and the intervals; J [values × numbers]: ∂u/∂x.
void set_intervals(const MatrixXd& J, const VectorXd& u, const Measured& measured, Fitted& found) {
    const Index n = J.cols();
    const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeFullV);
    VectorXd& S = found.singular_values = VectorXd::Zero(n);
    S.head(svd.singularValues().size()) = svd.singularValues();
    const Index determined = (S.array() > least_singular * S[0]).count();
    found.undetermined = svd.matrixV().rightCols(n - determined);
    const VectorXd variance =
        (svd.matrixV().leftCols(determined) * S.head(determined).cwiseInverse().asDiagonal())
            .rowwise()
            .squaredNorm();
    const double factor = measured.robust && found.freedom > 0 ? robust_factor(u, determined) : 1;
    const bool none = found.freedom < 1 || !std::isfinite(factor);
    const double t = student_95(found.freedom);
    found.interval = (t * (factor * variance).cwiseSqrt()).cwiseProduct(measured.step);
    for (Index i = 0; i < n; ++i)
        if (none || (found.undetermined.cols() > 0 &&
                     found.undetermined.row(i).cwiseAbs().maxCoeff() > least_part))
            found.interval[i] = unlimited;
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

Fitted fit(const Figures& figures, const Measured& measured) {
    const Index n = measured.start.size(), N = measured.value.size();
    const auto number_at = [&](const VectorXd& x) -> VectorXd {
        return within({measured.low, measured.high}, measured.step.cwiseProduct(x));
    };
    Fitted found;
    std::vector<double> least_of_column;
    for (const VectorXd& values : columns_of(measured.value, measured.column)) {
        found.noise.push_back(range_of(values));
        least_of_column.push_back(least_noise * found.noise.back());
    }
    VectorXd weight(N), loss = VectorXd::Ones(N), residual(N), u = VectorXd::Zero(N);
    LeastSquares problem{
        [&](const VectorXd& x) -> VectorXd {
            return (figures.value(number_at(x)) - measured.value).cwiseProduct(weight);
        },
        [&](const VectorXd& x) -> MatrixXd {
            return weight.asDiagonal() * figures.gradient(number_at(x)).rate *
                   measured.step.asDiagonal();
        },
        {measured.low.cwiseQuotient(measured.step), measured.high.cwiseQuotient(measured.step)}};
    problem.about = within(problem.box, measured.start.cwiseQuotient(measured.step));
    const VectorXd before = figures.value(number_at(problem.about));
    if (!before.allFinite()) {
        found.why_not = "a measured output has no value at the start";
        return found;
    }
    const double share = 1 - static_cast<double>(n) / static_cast<double>(N);
    found.freedom = std::numeric_limits<int>::max();
    for (const VectorXd& off : columns_of(before - measured.value, measured.column)) {
        found.rms_before.push_back(root_mean_square(off));
        found.freedom =
            std::min(found.freedom, static_cast<int>(share * static_cast<double>(off.size())));
    }

    Minimum nearest{.x = problem.about};
    bool stays = !measured.robust || N <= n;
    const int passes = measured.robust ? most_robust_passes : reweighted;
    for (int pass = 0; pass <= passes; ++pass) {
        weight = loss.cwiseQuotient(per_value(found.noise, measured.column));
        const VectorXd last = nearest.x;
        nearest = minimise(problem, last);
        residual = nearest.residual.cwiseQuotient(weight);
        if (N <= n) break;
        if (measured.robust && pass > reweighted &&
            (nearest.x - last).cwiseAbs().maxCoeff() <= numbers_stay) {
            stays = true;
            break;
        }
        const auto columns = columns_of(residual, measured.column);
        for (std::size_t c = 0; c < columns.size(); ++c)
            found.noise[c] = std::max(least_of_column[c],
                                      (measured.robust ? normal_median * median_size(columns[c])
                                                       : root_mean_square(columns[c])) /
                                          std::sqrt(share));
        u = residual.cwiseQuotient(per_value(found.noise, measured.column));
        loss = loss_weights(u, measured.robust);
    }
    if (N > n) u = residual.cwiseQuotient(per_value(found.noise, measured.column));
    for (const VectorXd& of : columns_of(u, measured.column))
        found.outliers.push_back(static_cast<int>((of.cwiseAbs().array() > outlying).count()));
    found.p = number_at(nearest.x);
    found.converged = nearest.converged && stays;
    for (Index i = 0; i < n; ++i)
        found.at_limit.push_back(nearest.x[i] <= problem.box.low[i] ||
                                 nearest.x[i] >= problem.box.high[i]);
    const FigureGradient gradient = figures.gradient(found.p);
    if (!gradient.rate.allFinite()) {
        found.converged = false;
        found.why_not = "no rate at the result: " + gradient.why_not;
        return found;
    }
    const VectorXd noise = per_value(found.noise, measured.column);
    set_intervals(noise.cwiseInverse().asDiagonal() * gradient.rate * measured.step.asDiagonal(), u,
                  measured, found);
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
            const double size = std::abs(movement[j]), least = least_movement(value[j]);
            if (!std::isfinite(size) || !(extent[j] > least) || !(size > least) ||
                !(size / extent[j] > best.share))
                continue;
            best = {.figure = j, .movement = movement[j], .share = size / extent[j]};
        }
        all.push_back(best);
    }
    return all;
}

}  // namespace elastocheck::compare
