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

// √(ψ(u) / u) per value.
VectorXd loss_weights(const VectorXd& u) {
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
    found.interval =
        student_95(found.freedom) * (factor * variance).cwiseSqrt().cwiseProduct(measured.step);
    for (Index i = 0; i < n; ++i)
        if (found.freedom < 1 || !std::isfinite(factor) ||
            (found.undetermined.array().row(i).abs() > least_part).any())
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

Fitted fit(const Figures& figures, const Measured& measured, const SearchRange& range) {
    const Index n = range.start.size(), N = measured.value.size();
    std::vector<std::vector<Index>> places;  // of the values of each column
    for (std::size_t k = 0; k < measured.column.size(); ++k) {
        const auto c = static_cast<std::size_t>(measured.column[k]);
        places.resize(std::max(places.size(), c + 1));
        places[c].push_back(static_cast<Index>(k));
    }
    const auto number_at = [&](const VectorXd& x) -> VectorXd {
        return within({range.low, range.high}, measured.step.cwiseProduct(x));
    };
    VectorXd noise(N), loss = VectorXd::Ones(N), residual(N), u = VectorXd::Zero(N);
    LeastSquares problem{
        [&](const VectorXd& x) -> VectorXd {
            return (figures.value(number_at(x)) - measured.value)
                .cwiseProduct(loss)
                .cwiseQuotient(noise);
        },
        [&](const VectorXd& x) -> MatrixXd {
            return loss.cwiseQuotient(noise).asDiagonal() * figures.gradient(number_at(x)) *
                   measured.step.asDiagonal();
        },
        {range.low.cwiseQuotient(measured.step), range.high.cwiseQuotient(measured.step)}};
    problem.about = within(problem.box, range.start.cwiseQuotient(measured.step));
    Fitted found{.p = range.start};
    const VectorXd before = figures.value(number_at(problem.about));
    if (!before.allFinite()) {
        found.why_not = "the start";
        return found;
    }
    const double share = 1 - static_cast<double>(n) / static_cast<double>(N);
    found.freedom = std::numeric_limits<int>::max();
    for (const auto& at : places) {
        const VectorXd values = measured.value(at);
        noise(at).setConstant(range_of(values));
        found.columns.push_back(
            {0, root_mean_square(before(at) - values), static_cast<int>(at.size())});
        found.freedom =
            std::min(found.freedom, static_cast<int>(share * static_cast<double>(at.size())));
    }

    Minimum nearest{.x = problem.about};
    bool stays = !measured.robust || N <= n;
    for (int pass = 0; pass <= (measured.robust ? most_robust_passes : reweighted); ++pass) {
        const VectorXd last = nearest.x;
        nearest = minimise(problem, last);
        residual = nearest.residual.cwiseProduct(noise).cwiseQuotient(loss);
        if (N <= n) break;
        stays = stays ||
                (pass > reweighted && (nearest.x - last).cwiseAbs().maxCoeff() <= numbers_stay);
        if (measured.robust && stays) break;
        for (const auto& at : places) {
            const VectorXd off = residual(at);
            noise(at).setConstant(std::max(
                least_noise * range_of(measured.value(at)),
                (measured.robust ? normal_median * median_size(off) : root_mean_square(off)) /
                    std::sqrt(share)));
        }
        if (measured.robust) loss = loss_weights(residual.cwiseQuotient(noise));
    }
    if (N > n) u = residual.cwiseQuotient(noise);
    for (std::size_t c = 0; c < places.size(); ++c) {
        found.columns[c].noise = noise[places[c].front()];
        found.columns[c].outliers =
            static_cast<int>((u(places[c]).array().abs() > outlying).count());
    }
    found.p = number_at(nearest.x);
    found.converged = nearest.converged && stays;
    for (Index i = 0; i < n; ++i)
        found.at_limit.push_back(nearest.x[i] <= problem.box.low[i] ||
                                 nearest.x[i] >= problem.box.high[i]);
    const MatrixXd rate = figures.gradient(found.p);
    if (rate.allFinite()) {
        set_intervals(noise.cwiseInverse().asDiagonal() * rate * measured.step.asDiagonal(), u,
                      measured, found);
        return found;
    }
    found.converged = false;
    found.why_not = "the result";
    return found;
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
