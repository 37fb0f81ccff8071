#include "reports/tables/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "reports/page/numbers.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Assessment;
using compare::Grade;
using compare::Worst;

constexpr double nothing = 1e-9;  // [mm], [deg]: smaller deviations are the arithmetic's

std::string spaced(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::string subject(const Assessment& j) {
    if (j.method.empty() || j.method == "published") return "the linear recursion as published";
    return fmt::format("the recursion by method ‘{}’", j.method);
}

// `limit`: what it was to be within, so that what breaks it by little is seen to.
std::string size(const Worst& worst, double limit) {
    if (std::isnan(worst.max)) return "a number that is none";
    if (worst.max > limit && worst.max < 1.1 * limit)
        return fmt::format("{:.6g} {}", worst.max, symbol(worst.unit));
    if (worst.max < nothing)
        return worst.max > limit ? fmt::format("{:.1e} {}", worst.max, symbol(worst.unit)) : "nothing";
    return quantity(worst.max, symbol(worst.unit));
}

std::string asked(const Assessment& j) {
    std::string text;
    if (std::isfinite(j.tolerance.mm)) text += setting(j.tolerance.mm, "mm");
    if (std::isfinite(j.tolerance.deg))
        text += (text.empty() ? "" : " and ") + setting(j.tolerance.deg, "deg");
    return text + (j.asked ? "" : " (the default)");
}

// "5.1 mm (wheel centre z, branch vertical) and 0.11 deg (camber, branch vertical)", by whichever reading is worse.
std::string worst_of(const Assessment& j) {
    std::string text;
    for (const auto& [at, across, limit] : {std::tuple(&j.position, &j.position_across, j.tolerance.mm),
                                            std::tuple(&j.angle, &j.angle_across, j.tolerance.deg)}) {
        const bool crosswise =
            *across && (!*at || (!std::isnan((*at)->max) && !((*across)->max <= (1 + 1e-6) * (*at)->max)));
        const auto& worst = crosswise ? *across : *at;
        if (worst)
            text +=
                fmt::format("{}{} ({}, branch {}{})", text.empty() ? "" : " and ", size(*worst, limit),
                            spaced(worst->channel), worst->branch, crosswise ? ", at equal position" : "");
    }
    return text;
}

std::string rate_of(const Assessment& j) {
    if (!j.wheel_rate) return "";
    const double off = j.wheel_rate->off;
    return fmt::format("; its wheel rate is up to {} too {}", percent(std::abs(off)),
                       off < 0 ? "soft" : "stiff");
}

bool exact(const Assessment& j) {
    const auto none = [](const std::optional<Worst>& worst) { return !worst || worst->max < nothing; };
    return none(j.position) && none(j.angle) && none(j.position_across) && none(j.angle_across) &&
           !(j.wheel_rate && !(compare::as_position(*j.wheel_rate) < nothing));
}

json worst_json(const std::optional<Worst>& worst) {
    if (!worst) return nullptr;
    return {{"channel", worst->channel},
            {"branch", worst->branch},
            {"unit", symbol(worst->unit)},
            {"max", worst->max}};
}

}  // namespace

std::string sentence(const Assessment& j) {
    switch (j.verdict) {
        case Grade::not_judged: {
            const std::string more =
                j.reasons.size() > 1 ? fmt::format(" (and {} reasons more)", j.reasons.size() - 1) : "";
            return fmt::format("Not judged: {}{}. What is shown is no basis for a decision.",
                               j.reasons.empty() ? "nothing was compared" : j.reasons.front(), more);
        }
        case Grade::pass:
            if (exact(j))
                return fmt::format("Pass: {} is exact here, within the arithmetic; the tolerance is {}.",
                                   subject(j), asked(j));
            return fmt::format("Pass: {} is within {} of the full solution everywhere, off by at most {}{}.",
                               subject(j), asked(j), worst_of(j), rate_of(j));
        case Grade::fail:
            return fmt::format("Fail: {} is off from the full solution by up to {}{}. The tolerance is {}.",
                               subject(j), worst_of(j), rate_of(j), asked(j));
    }
    return {};
}

json judgement_json(const Assessment& j) {
    json rate = nullptr;
    if (j.wheel_rate)
        rate = {{"branch", j.wheel_rate->branch}, {"wheel", j.wheel_rate->wheel},
                {"to", j.wheel_rate->to},         {"unit", symbol(j.wheel_rate->unit)},
                {"off", j.wheel_rate->off},       {"as_position_mm", compare::as_position(*j.wheel_rate)}};
    return {{"verdict", compare::name(j.verdict)},
            {"sentence", sentence(j)},
            {"method", j.method},
            {"tolerance", {{"mm", j.tolerance.mm}, {"deg", j.tolerance.deg}, {"asked", j.asked}}},
            {"position", worst_json(j.position)},
            {"angle", worst_json(j.angle)},
            {"position_across", worst_json(j.position_across)},
            {"angle_across", worst_json(j.angle_across)},
            {"wheel_rate", rate},
            {"reasons", j.reasons}};
}

}  // namespace elastocheck::reports
