// Measures that make SLSQP converge to the last digits; without, it stops at 1e-6 of the gradient.
//
// 1. Coordinates y, ξ = T y, in which the problem is well scaled: T = [N B] with
//      B = Z |W|^-½                      the modes along the constraints, each with unit stiffness
//      N = (1 - Z W⁻¹ Zᵀ H) Y, scaled    the directions across them, conjugate to the modes
//    SLSQP's first Hessian, the unit matrix, is then the right one, and its first steps are Newton
//    steps.
//
// 2. The function is V + λᵀΦ with λ fixed at the least-squares multipliers of the centre. It equals
//    V wherever Φ = 0, so it has the same constrained minima, but its gradient is small and its own
//    multipliers almost vanish. The line search on V + Σ μ|Φ| then accepts full steps; with V alone
//    the curvature of loaded constraints makes it reject them (Maratos effect, 1978).
//
// 3. All values are changes since the centre, summed without cancellation (potential.hpp,
//    constraints.hpp): the function-value test has its floor at the roundoff of the change, not of
//    V. Charts of large steps end there; the next chart, centred at their result, has a far lower
//    floor.
//
// 4. Motions that were idle at the last equilibrium get a stiffness about the centre. V does not
//    change along them, so this selects one of many equal minima, where the added stiffness
//    vanishes. Without it, the small stiffness that they show away from equilibrium would cause
//    arbitrary steps. If V did change along them, the acceptance measure, which excludes this term,
//    would show it. Modes that are idle only at the centre are left out of T.
//
// 5. Dependent rows of Φ are withheld from SLSQP, whose least-squares subproblem fails on them.
//    They stay in the acceptance measure.
#include "reference/energy/minimise/minimise.hpp"
#include "models/eigen/dense.hpp"

#include <nlopt.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <memory>

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double stop_excess = 0.01;   // of the tolerance: the minimisation stops below it
constexpr double added_stiffness = 1;  // stiffness given to idle motions, in units of F·L
// consecutive calls at one point: SLSQP's step has vanished and it would not end
constexpr int max_repeats = 20;
// evaluations without improvement, once within the tolerance and before that (a chart of large steps
// ends at their roundoff)
constexpr int max_stagnation = 5, max_stagnation_at_first = 20;
// A chart that has reduced its residual by this factor and needs more evaluations than this is
// ended: the Hessian of the next chart achieves in one step what SLSQP's update learns slowly (long
// chains, closing stops).
constexpr double chart_reduction = 1e-3;
constexpr int min_chart_evaluations = 8;

// The matrix T of item 1.
MatrixXd well_scaled_coordinates(const Balance& centre, const MatrixXd& H, const Modes& modes) {
    const auto resisting = modes.resisting();
    const MatrixXd Z = modes.Z(Eigen::all, resisting);
    const VectorXd W = modes.stiffness(resisting);
    const MatrixXd Y = row_space(centre);
    const auto rank = Y.cols();
    MatrixXd T(H.rows(), rank + Z.cols());
    const MatrixXd coupling = transposed_product(matrix_product(H, Z), Y);
    T.leftCols(rank) = Y - matrix_product(Z, W.cwiseInverse().asDiagonal() * coupling);
    const MatrixXd H_T = H * T.leftCols(rank);
    for (Eigen::Index i = 0; i < rank; ++i) {
        const double stiffness = std::abs(T.col(i).dot(H_T.col(i)));
        T.col(i) /= std::sqrt(std::max(stiffness, 1.0));
    }
    T.rightCols(Z.cols()) = Z * W.cwiseAbs().cwiseSqrt().cwiseInverse().asDiagonal();
    return T;
}

struct Problem {
    const Model& model;
    const Prescribed& prescribed;
    const Scales& scales;
    const Balance& balance;
    double tolerance;
    int evaluation_limit;
    const Modes& modes;
    const MatrixXd& idle;
    MatrixXd T_t;        // ξ = T y
    VectorXd lambda, D;  // multipliers of D Φ
    VectorXd row_scale;  // scales the rows of ∂c/∂y to unit vectors at the centre
    Chart chart;
    nlopt_opt opt = nullptr;

    // the last point evaluated
    VectorXd y{}, c{};
    double f = 0;
    VectorXd f_y{};
    MatrixXd c_y_t{};  // (∂c/∂y)ᵀ [size of y × rank]

    Minimisation best;
    double excess_at_centre = std::numeric_limits<double>::quiet_NaN();
    int since_best = 0;
    int repeats = 0;  // calls at the same y
};

// Acceptance measure for the gradient g and the independent rows J_t: g projected by their QR.
double measure(Problem& p, const VectorXd& g, const MatrixXd& J_t, const VectorXd& Phi) {
    VectorXd projected = g;
    if (J_t.cols() > 0) {
        const Eigen::HouseholderQR<MatrixXd> qr(J_t);
        projected = transposed_times_vector(qr.householderQ(), projected);
        projected.head(J_t.cols()).setZero();
        projected = times_vector(qr.householderQ(), projected);
    }
    return excess(projected, Phi, p.modes, p.scales, p.tolerance);
}

