#include "compare/sensitivity/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/rates.hpp"
#include "compare/sensitivity/element_rates.hpp"
#include "compare/sensitivity/one_sided.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "models/rates/fields.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/sensitivity.hpp"
#include "reference/energy/sensitivity.hpp"
#include "reference/equilibrium/sensitivity.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Smallest size of a row, of the largest row of its kind, and in its unit; of a characteristic, in
// its unit.
constexpr double smallest_row = 1e-6, smallest_effect = 1e-5, smallest_characteristic = 1e-3;

std::vector<StateRate> sensitivity_by(Leg leg, const BranchSide& side, const Equilibrium& state,
                                      std::span<const Model> rates) {
    switch (leg) {
        case Leg::recursive:
        case Leg::series:
            if (side.analysis == nullptr)
                return recursive::sensitivity(side.model, side.branch, state, rates);
            return recursive::sensitivity(side.model, side.branch, state, rates, *side.analysis);
        case Leg::equilibrium:
            return reference::equilibrium::sensitivity(side.model, side.branch, state, rates);
        case Leg::energy:
            return reference::energy::sensitivity(side.model, side.branch, state, rates);
    }
    return {};
}

// The rate of the model on a side of the branch.
Model on_side(const Model& rate, std::size_t branch, const BranchSide& side) {
    Branch here = side.branch;
    here.drivers = rate.branches[branch].drivers;
    return on_branch(rate, here);
}

// What an output reads, and its position in channels(model); -1 for one that is not in this list,
// which has no points or numbers of its own.
struct ReadFrom {
    Reads reads;
    int channel = -1;
};

// A rate of the model with what the outputs read, on any side.
struct NumberColumn {
    const ModelRate* rate;
    std::vector<Reads> reads;
};
std::vector<NumberColumn> columns_of(const Model& model, std::span<const ReadFrom> outputs,
                                     std::span<const ModelRate> rates) {
    std::vector<NumberColumn> all;
    for (const ModelRate& rate : rates) {
        NumberColumn& column = all.emplace_back(NumberColumn{&rate, {}});
        if (!rate.undefined.empty()) continue;
        const auto changed = read_rates(model, rate.rate);
        for (const ReadFrom& output : outputs)
            column.reads.push_back(output.channel >= 0
                                       ? changed[static_cast<std::size_t>(output.channel)]
                                       : output.reads);
    }
    return all;
}

// What a side of a branch needs of the scene: columns of the numbers, then of the adjustments.
struct SideJob {
    const BranchSide& side;
    std::span<const Channel> outputs;
    std::span<const NumberColumn> columns;
    std::vector<Model> rates;            // on this side, of the columns that have a derivative
    std::vector<std::size_t> of_column;  // their columns
    std::size_t numbers = 0;
    // outputs that are characteristics, by their positions
    std::vector<std::size_t> characteristic_at = {};
    std::vector<Characteristic> which = {};
    bool with_free = false;  // whether one reads the wheels without jacks
    int steering = -1;
};

// Of a channel or of an element, in its unit; NaN of a characteristic.
double output_rate(const Channel& output, const BranchSide& side, const Equilibrium& state,
                   const Model& rate, const Reads& reads_rate, const StateRate& state_rate) {
    const auto* element = std::get_if<OfElement>(&output.reads);
    return in_unit(output.unit) *
           (element != nullptr
                ? element_rate(side.model, side.branch, state, *element, rate, state_rate)
                : rate_of(side.model, output.reads, state, rate, reads_rate, state_rate));
}

// Total derivatives by the numbers, from those by numbers and adjustments. A number that moves no
// adjustment takes none of their derivatives, which may be undefined.
MatrixXd with_adjustments(const MatrixXd& all, Index numbers, const MatrixXd& adjusting) {
    MatrixXd total = all.leftCols(numbers);
    for (Index k = 0; k < numbers; ++k)
        for (Index j = 0; j < adjusting.rows(); ++j)
            if (adjusting(j, k) != 0) total.col(k) += adjusting(j, k) * all.col(numbers + j);
    return total;
}

