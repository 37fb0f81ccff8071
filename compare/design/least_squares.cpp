#include "compare/design/least_squares.hpp"

#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// of |r|² and of the scaled x
constexpr double least_decrease = 1e-14, least_change = 1e-10;
constexpr double beside = 1e-6;  // |Δx| to a point without residuals at which a search ends

// -1, 1: x is at this bound, beyond which the sum of squares decreases.
int held(const Box& box, const VectorXd& x, Index i, double descent) {
    return descent < 0 && x[i] <= box.low[i] ? -1 : descent > 0 && x[i] >= box.high[i] ? 1 : 0;
}

// [r; w (x - about)] at P(x), as Eigen's method calls it.
struct Stacked {
    const LeastSquares& problem;
    MatrixXd first;      // ∂r/∂x at the start, for the first step
    double weight;       // w
    Index rows;          // of the stack
    VectorXd last = {};  // of the last call
    VectorXd none = {};  // last point without residuals

    int values() const { return static_cast<int>(rows); }
    int operator()(const VectorXd& x, VectorXd& stacked) {
        const VectorXd at = within(problem.box, x);
        stacked << problem.residual(at), weight * (at - problem.about);
        last = stacked;
        if (!stacked.allFinite()) none = at;
        return 0;
    }
    int df(const VectorXd& x, MatrixXd& J) {
        J << (first.size() > 0 ? std::exchange(first, {}) : problem.jacobian(x)),
            weight * MatrixXd::Identity(x.size(), x.size());
        const VectorXd descent = -J.transpose() * last;
        for (Index i = 0; i < x.size(); ++i)
            if (held(problem.box, x, i, descent[i]) != 0) J.col(i).setZero();
        return J.allFinite() ? 0 : -1;
    }
};

}  // namespace

VectorXd within(const Box& box, const VectorXd& x) {
    return x.cwiseMax(box.low).cwiseMin(box.high);
}

Minimum minimise(const LeastSquares& problem, VectorXd start) {
    namespace Status = Eigen::LevenbergMarquardtSpace;
    Minimum found{.x = std::move(start)};
    found.residual = problem.residual(found.x);
    const MatrixXd J = problem.jacobian(found.x);
    if (!found.residual.allFinite() || !J.allFinite()) return found;
    const double size = J.size() > 0 ? J.colwise().norm().maxCoeff() : 0;
    found.converged = !(size > 0);
    if (found.converged) return found;
    Stacked stacked{problem, J, problem.pull * size, J.rows() + J.cols()};
    Eigen::LevenbergMarquardt<Stacked> method(stacked);
    method.parameters.ftol = least_decrease, method.parameters.xtol = least_change;
    auto status = method.minimizeInit(found.x);
    bool ends = false;  // where the residuals do
    do {
        status = method.minimizeOneStep(found.x);
        found.x = within(problem.box, found.x);
        ends = stacked.none.size() > 0 && (found.x - stacked.none).norm() <= beside;
    } while (!ends && status == Status::Running &&
             !method.fvec.head(found.residual.size()).isZero(0));
    found.residual = method.fvec.head(found.residual.size());
    found.converged =
        !ends && status != Status::TooManyFunctionEvaluation && status != Status::UserAsked;
    return found;
}

std::vector<int> limits_reached(const LeastSquares& problem, const Minimum& at) {
    const VectorXd descent = -problem.jacobian(at.x).transpose() * at.residual;
    std::vector<int> limits;
    for (Index i = 0; i < descent.size(); ++i)
        limits.push_back(std::abs(descent[i]) > 1e-6 * at.residual.norm()
                             ? held(problem.box, at.x, i, descent[i])
                             : 0);
    return limits;
}

}  // namespace elastocheck::compare
