#include "compare/outputs/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/decimal.hpp"

namespace elastocheck::compare {
namespace {

// Smallest range that is not rounding of coordinates in metres [mm, deg, N, N·m].
constexpr double min_range = 1e-9;

}  // namespace

std::vector<double> Curve::channel(std::size_t c) const {
    std::vector<double> y;
    y.reserve(values.size());
    for (const auto& point : values) y.push_back(point[c]);
    return y;
}

double parameter_in(Unit unit, double load) {
    const std::string digits = fmt::format("{:.15g}", in_unit(unit) * load);
    double rounded = load;
    read_decimal(digits.data(), digits.data() + digits.size(), rounded);
    return rounded + 0.0;  // no negative zero at the start of a negative side
}

void append(Curve& curve, double load, std::vector<double> values) {
    const double a = parameter_in(curve.unit, load);
    if (!curve.a.empty() && std::abs(a) < std::abs(curve.a[curve.start]))
        curve.start = curve.a.size();
    curve.a.push_back(a);
    curve.values.push_back(std::move(values));
}

Curve curve(const Model& model, std::span<const Channel> channels, const Branch& branch,
            const std::vector<Equilibrium>& points) {
    Curve result;
    result.unit = unit_of(branch.unit);
    for (const auto& point : points) append(result, point.load, evaluate(model, channels, point));
    return result;
}

Curve thinned(const Curve& curve, std::size_t stride) {
    Curve result{.unit = curve.unit, .a = {}, .start = curve.start / stride, .values = {}};
    for (std::size_t k = curve.start % stride; k < curve.a.size(); k += stride) {
        result.a.push_back(curve.a[k]);
        result.values.push_back(curve.values[k]);
    }
    return result;
}

Trend trend(std::span<const double> x) {
    for (std::size_t k = 0; k < x.size(); ++k)
        if (!std::isfinite(x[k])) return {Course::not_finite, k};
    if (x.size() < 2) return {};
    const auto [low, high] = std::ranges::minmax(x);
    if (!(high - low > min_range)) return {Course::still, 0};
    const bool up = x[1] > x[0];
    for (std::size_t k = 1; k < x.size(); ++k)
        if (!(up ? x[k] > x[k - 1] : x[k] < x[k - 1])) return {Course::turning, k - 1};
    return {up ? Course::rising : Course::falling, 0};
}

Abscissa abscissa(std::span<const Channel> channels, int channel, const Curve& a, const Curve& b) {
    if (channel < 0) return {-1, "the scene has no position that can be the abscissa"};
    const Channel& candidate = channels[static_cast<std::size_t>(channel)];
    std::string why;
    Course first = Course::rising;
    for (const Curve* curve : {&a, &b}) {
        const auto x = curve->channel(static_cast<std::size_t>(channel));
        const Trend along_curve = trend(x);
        switch (along_curve.course) {
            case Course::rising:
            case Course::falling: break;
            case Course::still: why = fmt::format("{} does not move", candidate.name); break;
            case Course::turning:
                why = fmt::format("{} turns back at {:.4g} {} (at {:.4g} {})", candidate.name,
                                  curve->a[along_curve.at], symbol(curve->unit), x[along_curve.at],
                                  symbol(candidate.unit));
                break;
            case Course::not_finite:
                why = fmt::format("{} is not a number at {:.4g} {}", candidate.name,
                                  curve->a[along_curve.at], symbol(curve->unit));
                break;
            case Course::too_short: why = "a curve has fewer than two points"; break;
        }
        if (!why.empty()) return {channel, why};
        if (curve == &a) first = along_curve.course;
        if (curve == &b && along_curve.course != first)
            return {channel,
                    fmt::format("{} has opposite directions on the two curves", candidate.name)};
    }
    return {channel, ""};
}

}  // namespace elastocheck::compare
