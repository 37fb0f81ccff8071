#include "reference/energy/solve.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "reference/energy/branch.hpp"
#include "reference/energy/reactions.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The joint that cannot be closed: Gauss-Newton on |Φ|² from the design pose comes to rest with Φ ≠ 0.
std::optional<std::string> contradicting_joint(const Path& path) {
    const VectorXd S = path.scales.coordinates(coordinates(path.model)), D = path.scales.rows(path.model);
    Chart chart = chart_about(design_poses(path.model));
    double before = INFINITY;
    for (int i = 0; i < 50; ++i) {
        const ConstraintValues values = constraints(path.model, chart);
        const VectorXd Phi = D.cwiseProduct(values.Phi);
        const MatrixXd J = D.asDiagonal() * values.Phi_q * S.asDiagonal();
        const double error = largest(Phi);
        if (!std::isfinite(error) || error <= path.options.tolerance) return {};
        if (Phi.norm() > 0.999 * before) {
            int row = 0, worst = 0;
            Phi.cwiseAbs().maxCoeff(&worst);
            for (const auto& constraint : path.model.constraints) {
                row += rows(constraint.kind);
                if (row > worst) return path.model.joints[static_cast<std::size_t>(constraint.joint)].name;
            }
        }
        before = Phi.norm();
        Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr;
        qr.setThreshold(1e-9);
        qr.compute(J);
        const VectorXd x = S.cwiseProduct(qr.solve(-Phi));
        move_to(chart, x);
        chart = chart_about(poses(chart));
    }
    return {};
}

// The equilibrium at load factor 0. The design pose need not be one: then preloads and static loads are
// switched on along a branch of their own, from τ = 1 to 0.
std::optional<Failure> settle(const Path& path, State& state) {
    state = state_at(path, 0, design_poses(path.model));
    if (!state.at.left.allFinite() || !state.at.Phi.allFinite() || !state.H.allFinite())
        return Failure{Outcome::not_finite, "the design pose has no finite potential"};
    if (!within_half_turn(path.model, state.poses)) return Failure{Outcome::branch_lost, turned_over};
    if (is_stationary(path, state) && !state.modes.unstable()) return {};

    Path settling = path;
    settling.loading = [&](double tau) { return settling_at(path.model, tau); };
    state = state_at(settling, 1, state.poses);
    if (!is_stationary(settling, state)) {
        const Attempt closed = minimum_from(settling, 1, state.poses, state.modes.idle_motions());
        if (closed.failure) {
            if (const auto joint = contradicting_joint(path))
                return Failure{Outcome::inconsistent_constraints,
                               fmt::format("joint '{}' cannot be closed", *joint)};
            return closed.failure;
        }
        state = closed.state;
    }
    settling.first = state.modes;
    return advance(settling, state, 0);
}

Equilibrium equilibrium(const Path& path, const State& state) {
    const Chart chart = chart_about(state.poses);
    const ConstraintValues values = constraints(path.model, chart);
    const VectorXd lambda = path.scales.energy() * path.scales.rows(path.model).cwiseProduct(state.at.lambda);
    return {state.a, state.poses, reactions(path.model, chart, values, lambda), values.Phi.norm()};
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> loads,
                      const Options& options) {
    EquilibriumPath result;
    const auto fail = [&](const Failure& failure, double load, const std::string& reached) {
        result.outcome = failure.outcome;
        result.detail =
            fmt::format("branch '{}', load factor {:.10g}: {}{}", branch.name, load, failure.what, reached);
        return result;
    };
    Path path{model, options, scales_of(model, branch, loads),
              [&](double a) { return loading_at(model, branch, a); }, result.counts};
    State state;
    if (const auto failure = settle(path, state)) return fail(*failure, 0, ", before any load of the branch");
    path.first = state.modes;
    for (const double load : loads) {
        if (!std::isfinite(load)) return fail({Outcome::not_finite, "the load is not finite"}, load, "");
        if (const auto failure = advance(path, state, load))
            return fail(*failure, load, fmt::format("; the last equilibrium found is at {:.10g}", state.a));
        result.points.push_back(equilibrium(path, state));
    }
    return result;
}

}  // namespace elastocheck::reference::energy
