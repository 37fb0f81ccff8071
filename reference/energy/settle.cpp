// The design pose need not be the equilibrium at a = 0: loads are held, springs preloaded, joints held away
// from where they are drawn, links given another length. All of that is switched on along a branch of its
// own, from τ = 1, where the design pose is in equilibrium whatever they are, to τ = 0, where all is as it
// should be:
//
//   loads     (1 - τ) f
//   stresses  ∂U/∂e - τ σ_design
//   offsets   c + τ (c_drawn - c)      of lengths, planes and angles
//   gaps      Φ = τ Φ_design           of what has no offset
#include "reference/energy/settle.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int closing_steps = 100;       // Gauss-Newton on |Φ|²
constexpr int closing_halvings = 20;     // of each of them
constexpr double at_rest = 0.999;        // times the |Φ| before: no longer falling
constexpr double rank_threshold = 1e-9;  // of the pivots of ∂DΦ/∂ξ, as in balance.cpp

Course settling_course(const Model& model, const Prescribed& held) {
    const Chart design = chart_about(design_poses(model));
    Prescribed drawn = held, change = nothing_prescribed(model);
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const auto index = static_cast<Eigen::Index>(k);
        const auto& kind = model.constraints[k].kind;
        if (const auto measured = measured_offset(kind, design))
            change.offset[index] = *measured - own_offset(kind) - held.offset[index];
    }
    drawn.offset += change.offset;
    change.forces = sum(nothing_prescribed(model), -1, held).forces;
    change.moments = sum(nothing_prescribed(model), -1, held).moments;
    change.gap = constraints(model, drawn, design).Phi;
    change.preload = -stresses(model, held, design);
    return {held, change};
}

std::string joint_of_row(const Model& model, int row) {
    int next = 0;
    for (const auto& constraint : model.constraints) {
        next += rows(constraint.kind);
        if (next > row) return model.joints[static_cast<std::size_t>(constraint.joint)].name;
    }
    return {};
}

}  // namespace

// Gauss-Newton on |Φ|², each step halved until |Φ| falls. Where it no longer does, with Φ ≠ 0, the joints
// contradict each other; the row that is furthest from closed tells which.
std::optional<std::string> contradicting_joint(const Path& path, double a,
                                               const std::vector<Pose>& poses_then) {
    const Prescribed prescribed = at(path.course, a);
    const VectorXd S = path.scales.coordinates(coordinates(path.model)), D = path.scales.rows(path.model);
    Chart chart = chart_about(poses_then);
    for (int i = 0; i < closing_steps; ++i) {
        const ConstraintValues values = constraints(path.model, prescribed, chart);
        const VectorXd Phi = D.cwiseProduct(values.Phi);
        const double error = largest(Phi);
        if (!std::isfinite(error) || error <= path.options.tolerance) return {};
        Eigen::CompleteOrthogonalDecomposition<MatrixXd> J;
        J.setThreshold(rank_threshold);
        J.compute(transposed(scaled(values.Phi_q, D, S)).transpose());
        VectorXd x = S.cwiseProduct(J.solve(-Phi));
        double after = INFINITY;
        for (int halved = 0; halved <= closing_halvings && !(after <= at_rest * Phi.norm()); ++halved) {
            move_to(chart, x);
            after = D.cwiseProduct(constraints(path.model, prescribed, chart).Phi).norm();
            x *= 0.5;
        }
        if (!(after <= at_rest * Phi.norm())) {
            int worst = 0;
            Phi.cwiseAbs().maxCoeff(&worst);
            return joint_of_row(path.model, worst);
        }
        chart = chart_about(poses(chart));
    }
    return {};
}

std::optional<Failure> settle(const Path& path, State& state) {
    state = state_at(path, 0, design_poses(path.model));
    if (!state.at.left.allFinite() || !state.at.Phi.allFinite() || !state.H.allFinite())
        return Failure{Outcome::not_finite, "the design pose has no finite potential"};
    if (!within_laws(path.model, path.turning, state.poses))
        return Failure{Outcome::branch_lost, turned_over};
    if (is_stationary(path, state) && !state.modes.unstable()) return {};

    Path settling = path;
    settling.course = settling_course(path.model, at(path.course, 0));
    settling.span = 1;
    state = state_at(settling, 1, state.poses);
    if (!is_stationary(settling, state)) {
        const Attempt closed = minimum_from(settling, 1, state.poses, state.modes.idle_motions());
        if (closed.failure) return closed.failure;
        state = closed.state;
    }
    settling.first = state.modes;
    Walk walk = walk_from(settling, state);
    const auto failure = advance(settling, walk, 0);
    state = walk.state;
    if (!failure) return {};
    if (const auto joint = contradicting_joint(path, 0, state.poses))
        return Failure{Outcome::inconsistent_constraints, fmt::format("joint '{}' cannot be closed", *joint)};
    return Failure{failure->outcome, fmt::format("{}, with {:.3g} % of what is held applied", failure->what,
                                                 100 * (1 - state.a))};
}

}  // namespace elastocheck::reference::energy
