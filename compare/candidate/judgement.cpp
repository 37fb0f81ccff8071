#include "compare/candidate/judgement.hpp"

#include <cmath>

#include "compare/deviation/tolerance.hpp"

namespace elastocheck::compare {
namespace {

// Smaller deviations are rounding: of a position or angle in mm or deg, of other outputs as a share of the
// extent.
constexpr double rounding = 1e-9, rounding_share = 1e-6;

// Deviation relative to its limit; without a finite limit, relative to its extent.
double share_of_limit(const Worst& worst) {
    return worst.max / (std::isfinite(worst.limit) ? worst.limit
                        : worst.extent > 0         ? worst.extent
                                                   : 1);
}

// Whether `candidate` is a larger share of its limit than `worst`, or not a number; NaN in `worst` stays.
bool is_worse(const Worst& candidate, const std::optional<Worst>& worst) {
    return !worst || (!std::isnan(share_of_limit(*worst)) &&
                      !(share_of_limit(candidate) <= share_of_limit(*worst)));
}

bool is_within(const Worst& worst) { return std::isfinite(worst.max) && worst.max <= worst.limit; }

// Calls sink(channel, worst) for every determined output of one reading of a branch,
// with its limit.
template <class Sink>
void for_each_output(const Comparison& comparison, const BranchComparison& branch, ReadingKind kind,
                     const Tolerance& tolerance, Sink&& sink) {
    const bool by_abscissa = kind == ReadingKind::equal_abscissa;
    if (by_abscissa && !is_readable(comparison, branch)) return;
    const Reading& reading = reading_of(branch.deviation, kind);
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        const Channel& channel = comparison.channels[c];
        const Deviation& d = reading.channels[c];
        if (!branch.determined[c] || d.compared == 0) continue;
        const bool motion = is_motion(channel);
        const double uncertainty = by_abscissa && !motion ? d.interpolation : 0;
        sink(c, Worst{.branch = branch.branch,
                      .channel = channel.name,
                      .unit = channel.unit,
                      .max = d.max <= uncertainty ? 0 : d.max - uncertainty,
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
    Assessment result;
    result.tolerance = tolerance;
    result.tolerance_given = tolerance_given;
    for (const auto& branch : comparison.branches) {
        result.method = branch.run(Leg::recursive).method;
        for (const auto& reason : branch.inconclusive.texts())
            result.reasons.push_back(branch.branch + ": " + reason);
    }
    const auto rates =
        comparison.branches.empty() ? std::vector<RateError>{} : rate_errors(model, comparison);
    for (const auto& rate : rates)
        if (!result.wheel_rate || std::abs(rate.off) > std::abs(result.wheel_rate->off))
            result.wheel_rate = rate;

    bool within = true;
    result.exact = true;
    std::vector<bool> judged(comparison.channels.size());
    for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
        const bool by_abscissa = kind == ReadingKind::equal_abscissa;
        std::optional<Worst>&position = by_abscissa ? result.position_at_abscissa : result.position,
        &angle = by_abscissa ? result.angle_at_abscissa : result.angle,
        &other = by_abscissa ? result.other_at_abscissa : result.other;
        // Worst deviations of outputs that are not main, and of rates that may be undefined: near a zero of the
        // denominator of a rate a small error is a large share.
        std::optional<Worst> other_position, other_angle, quotient;
        for (const auto& branch : comparison.branches)
            for_each_output(
                comparison, branch, kind, tolerance, [&](std::size_t c, const Worst& found) {
                    const Channel& channel = comparison.channels[c];
                    const bool motion = is_motion(channel), mm = channel.unit == Unit::mm;
                    judged[c] = judged[c] || std::isfinite(found.limit);
                    within = within && is_within(found);
                    result.exact = result.exact &&
                                   found.max < (motion ? rounding : rounding_share * found.extent);
                    auto& worst = !motion        ? (channel.may_be_undefined() ? quotient : other)
                                  : channel.main ? (mm ? position : angle)
                                                 : (mm ? other_position : other_angle);
                    if (is_worse(found, worst)) worst = found;
                });
        for (const auto& [main, secondary] :
             {std::pair{&position, &other_position}, {&angle, &other_angle}, {&other, &quotient}})
            if (*secondary && (!*main || (is_within(**main) && is_worse(**secondary, *main))))
                *main = *secondary;
    }
    for (const auto& rate : rates) {
        within = within && std::isfinite(rate.off) && as_position(rate) <= tolerance.mm;
        result.exact = result.exact && as_position(rate) < rounding;
    }
    for (std::size_t c = 0; c < judged.size(); ++c) {
        result.outputs += judged[c];
        result.others += judged[c] && !is_motion(comparison.channels[c]);
    }
    if ((!result.position && !result.angle && !result.other) ||
        (!comparison.conclusive() && result.reasons.empty()))
        result.reasons.emplace_back("nothing was compared");
    if (result.reasons.empty()) result.verdict = within ? Grade::pass : Grade::fail;
    return result;
}

}  // namespace elastocheck::compare
