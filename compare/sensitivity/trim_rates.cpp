#include "compare/sensitivity/trim_rates.hpp"

#include <Eigen/LU>
#include <cmath>
#include <variant>

#include "compare/comparison/legs.hpp"
#include "compare/comparison/trim.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/rates.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"
#include "models/rates/fields.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Found adjustments, SI.
VectorXd adjusted(const TrimRecord& record) {
    VectorXd x(std::ssize(record.adjusted));
    for (Index k = 0; k < x.size(); ++k) {
        const auto& one = record.adjusted[static_cast<std::size_t>(k)];
        x[k] = one.by / in_unit(one.unit);
    }
    return x;
}

// A scene that changes by the amounts `by` of the quantities that are adjusted in `trim`, besides
// what it changes already. Adding is linear, so the amounts may be rates.
Scene adding(Scene scene, Trim trim, const VectorXd& by) {
    for (auto& adjustment : trim.adjust) adjustment.per_unit = 1;
    scene.trim = std::move(trim);
    return with_adjusted(std::move(scene), by);
}

// Derivative of scene.with_adjusted(x) at constant x: the change of the scene, and of per_unit and
// of a preload's direction by the product rule.
Scene adjusted_rate(const Trim& trim, const Scene& rate, const VectorXd& x) {
    Trim directions = *rate.trim;
    VectorXd changes(x.size()), turns(x.size());
    for (Index k = 0; k < x.size(); ++k) {
        const auto at = static_cast<std::size_t>(k);
        changes[k] = directions.adjust[at].per_unit * x[k];
        turns[k] = preload(trim.adjust[at].what) != nullptr ? trim.adjust[at].per_unit * x[k] : 0;
    }
    return adding(adding(rate, trim, changes), directions, turns);
}

// The branch without drivers, whose start is the trimmed state.
BranchSide at_rest(const Model& model) {
    Branch branch;
    branch.name = "trim";
    branch.to = 1, branch.steps = 1, branch.unit = ParameterUnit::none;
    return {"trim", on_branch(model, branch), branch, {}};
}

}  // namespace

TrimRates trim_rates(const Scene& as_read, const Trimmed& trimmed, std::span<const ModelRate> rates,
                     Detail detail) {
    TrimRates result{*as_read.trim, {}, {}, {}};
    const VectorXd x = adjusted(*trimmed.record);
    for (const ModelRate& rate : rates) {
        result.scenes.push_back(rate.scene_rate);
        ModelRate& of_trimmed = result.numbers.emplace_back();
        if (rate.undefined.empty())
            of_trimmed =
                model_rate(trimmed.scene, adjusted_rate(*as_read.trim, rate.scene_rate, x), detail);
        of_trimmed.path = rate.path;
        if (!rate.undefined.empty()) of_trimmed.undefined = rate.undefined;
    }
    const Scene still = rates::without_numbers(trimmed.scene);
    for (Index k = 0; k < x.size(); ++k)
        result.adjustments.push_back(
            model_rate(trimmed.scene,
                       adding(still, *as_read.trim,
                              as_read.trim->adjust[static_cast<std::size_t>(k)].per_unit *
                                  VectorXd::Unit(x.size(), k)),
                       detail));
    return result;
}

MatrixXd adjustment_rates(const Model& model, const TrimRates& rates, Leg leg,
                          const SensitivityOf& sensitivity) {
    const BranchSide side = at_rest(model);
    const Index n = std::ssize(rates.adjustments), numbers = std::ssize(rates.numbers);
    MatrixXd none = MatrixXd::Constant(n, numbers, nan);
    const EquilibriumPath path = rest(side, leg);
    if (path.points.empty()) return none;
    const Equilibrium &state = path.points.front(), drawn = design_state(side.model);
    auto conditions = condition_channels(side.model, rates.trim);
    const auto plain = [](Channel& channel) {  // counted from zero: the target is the drawn value
        if (auto* coordinate = std::get_if<Coordinate>(&channel.reads))
            coordinate->counted_from = 0;
    };
    for (auto& channel : conditions) plain(channel);

    // d(c - t) by one rate, SI. `scene`: rate of the scene with its trim, for given values.
    const auto missed_rate = [&](const ModelRate& by, const Scene* scene) {
        const Model rate = at_rest(by.rate).model;
        VectorXd result = VectorXd::Constant(n, nan);
        const StateRate found = sensitivity(side, state, {&rate, 1}).front();
        if (found.outcome != Outcome::converged) return result;
        StateRate design;
        for (std::size_t b = 0; b < side.model.bodies.size(); ++b) {
            const Pose &at = side.model.bodies[b].design, &change = rate.bodies[b].design;
            design.increments.push_back({change.r, 2 * (change.p * at.p.conjugate()).vec()});
        }
        auto changed = condition_channels(rate, rates.trim);
        for (Index c = 0; c < n; ++c) {
            const auto at = static_cast<std::size_t>(c);
            plain(changed[at]);
            const auto read = [&](const Equilibrium& in, const StateRate& changing) {
                return rate_of(side.model, conditions[at].reads, in, rate, changed[at].reads,
                               changing);
            };
            const auto& value = rates.trim.until[at].value;
            const bool counted = std::holds_alternative<Coordinate>(conditions[at].reads);
            result[c] = read(state, found);
            if (counted || !value) result[c] -= read(drawn, design);
            if (value && scene != nullptr) result[c] -= *scene->trim->until[at].value;
        }
        return result;
    };
    MatrixXd J(n, n), by_numbers = none;
    for (Index k = 0; k < n; ++k)
        J.col(k) = missed_rate(rates.adjustments[static_cast<std::size_t>(k)], nullptr);
    for (Index k = 0; k < numbers; ++k) {
        const auto at = static_cast<std::size_t>(k);
        if (rates.numbers[at].undefined.empty())
            by_numbers.col(k) = missed_rate(rates.numbers[at], &rates.scenes[at]);
    }
    if (!J.allFinite()) return none;
    return -J.partialPivLu().solve(by_numbers);
}

}  // namespace elastocheck::compare
