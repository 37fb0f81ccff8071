#include "compare/tables/rows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/readings.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "compare/studies/formulations.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {
namespace {

double count(auto number) { return static_cast<double>(number); }

// Calls sink(name of the reading, value) for both readings of a branch: over its parameter
// and its abscissa.
template <class T, class Sink>
void both(Unit unit, const std::string& abscissa, const T& at_parameter, const T& at_abscissa,
          Sink&& sink) {
    sink(parameter_reading(symbol(unit)), at_parameter);
    sink(abscissa_reading(abscissa), at_abscissa);
}

// Percentage; NaN where the whole is rounding, less than 1e-9 mm or deg.
double percent(double part, double whole) {
    return std::abs(whole) < 1e-9 ? nan : 100 * part / whole;
}

// Value of a channel at a = 0 by a leg.
double at_start(const LegRun& run, std::size_t channel) {
    return run.curve.values.empty() ? nan : run.curve.values[run.curve.start][channel];
}

std::string behaviour_words(const ChannelStudy& study) {
    std::string text = name(study.behaviour);
    if (study.behaviour == Behaviour::converging && study.zero_at_end)
        text += "; nearly zero at the end";
    return text;
}

}  // namespace

std::vector<CharacteristicRow> characteristic_rows(const Comparison& comparison) {
    std::vector<CharacteristicRow> rows;
    if (comparison.branches.empty()) return rows;
    const BranchComparison& branch = comparison.branches.front();
    for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
        const Channel& channel = comparison.channels[c];
        if (channel.kind() != ChannelKind::characteristic) continue;
        const double is = at_start(branch.run(Leg::equilibrium), c),
                     second = at_start(branch.run(branch.second), c),
                     recursion = at_start(branch.run(Leg::recursive), c);
        rows.push_back({channel.name, symbol(channel.unit), finite_or_nan(is),
                        finite_or_nan(second - is), finite_or_nan(recursion),
                        finite_or_nan(recursion - is),
                        finite_or_nan(100 * (recursion - is) / std::abs(is)),
                        is == undefined ? why_undefined(channel) : "", channel.definition});
    }
    return rows;
}

std::vector<ComplianceRow> compliance_rows(const Model& model, const Comparison& comparison) {
    std::vector<ComplianceRow> rows;
    const auto wheel = [&](Eigen::Index k) {
        return model.wheels[static_cast<std::size_t>(k / 6)].name;
    };
    for (const auto& branch : comparison.branches)
        for (const auto& run : branch.runs)
            for (const auto& at : run.compliance)
                for (const double per_si = in_unit(run.curve.unit);
                     const auto& [point, C] :
                     {std::pair{"wheel centre", &at.centre}, {"contact patch", &at.patch}})
                    for (Eigen::Index r = 0; r < C->rows(); ++r)
                        for (Eigen::Index loaded = 0; loaded < C->cols(); loaded += 6) {
                            ComplianceRow row{
                                .branch = branch.branch,
                                .a = parameter_in(run.curve.unit, at.a / per_si),
                                .unit = symbol(run.curve.unit),
                                .leg = name(run.leg),
                                .point = point,
                                .wheel = wheel(r),
                                .answer = fmt::format(
                                    "{} {}", r % 6 < 3 ? "displacement" : "rotation", "xyz"[r % 3]),
                                .loaded_wheel = wheel(loaded),
                                .reciprocity = at.reciprocity};
                            for (std::size_t k = 0; k < 6; ++k)
                                row.by_cause[k] =
                                    in_table_units(*C, r, loaded + static_cast<Eigen::Index>(k));
                            rows.push_back(std::move(row));
                        }
    return rows;
}