// The model on one side of the only corner of a state: derivatives of the outputs, and in the last
// row of the deformation beyond the knot.
MatrixXd beside_corner(const SideJob& job, Leg leg, const Equilibrium& state, const Corner& corner,
                       int which, const MatrixXd& adjusting) {
    BranchSide side = job.side;
    side.model = one_sided(job.side.model, corner, which);
    std::vector<Model> rates;
    for (const Model& rate : job.rates)
        rates.push_back(one_sided_rate(rate, job.side.model, corner, which));
    const auto found = sensitivity_by(leg, side, state, rates);
    const auto rows = std::ssize(job.outputs);
    MatrixXd all = MatrixXd::Constant(rows + 1, std::ssize(job.columns), nan);
    for (std::size_t n = 0; n < found.size(); ++n) {
        const std::size_t k = job.of_column[n];
        const auto column = static_cast<Index>(k);
        for (std::size_t c = 0; c < job.outputs.size(); ++c)
            all(static_cast<Index>(c), column) = output_rate(job.outputs[c], side, state, rates[n],
                                                             job.columns[k].reads[c], found[n]);
        const elastocheck::Curve& curve =
            *curve_of(rates[n].elastics[corner.element].kind, corner.axis);
        all(rows, column) = deformation_rate(side.model, side.branch, state, corner.element,
                                             corner.axis, rates[n], found[n]) -
                            curve.knots[corner.knot];
    }
    return with_adjustments(all, static_cast<Index>(job.numbers), adjusting);
}

// The one-sided derivatives at a corner. Where a number moves the state above the knot, those of the
// model above it hold; the two models must agree on the direction.
OneSided one_sided_at(const SideJob& job, Leg leg, const Equilibrium& state,
                      const MatrixXd& adjusting) {
    const auto at = corners(job.side.model, job.side.branch, state);
    if (at.size() != 1) return {};
    const MatrixXd above = beside_corner(job, leg, state, at.front(), +1, adjusting),
                   below = beside_corner(job, leg, state, at.front(), -1, adjusting);
    const auto rows = std::ssize(job.outputs), numbers = std::ssize(job.columns);
    OneSided both{MatrixXd::Constant(rows, above.cols(), nan),
                  MatrixXd::Constant(rows, above.cols(), nan)};
    for (Index k = 0; k < std::min(numbers, above.cols()); ++k) {
        const double up = above(rows, k), down = below(rows, k);
        if (!(up * down > 0) && !(up == 0 && down == 0)) continue;
        both.growing.col(k) = (up > 0 ? above : below).col(k).head(rows);
        both.falling.col(k) = (up > 0 ? below : above).col(k).head(rows);
    }
    return both;
}

// The rows of the characteristics, for the numbers without a reason.
void add_characteristics(const SideJob& job, Leg leg, const Equilibrium& state,
                         std::span<const StateRate> found, std::span<const std::string> reasons,
                         Analyses& analyses, MatrixXd& all) {
    if (job.which.empty()) return;
    std::vector<Model> rates;
    std::vector<StateRate> state_rates;
    std::vector<std::size_t> columns;
    for (std::size_t n = 0; n < found.size(); ++n)
        if (reasons[job.of_column[n]].empty()) {
            rates.push_back(job.rates[n]);
            state_rates.push_back(found[n]);
            columns.push_back(job.of_column[n]);
        }
    if (columns.empty()) return;
    const WheelResponseRates response = wheel_response_rates(
        job.side, leg, job.steering, state, rates, state_rates, job.with_free, analyses);
    for (std::size_t n = 0; n < columns.size(); ++n) {
        const auto values = rates_of(job.side.model, job.which, state, rates[n], state_rates[n],
                                     response.at, response.by[n]);
        for (std::size_t w = 0; w < values.size(); ++w) {
            const std::size_t c = job.characteristic_at[w];
            all(static_cast<Index>(c), static_cast<Index>(columns[n])) =
                in_unit(job.outputs[c].unit) * values[w];
        }
    }
}

