#include "reports/tables/judgement.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <tuple>

#include "reports/text/numbers.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using compare::Assessment;
using compare::Grade;
using compare::Worst;

constexpr double zero_deviation = 1e-9;  // [mm], [deg]: smaller deviations are rounding
constexpr double zero_share = 1e-6;      // share of an extent: likewise

std::string subject(const Assessment& j) {
    if (j.method.empty() || j.method == "published") return "the linear recursion as published";
    return fmt::format("the recursion by method ‘{}’", j.method);
}

std::string size(const Worst& worst, double limit) {
    return deviation_text(worst.max, limit, symbol(worst.unit));
}

std::string tolerance_of(const Assessment& j) {
    return tolerance_text(j.tolerance, j.others > 0, j.tolerance_given);
}

// "6.9 N, 7 % of its extent (rod.drive force, branch len)"
std::string other_of(const Assessment& j) {
    const auto share_of_limit = [](const std::optional<Worst>& worst) {
        return worst ? worst->max / (std::isfinite(worst->limit) ? worst->limit : worst->extent)
                     : -1;
    };
    const bool at_equal_position =
        !std::isnan(share_of_limit(j.other)) &&
        !(share_of_limit(j.other_at_abscissa) <= (1 + 1e-6) * share_of_limit(j.other));
    const auto& worst = at_equal_position ? j.other_at_abscissa : j.other;
    if (!worst || !(worst->max >= zero_share * worst->extent || std::isnan(worst->max))) return "";
    return fmt::format("{}, {} of its extent ({}, branch {}{})", size(*worst, worst->limit),
                       percent(worst->max / worst->extent), as_words(worst->channel), worst->branch,
                       at_equal_position ? ", at equal position" : "");
}

// "5.1 mm (wheel centre z, branch vertical) and 0.11 deg (camber, branch vertical)", by the worse
// reading; empty where all is rounding.
std::string worst_of(const Assessment& j) {
    std::vector<std::string> parts;
    for (const auto& [at_parameter, at_position, limit] :
         {std::tuple(&j.position, &j.position_at_abscissa, j.tolerance.mm),
          std::tuple(&j.angle, &j.angle_at_abscissa, j.tolerance.deg)}) {
        const bool at_equal_position =
            *at_position &&
            (!*at_parameter || (!std::isnan((*at_parameter)->max) &&
                                !((*at_position)->max <= (1 + 1e-6) * (*at_parameter)->max)));
        const auto& worst = at_equal_position ? *at_position : *at_parameter;
        if (!worst || (worst->max < zero_deviation && worst->max <= limit)) continue;
        parts.push_back(fmt::format("{} ({}, branch {}{})", size(*worst, limit),
                                    as_words(worst->channel), worst->branch,
                                    at_equal_position ? ", at equal position" : ""));
    }
    if (auto other = other_of(j); !other.empty()) parts.push_back(std::move(other));
    return enumerated(parts);
}

std::string rate_of(const Assessment& j) {
    if (!j.wheel_rate) return "";
    const double off = j.wheel_rate->off;
    return fmt::format("; its wheel rate is up to {} too {}", percent(std::abs(off)),
                       off < 0 ? "soft" : "stiff");
}

// "84 outputs compared, 60 of them forces, moments and rates"
std::string compared(const Assessment& j) {
    const std::string others =
        j.others == 0 ? ", no force, moment or rate among them"
                      : fmt::format(", {} of them forces, moments and rates", j.others);
    return counted(static_cast<std::size_t>(j.outputs), "output") + " compared" + others;
}

// The deviations without a verdict.
std::string deviations(const Assessment& j) {
    const std::string worst = worst_of(j);
    const std::string text = j.exact || (worst.empty() && !j.wheel_rate)
                                 ? fmt::format("{} is exact to round-off", subject(j))
                             : worst.empty()
                                 ? fmt::format("{} is exact to round-off but for the wheel rate{}",
                                               subject(j), rate_of(j))
                                 : fmt::format("{} is off from the full solution by up to {}{}",
                                               subject(j), worst, rate_of(j));
    return fmt::format("{}{}; {}. No verdict was requested: --within gives a tolerance.",
                       static_cast<char>(std::toupper(static_cast<unsigned char>(text.front()))),
                       text.substr(1), compared(j));
}

}  // namespace

std::string deviation_text(double value, double limit, const char* unit) {
    if (std::isnan(value)) return "not a number";
    if (value > limit && value < 1.1 * limit) return fmt::format("{:.6g} {}", value, unit);
    if (value < zero_deviation)
        return value > limit ? fmt::format("{:.1e} {}", value, unit) : "nothing";
    return quantity(value, unit);
}

std::string not_judged(const std::vector<std::string>& reasons) {
    return fmt::format(
        "Not judged: {}{}.", reasons.empty() ? "nothing was compared" : reasons.front(),
        reasons.size() > 1 ? fmt::format(" (and {} reasons more)", reasons.size() - 1) : "");
}

std::string tolerance_text(const compare::Tolerance& tolerance, bool others, bool given) {
    std::vector<std::string> parts;
    const auto add = [&](double value, const char* unit) {
        if (std::isfinite(value)) parts.push_back(setting(value, unit));
    };
    add(tolerance.mm, "mm");
    add(tolerance.deg, "deg");
    add(tolerance.newton, "N");
    add(tolerance.newton_metre, "N·m");
    if (others && std::isfinite(tolerance.share)) {
        const bool force = std::isfinite(tolerance.newton),
                   moment = std::isfinite(tolerance.newton_metre);
        parts.push_back(fmt::format("{} of the extent of {}", setting(100 * tolerance.share, "%"),
                                    force && moment ? "rates"
                                    : force         ? "moments and rates"
                                    : moment        ? "forces and rates"
                                                    : "forces, moments and rates"));
    }
    return enumerated(parts) + (given ? "" : " (the default)");
}

std::string sentence(const Assessment& j) {
    if (!j.requested && j.verdict != Grade::not_judged) return deviations(j);
    switch (j.verdict) {
        case Grade::not_judged:
            return not_judged(j.reasons) + " The results are no basis for a decision.";
        case Grade::pass:
            if (j.exact)
                return fmt::format("Pass: {} is exact to round-off; the tolerance is {}; {}.",
                                   subject(j), tolerance_of(j), compared(j));
            return fmt::format(
                "Pass: {} is within {} of the full solution everywhere, off by at most {}{}; {}.",
                subject(j), tolerance_of(j), worst_of(j).empty() ? "round-off" : worst_of(j),
                rate_of(j), compared(j));
        case Grade::fail:
            return fmt::format(
                "Fail: {} is off from the full solution by up to {}{}. The tolerance is {}.",
                subject(j), worst_of(j), rate_of(j), tolerance_of(j));
    }
    return {};
}

}  // namespace elastocheck::reports
