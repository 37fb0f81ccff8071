#include "compare/candidate/judgement.hpp"
#include "compare/deviation/tolerance.hpp"

#include <cmath>

namespace elastocheck::compare {
namespace {

constexpr double nothing = 1e-9;        // [mm], [deg]: smaller deviations are rounding
constexpr double nothing_of_it = 1e-6;  // share of an extent: likewise

// Deviation relative to its limit; without a finite limit, relative to its extent.
double taken(const Worst& worst) {
    return worst.max / (std::isfinite(worst.limit) ? worst.limit
                        : worst.extent > 0         ? worst.extent
                                                   : 1);
}

bool is_worse(const Worst& one, const std::optional<Worst>& than) {
    return !than || (!std::isnan(taken(*than)) && !(taken(one) <= taken(*than)));
}

bool is_within(const Worst& worst) { return std::isfinite(worst.max) && worst.max <= worst.limit; }

// Calls sink(channel, worst) for every determined output of one reading of a branch,
// with its limit.
template <class Sink>
void for_each_output(const Comparison& comparison, const BranchComparison& branch, ReadingKind kind,
                     const Tolerance& tolerance, Sink&& sink) {
    const bool across = kind == ReadingKind::equal_abscissa;
    if (across && !is_readable(comparison, branch)) return;
    const Reading& reading = reading_of(branch.deviation, kind);
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        const Channel& channel = comparison.channels[c];
        const Deviation& d = reading.channels[c];
        if (!branch.determined[c] || d.compared == 0) continue;
        const bool motion = is_motion(channel);
        const double uncertain = across && !motion ? d.interpolation : 0;
        sink(c, Worst{.branch = branch.branch,
                      .channel = channel.name,
                      .unit = channel.unit,
                      .max = d.max <= uncertain ? 0 : d.max - uncertain,
                      .end = d.end,
                      .range = d.range,
                      .limit = limit_of(channel, branch.extents[c], tolerance),
                      .extent = motion ? 0 : branch.extents[c]});
    }
}

}  // namespace

const char* name(Grade verdict) {
    switch (verdict) {
        case Grade::pass: return "pass";
        case Grade::fail: return "fail";
        case Grade::not_judged: return "not judged";
    }
    return "";
}

double as_position(const RateError& rate) { return std::abs(rate.off * rate.over); }

Assessment assess(const Model& model, const Comparison& comparison, const Tolerance& tolerance,
                  bool tolerance_given) {
    Assessment j;
    j.tolerance = tolerance;
    j.tolerance_given = tolerance_given;
    for (const auto& branch : comparison.branches) {
        j.method = branch.run(Leg::recursive).method;
        for (const auto& reason : branch.inconclusive.texts())
            j.reasons.push_back(branch.branch + ": " + reason);
    }
    const auto rates =
        comparison.branches.empty() ? std::vector<RateError>{} : rate_errors(model, comparison);
    for (const auto& rate : rates)
        if (!j.wheel_rate || std::abs(rate.off) > std::abs(j.wheel_rate->off)) j.wheel_rate = rate;

    bool within = true;
    j.exact = true;
    std::vector<bool> judged(comparison.channels.size());
    for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
        const bool across = kind == ReadingKind::equal_abscissa;
        std::optional<Worst>&position = across ? j.position_across : j.position,
        &angle = across ? j.angle_across : j.angle, &other = across ? j.other_across : j.other;
        std::optional<Worst> position_otherwise, angle_otherwise;  // of outputs that are not main
        // of rates that may be undefined: near the zero of a denominator a small error is
        // a large share
        std::optional<Worst> quotient;
        for (const auto& branch : comparison.branches)
            for_each_output(
                comparison, branch, kind, tolerance, [&](std::size_t c, const Worst& found) {
                    const Channel& channel = comparison.channels[c];
                    const bool motion = is_motion(channel), mm = channel.unit == Unit::mm;
                    judged[c] = judged[c] || std::isfinite(found.limit);
                    within = within && is_within(found);
                    j.exact =
                        j.exact && found.max < (motion ? nothing : nothing_of_it * found.extent);
                    auto& worst = !motion        ? (channel.may_be_undefined() ? quotient : other)
                                  : channel.main ? (mm ? position : angle)
                                                 : (mm ? position_otherwise : angle_otherwise);
                    if (is_worse(found, worst)) worst = found;
                });
        for (const auto& [main, otherwise] : {std::pair{&position, &position_otherwise},
                                              {&angle, &angle_otherwise},
                                              {&other, &quotient}})
            if (*otherwise && (!*main || (is_within(**main) && is_worse(**otherwise, *main))))
                *main = *otherwise;
    }
    for (const auto& rate : rates) {
        within = within && std::isfinite(rate.off) && as_position(rate) <= tolerance.mm;
        j.exact = j.exact && as_position(rate) < nothing;
    }
    for (std::size_t c = 0; c < judged.size(); ++c) {
        j.outputs += judged[c];
        j.others += judged[c] && !is_motion(comparison.channels[c]);
    }
    if (!j.position && !j.angle && !j.other) j.reasons.emplace_back("nothing was compared");
    if (!comparison.conclusive() && j.reasons.empty())
        j.reasons.emplace_back("nothing was compared");
    if (j.reasons.empty()) j.verdict = within ? Grade::pass : Grade::fail;
    return j;
}

}  // namespace elastocheck::compare