// Derivatives of the outputs by every number; `adjusting`: dx/dp of a trim, or empty.
MatrixXd derivatives_at(const SideJob& job, Leg leg, const Equilibrium& state,
                        const MatrixXd& adjusting, Analyses& analyses,
                        std::vector<std::string>* why) {
    MatrixXd all = MatrixXd::Constant(std::ssize(job.outputs), std::ssize(job.columns), nan);
    std::vector<std::string> reasons(job.columns.size());
    for (std::size_t k = 0; k < job.columns.size(); ++k)
        reasons[k] = job.columns[k].rate->undefined;
    const auto found = sensitivity_by(leg, job.side, state, job.rates);
    const bool corner = at_corner(job.side.model, job.side.branch, state);
    for (std::size_t n = 0; n < found.size(); ++n) {
        const std::size_t k = job.of_column[n];
        if (corner)
            reasons[k] = "an element is at a corner of its law, where its stiffness has two values";
        else if (found[n].outcome != Outcome::converged)
            reasons[k] = fmt::format("{}: {}", name(found[n].outcome), found[n].detail);
        if (!reasons[k].empty()) continue;
        for (std::size_t c = 0; c < job.outputs.size(); ++c)
            all(static_cast<Index>(c), static_cast<Index>(k)) = output_rate(
                job.outputs[c], job.side, state, job.rates[n], job.columns[k].reads[c], found[n]);
    }
    add_characteristics(job, leg, state, found, reasons, analyses, all);
    const MatrixXd by_numbers = with_adjustments(all, static_cast<Index>(job.numbers), adjusting);
    if (why != nullptr) {
        reasons.resize(job.numbers);
        for (Index k = 0; k < adjusting.cols(); ++k) {
            auto& reason = reasons[static_cast<std::size_t>(k)];
            if (reason.empty() && !adjusting.col(k).allFinite())
                reason = "the trim has no derivative by it";
        }
        *why = std::move(reasons);
    }
    return by_numbers;
}

// Of a motion that nothing resists, which has no derivative, where it deforms the element at the
// design position: its description. Then no component in the element's axes is determined, which
// turn with it. Empty for other outputs.
std::string idle_motion_of(const BranchSide& side, const Channel& output) {
    constexpr double moves = 1e-9;  // [m, rad] of a unit motion
    const auto* of = std::get_if<OfElement>(&output.reads);
    if (of == nullptr || side.analysis->diagnosis.idle.empty()) return {};
    const auto element = static_cast<std::size_t>(of->element);
    const std::size_t axes =
        member<ScalarLaw>(side.model.elastics[element].kind) != nullptr ? 1 : 6;
    const Equilibrium drawn = design_state(side.model);
    const Model constant = elastocheck::rates::without_numbers(side.model);
    for (const auto& mode : side.analysis->diagnosis.idle) {
        StateRate motion;
        const Eigen::VectorXd dq = mode.dq;
        for (Index b = 0; b < dq.size(); b += 6)
            motion.increments.push_back({dq.segment<3>(b), dq.segment<3>(b + 3)});
        for (std::size_t axis = 0; axis < axes; ++axis)
            if (std::abs(deformation_rate(side.model, side.branch, drawn, element, axis, constant,
                                          motion)) > moves)
                return "it takes part in a motion that nothing resists: " + mode.description;
    }
    return {};
}

// The values on this side of a branch, from its start on; the start is on the first side.
std::vector<double> on_this_side(std::vector<double> values, const BranchSide& side, bool first) {
    std::erase_if(values, [&](double a) { return a == 0 ? !first : !(a * side.branch.to > 0); });
    std::ranges::sort(values, {}, [](double a) { return std::abs(a); });
    const auto again = std::ranges::unique(values);
    values.erase(again.begin(), again.end());
    return values;
}

