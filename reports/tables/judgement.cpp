#include "reports/tables/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string size(const Worst& worst) {
    if (std::isnan(worst.max)) return "a number that is none";
    return worst.max < nothing ? "nothing" : quantity(worst.max, symbol(worst.unit));
}

std::string asked(const Assessment& j) {
    std::string text;
    if (std::isfinite(j.tolerance.mm)) text += setting(j.tolerance.mm, "mm");
    if (std::isfinite(j.tolerance.deg))
        text += (text.empty() ? "" : " and ") + setting(j.tolerance.deg, "deg");
    return text + (j.asked ? "" : " (the default)");
}

// "5.1 mm (wheel centre z, branch vertical) and 0.11 deg (camber, branch vertical)"
std::string worst_of(const Assessment& j) {
    std::string text;
    for (const auto* worst : {&j.position, &j.angle})
        if (*worst)
            text += fmt::format("{}{} ({}, branch {})", text.empty() ? "" : " and ", size(**worst),
                                spaced((*worst)->channel), (*worst)->branch);
    return text;
}

std::string rate_of(const Assessment& j) {
    if (!j.wheel_rate) return "";
    const double off = j.wheel_rate->off;
    return fmt::format("; its wheel rate is up to {} too {}", percent(std::abs(off)),
                       off < 0 ? "soft" : "stiff");
}

bool exact(const Assessment& j) {
    return !(j.position && !(j.position->max < nothing)) && !(j.angle && !(j.angle->max < nothing)) &&
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