std::vector<ForceRow> force_rows(const Model& model, const Comparison& comparison) {
    const auto channels = element_channels(model);
    std::vector<ForceRow> rows;
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const BranchComparison& branch = comparison.branches[b];
        const BranchSide side = sides_of(model, model.branches[b]).front();
        Analyses analyses;
        for (const auto end : {&Landmarks::front, &Landmarks::back}) {
            const auto &truth = branch.run(Leg::equilibrium).landmarks.*end,
                       &reached = branch.run(Leg::recursive).landmarks.*end;
            // A one-sided branch starts at its front; a leg that ended early is at another load.
            if (!truth || !reached || truth->load == 0 ||
                !(std::abs(truth->load - reached->load) <= 1e-9 * std::abs(truth->load)))
                continue;
            const auto values = evaluate(model, side, channels, *truth, analyses),
                       others = evaluate(model, side, channels, *reached, analyses);
            for (std::size_t c = 0; c < channels.size(); ++c) {
                const double error = others[c] - values[c], size = std::abs(values[c]);
                if (std::isnan(values[c])) continue;  // inactive here
                rows.push_back({branch.branch, parameter_in(branch.unit, truth->load),
                                symbol(branch.unit), element_of(channels[c]), channels[c].name,
                                symbol(channels[c].unit), finite_or_nan(values[c]), error,
                                size > zero_value ? 100 * (error / size) : nan});
            }
        }
    }
    return rows;
}

std::vector<LargestForceRow> largest_force_rows(const Comparison& comparison) {
    std::vector<LargestForceRow> rows;
    for (const auto& branch : comparison.branches)
        for (const auto& l : branch.run(Leg::equilibrium).largest)
            rows.push_back({branch.branch, l.a, symbol(branch.unit), l.element, l.output, l.value,
                            symbol(l.unit), l.deformation, symbol(l.deformation_unit)});
    return rows;
}

std::vector<FormulationRow> formulation_rows(const FormulationStudy& study,
                                             const Comparison& comparison) {
    std::vector<FormulationRow> rows;
    const auto in = [&](const Reading& reading, const std::string& channel) {
        const int c = find_channel(comparison.channels, channel);
        return c < 0 || reading.channels.empty()
                   ? nan
                   : reading.channels[static_cast<std::size_t>(c)].max;
    };
    for (std::size_t b = 0; b < study.branches.size(); ++b)
        for (const auto& found : study.branches[b].outputs) {
            const Channel& channel = study.channels[found.channel];
            const BranchComparison& compared = comparison.branches[b];
            rows.push_back({study.branches[b].branch, channel.name, symbol(channel.unit),
                            found.spread, found.at, symbol(study.branches[b].unit), found.lowest,
                            found.highest, in(compared.uncertainty.equal_parameter, channel.name),
                            in(compared.deviation.equal_parameter, channel.name)});
        }
    return rows;
}

std::vector<StudyRow> study_rows(const Study& study) {
    std::vector<StudyRow> rows;
    for (const auto& branch : study.branches)
        for (const auto& m : branch.methods)
            both(branch.unit, branch.abscissa, m.equal_parameter, m.equal_abscissa,
                 [&](const std::string& reading, const std::vector<ChannelStudy>& outputs) {
                     const OrderFit& Phi = m.constraint_order;
                     if (outputs.empty())
                         rows.push_back({.branch = branch.branch,
                                         .method = m.method,
                                         .reading = reading,
                                         .constraint_order = Phi.order,
                                         .constraint_order_error = Phi.order_error,
                                         .not_studied = m.not_studied.empty() ? m.no_abscissa
                                                                              : m.not_studied});
                     for (std::size_t c = 0; c < outputs.size(); ++c) {
                         const ChannelStudy& s = outputs[c];
                         rows.push_back({branch.branch,
                                         m.method,
                                         reading,
                                         study.channels[c].name,
                                         symbol(study.channels[c].unit),
                                         behaviour_words(s),
                                         s.order.order,
                                         s.order.order_error,
                                         s.as_formal,
                                         s.end.limit,
                                         s.end.band,
                                         s.step_error_max.back(),
                                         s.gap,
                                         s.gap_max,
                                         s.gap_rms,
                                         s.gap_exponent,
                                         s.uncertainty,
                                         s.range,
                                         percent(s.gap, s.range),
                                         Phi.order,
                                         Phi.order_error,
                                         ""});
                     }
                 });
    return rows;
}

