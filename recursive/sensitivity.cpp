#include "recursive/sensitivity.hpp"

#include <stdexcept>

#include "recursive/diagnosis/analysis.hpp"
#include "recursive/formula/number_rates.hpp"
#include "recursive/response_system.hpp"

namespace elastocheck::recursive {
namespace {

void check_rate(const Model& model, const Branch& branch, const Model& rate) {
    if (rate.bodies.size() != model.bodies.size() ||
        rate.constraints.size() != model.constraints.size() ||
        rate.elastics.size() != model.elastics.size() || rate.branches.empty() ||
        rate.branches.front().drivers.size() != branch.drivers.size())
        throw std::invalid_argument("the rate belongs to another model or branch");
}

std::string why_no_rate(Outcome outcome, const Diagnosis& diagnosis) {
    switch (outcome) {
        case Outcome::loaded_idle_mode:
            return "the number loads a motion that no joint or element resists: " +
                   idle_modes(diagnosis);
        case Outcome::inconsistent_constraints:
            return "redundant joints close at this value of the number only";
        case Outcome::not_finite: return "the derivative is not finite";
        default: return "the tangent is singular at the state";
    }
}

}  // namespace

std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates,
                                   const Analysis& analysis) {
    check(model, branch);
    if (state.poses.size() != model.bodies.size())
        throw std::invalid_argument("the state belongs to another model");
    SteppingState s(model, branch, analysis);
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    ResponseOrders orders;
    const Outcome ready = std::isnan(analysis.diagnosis.constraint_error)
                              ? Outcome::not_finite
                              : factorise_response(s, true, orders);
    std::vector<StateRate> all;
    for (const Model& rate : rates) {
        check_rate(model, branch, rate);
        StateRate& result = all.emplace_back();
        result.outcome = ready;
        const Inputs<double> input_rate =
            input_rates(model, branch, rate, rate.branches.front(), state.load);
        if (ready == Outcome::converged) {
            const NumberRates by = number_rates(model, branch, s.inputs, rate,
                                                rate.branches.front(), input_rate, s.q, s.lambda);
            s.upper = by.upper, s.lower = by.lower;
            result.outcome = answer_response(s, Judged::all);
        }
        if (result.outcome != Outcome::converged) {
            result.detail = why_no_rate(result.outcome, analysis.diagnosis);
            continue;
        }
        const Vector<double> dq = s.x.head(s.n()), dlambda = s.x.tail(s.m());
        for (Eigen::Index b = 0; b < dq.size(); b += 6)
            result.increments.push_back({dq.segment<3>(b), dq.segment<3>(b + 3)});
        result.reactions =
            wrench_rates(model, s.inputs, rate, input_rate, {s.q, dq}, s.lambda, dlambda);
    }
    return all;
}

std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates) {
    check(model, branch);
    return sensitivity(model, branch, state, rates, analyse(model));
}

}  // namespace elastocheck::recursive
