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

// ---- The columns, with name, unit, definition, and for readers digits, heading and place.

std::vector<ColumnOf<CharacteristicRow>> CharacteristicRow::columns() {
    using enum Digits;
    using R = CharacteristicRow;
    return {
        {"output", words, &R::output},
        {"unit", words, &R::unit},
        {"value", four, &R::value,
         "at a = 0 of the first branch, by the equilibrium leg; none if it is undefined"},
        {"distance of references", hidden, &R::apart, "second reference less equilibrium leg"},
        {"recursion", hidden, &R::recursion, "by the matrix that the recursion factorises there"},
        {"off", deviation, &R::off, "recursion less equilibrium leg", "", "error"},
        {"off %", three, &R::off_percent, "of the value", "%", "share"},
        {"undefined", hidden, &R::undefined, "reason for a missing value"},
        {"definition", hidden, &R::definition}};
}

std::vector<ColumnOf<StaticRow>> StaticRow::columns() {
    using enum Digits;
    using R = StaticRow;
    return {{"wheel", hidden, &R::wheel},
            {"output", hidden, &R::output},
            {"unit", hidden, &R::unit},
            {"drawn", hidden, &R::drawn, "in the design position, as the file has it"},
            {"settled", hidden, &R::settled, "in equilibrium, after the trim where there is one"}};
}

std::vector<ColumnOf<ComplianceRow>> ComplianceRow::columns() {
    using enum Digits;
    using R = ComplianceRow;
    std::vector<ColumnOf<R>> all{
        {"branch", hidden, &R::branch},
        {"a", hidden, &R::a, "parameter of the branch"},
        {"unit", hidden, &R::unit, "of a"},
        {"leg", hidden, &R::leg},
        {"point", hidden, &R::point,
         "where forces act and displacements are read: wheel centre or contact patch"},
        {"wheel", hidden, &R::wheel, "whose displacement is given"},
        {"answer", hidden, &R::answer,
         "displacement of the point in mm, rotation of the wheel in deg, ground axes"},
        {"loaded wheel", hidden, &R::loaded_wheel,
         "on which forces and moments act, all jacks and tyres removed"}};
    for (std::size_t k = 0; k < causes.size(); ++k)
        all.push_back({causes[k], four, [k](const R& r) { return r.by_cause[k]; },
                       k < 3 ? "response per kN" : "response per 100 N·m"});
    all.push_back({"reciprocity", hidden, &R::reciprocity,
                   "|C - Cᵀ| / |C| of the whole matrix at the wheel centres, rotations counted by "
                   "the tyre's radius"});
    return all;
}

std::vector<ColumnOf<ForceRow>> ForceRow::columns() {
    using enum Digits;
    using R = ForceRow;
    return {{"branch", hidden, &R::branch},
            {"end", hidden, &R::end, "parameter there"},
            {"end unit", hidden, &R::end_unit},
            {"element", hidden, &R::element},
            {"output", hidden, &R::output},
            {"unit", hidden, &R::unit},
            {"value", hidden, &R::value, "of the equilibrium leg"},
            {"error", hidden, &R::error, "recursion less equilibrium leg, in the same unit"},
            {"share", hidden, &R::share, "of the value", "%"}};
}

std::vector<ColumnOf<LargestForceRow>> LargestForceRow::columns() {
    using enum Digits;
    using R = LargestForceRow;
    return {{"branch", hidden, &R::branch},
            {"at", hidden, &R::at, "parameter of the branch where it is largest"},
            {"parameter unit", hidden, &R::parameter_unit},
            {"element", hidden, &R::element},
            {"output", hidden, &R::output, "its component of the largest absolute value"},
            {"value", hidden, &R::value, "by the equilibrium leg"},
            {"unit", hidden, &R::unit},
            {"deformation", hidden, &R::deformation, "conjugate to the force, at the same point"},
            {"deformation unit", hidden, &R::deformation_unit}};
}

