#include "compare/deviation/tolerance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
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
    const bool shares = allowed != ToleranceParts::motion,
               forces = allowed == ToleranceParts::with_forces;
    const auto refuse = [&](std::string_view why) {
        throw std::invalid_argument(fmt::format(
            "tolerance '{}': {}; allowed: {}, each above 0, such as 0.01mm,0.001deg{}", text, why,
            forces   ? "a length in mm, an angle in deg, a force in N, a moment in Nm, a share of "
                       "all other "
                       "outputs in %, or some of these"
            : shares ? "a length in mm, an angle in deg, a share of all other outputs in %, or "
                       "some of these"
                     : "a length in mm, an angle in deg or both",
            forces   ? ",1N,1%"
            : shares ? ",1%"
                     : ""));
    };
    const auto trim = [](std::string_view word) {
        while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
        while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
        return word;
    };
    Tolerance result;
    const std::pair<std::string_view, double*> known[] = {{"mm", &result.mm},
                                                          {"deg", &result.deg},
                                                          {"%", &result.share},
                                                          {"N", &result.newton},
                                                          {"Nm", &result.newton_metre}};
    for (std::string_view rest = text;;) {
        const auto comma = rest.find(',');
        const std::string_view word = trim(rest.substr(0, comma));
        if (word.empty()) refuse("a number with its unit is missing");
        double value = 0;
        const auto [end, error] = read_decimal(word.data(), word.data() + word.size(), value);
        if (error == std::errc::invalid_argument)
            refuse(fmt::format("'{}' does not begin with a number", word));
        if (error != std::errc{} || !std::isfinite(value) || !(value > 0))
            refuse(fmt::format("'{}' is not a finite number above 0", word));
        const std::string_view unit =
            trim(word.substr(static_cast<std::size_t>(end - word.data())));
        const auto* const of =
            std::ranges::find(known, unit, [](const auto& entry) { return entry.first; });
        if (of >= known + (forces ? 5 : shares ? 3 : 2))
            refuse(unit.empty() ? fmt::format("'{}' has no unit", word)
                                : fmt::format("'{}' is not a unit of it", unit));
        if (std::isfinite(*of->second)) refuse(fmt::format("{} is given twice", unit));
        *of->second = of->second == &result.share ? value / 100 : value;
        if (comma == rest.npos) break;
        rest.remove_prefix(comma + 1);
    }
    if (shares && std::isinf(result.share)) result.share = default_share;
    return result;
}

bool is_motion(const Channel& channel) {
    return channel.kinematic() && (channel.unit == Unit::mm || channel.unit == Unit::deg);
}

std::vector<double> extents_of(const std::vector<Channel>& channels, const Curve& truth,
                               const Scale& acts) {
    constexpr double no_force = 1e-12;  // [N]: lower limit where no force acts
    constexpr double of_value = 0.1, of_what_acts = 1e-3, of_rounding = 1.6e3, of_unit = 1e-3;
    const double force =
        of_what_acts * std::max(acts.force, no_force) + of_rounding * acts.round_off;
    std::vector<double> extents;
    std::map<std::pair<std::vector<int>, Unit>, double> of_wrench;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Channel& channel = channels[c];
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const auto& point : truth.values) {
            low = std::min(low, point[c]);
            high = std::max(high, point[c]);
        }
        const double part = channel.kind() == ChannelKind::characteristic ? 1 : of_value;
        double extent = truth.values.empty()
                            ? 0
                            : std::max(high - low, part * std::max(std::abs(low), std::abs(high)));
        switch (channel.unit) {
            case Unit::newton: extent = std::max(extent, force); break;
            case Unit::newton_metre: extent = std::max(extent, force * acts.length); break;
            default: extent = std::max(extent, of_unit);
        }
        extents.push_back(extent);
        if (!is_wrench(channel)) continue;
        double& whole = of_wrench[{channel.joints(), channel.unit}];
        whole = std::max(whole, extent);
    }
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (is_wrench(channels[c]))
            extents[c] = of_wrench[{channels[c].joints(), channels[c].unit}];
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
