#include "reference/energy/constraints/balance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"
#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double idle_stiffness = 1e-9;  // [F L]: a force F would move such a mode by 10⁹ L

}  // namespace

double largest(const Eigen::Ref<const VectorXd>& v) {
    if (v.size() == 0) return 0;
    return v.allFinite() ? v.cwiseAbs().maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

Balance balance(const Model& model, const Scales& scales, const VectorXd& gradient,
                const ConstraintValues& values) {
    const int n = static_cast<int>(gradient.size()), m = static_cast<int>(values.Phi.size());
    const VectorXd S = scales.coordinates(n), D = scales.rows(model);
    const VectorXd g = S.cwiseProduct(gradient) / scales.energy();
    Balance result{.lambda = VectorXd::Zero(m),
                   .projected_gradient = g,
                   .Phi = D.cwiseProduct(values.Phi),
                   .J_t = transposed(scaled(values.Phi_q, D, S)),
                   .null_space = MatrixXd::Identity(n, n),
                   .independent = {},
                   .qr = {}};
    if (m == 0 || n == 0 || !result.J_t.allFinite() || !g.allFinite()) return result;

    auto& qr = result.qr;
    qr.setThreshold(rank_threshold);
    qr.compute(result.J_t);
    const int rank = static_cast<int>(qr.rank());
    const VectorXd minus_g = -g;
    result.lambda = qr.solve(minus_g);
    result.projected_gradient = g + result.J_t * result.lambda;
    result.null_space =
        times_matrix(qr.householderQ(), MatrixXd::Identity(n, n).rightCols(n - rank));
    for (int i = 0; i < rank; ++i) result.independent.push_back(qr.colsPermutation().indices()[i]);
    return result;
}

MatrixXd row_space(const Balance& conditions) {
    const MatrixXd unit_columns =
        MatrixXd::Identity(conditions.null_space.rows(), std::ssize(conditions.independent));
    return unit_columns.cols() > 0 ? times_matrix(conditions.qr.householderQ(), unit_columns)
                                   : unit_columns;
}

VectorXd shortest(const Balance& conditions, const VectorXd& Phi) {
    return conditions.qr.transpose().solve(Phi);
}

Balance balance(const Model& model, const Prescribed& prescribed, const Scales& scales,
                const Chart& chart) {
    return balance(model, scales, potential(model, prescribed, chart).gradient,
                   constraints(model, prescribed, chart));
}

Balance sparse_balance(const Model& model, const Prescribed& prescribed, const Scales& scales,
                       const Chart& chart, const VectorXd& lambda) {
    const VectorXd S = scales.coordinates(coordinates(model)), D = scales.rows(model);
    const ConstraintValues values = constraints(model, prescribed, chart);
    const Jacobian J = scaled(values.Phi_q, D, S);
    const VectorXd g =
        S.cwiseProduct(potential(model, prescribed, chart).gradient) / scales.energy();
    Projection projection = lambda.size() > 0 ? Projection{g + transposed_times(J, lambda), lambda}
                                              : project_gradient(J, g);
    Balance result;
    result.lambda = std::move(projection.lambda);
    result.projected_gradient = std::move(projection.gradient);
    result.Phi = D.cwiseProduct(values.Phi);
    return result;
}

Blocks scaled(Blocks H, const Scales& scales) {
    const VectorXd S = scales.coordinates(H.size);
    for (auto& block : H.blocks) block.M *= S[block.row] * S[block.column] / scales.energy();
    return H;
}

MatrixXd hessian(const Model& model, const Prescribed& prescribed, const Scales& scales,
                 const std::vector<Pose>& centre, const VectorXd& lambda) {
    const VectorXd S = scales.coordinates(coordinates(model));
    const MatrixXd H = hessian_blocks(model, prescribed, scales, centre, lambda).dense();
    return S.asDiagonal() * (0.5 * (H + H.transpose())) * S.asDiagonal() / scales.energy();
}

Blocks hessian_blocks(const Model& model, const Prescribed& prescribed, const Scales& scales,
                      const std::vector<Pose>& centre, const VectorXd& lambda) {
    const VectorXd lambda_D = scales.rows(model).cwiseProduct(lambda) * scales.energy();  // SI
    const Chart chart = chart_about(centre);
    const auto stress = stresses(model, prescribed, chart);
    Blocks H = stiffness(model, prescribed, chart);
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const Vector6 sigma = stress.col(static_cast<Eigen::Index>(k));
        if (!sigma.isZero(0)) add_curvature(model.elastics[k].kind, sigma, chart, H);
    }
    for (const auto& force : prescribed.forces) add_curvature(force, chart, H);
    for (const auto& brake : prescribed.brakes) add_curvature(dead_force(brake, chart), chart, H);
    int row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const ConstraintKind& kind = model.constraints[k].kind;
        add_curvature(kind, prescribed.offset[static_cast<Eigen::Index>(k)], chart,
                      lambda_D.data() + row, H);
        row += rows(kind);
    }
    return H;
}

