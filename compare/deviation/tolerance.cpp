#include "compare/deviation/tolerance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "models/decimal.hpp"

namespace elastocheck::compare {
namespace {

bool is_wrench(const Channel& channel) {
    return std::holds_alternative<Reaction>(channel.reads) ||
           std::holds_alternative<Total>(channel.reads);
}

}  // namespace

Tolerance parse_tolerance(std::string_view text, ToleranceParts allowed) {
    const bool allows_share = allowed != ToleranceParts::motion,
               allows_forces = allowed == ToleranceParts::with_forces;
    const auto refuse = [&](std::string_view why) {
        throw std::invalid_argument(fmt::format(
            "tolerance '{}': {}; allowed: {}, each above 0, such as 0.01mm,0.001deg{}", text, why,
            allows_forces
                ? "a length in mm, an angle in deg, a force in N, a moment in Nm, a share of "
                  "all other "
                  "outputs in %, or some of these"
            : allows_share
                ? "a length in mm, an angle in deg, a share of all other outputs in %, or "
                  "some of these"
                : "a length in mm, an angle in deg or both",
            allows_forces  ? ",1N,1%"
            : allows_share ? ",1%"
                           : ""));
    };
    const auto trim = [](std::string_view word) {
        while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
        while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
        return word;
    };
    Tolerance result;
    // in the order in which ToleranceParts allows them: the first two, three or all
    const std::pair<std::string_view, double*> parts[] = {{"mm", &result.mm},
                                                          {"deg", &result.deg},
                                                          {"%", &result.share},
                                                          {"N", &result.newton},
                                                          {"Nm", &result.newton_metre}};
    for (std::string_view remaining = text;;) {
        const auto comma = remaining.find(',');
        const std::string_view word = trim(remaining.substr(0, comma));
        if (word.empty()) refuse("a number with its unit is missing");
        double value = 0;
        const auto [end, error] = read_decimal(word.data(), word.data() + word.size(), value);
        if (error == std::errc::invalid_argument)
            refuse(fmt::format("'{}' does not begin with a number", word));
        if (error != std::errc{} || !std::isfinite(value) || !(value > 0))
            refuse(fmt::format("'{}' is not a finite number above 0", word));
        const std::string_view unit =
            trim(word.substr(static_cast<std::size_t>(end - word.data())));
        const auto* const entry = std::ranges::find(
            parts, unit, [](const auto& unit_and_value) { return unit_and_value.first; });
        if (entry >= parts + (allows_forces ? 5 : allows_share ? 3 : 2))
            refuse(unit.empty() ? fmt::format("'{}' has no unit", word)
                                : fmt::format("'{}' is not a unit of it", unit));
        if (std::isfinite(*entry->second)) refuse(fmt::format("{} is given twice", unit));
        *entry->second = entry->second == &result.share ? value / 100 : value;
        if (comma == remaining.npos) break;
        remaining.remove_prefix(comma + 1);
    }
    if (allows_share && std::isinf(result.share)) result.share = default_share;
    return result;
}

bool is_motion(const Channel& channel) {
    return channel.kinematic() && (channel.unit == Unit::mm || channel.unit == Unit::deg);
}

std::vector<double> extents_of(const std::vector<Channel>& channels, const Curve& truth,
                               const Scale& scale) {
    constexpr double no_force = 1e-12;  // [N]: lower limit where no force acts
    // The factors of tolerance.hpp: a tenth of the largest |value|; F / 1000 + 1600 ε k X; a
    // thousandth of the unit.
    constexpr double share_of_value = 0.1, share_of_force = 1e-3, multiple_of_rounding = 1.6e3,
                     share_of_unit = 1e-3;
    const double force =
        share_of_force * std::max(scale.force, no_force) + multiple_of_rounding * scale.round_off;
    std::vector<double> extents;
    // of the component with the largest one; the force and the moment of a joint are two wrenches
    std::map<std::pair<std::vector<int>, Unit>, double> extents_of_wrenches;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Channel& channel = channels[c];
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const auto& point : truth.values) {
            low = std::min(low, point[c]);
            high = std::max(high, point[c]);
        }
        const double share_of_largest =
            channel.kind() == ChannelKind::characteristic ? 1 : share_of_value;
        double extent =
            truth.values.empty()
                ? 0
                : std::max(high - low, share_of_largest * std::max(std::abs(low), std::abs(high)));
        switch (channel.unit) {
            case Unit::newton: extent = std::max(extent, force); break;
            case Unit::newton_metre: extent = std::max(extent, force * scale.length); break;
            default: extent = std::max(extent, share_of_unit);
        }
        extents.push_back(extent);
        if (!is_wrench(channel)) continue;
        double& extent_of_wrench = extents_of_wrenches[{channel.joints(), channel.unit}];
        extent_of_wrench = std::max(extent_of_wrench, extent);
    }
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (is_wrench(channels[c]))
            extents[c] = extents_of_wrenches[{channels[c].joints(), channels[c].unit}];
    return extents;
}

double limit_of(const Channel& channel, double extent, const Tolerance& tolerance) {
    if (is_motion(channel)) return channel.unit == Unit::mm ? tolerance.mm : tolerance.deg;
    if (channel.unit == Unit::newton && std::isfinite(tolerance.newton)) return tolerance.newton;
    if (channel.unit == Unit::newton_metre && std::isfinite(tolerance.newton_metre))
        return tolerance.newton_metre;
    return tolerance.share * extent;
}

}  // namespace elastocheck::compare