// The largest entry of every output's row by the first leg, each number by its step.
std::vector<double> row_sizes(const Gradients& all, const SideGradients& side) {
    std::vector<double> sizes(all.outputs.size(), 0);
    double motions = 0, forces = 0;
    const auto is_characteristic = [&](std::size_t c) {
        return all.outputs[c].kind() == ChannelKind::characteristic;
    };
    const auto largest = [&](std::size_t c) -> double& {
        const Unit unit = all.outputs[c].unit;
        return unit == Unit::newton || unit == Unit::newton_metre ? forces : motions;
    };
    for (std::size_t c = 0; c < sizes.size(); ++c) {
        if (!side.why_output[c].empty()) continue;
        for (const MatrixXd& at : side.legs.front().at)
            for (std::size_t k = 0; k < all.numbers.size(); ++k) {
                const double entry = std::abs(at(static_cast<Index>(c), static_cast<Index>(k)) *
                                              all.numbers[k].step);
                if (entry > sizes[c]) sizes[c] = entry;
            }
        if (!is_characteristic(c)) largest(c) = std::max(largest(c), sizes[c]);
    }
    for (std::size_t c = 0; c < sizes.size(); ++c)
        sizes[c] = std::max(sizes[c], is_characteristic(c)
                                          ? smallest_characteristic
                                          : std::max(smallest_effect, smallest_row * largest(c)));
    return sizes;
}

Disagreement compared(const Gradients& all, const SideGradients& side) {
    Disagreement worst;
    const auto sizes = row_sizes(all, side);
    const LegGradients& first = side.legs.front();
    for (const LegGradients& other : std::span(side.legs).subspan(1)) {
        if (other.not_applicable) continue;
        for (std::size_t s = 0; s < std::min(first.at.size(), other.at.size()); ++s)
            for (std::size_t c = 0; c < sizes.size(); ++c) {
                if (!side.why_output[c].empty()) continue;
                for (std::size_t k = 0; k < all.numbers.size(); ++k) {
                    const auto row = static_cast<Index>(c), column = static_cast<Index>(k);
                    const double a = first.at[s](row, column), b = other.at[s](row, column);
                    if (std::isnan(a) && std::isnan(b)) continue;
                    ++worst.compared;
                    const double off = std::abs(a - b) * all.numbers[k].step,
                                 share = off == 0 ? 0 : off / sizes[c];
                    const double allowed =
                        other.leg == Leg::energy &&
                                all.outputs[c].kind() == ChannelKind::characteristic
                            ? differences_agree
                            : gradients_agree;
                    if (share / allowed <= worst.share / worst.allowed || std::isnan(worst.share))
                        continue;
                    worst.share = share, worst.allowed = allowed;
                    worst.where = fmt::format("{} by {} at {:g} {}: {} {:.12g}, {} {:.12g}",
                                              all.outputs[c].name, all.numbers[k].path,
                                              in_unit(side.unit) * side.a[s], symbol(side.unit),
                                              name(first.leg), a, name(other.leg), b);
                }
            }
    }
    return worst;
}

}  // namespace

VariedNumber varied_number(const ModelRate& rate, std::span<const Number> numbers) {
    const std::string first = rate.path.substr(0, rate.path.find(','));
    const auto found = std::ranges::find(numbers, first, &Number::path);
    const Number number = found == numbers.end() ? Number{} : *found;
    VariedNumber varied{.path = rate.path,
                        .value = number.value,
                        .unit = number.unit,
                        .side = rate.side,
                        .undefined = rate.undefined};
    const std::pair<const char*, double> millimetre[] = {
        {"mm", 1}, {"m", 1e-3}, {"cm", 0.1}, {"in", 1 / 25.4}};
    for (const auto& [unit, step] : millimetre)
        if (number.unit == unit) {
            varied.step = step, varied.step_name = "1 mm";
            return varied;
        }
    varied.step = number.value != 0 ? std::abs(number.value) / 100 : 1;
    if (number.value == 0) varied.step_name = "1 unit";
    return varied;
}

bool Gradients::conclusive() const {
    bool any = false;
    for (const SideGradients& side : sides) {
        for (const LegGradients& leg : side.legs)
            if (!leg.failure.empty() && !leg.not_applicable) return false;
        if (!side.worst.agrees()) return false;
        any = any || side.worst.compared > 0;
    }
    return any;
}

