#include "compare/comparison/extrapolation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "elastocheck/channels.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

// For a quantity at three points: zero of the line through the last two, and relative misfit of the
// first.
struct Line {
    double zero = 0, off = 0;
};
Line line(const double (&a)[3], const double (&y)[3]) {
    const double slope = (y[2] - y[1]) / (a[2] - a[1]);
    return {a[2] - y[2] / slope, std::abs(y[2] + slope * (a[0] - a[2]) - y[0]) / std::abs(y[0])};
}

}  // namespace

std::optional<double> stiffness_gone_near(std::span<const Equilibrium> points) {
    if (points.size() < 3) return std::nullopt;
    const auto last = points.last(3);
    double a[3], s[3], squared[3];
    for (std::size_t k = 0; k < 3; ++k) {
        a[k] = last[k].load, s[k] = last[k].stiffness_left, squared[k] = s[k] * s[k];
        if (!(s[k] > 0)) return std::nullopt;
    }
    if (!(s[0] > s[1] && s[1] > s[2])) return std::nullopt;
    const Line straight = line(a, s), root = line(a, squared);
    return root.off / 2 < straight.off ? root.zero : straight.zero;
}

namespace {

// Empty where the prediction is farther ahead than the path is long.
std::optional<double> announced(std::span<const Equilibrium> points) {
    const auto gone = stiffness_gone_near(points);
    if (!gone || !(std::abs(*gone - points.back().load) <= std::abs(points.back().load)))
        return std::nullopt;
    return gone;
}

}  // namespace

std::optional<ErrorBound> tolerance_of_method(const recursive::Method& method, double length) {
    constexpr double rounding = 1e-9;
    return std::visit(
        overloaded{[](const recursive::Adaptive& steps) -> std::optional<ErrorBound> {
                       return ErrorBound{steps.length_tolerance, steps.angle_tolerance};
                   },
                   [&](const recursive::Series& series) -> std::optional<ErrorBound> {
                       return ErrorBound{std::max(series.tolerance, rounding * length),
                                         std::max(series.tolerance / length, rounding)};
                   },
                   [](const auto&) -> std::optional<ErrorBound> { return std::nullopt; }},
        method.kind);
}

void add(ErrorBoundSummary& error_bounds, const Equilibrium& point,
         const std::optional<ErrorBound>& tolerance) {
    if (error_bounds.last.size() == 3) error_bounds.last.erase(error_bounds.last.begin());
    Equilibrium& kept = error_bounds.last.emplace_back();
    kept.load = point.load;
    kept.bound = point.bound;
    kept.stiffness_left = point.stiffness_left;
    if (!announced(error_bounds.last))
        error_bounds.announced_from = std::nullopt;
    else if (!error_bounds.announced_from)
        error_bounds.announced_from = point.load;

    ++error_bounds.points;
    if (!tolerance) return;
    const double over =
        std::max(point.bound.length / tolerance->length, point.bound.angle / tolerance->angle);
    if (over <= 1) return;
    if (!std::isfinite(over)) {
        ++error_bounds.unbounded;
        return;
    }
    ++error_bounds.beyond;
    if (over > error_bounds.share)
        error_bounds.share = over, error_bounds.worst_bound = point.bound,
        error_bounds.worst_load = point.load;
}

std::string exceeded_bounds(const ErrorBoundSummary& error_bounds, const ErrorBound& tolerance,
                            ParameterUnit unit) {
    const auto angle = [](double radian) { return in_unit(Unit::deg) * radian; };
    std::string text;
    if (error_bounds.beyond > 0)
        text = fmt::format(
            "promises {:.2g} mm and {:.2g} deg, which the error bounds of {} of {} points exceed: "
            "{:.2g} mm and {:.2g} deg at {:.5g} {}",
            1e3 * tolerance.length, angle(tolerance.angle), error_bounds.beyond,
            error_bounds.points, 1e3 * error_bounds.worst_bound.length,
            angle(error_bounds.worst_bound.angle), in_unit(unit_of(unit)) * error_bounds.worst_load,
            symbol(unit_of(unit)));
    if (error_bounds.unbounded > 0)
        text += fmt::format("{}{} of {} points have no error bound", text.empty() ? "" : "; ",
                            error_bounds.unbounded, error_bounds.points);
    return text;
}

std::string stiffness_message(std::span<const Equilibrium> points, ParameterUnit unit) {
    const auto gone = announced(points);
    if (!gone) return {};
    const Unit shown = unit_of(unit);
    return fmt::format("by extrapolation the stiffness vanishes near {:.5g} {}",
                       in_unit(shown) * *gone, symbol(shown));
}

void add(BranchErrorBounds& error_bound, const Equilibrium& point) {
    if (error_bound.sides.empty() || point.load == 0) error_bound.sides.emplace_back();
    add(error_bound.sides.back(), point, error_bound.tolerance);
}

std::vector<std::string> messages(const BranchErrorBounds& error_bound, ParameterUnit unit) {
    const Unit shown = unit_of(unit);
    std::vector<std::string> lines;
    for (const auto& points : error_bound.sides) {
        if (error_bound.tolerance)
            if (auto text = exceeded_bounds(points, *error_bound.tolerance, unit); !text.empty())
                lines.push_back(std::move(text));
        if (const auto from = points.announced_from)
            lines.push_back(fmt::format("{}, predicted from {:.5g} {} on",
                                        stiffness_message(points.last, unit),
                                        in_unit(shown) * *from, symbol(shown)));
    }
    return lines;
}

}  // namespace elastocheck::compare
