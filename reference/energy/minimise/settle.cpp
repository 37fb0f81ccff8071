// Homotopy to the equilibrium at a = 0. The design pose need not be that equilibrium: loads are
// held, springs preloaded, joints held away from their design position, links given another length.
// All of these are applied along a branch of their own, from τ = 1, where the design pose is in
// equilibrium, to τ = 0, where they have their full values:
//
//   offsets   c + τ (c_drawn - c)      of lengths, planes and angles
//   gaps      Φ = τ Φ_design           of what has no offset
//   loads     (1 - τ) f
//   stresses  ∂U/∂e - τ σ_design
//
// This homotopy fails where the loads first act on an unresisted motion (the weight of a pendulum),
// or where its path turns back. It is then repeated with every body on springs to the ground,
//
//   τ ½ κ (|r - r_design|² / L² + |θ|²),   κ in units of F L
#include "reference/energy/minimise/settle.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kappa = 1;                  // κ
constexpr int closing_steps = 100;           // Gauss-Newton on |Φ|²
constexpr int closing_halvings = 20;         // of each of them
constexpr double stagnation_factor = 0.999;  // times the previous |Φ|: stagnation

// Course of the homotopy: `at_0`, prescribed at a = 0, and the rates by τ that lead from the design
// pose to it.
Course settling_course(const Model& model, const Prescribed& at_0) {
    const Chart design = chart_about(design_poses(model));
    Prescribed at_design = at_0, change = nothing_prescribed(model);
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const auto index = static_cast<Eigen::Index>(k);
        const auto& kind = model.constraints[k].kind;
        if (const auto measured = measured_offset(kind, design))
            change.offset[index] = *measured - own_offset(kind) - at_0.offset[index];
    }
    at_design.offset += change.offset;
    const Prescribed minus_loads = sum(nothing_prescribed(model), -1, at_0);
    change.forces = minus_loads.forces;
    change.moments = minus_loads.moments;
    change.brakes = minus_loads.brakes;
    change.gap = constraints(model, at_design, design).Phi;
    change.preload = -stresses(model, at_0, design);
    return {at_0, change};
}

// Adds a bushing to the ground for every body, stress-free in the design pose.
Model on_ground_springs(Model model, const Scales& scales) {
    LinearStiffness law;
    law.K.setZero();
    law.K.diagonal() << Eigen::Vector3d::Constant(kappa * scales.force / scales.length),
        Eigen::Vector3d::Constant(kappa * scales.energy());
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const Pose& design = model.bodies[b].design;
        model.elastics.push_back({"hold", Bushing{{ground, design.r, design.p},
                                                  {static_cast<BodyId>(b), {0, 0, 0}, {1, 0, 0, 0}},
                                                  law}});
    }
    return model;
}

// Settling course of a model with springs, from `at_0` of the model without them: the added springs
// have full strength at τ = 1 and none at τ = 0.
Course with_springs(const Model& model, Prescribed at_0) {
    const auto own_elements = at_0.strength.size(),
               elements = static_cast<Eigen::Index>(model.elastics.size());
    at_0.free_length.conservativeResizeLike(VectorXd::Zero(elements));
    at_0.preload.conservativeResizeLike(MatrixXd::Zero(6, elements));
    at_0.strength.conservativeResizeLike(VectorXd::Constant(elements, -1));
    Course course = settling_course(model, at_0);
    course.rate.strength.tail(elements - own_elements).setOnes();
    return course;
}

std::string joint_of_row(const Model& model, int row) {
    int next = 0;
    for (const auto& constraint : model.constraints) {
        next += rows(constraint.kind);
        if (next > row) return model.joints[static_cast<std::size_t>(constraint.joint)].name;
    }
    return {};
}

// Continuation from τ = 1 to 0. On failure the state is the last one reached.
std::optional<Failure> run_homotopy(const Path& settling, State& state) {
    state = state_at(settling, 1, design_poses(settling.model));
    if (!is_stationary(settling, state)) {
        const Attempt minimum = minimum_from(settling, 1, state.poses, state);
        if (minimum.failure) return minimum.failure;
        state = minimum.state;
    }
    Path path = settling;
    path.start_modes = state.modes;
    Continuation continuation = start_continuation(path, state);
    const auto failure = advance(path, continuation, 0);
    state = continuation.state;
    if (!failure) return {};
    return Failure{failure->outcome,
                   fmt::format("{}, with {:.3g} % of the static loads and held quantities applied",
                               failure->what, 100 * (1 - state.a))};
}

}  // namespace

// Gauss-Newton on |Φ|², each step halved until |Φ| falls. At stagnation with Φ ≠ 0 the joints are
// inconsistent; the row with the largest gap names one.
std::optional<std::string> contradicting_joint(const Path& path, double a,
                                               const std::vector<Pose>& start) {
    const Prescribed prescribed = at(path.course, a);
    const VectorXd S = path.scales.coordinates(coordinates(path.model)),
                   D = path.scales.rows(path.model);
    Chart chart = chart_about(start);
    for (int i = 0; i < closing_steps; ++i) {
        const ConstraintValues values = constraints(path.model, prescribed, chart);
        const VectorXd Phi = D.cwiseProduct(values.Phi);
        const double error = largest(Phi);
        if (!std::isfinite(error) || error <= path.options.tolerance) return {};
        const Blocks none{coordinates(path.model)};
        VectorXd x =
            S.cwiseProduct(Quadratic(none, none, scaled(values.Phi_q, D, S))
                               .minimum(VectorXd::Zero(none.size), Phi, MatrixXd(none.size, 0))
                               .x);
        double next_size = INFINITY;
        for (int halvings = 0;
             halvings <= closing_halvings && !(next_size <= stagnation_factor * Phi.norm());
             ++halvings) {
            move_to(chart, x);
            next_size = D.cwiseProduct(constraints(path.model, prescribed, chart).Phi).norm();
            x *= 0.5;
        }
        if (!(next_size <= stagnation_factor * Phi.norm())) {
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
    if (!state.balance.projected_gradient.allFinite() || !state.balance.Phi.allFinite() ||
        !state.H.allFinite() || !state.modes.stiffness.allFinite())
        return Failure{Outcome::not_finite, "the design pose has no finite potential"};
    if (!within_laws(path.model, path.turning, state.poses))
        return Failure{Outcome::branch_lost, law_ended};
    if (is_stationary(path, state) && !state.modes.unstable()) return {};

    const Prescribed at_0 = at(path.course, 0);
    const auto settling_path = [&](const Model& model, const Course& course) {
        return Path{model, path.options, path.scales, course, turning_bushings(model, course),
                    1,     path.counts};
    };
    const auto failure =
        run_homotopy(settling_path(path.model, settling_course(path.model, at_0)), state);
    if (!failure) return {};
    const Model spring_model = on_ground_springs(path.model, path.scales);
    if (State settled;
        !run_homotopy(settling_path(spring_model, with_springs(spring_model, at_0)), settled)) {
        state = state_at(path, 0, settled.poses);
        return {};
    }
    if (const auto joint = contradicting_joint(path, 0, state.poses))
        return Failure{Outcome::inconsistent_constraints,
                       fmt::format("joint '{}' cannot be closed", *joint)};
    return failure;
}

}  // namespace elastocheck::reference::energy