Gradients gradients(const Model& model, std::span<const Channel> outputs,
                    std::span<const VariedNumber> numbers, std::span<const ModelRate> rates,
                    const GradientOptions& options) {
    Gradients all{{outputs.begin(), outputs.end()}, {numbers.begin(), numbers.end()}, {}};
    const auto every = channels(model);
    std::vector<ReadFrom> places;
    for (const Channel& output : outputs)
        places.push_back({output.reads, find_channel(every, output.name)});
    std::vector<NumberColumn> columns = columns_of(model, places, rates);
    std::map<Leg, MatrixXd> adjusting;
    for (const Leg leg : options.legs) adjusting[leg] = {};
    if (options.trim != nullptr) {
        for (auto& column : columns_of(model, places, options.trim->adjustments))
            columns.push_back(std::move(column));
        for (auto& [leg, dx] : adjusting)
            dx = adjustment_rates(model, *options.trim, leg,
                                  [leg = leg](const BranchSide& side, const Equilibrium& state,
                                              std::span<const Model> by) {
                                      return sensitivity_by(leg, side, state, by);
                                  });
    }
    for (std::size_t branch = 0; branch < model.branches.size(); ++branch) {
        const std::string& branch_name = model.branches[branch].name;
        if (!options.branches.empty() && std::ranges::count(options.branches, branch_name) == 0)
            continue;
        bool first_side = true;
        for (BranchSide side : sides_of(model, model.branches[branch], options.points)) {
            if (options.progress) options.progress(side.name);
            side.analysis =
                std::make_shared<const recursive::Analysis>(recursive::analyse(side.model));
            const bool chosen = options.stations.contains(branch_name);
            const std::vector<double> stations =
                chosen ? on_this_side(options.stations.at(branch_name), side, first_side)
                       : std::vector<double>{};
            first_side = false;
            if (chosen && stations.empty()) continue;
            SideJob job{side, outputs, columns, {}, {}, numbers.size()};
            job.steering = steering_joint(side.model);
            for (std::size_t c = 0; c < outputs.size(); ++c)
                if (const auto* which = std::get_if<Characteristic>(&outputs[c].reads)) {
                    job.characteristic_at.push_back(c);
                    job.which.push_back(*which);
                    job.with_free = job.with_free || needs_free(*which);
                }
            for (std::size_t k = 0; k < columns.size(); ++k)
                if (columns[k].rate->undefined.empty()) {
                    job.rates.push_back(on_side(columns[k].rate->rate, branch, side));
                    job.of_column.push_back(k);
                }
            SideGradients& here = all.sides.emplace_back();
            here.name = side.name, here.branch = branch_name;
            here.unit = unit_of(side.branch.unit);
            const auto active = active_channels(outputs, side.model);
            Analyses as_drawn;
            const auto drawn =
                evaluate(side.model, side, outputs, design_state(side.model), as_drawn);
            for (std::size_t c = 0; c < outputs.size(); ++c)
                here.why_output.push_back(!active[c] ? "its joint is inactive on this branch"
                                          : !outputs[c].joints().empty() && drawn[c] == undefined
                                              ? why_undefined(outputs[c])
                                              : idle_motion_of(side, outputs[c]));
            for (const Leg leg : options.legs) {
                LegGradients& by = here.legs.emplace_back();
                by.leg = leg;
                const bool first = here.legs.size() == 1;
                Analyses analyses;
                const auto visit = [&](const Equilibrium& state) {
                    std::vector<std::string>* why = nullptr;
                    if (first) {
                        here.a.push_back(state.load + 0.0);  // no -0
                        here.values.push_back(
                            row_of(side.model, outputs, side, {.leg = leg}, state, analyses)
                                .values);
                        why = &here.why_number.emplace_back();
                    }
                    by.at.push_back(
                        derivatives_at(job, leg, state, adjusting.at(leg), analyses, why));
                    if (first)
                        here.one_sided.push_back(one_sided_at(job, leg, state, adjusting.at(leg)));
                };
                const EquilibriumPath path = chosen ? walk_through(side, leg, stations, visit)
                                                    : walk(side, {.leg = leg}, visit);
                if (path.outcome != Outcome::converged) {
                    by.failure =
                        fmt::format("{}: {}", elastocheck::name(path.outcome), path.detail);
                    by.not_applicable = is_not_applicable(path.outcome);
                }
            }
            here.worst = compared(all, here);
        }
    }
    return all;
}

}  // namespace elastocheck::compare
