#include "reference/energy/sensitivity.hpp"

#include "reference/energy/number_rates.hpp"

namespace elastocheck::reference::energy {
namespace {

// Whether the branch turns back here: its drivers move a motion without stiffness.
bool turns_back(const Model& model, const StateTangent& at) {
    const Chart chart = chart_about(at.state.poses);
    const Prescribed& rate = at.course.rate;
    const ConstraintRates rates = constraint_rates(model, at.prescribed, rate, chart);
    const Eigen::VectorXd b = gradient_rate(model, at.prescribed, rate, chart) +
                              transposed_times(rates.Phi_qa, at.lambda);
    return answer(at, b, rate.offset.isZero(0) ? Eigen::VectorXd() : rates.Phi_a).outcome ==
           Outcome::loaded_idle_mode;
}

}  // namespace

std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates) {
    const StateTangent tangent = tangent_at(model, branch, state);
    std::optional<Failure> failure = tangent.failure;
    if (!failure && turns_back(model, tangent))
        failure = Failure{Outcome::singular,
                          "the stiffness of a motion vanishes, the branch turns back here"};
    if (failure) return {rates.size(), StateRate{failure->outcome, failure->what, {}, {}}};

    const Parts parts = parts_of(model, tangent);
    std::vector<StateRate> all;
    for (const Model& rate : rates) {
        StateRate& result = all.emplace_back();
        const NumberRate number = number_rate(model, branch, rate, tangent, parts);
        const Answer answered = answer(
            tangent, number.b, number.Phi_rate.isZero(0) ? Eigen::VectorXd() : number.Phi_rate,
            number.rounding);
        if (answered.outcome != Outcome::converged) {
            result.outcome = answered.outcome, result.detail = answered.what;
            continue;
        }
        for (Eigen::Index b = 0; b < answered.x.size(); b += 6)
            result.increments.push_back({answered.x.segment<3>(b), answered.x.segment<3>(b + 3)});
        result.reactions = wrench_rates(model, rate, tangent, parts, number, answered.x,
                                        multiplier_rates(tangent, answered));
    }
    return all;
}

}  // namespace elastocheck::reference::energy