std::vector<ColumnOf<FormulationRow>> FormulationRow::columns() {
    using enum Digits;
    using R = FormulationRow;
    return {{"branch", hidden, &R::branch},
            {"output", words, &R::output},
            {"unit", words, &R::unit},
            {"spread", three, &R::spread,
             "largest less smallest value over the formulations, maximum over the branch"},
            {"at", given, &R::at, "parameter there"},
            {"parameter unit", words, &R::parameter_unit, "", "", "unit"},
            {"smallest by", words, &R::smallest_by,
             "the formulation that gives the smallest value there"},
            {"largest by", words, &R::largest_by, "likewise"},
            {"distance of references", size, &R::apart, "at most, at equal parameter"},
            {"deviation", three, &R::deviation,
             "of the recursion from the equilibrium leg at equal parameter, at most"}};
}

std::vector<ColumnOf<DefinitionRow>> DefinitionRow::columns() {
    using enum Digits;
    using R = DefinitionRow;
    return {
        {"branch", words, &R::branch},
        {"output", words, &R::output, "the figure, and its other definition after @"},
        {"unit", words, &R::unit},
        {"difference", three, &R::difference,
         "from the figure as defined here, by the equilibrium leg, largest over the branch"},
        {"at", given, &R::at, "parameter there"},
        {"parameter unit", words, &R::parameter_unit, "", "", "unit"},
        {"drawn", three, &R::drawn, "difference in the design position"},
        {"deviation", three, &R::deviation,
         "of the recursion from the equilibrium leg in the figure, at equal parameter, at most"},
        {"formula", hidden, &R::formula, "of the other definition"}};
}

std::vector<ColumnOf<StudyRow>> StudyRow::columns() {
    using enum Digits;
    using R = StudyRow;
    return {{"branch", hidden, &R::branch},
            {"method", words, &R::method},
            {"reading", hidden, &R::reading},
            {"output", words, &R::output},
            {"unit", words, &R::unit},
            {"behaviour", words, &R::behaviour,
             "of the value with the largest step error on the branch"},
            {"order", three, &R::order, "at which the largest step error over the branch falls"},
            {"order error", size, &R::order_error, "its standard error", "", "±"},
            {"as formal", hidden, &R::as_formal, "the order agrees with the method's"},
            {"limit", hidden, &R::limit, "own limit for infinitely many steps, at the end"},
            {"band", size, &R::band, "uncertainty of the limit", "", "± band", 13},
            {"finest step error", size, &R::finest_step_error,
             "largest over the branch with the most steps"},
            {"gap", three, &R::gap, "own limit less reference at the end", "", "gap at end"},
            {"largest gap", hidden, &R::gap_max},
            {"rms gap", hidden, &R::gap_rms},
            {"gap exponent", three, &R::gap_exponent,
             "power of the parameter or abscissa with which it grows", "", "growth a^"},
            {"distance of references", size, &R::apart},
            {"range", hidden, &R::range, "of the reference over the branch"},
            {"gap share", three, &R::gap_share, "gap at the end, of the range", "%", "of the range",
             14},
            {"constraint order", hidden, &R::constraint_order,
             "order at which |Φ| of eq. (31) decreases at the end"},
            {"constraint order error", hidden, &R::constraint_order_error, "its standard error"},
            {"not studied", words, &R::not_studied, "why"}};
}

std::vector<ColumnOf<StepRow>> StepRow::columns() {
    using enum Digits;
    using R = StepRow;
    return {{"branch", hidden, &R::branch},
            {"method", hidden, &R::method},
            {"reading", hidden, &R::reading},
            {"output", hidden, &R::output},
            {"unit", hidden, &R::unit},
            {"steps", hidden, &R::steps},
            {"outcome", hidden, &R::outcome},
            {"end", hidden, &R::end, "value less own limit at the end"},
            {"largest", hidden, &R::largest},
            {"rms", hidden, &R::rms},
            {"error", hidden, &R::error, "value less reference at the end: step error and gap"},
            {"constraint error", hidden, &R::constraint_error, "or rad: |Φ| at the end, eq. (31)",
             "m"}};
}

