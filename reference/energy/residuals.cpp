// Any state judged by this leg's conditions.
#include <cmath>
#include <limits>

#include "reference/energy/balance.hpp"
#include "reference/energy/solve.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double max_or_nan(double a, double b) { return std::isnan(a) || std::isnan(b) ? unknown : std::max(a, b); }

}  // namespace

Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state) {
    if (state.poses.size() != model.bodies.size()) return {unknown, unknown, unknown, unknown};
    const Chart chart = chart_about(state.poses);
    const Loading loading = loading_at(model, branch, state.load);
    const double loads[] = {state.load};
    const Scales scales = scales_of(model, branch, loads);
    const ConstraintValues values = constraints(model, chart);
    const Balance at = balance(model, scales, potential(model, loading, chart).gradient, values);

    Residuals worst;
    int row = 0;
    for (const auto& constraint : model.constraints) {
        const double error = largest(values.Phi.segment(row, rows(constraint.kind)));
        double& kind =
            std::holds_alternative<PerpendicularDirections>(constraint.kind) ? worst.direction : worst.length;
        kind = max_or_nan(kind, error);
        row += rows(constraint.kind);
    }
    // A pose's p is a direction too: it must be a unit quaternion.
    for (const auto& pose : state.poses)
        worst.direction = max_or_nan(worst.direction, std::abs(pose.p.norm() - 1));
    if (!within_half_turn(model, state.poses)) worst.force = worst.moment = unknown;
    for (std::size_t b = 0; b < state.poses.size(); ++b) {
        const VectorXd left = at.left.segment<6>(6 * static_cast<int>(b));
        worst.force = max_or_nan(worst.force, scales.force * largest(left.head<3>()));
        worst.moment = max_or_nan(worst.moment, scales.energy() * largest(left.tail<3>()));
    }
    return worst;
}

}  // namespace elastocheck::reference::energy
