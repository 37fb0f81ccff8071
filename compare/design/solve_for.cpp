#include "compare/design/solve_for.hpp"

#include "compare/design/least_squares.hpp"

namespace elastocheck::compare {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SearchStart start_of(const Figures& figures, const SearchRange& range) {
    SearchStart start{figures.value(range.start), {}};
    if (!start.value.allFinite()) return start;
    start.gradient = figures.gradient(range.start);
    start.movement = (start.gradient * (range.high - range.low).asDiagonal()).rowwise().norm();
    for (Index j = 0; j < start.value.size(); ++j)
        start.still.push_back(!(start.movement[j] > min_movement(start.value[j])));
    return start;
}

Solution solve_for(const Figures& figures, const Bands& bands, const SearchRange& range,
                   const VectorXd& p) {
    // Figures and gradient at the last points: each search begins where the one before it ended.
    VectorXd valued, f, rated;
    MatrixXd rate;
    const auto value_at = [&](const VectorXd& x) -> const VectorXd& {
        if (x.size() != valued.size() || x != valued) {
            f = figures.value(range.point(x));
            valued = x;
        }
        return f;
    };
    const auto rate_at = [&](const VectorXd& x) -> const MatrixXd& {
        if (x.size() != rated.size() || x != rated) {
            rate = figures.gradient(range.point(x));
            rated = x;
        }
        return rate;
    };
    LeastSquares problem{
        [&](const VectorXd& x) -> VectorXd {
            value_at(x);
            return (f - f.cwiseMax(bands.low).cwiseMin(bands.high)).cwiseQuotient(bands.scale);
        },
        [&](const VectorXd& x) -> MatrixXd {
            value_at(x);
            MatrixXd J = bands.scale.cwiseInverse().asDiagonal() * rate_at(x) *
                         (range.high - range.low).asDiagonal();
            for (Index j = 0; j < J.rows(); ++j)
                if (f[j] > bands.low[j] && f[j] < bands.high[j]) J.row(j).setZero();
            return J;
        },
        {range.shares(range.low), range.shares(range.high)},
        VectorXd::Zero(p.size())};
    Minimum nearest{within(problem.box, range.shares(p))};
    for (const double mu : {1e-2, 1e-4, 1e-6}) {
        problem.pull = mu;
        nearest = minimise(problem, nearest.x);
    }
    return {range.point(nearest.x), nearest.converged, nearest.residual,
            limits_reached(problem, nearest)};
}

}  // namespace elastocheck::compare
