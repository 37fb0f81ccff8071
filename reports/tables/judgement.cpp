#include "reports/tables/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>

#include "reports/text/numbers.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Assessment;
using compare::Grade;
using compare::Worst;

constexpr double nothing = 1e-9;        // [mm], [deg]: smaller deviations are rounding
constexpr double nothing_of_it = 1e-6;  // share of an extent: likewise

std::string subject(const Assessment& j) {
    if (j.method.empty() || j.method == "published") return "the linear recursion as published";
    return fmt::format("the recursion by method ‘{}’", j.method);
}

// `limit`: the tolerance; a small excess is shown with enough digits.
std::string size(const Worst& worst, double limit) {
    if (std::isnan(worst.max)) return "not a number";
    if (worst.max > limit && worst.max < 1.1 * limit)
        return fmt::format("{:.6g} {}", worst.max, symbol(worst.unit));
    if (worst.max < nothing)
        return worst.max > limit ? fmt::format("{:.1e} {}", worst.max, symbol(worst.unit))
                                 : "nothing";
    return quantity(worst.max, symbol(worst.unit));
}

std::string asked(const Assessment& j) {
    return tolerance_text(j.tolerance, j.others > 0) + (j.asked ? "" : " (the default)");
}

// "6.9 N, 7 % of its extent (rod.drive force, branch len)"
std::string other_of(const Assessment& j) {
    const auto taken = [](const std::optional<Worst>& worst) {
        return worst ? worst->max / (std::isfinite(worst->limit) ? worst->limit : worst->extent)
                     : -1;
    };
    const bool crosswise =
        !std::isnan(taken(j.other)) && !(taken(j.other_across) <= (1 + 1e-6) * taken(j.other));
    const auto& worst = crosswise ? j.other_across : j.other;
    if (!worst || !(worst->max >= nothing_of_it * worst->extent || std::isnan(worst->max)))
        return "";
    return fmt::format("{}, {} of its extent ({}, branch {}{})", size(*worst, worst->limit),
                       percent(worst->max / worst->extent), as_words(worst->channel), worst->branch,
                       crosswise ? ", at equal position" : "");
}

// "5.1 mm (wheel centre z, branch vertical) and 0.11 deg (camber, branch vertical)", by the worse
// reading.
std::string worst_of(const Assessment& j) {
    std::vector<std::string> parts;
    for (const auto& [at, across, limit] :
         {std::tuple(&j.position, &j.position_across, j.tolerance.mm),
          std::tuple(&j.angle, &j.angle_across, j.tolerance.deg)}) {
        const bool crosswise =
            *across &&
            (!*at || (!std::isnan((*at)->max) && !((*across)->max <= (1 + 1e-6) * (*at)->max)));
        const auto& worst = crosswise ? *across : *at;
        if (!worst || (worst->max < nothing && worst->max <= limit)) continue;
        parts.push_back(fmt::format("{} ({}, branch {}{})", size(*worst, limit),
                                    as_words(worst->channel), worst->branch,
                                    crosswise ? ", at equal position" : ""));
    }
    if (auto other = other_of(j); !other.empty()) parts.push_back(std::move(other));
    return parts.empty() ? "nothing" : enumerated(parts);
}

std::string rate_of(const Assessment& j) {
    if (!j.wheel_rate) return "";
    const double off = j.wheel_rate->off;
    return fmt::format("; its wheel rate is up to {} too {}", percent(std::abs(off)),
                       off < 0 ? "soft" : "stiff");
}

// "; 84 outputs compared, 60 of them forces, moments and rates"
std::string compared(const Assessment& j) {
    const std::string others =
        j.others == 0 ? ", no force, moment or rate among them"
                      : fmt::format(", {} of them forces, moments and rates", j.others);
    return fmt::format("{} {} compared{}", j.outputs, j.outputs == 1 ? "output" : "outputs",
                       others);
}

// The deviations without a verdict.
std::string deviations(const Assessment& j) {
    const std::string text = j.exact ? fmt::format("{} is exact to round-off", subject(j))
                                     : fmt::format("{} is off from the full solution by up to {}{}",
                                                   subject(j), worst_of(j), rate_of(j));
    return fmt::format("{}{}; {}. No verdict was asked for: --within gives a tolerance.",
                       static_cast<char>(std::toupper(static_cast<unsigned char>(text.front()))),
                       text.substr(1), compared(j));
}

json worst_json(const std::optional<Worst>& worst) {
    if (!worst) return nullptr;
    return {{"channel", worst->channel},
            {"branch", worst->branch},
            {"unit", symbol(worst->unit)},
            {"max", worst->max},
            {"share", worst->extent > 0 ? json(worst->max / worst->extent) : json(nullptr)}};
}

}  // namespace

std::string tolerance_text(const compare::Tolerance& tolerance, bool others) {
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
    return enumerated(parts);
}

std::string sentence(const Assessment& j) {
    if (!j.requested && j.verdict != Grade::not_judged) return deviations(j);
    switch (j.verdict) {
        case Grade::not_judged: {
            const std::string more =
                j.reasons.size() > 1 ? fmt::format(" (and {} reasons more)", j.reasons.size() - 1)
                                     : "";
            return fmt::format("Not judged: {}{}. The results are no basis for a decision.",
                               j.reasons.empty() ? "nothing was compared" : j.reasons.front(),
                               more);
        }
        case Grade::pass:
            if (j.exact)
                return fmt::format("Pass: {} is exact to round-off; the tolerance is {}; {}.",
                                   subject(j), asked(j), compared(j));
            return fmt::format(
                "Pass: {} is within {} of the full solution everywhere, off by at most {}{}; {}.",
                subject(j), asked(j), worst_of(j), rate_of(j), compared(j));
        case Grade::fail:
            return fmt::format(
                "Fail: {} is off from the full solution by up to {}{}. The tolerance is {}.",
                subject(j), worst_of(j), rate_of(j), asked(j));
    }
    return {};
}

nlohmann::ordered_json tolerance_json(const compare::Tolerance& tolerance, bool asked) {
    return {{"mm", tolerance.mm},           {"deg", tolerance.deg},     {"N", tolerance.newton},
            {"Nm", tolerance.newton_metre}, {"share", tolerance.share}, {"asked", asked}};
}

json judgement_json(const Assessment& j) {
    json rate = nullptr;
    if (j.wheel_rate)
        rate = {{"branch", j.wheel_rate->branch},
                {"wheel", j.wheel_rate->wheel},
                {"to", j.wheel_rate->to},
                {"unit", symbol(j.wheel_rate->unit)},
                {"off", j.wheel_rate->off},
                {"as_position_mm", compare::as_position(*j.wheel_rate)}};
    const bool told = j.requested || j.verdict == Grade::not_judged;
    return {{"verdict", told ? compare::name(j.verdict) : "not asked"},
            {"sentence", sentence(j)},
            {"method", j.method},
            {"tolerance", tolerance_json(j.tolerance, j.asked)},
            {"position", worst_json(j.position)},
            {"angle", worst_json(j.angle)},
            {"position_across", worst_json(j.position_across)},
            {"angle_across", worst_json(j.angle_across)},
            {"other", worst_json(j.other)},
            {"other_across", worst_json(j.other_across)},
            {"wheel_rate", rate},
            {"outputs", j.outputs},
            {"others", j.others},
            {"reasons", j.reasons}};
}

}  // namespace elastocheck::reports
