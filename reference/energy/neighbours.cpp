#include "reference/energy/neighbours.hpp"

#include <limits>

#include "reference/energy/constraints/reactions.hpp"
#include "reference/energy/state_tangent.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

// Whether the branch turns back here: its drivers move a motion without stiffness.
bool turns_back(const Model& model, const StateTangent& tangent) {
    const Chart chart = chart_about(tangent.state.poses);
    const Prescribed& rate = tangent.course.rate;
    const ConstraintRates rates = constraint_rates(model, tangent.prescribed, rate, chart);
    const VectorXd b = gradient_rate(model, tangent.prescribed, rate, chart) +
                       transposed_times(rates.Phi_qa, tangent.lambda);
    return solve_tangent(tangent, b, rate.offset.isZero(0) ? VectorXd() : rates.Phi_a).outcome ==
           Outcome::loaded_idle_mode;
}

struct Conditions {
    VectorXd b, Phi;  // ∂V/∂x + Φ_qᵀ λ [6nb], Φ [m]
};
Conditions conditions(const Model& model, const StateTangent& at, const VectorXd& lambda,
                      const Chart& chart) {
    const Prescribed prescribed = energy::at(course_of(model, model.branches.front()), at.state.a);
    const ConstraintValues values = constraints(model, prescribed, chart);
    return {potential(model, prescribed, chart).gradient + transposed_times(values.Phi_q, lambda),
            values.Phi};
}

// The state of a neighbour by the chord method: Newton steps with the factors of the state, and one
// more step once they are small.
Equilibrium solved(const Model& model, const StateTangent& tangent, const Conditions& own) {
    constexpr double not_judged = std::numeric_limits<double>::infinity();
    std::vector<Pose> centre = tangent.state.poses;
    VectorXd lambda = tangent.lambda;
    double first = 0, first_reactions = 0;
    bool converged = false, last = false;
    for (int step = 0; step < chord_steps && !last; ++step) {
        last = converged;
        Chart chart = chart_about(centre);
        const Conditions there = conditions(model, tangent, lambda, chart);
        const TangentSolution solution =
            solve_tangent(tangent, there.b - own.b, there.Phi - own.Phi, not_judged);
        if (solution.outcome != Outcome::converged) break;
        const VectorXd dlambda = multiplier_rates(tangent, solution);
        lambda += dlambda;
        move_to(chart, solution.x);
        centre = poses(chart);
        if (step == 0) {
            first = solution.x.norm();
            first_reactions = dlambda.norm();
        }
        converged = solution.x.norm() <= chord_met * first &&
                    dlambda.norm() <= chord_met * first_reactions + chord_reactions * lambda.norm();
    }
    const Chart chart = chart_about(centre);
    const ConstraintValues values = constraints(
        model, energy::at(course_of(model, model.branches.front()), tangent.state.a), chart);
    return {tangent.state.a, centre, reactions(model, chart, values, lambda), values.Phi.norm()};
}

}  // namespace

std::vector<NeighbourStates> neighbour_states(const Model& model, const Branch& branch,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils) {
    const StateTangent tangent = tangent_at(model, branch, state);
    std::optional<Failure> failure = tangent.failure;
    if (!failure && turns_back(model, tangent))
        failure = Failure{Outcome::singular,
                          "the stiffness of a motion vanishes, the branch turns back here"};
    if (failure) return {stencils.size(), NeighbourStates{failure->outcome, failure->what, {}}};

    const Chart chart = chart_about(tangent.state.poses);
    Model here_alone = model;
    here_alone.branches = {branch};
    const Conditions own = conditions(here_alone, tangent, tangent.lambda, chart);
    double reach = 1;
    for (const Pose& pose : tangent.state.poses) reach = std::max(reach, pose.r.norm());
    const double stiffest = tangent.K.size() > 0 ? tangent.K.cwiseAbs().maxCoeff() : 0;
    std::vector<NeighbourStates> list;
    for (const Neighbours& stencil : stencils) {
        NeighbourStates& result = list.emplace_back();
        Conditions change{VectorXd::Zero(own.b.size()), VectorXd::Zero(own.Phi.size())};
        for (const Neighbour& k : stencil) {
            const Conditions there = conditions(*k.model, tangent, tangent.lambda, chart);
            change.b += k.weight * (there.b - own.b);
            change.Phi += k.weight * (there.Phi - own.Phi);
        }
        // Points and lengths that change together keep a row closed: what is left is rounding.
        const double rounding = last_digits * amplification(stencil);
        for (double& row : change.Phi)
            if (std::abs(row) <= reach * rounding) row = 0;
        const TangentSolution solution = solve_tangent(
            tangent, change.b, change.Phi.isZero(0) ? VectorXd() : change.Phi, stiffest * rounding);
        if (solution.outcome != Outcome::converged) {
            result.outcome = solution.outcome;
            result.detail = solution.what;
            continue;
        }
        for (const Neighbour& k : stencil) result.states.push_back(solved(*k.model, tangent, own));
    }
    return list;
}

}  // namespace elastocheck::reference::energy