std::vector<StepRow> step_rows(const Study& study) {
    std::vector<StepRow> rows;
    for (const auto& branch : study.branches)
        for (const auto& m : branch.methods)
            both(branch.unit, branch.abscissa, m.equal_parameter, m.equal_abscissa,
                 [&](const std::string& reading, const std::vector<ChannelStudy>& outputs) {
                     for (std::size_t c = 0; c < std::max<std::size_t>(1, outputs.size()); ++c)
                         for (std::size_t l = 0; l < branch.steps.size(); ++l) {
                             StepRow row{.branch = branch.branch,
                                         .method = m.method,
                                         .reading = reading,
                                         .steps = count(branch.steps[l]),
                                         .outcome = elastocheck::name(m.outcomes[l]),
                                         .constraint_error = m.constraint_error[l]};
                             if (!outputs.empty()) {
                                 row.output = study.channels[c].name;
                                 row.unit = symbol(study.channels[c].unit);
                                 row.end = outputs[c].step_error_end[l];
                                 row.largest = outputs[c].step_error_max[l];
                                 row.rms = outputs[c].step_error_rms[l];
                                 row.error = row.end + outputs[c].gap;
                             }
                             rows.push_back(std::move(row));
                         }
                 });
    return rows;
}

std::vector<GapRow> gap_rows(const std::vector<Channel>& main,
                             const std::vector<BranchAttribution>& attribution) {
    std::vector<GapRow> rows;
    for (const auto& branch : attribution)
        both(branch.unit, branch.abscissa, branch.equal_parameter, branch.equal_abscissa,
             [&](const std::string& reading, const std::vector<GapShare>& found) {
                 if (found.empty())
                     rows.push_back({.branch = branch.branch,
                                     .reading = reading,
                                     .not_attributed = branch.not_attributed.empty()
                                                           ? branch.no_abscissa
                                                           : branch.not_attributed});
                 for (std::size_t c = 0; c < found.size(); ++c) {
                     const GapShare& s = found[c];
                     rows.push_back({branch.branch, reading, main[c].name, symbol(main[c].unit),
                                     s.whole, s.lever, s.axis, s.load, s.rest, s.band,
                                     percent(s.lever, s.whole), percent(s.axis, s.whole),
                                     percent(s.load, s.whole)});
                     std::ranges::copy(s.combinations, rows.back().following.begin());
                 }
             });
    return rows;
}

std::vector<TradeRow> trade_rows(const Trade& trade) {
    std::vector<TradeRow> rows;
    for (std::size_t k = 0; k < trade.points.size(); ++k) {
        const TradePoint& p = trade.points[k];
        std::string front;
        for (std::size_t kind = 0; kind < p.on_front.size(); ++kind)
            if (p.on_front[kind]) front += "sft"[kind];
        rows.push_back({name(p.leg), p.method, p.steps > 0 ? count(p.steps) : nan,
                        p.own_tolerance > 0 ? 1e3 * p.own_tolerance : nan,
                        elastocheck::name(p.outcome), p.error.mm, trade.angles ? p.error.deg : nan,
                        p.share, count(p.work.solves), count(p.work.factorisations),
                        count(p.work.evaluations), p.work.price, p.work.seconds, p.ratio, front,
                        p.not_ranked, trade.recommendation && trade.recommendation->point == k,
                        p.detail});
    }
    return rows;
}

std::vector<EffectRow> effect_rows(const Gradients& gradients) {
    std::vector<EffectRow> rows;
    for (std::size_t b = 0; b < gradients.sides.size(); ++b) {
        const SideGradients& side = gradients.sides[b];
        for (std::size_t s = 0; s < side.a.size(); ++s) {
            if (b > 0 && side.a[s] == 0) continue;
            for (std::size_t c = 0; c < gradients.outputs.size(); ++c)
                for (std::size_t k = 0; k < gradients.numbers.size(); ++k) {
                    const VariedNumber& number = gradients.numbers[k];
                    const double rate = side.legs.front().at[s](static_cast<Eigen::Index>(c),
                                                                static_cast<Eigen::Index>(k));
                    const std::string& why =
                        side.why_output[c].empty() ? side.why_number[s][k] : side.why_output[c];
                    rows.push_back({side.branch, parameter_in(side.unit, side.a[s]),
                                    symbol(side.unit), gradients.outputs[c].name,
                                    symbol(gradients.outputs[c].unit), number.path,
                                    number.step_name,
                                    why.empty() ? finite_or_nan(rate * number.step) : nan, why});
                }
        }
    }
    return rows;
}

}  // namespace elastocheck::compare