// Evaluates f, c and their derivatives at y, and the stop criteria.
void evaluate(Problem& p, const VectorXd& y) {
    if (p.best.evaluations > 0 && p.y == y) {
        if (++p.repeats >= max_repeats && p.opt) nlopt_force_stop(p.opt);
        return;
    }
    p.y = y;
    p.repeats = 0;
    const VectorXd xi = p.T_t.transpose() * y;
    const VectorXd S = p.scales.coordinates(static_cast<int>(xi.size()));
    move_to(p.chart, S.cwiseProduct(xi));
    const Potential V = potential(p.model, p.prescribed, p.chart);
    const ConstraintValues Phi = constraints(p.model, p.prescribed, p.chart);
    const double energy = p.scales.energy();
    const VectorXd DPhi = p.D.cwiseProduct(Phi.Phi);
    const Jacobian J = scaled(Phi.Phi_q, p.D, S);  // ∂DΦ/∂ξ [m × 6nb]
    const MatrixXd J_t = transposed(J);
    const VectorXd g = S.cwiseProduct(V.gradient) / energy + J_t * p.lambda;

    p.c = p.row_scale.cwiseProduct(DPhi(p.balance.independent));
    const VectorXd idle_part = p.idle.transpose() * xi;
    p.f = V.change / energy + p.lambda.dot(p.D.cwiseProduct(Phi.dPhi)) +
          0.5 * added_stiffness * idle_part.squaredNorm();
    p.f_y = p.T_t * (g + added_stiffness * p.idle * idle_part);
    p.c_y_t =
        times_transposed(p.T_t, J)(Eigen::all, p.balance.independent) * p.row_scale.asDiagonal();

    // SLSQP begins at the centre, whose projected gradient is known.
    const double e =
        p.best.evaluations++ == 0
            ? excess(p.balance.projected_gradient, DPhi, p.modes, p.scales, p.tolerance)
            : measure(p, g, J_t(Eigen::all, p.balance.independent), DPhi);
    if (!std::isfinite(e) || !std::isfinite(p.f)) p.f = HUGE_VAL;  // SLSQP then shortens its step
    if (std::isfinite(e) && !(p.best.excess <= e)) {
        p.best.excess = e;
        p.best.poses = poses(p.chart);
        p.since_best = 0;
    } else {
        ++p.since_best;
    }
    if (p.best.evaluations == 1) p.excess_at_centre = e;
    const bool accepted = p.best.excess <= p.tolerance;
    const bool ends_chart = p.best.evaluations >= min_chart_evaluations &&
                            p.best.excess <= chart_reduction * p.excess_at_centre && !accepted;
    if (ends_chart || p.best.excess <= stop_excess * p.tolerance ||
        p.since_best >= (accepted ? max_stagnation : max_stagnation_at_first) ||
        p.best.evaluations >= p.evaluation_limit || !std::isfinite(p.best.excess))
        if (p.opt) nlopt_force_stop(p.opt);
}

double objective(unsigned n, const double* y, double* gradient, void* data) {
    Problem& p = *static_cast<Problem*>(data);
    evaluate(p, Eigen::Map<const VectorXd>(y, n));
    if (gradient) Eigen::Map<VectorXd>(gradient, n) = p.f_y;
    return p.f;
}

void constraint_vector(unsigned m, double* result, unsigned n, const double* y, double* gradient,
                       void* data) {
    Problem& p = *static_cast<Problem*>(data);
    evaluate(p, Eigen::Map<const VectorXd>(y, n));
    Eigen::Map<VectorXd>(result, m) = p.c;
    if (gradient)
        Eigen::Map<MatrixXd>(gradient, n, m) =
            p.c_y_t;  // row-major [m × n] is column-major [n × m]
}

}  // namespace

Minimisation minimise(const Path& path, const State& centre, const MatrixXd& idle,
                      int evaluation_limit) {
    const Model& model = path.model;
    const Scales& scales = path.scales;
    const Balance& balance_at_centre = centre.balance;
    const Prescribed prescribed = at(path.course, centre.a);
    const int rank = static_cast<int>(balance_at_centre.independent.size());
    const MatrixXd H_with_idle = centre.H + added_stiffness * idle * idle.transpose();
    const Modes modes = idle.cols() > 0 ? modes_of(balance_at_centre, H_with_idle) : centre.modes;
    const MatrixXd T = well_scaled_coordinates(balance_at_centre, H_with_idle, modes);
    const int n = static_cast<int>(T.cols());
    Problem p{.model = model,
              .prescribed = prescribed,
              .scales = scales,
              .balance = balance_at_centre,
              .tolerance = path.options.tolerance,
              .evaluation_limit = evaluation_limit,
              .modes = modes,
              .idle = idle,
              .T_t = T.transpose(),
              .lambda = balance_at_centre.lambda,
              .D = scales.rows(model),
              .row_scale = VectorXd::Ones(rank),
              .chart = chart_about(centre.poses),
              .best = {centre.poses, std::numeric_limits<double>::quiet_NaN(), 0}};
    if (n == 0) {
        evaluate(p, VectorXd(0));
        return p.best;
    }

    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt(
        nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(n)), nlopt_destroy);
    p.opt = opt.get();
    for (int i = 0; i < rank; ++i)
        p.row_scale[i] =
            1 / (T.transpose() * balance_at_centre.J_t.col(
                                     balance_at_centre.independent[static_cast<std::size_t>(i)]))
                    .norm();
    nlopt_set_min_objective(opt.get(), objective, &p);
    const std::vector<double> no_tolerance(static_cast<std::size_t>(rank), 0.0);
    if (rank > 0)
        nlopt_add_equality_mconstraint(opt.get(), static_cast<unsigned>(rank), constraint_vector,
                                       &p, no_tolerance.data());
    VectorXd y = VectorXd::Zero(n);
    double f = 0;
    nlopt_optimize(opt.get(), y.data(), &f);
    return p.best;
}

}  // namespace elastocheck::reference::energy
