#include "compare/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace elastocheck::compare {

const char* name(Grade verdict) {
    switch (verdict) {
        case Grade::pass: return "pass";
        case Grade::fail: return "fail";
        case Grade::not_judged: return "not judged";
    }
    return "";
}

double as_position(const RateError& rate) { return std::abs(rate.off * rate.over); }

Assessment assess(const Model& model, const Comparison& comparison, const Tolerance& tolerance, bool asked) {
    Assessment j;
    j.tolerance = tolerance;
    j.asked = asked;
    for (const auto& branch : comparison.branches) {
        j.method = branch.runs[static_cast<std::size_t>(Leg::recursive)].method;
        for (const auto& reason : branch.inconclusive.texts())
            j.reasons.push_back(branch.branch + ": " + reason);
    }
    j.position = worst_deviation(comparison, ReadingKind::equal_parameter, Unit::mm);
    j.angle = worst_deviation(comparison, ReadingKind::equal_parameter, Unit::deg);
    j.position_across = worst_deviation(comparison, ReadingKind::equal_abscissa, Unit::mm);
    j.angle_across = worst_deviation(comparison, ReadingKind::equal_abscissa, Unit::deg);
    const auto rates =
        comparison.branches.empty() ? std::vector<RateError>{} : rate_errors(model, comparison);
    for (const auto& rate : rates)
        if (!j.wheel_rate || std::abs(rate.off) > std::abs(j.wheel_rate->off)) j.wheel_rate = rate;

    if (!j.position && !j.angle) j.reasons.emplace_back("nothing was compared");
    if (!comparison.conclusive() && j.reasons.empty()) j.reasons.emplace_back("nothing was compared");
    if (!j.reasons.empty()) return j;
    bool within = true;
    const auto hold = [&](double value, double limit) {
        within = within && std::isfinite(value) && value <= limit;
    };
    for (const auto* worst : {&j.position, &j.position_across})
        if (*worst) hold((*worst)->max, tolerance.mm);
    for (const auto* worst : {&j.angle, &j.angle_across})
        if (*worst) hold((*worst)->max, tolerance.deg);
    for (const auto& rate : rates) hold(as_position(rate), tolerance.mm);
    j.verdict = within ? Grade::pass : Grade::fail;
    return j;
}

}  // namespace elastocheck::compare
