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
        start.still.push_back(!(start.movement[j] > least_movement(start.value[j])));
    return start;
}

Solution solve_for(const Figures& figures, const Bands& bands, const SearchRange& range,
                   const VectorXd& p) {
    LeastSquares problem{
        [&](const VectorXd& x) -> VectorXd {
            const VectorXd f = figures.value(range.at(x));
            return (f - f.cwiseMax(bands.low).cwiseMin(bands.high)).cwiseQuotient(bands.scale);
        },
        [&](const VectorXd& x) -> MatrixXd {
            const VectorXd f = figures.value(range.at(x));
            MatrixXd J = bands.scale.cwiseInverse().asDiagonal() * figures.gradient(range.at(x)) *
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
    return {range.at(nearest.x), nearest.converged, nearest.residual,
            limits_reached(problem, nearest)};
}

}  // namespace elastocheck::compare
