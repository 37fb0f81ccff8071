#include "recursive/linear_response.hpp"

#include <fmt/format.h>

#include "recursive/diagnosis/finite.hpp"
#include "recursive/response_system.hpp"

namespace elastocheck::recursive {
namespace {

// Right-hand side of one disturbance. A wrench enters the upper rows. A motion of a joint enters
// the lower row as -∂Φ/∂c and the upper rows as the change of its reaction, -∂(Φ_qᵀ λ)/∂c.
void disturb(SteppingState& s, const Disturbance& disturbance) {
    s.work.upper.setZero();
    s.work.lower.setZero();
    std::visit(
        overloaded{
            [&](const UnitWrench& wrench) {
                add_load<double>(DeadForce{wrench.at, wrench.force}, 1, s.q, s.work.upper);
                add_load<double>(DeadMoment{wrench.at.body, wrench.moment}, 1, s.q, s.work.upper);
            },
            [&](const Motion& motion) {
                const std::size_t k = constraint_of(s.model, motion);
                const int row = s.inputs.row[k];
                const Row<double> d =
                    rate<double>(s.model.constraints[k].kind, s.inputs.offset[k], s.q);
                s.work.lower[row] = -d.Phi;
                if (d.i != ground) s.work.upper.segment<6>(6 * d.i) -= s.lambda[row] * d.on_i();
                if (d.j != ground) s.work.upper.segment<6>(6 * d.j) -= s.lambda[row] * d.on_j();
            },
        },
        disturbance);
}

std::string failure_text(Outcome outcome, const Disturbance& disturbance, const Model& model,
                         const Diagnosis& diagnosis) {
    const std::string cause = name_of(model, disturbance);
    if (outcome == Outcome::loaded_idle_mode)
        return cause +
               " acts on a motion that no joint or element resists at the design position: " +
               idle_modes(diagnosis);
    if (outcome == Outcome::inconsistent_constraints) return cause + " would open redundant joints";
    return cause;
}

// The responses [coordinates + rows of Φ × disturbances], with the matrix of `s`.
Response responses(SteppingState& s, const Branch& branch, const Analysis& analysis,
                   ResponseOrders& orders, bool consistent,
                   std::span<const Disturbance> disturbances) {
    const Model& model = s.model;
    Response response;
    const auto fail = [&](Outcome outcome, std::string detail) {
        response = {outcome, fmt::format("branch '{}': {}", branch.name, detail), {}};
        return response;
    };
    if (const Outcome outcome = factorise_response(s, consistent, orders);
        outcome != Outcome::converged)
        return fail(outcome, "the response to a small disturbance is not unique at the state");
    for (const Disturbance& disturbance : disturbances) {
        disturb(s, disturbance);
        // Redundant joints carry a wrench, in an undetermined distribution; they may not open.
        const Outcome outcome = solve_response(s, std::holds_alternative<Motion>(disturbance)
                                                      ? CheckedDirections::all
                                                      : CheckedDirections::idle_motions);
        if (outcome != Outcome::converged)
            return fail(outcome, failure_text(outcome, disturbance, model, analysis.diagnosis));
        auto& increments = response.increments.emplace_back(model.bodies.size());
        for (std::size_t b = 0; b < increments.size(); ++b) {
            const auto at = static_cast<Eigen::Index>(6 * b);
            increments[b] = {s.work.x.segment<3>(at), s.work.x.segment<3>(at + 3)};
        }
    }
    return response;
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method,
                         ResponseAnalysis& shared) {
    const Analysis& analysis = shared.analysis;
    check(model, branch);
    elastocheck::check(model, disturbances);
    if (state.poses.size() != model.bodies.size())
        throw std::invalid_argument("the state belongs to another model");
    if (std::isnan(analysis.diagnosis.constraint_error))
        return {Outcome::not_finite,
                fmt::format("branch '{}': {}", branch.name, not_finite(model)),
                {}};
    SteppingState s(model, branch, analysis);
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    return responses(s, branch, analysis, shared.orders,
                     !std::holds_alternative<Linear>(method.kind), disturbances);
}

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method) {
    check(model, branch);
    ResponseAnalysis analysis{analyse(model)};
    return linear_response(model, branch, state, disturbances, method, analysis);
}

}  // namespace elastocheck::recursive
