#include "reference/equilibrium/sensitivity.hpp"

#include <limits>

#include "reference/equilibrium/linear_algebra/number_rates.hpp"
#include "reference/equilibrium/state_tangent.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

}  // namespace

std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates) {
    const StateTangent tangent = tangent_at(model, branch, state);
    const System& system = tangent.system;
    std::vector<StateRate> all;
    for (const Model& rate : rates) {
        StateRate& result = all.emplace_back();
        if (tangent.outcome != Outcome::converged) {
            result.outcome = tangent.outcome, result.detail = tangent.what;
            continue;
        }
        const NumberRate number = number_rate(system, rate, state.load, tangent.x);
        // The forces of features that move together cancel but for rounding of the stiffness.
        const double rounding = last_digits * largest_entry(tangent.at.J) * number.motion;
        const Answered answered = answer_to(tangent, rate_of(number, tangent.x), rounding);
        if (answered.outcome != Outcome::converged) {
            result.outcome = answered.outcome, result.detail = answered.what;
            continue;
        }
        for (int body = 0; body < system.bodies; ++body)
            result.increments.push_back({system.length * answered.dx.segment<3>(6 * body),
                                         answered.dx.segment<3>(6 * body + 3)});
        result.reactions = wrench_rates(number, tangent.x, answered.dx);
    }
    return all;
}

}  // namespace elastocheck::reference::equilibrium