std::vector<ColumnOf<GapRow>> GapRow::columns() {
    using enum Digits;
    using R = GapRow;
    std::vector<ColumnOf<R>> all{
        {"branch", hidden, &R::branch},
        {"reading", hidden, &R::reading},
        {"output", words, &R::output},
        {"unit", words, &R::unit},
        {"whole", three, &R::whole,
         "gap of the recursion in which forces do not follow the bodies"},
        {"lever", three, &R::lever, "contribution of the lever of the stored force", "",
         "stored force's lever"},
        {"axis", three, &R::axis, "contribution of its axis and law", "", "its axis and law"},
        {"load", three, &R::load, "contribution of the lever of the load", "", "load's lever"},
        {"rest", size, &R::rest, "remaining gap when all three follow: 0 within the band"},
        {"band", size, &R::band, "", "", "± band"},
        {"lever share", three, &R::lever_share, "of the whole", "%", "share", 5},
        {"axis share", three, &R::axis_share, "likewise", "%", "share", 6},
        {"load share", three, &R::load_share, "likewise", "%", "share", 7}};
    // In the order of GapShare::combinations.
    constexpr std::array follows{
        "nothing", "lever",          "axis",          "lever and axis",
        "load",    "lever and load", "axis and load", "lever, axis and load"};
    for (std::size_t k = 0; k < follows.size(); ++k)
        all.push_back({fmt::format("gap, following: {}", follows[k]), hidden,
                       [k](const R& r) { return r.following[k]; }});
    all.push_back({"not attributed", words, &R::not_attributed, "why"});
    return all;
}

std::vector<ColumnOf<TradeRow>> TradeRow::columns() {
    using enum Digits;
    using R = TradeRow;
    return {{"leg", hidden, &R::leg},
            {"method", words, &R::method},
            {"steps", whole, &R::steps, "per branch; none if the method chooses them"},
            {"tolerance", given, &R::tolerance,
             "that is required of a method that chooses its steps", "mm"},
            {"outcome", hidden, &R::outcome},
            {"error", size, &R::error, "", "mm"},
            {"angle error", size, &R::angle_error, "", "deg", "error"},
            {"share", hidden, &R::share, "of the tolerance"},
            {"solves", whole, &R::solves},
            {"factorisations", whole, &R::factorisations},
            {"evaluations", whole, &R::evaluations},
            {"price", whole, &R::price,
             "in back-substitutions: N/3 · factorisations + solves + evaluations"},
            {"time", three, &R::time, "median over the rounds", "s"},
            {"time ratio", three, &R::time_ratio, "to the equilibrium leg", "", "ratio"},
            {"front", words, &R::front,
             "no other is as accurate with s: fewer solves, f: fewer factorisations + evaluations, "
             "t: less time"},
            {"not ranked", words, &R::not_ranked, "why"},
            {"recommended", hidden, &R::recommended},
            {"detail", hidden, &R::detail, "of the outcome"}};
}

std::vector<ColumnOf<EffectRow>> EffectRow::columns() {
    using enum Digits;
    using R = EffectRow;
    return {{"branch", hidden, &R::branch},
            {"at", hidden, &R::at, "parameter of the branch"},
            {"parameter unit", hidden, &R::parameter_unit},
            {"output", hidden, &R::output},
            {"unit", hidden, &R::unit},
            {"number", hidden, &R::number, "path in the scene file"},
            {"step", hidden, &R::step, "1 mm of a length, else 1 % of the value"},
            {"effect", hidden, &R::effect, "derivative of the output times the step"},
            {"undefined", hidden, &R::undefined, "reason for a missing effect"}};
}

// ---- The rows.

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
