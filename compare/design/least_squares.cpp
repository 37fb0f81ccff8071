#include "compare/design/least_squares.hpp"

#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The search has converged below these relative changes of |r|² and of the scaled x.
constexpr double min_decrease = 1e-14, min_change = 1e-10;
// It has not converged within this |Δx| of a point at which the residuals are not finite.
constexpr double undefined_distance = 1e-6;

// Bound that stops x_i, -1 the lower or 1 the upper, beyond which the sum of squares
// would decrease; else 0. `descent` is -∂(½ |r|²)/∂x_i.
int active_bound(const Box& box, const VectorXd& x, Index i, double descent) {
    return descent < 0 && x[i] <= box.low[i] ? -1 : descent > 0 && x[i] >= box.high[i] ? 1 : 0;
}

// [r; w (x - c)] at P(x), and its Jacobian `df` without the columns of numbers at an active bound, with the
// names and return values that Eigen's method requires; a negative one ends the search.
struct Stacked {
    const LeastSquares& problem;
    MatrixXd first;                // ∂r/∂x at the start, for the first step
    double weight;                 // w
    Index rows;                    // of the stack
    VectorXd last = {};            // stack of the last call
    VectorXd last_undefined = {};  // last point at which the residuals were not finite

    int values() const { return static_cast<int>(rows); }
    int operator()(const VectorXd& x, VectorXd& stacked) {
        const VectorXd inside = within(problem.box, x);
        stacked << problem.residual(inside), weight * (inside - problem.centre);
        last = stacked;
        if (!stacked.allFinite()) last_undefined = inside;
        return 0;
    }
    int df(const VectorXd& x, MatrixXd& J) {
        J << (first.size() > 0 ? std::exchange(first, {}) : problem.jacobian(x)),
            weight * MatrixXd::Identity(x.size(), x.size());
        const VectorXd descent = -J.transpose() * last;
        for (Index i = 0; i < x.size(); ++i)
            if (active_bound(problem.box, x, i, descent[i]) != 0) J.col(i).setZero();
        return J.allFinite() ? 0 : -1;
    }
};

}  // namespace

VectorXd within(const Box& box, const VectorXd& x) {
    return x.cwiseMax(box.low).cwiseMin(box.high);
}

Minimum minimise(const LeastSquares& problem, VectorXd start) {
    namespace Status = Eigen::LevenbergMarquardtSpace;
    Minimum minimum{.x = std::move(start)};
    minimum.residual = problem.residual(minimum.x);
    const MatrixXd J = problem.jacobian(minimum.x);
    if (!minimum.residual.allFinite() || !J.allFinite()) return minimum;
    const double largest_column = J.size() > 0 ? J.colwise().norm().maxCoeff() : 0;
    minimum.converged = !(largest_column > 0);
    if (minimum.converged) return minimum;
    Stacked stacked{problem, J, problem.pull * largest_column, J.rows() + J.cols()};
    Eigen::LevenbergMarquardt<Stacked> method(stacked);
    method.parameters.ftol = min_decrease;
    method.parameters.xtol = min_change;
    auto status = method.minimizeInit(minimum.x);
    bool meets_undefined = false;
    do {
        status = method.minimizeOneStep(minimum.x);
        minimum.x = within(problem.box, minimum.x);
        meets_undefined = stacked.last_undefined.size() > 0 &&
                          (minimum.x - stacked.last_undefined).norm() <= undefined_distance;
    } while (!meets_undefined && status == Status::Running &&
             !method.fvec.head(minimum.residual.size()).isZero(0));
    minimum.residual = method.fvec.head(minimum.residual.size());
    minimum.converged = !meets_undefined && status != Status::TooManyFunctionEvaluation &&
                        status != Status::UserAsked;
    return minimum;
}

std::vector<int> limits_reached(const LeastSquares& problem, const Minimum& at) {
    const VectorXd descent = -problem.jacobian(at.x).transpose() * at.residual;
    std::vector<int> limits;
    for (Index i = 0; i < descent.size(); ++i)
        limits.push_back(std::abs(descent[i]) > 1e-6 * at.residual.norm()
                             ? active_bound(problem.box, at.x, i, descent[i])
                             : 0);
    return limits;
}

}  // namespace elastocheck::compare