// Dead moment m. With g the gradient of everything but m, in ground axes: ∂V/∂φ = Jᵀ g - m with
// J = 1 + ½ φ̃ + ..., whereas the balance is g - m. They differ by
// (1 - Jᵀ) g = ½ φ × g = ½ φ × m, since g = m at equilibrium.
//
// Brake force f. The lever to the patch p = r_w + u_w, whereas the chart's lever s turns with the
// carrier: the balance -(p - r) × f changes by f × (δp - δr - φ × s) more, δp = δr_w - ũ_w φ_w.
Blocks load_blocks(const Prescribed& prescribed, const std::vector<Pose>& centre) {
    Blocks A{static_cast<int>(6 * centre.size())};
    const auto add = [&](int row, int column, const Eigen::Matrix3d& M) {
        A.blocks.push_back({row, column, M});
    };
    for (const auto& moment : prescribed.moments) {
        const int row = 6 * moment.body + 3;
        add(row, row, -0.5 * skew(moment.m));
    }
    const Chart chart = chart_about(centre);
    for (const auto& brake : prescribed.brakes) {
        const int carrier = 6 * brake.body, wheel = 6 * brake.patch.body;
        const Eigen::Matrix3d f = skew(brake.f);
        const Point application_point = dead_force(brake, chart).at;
        add(carrier + 3, carrier, -f);
        add(carrier + 3, carrier + 3,
            f * skew(motion(chart[application_point.body], application_point.s_local).lever));
        if (brake.patch.body == ground) continue;
        add(carrier + 3, wheel, f);
        add(carrier + 3, wheel + 3,
            -f * skew(motion(chart[brake.patch.body], brake.patch.s_local).lever));
    }
    return A;
}

MatrixXd load_stiffness(const Prescribed& prescribed, const Scales& scales,
                        const std::vector<Pose>& centre) {
    const MatrixXd A = load_blocks(prescribed, centre).dense();
    const VectorXd S = scales.coordinates(static_cast<int>(A.rows()));
    return S.asDiagonal() * A * S.asDiagonal() / scales.energy();
}

double idle_limit(double stiffest) {
    return idle_stiffness + 50 * std::numeric_limits<double>::epsilon() * stiffest;
}

Modes modes_of(const Balance& conditions, const MatrixXd& H) {
    Modes modes;
    if (conditions.null_space.cols() == 0) return {conditions.null_space, VectorXd(0), 0};
    const bool unconstrained =
        conditions.independent.empty();  // `null_space` is then the unit matrix
    const MatrixXd reduced = unconstrained ? H : congruence(H, conditions.null_space);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(reduced);
    modes.Z = unconstrained ? eigen.eigenvectors()
                            : matrix_product(conditions.null_space, eigen.eigenvectors());
    modes.stiffness = eigen.eigenvalues();
    modes.idle_limit = idle_limit(modes.stiffness.cwiseAbs().maxCoeff());
    return modes;
}

bool Modes::unstable() const {
    return (count() > 0 && !(stiffness[0] >= -idle_limit)) || other_falling_modes > 0;
}

std::vector<int> Modes::resisting() const {
    std::vector<int> indices;
    for (int i = 0; i < count(); ++i)
        if (!idle(i)) indices.push_back(i);
    return indices;
}

MatrixXd Modes::idle_motions() const {
    std::vector<int> indices;
    for (int i = 0; i < count(); ++i)
        if (idle(i)) indices.push_back(i);
    return Z(Eigen::all, indices);
}

namespace {

double allowed(const Scales& scales, double stiffness, double tolerance) {
    return 1 + 8 * scales.roundoff * std::abs(stiffness) / tolerance;
}

}  // namespace

double excess(const Balance& conditions, const VectorXd& stiffness, const Scales& scales,
              double tolerance) {
    double worst = largest(conditions.Phi);
    if (!std::isfinite(worst) || !conditions.projected_gradient.allFinite())
        return std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index i = 0; i < conditions.projected_gradient.size(); ++i)
        worst = std::max(worst, std::abs(conditions.projected_gradient[i]) /
                                    allowed(scales, stiffness[i], tolerance));
    return worst;
}

double excess(const VectorXd& gradient, const VectorXd& Phi, const Modes& modes,
              const Scales& scales, double tolerance) {
    if (!gradient.allFinite() || !Phi.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    double worst = largest(Phi);
    const VectorXd g = modes.Z.transpose() * gradient;
    for (int i = 0; i < modes.count(); ++i)
        worst = std::max(worst, std::abs(g[i]) / allowed(scales, modes.stiffness[i], tolerance));
    return worst;
}

}  // namespace elastocheck::reference::energy
