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

std::optional<double> announced_from(std::span<const Equilibrium> points) {
    std::optional<double> since;
    for (; announced(points); points = points.first(points.size() - 1)) since = points.back().load;
    return since;
}

std::optional<ErrorBound> promised(const recursive::Method& method, double length) {
    constexpr double rounding = 1e-9;
    return std::visit(
        overloaded{[](const recursive::Adaptive& told) -> std::optional<ErrorBound> {
                       return ErrorBound{told.length_tolerance, told.angle_tolerance};
                   },
                   [&](const recursive::Series& told) -> std::optional<ErrorBound> {
                       return ErrorBound{std::max(told.tolerance, rounding * length),
                                         std::max(told.tolerance / length, rounding)};
                   },
                   [](const auto&) -> std::optional<ErrorBound> { return std::nullopt; }},
        method.kind);
}

std::string unkept(std::span<const Equilibrium> points, const ErrorBound& promise,
                   ParameterUnit unit) {
    Accounts error_bounds;
    for (const auto& point : points) add(error_bounds, point, promise);
    return unkept(error_bounds, promise, unit);
}

void add(Accounts& error_bounds, const Equilibrium& point,
         const std::optional<ErrorBound>& promise) {
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
    if (!promise) return;
    const double over =
        std::max(point.bound.length / promise->length, point.bound.angle / promise->angle);
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

std::string unkept(const Accounts& error_bounds, const ErrorBound& promise, ParameterUnit unit) {
    const auto angle = [](double radian) { return in_unit(Unit::deg) * radian; };
    std::string text;
    if (error_bounds.beyond > 0)
        text = fmt::format(
            "promises {:.2g} mm and {:.2g} deg, which {} of {} points do not keep by their own "
            "account: "
            "within {:.2g} mm "
            "and {:.2g} deg at {:.5g} {}",
            1e3 * promise.length, angle(promise.angle), error_bounds.beyond, error_bounds.points,
            1e3 * error_bounds.worst_bound.length, angle(error_bounds.worst_bound.angle),
            in_unit(unit_of(unit)) * error_bounds.worst_load, symbol(unit_of(unit)));
    if (error_bounds.unbounded > 0)
        text +=
            fmt::format("{}of {} of {} points no account can be given: nothing is promised of them",
                        text.empty() ? "" : "; ", error_bounds.unbounded, error_bounds.points);
    return text;
}

std::string outlook(std::span<const Equilibrium> points, ParameterUnit unit) {
    const auto gone = announced(points);
    if (!gone) return {};
    const Unit shown = unit_of(unit);
    return fmt::format("at this rate the stiffness is gone near {:.5g} {}", in_unit(shown) * *gone,
                       symbol(shown));
}

void add(BranchErrorBounds& error_bound, const Equilibrium& point) {
    if (error_bound.ways.empty() || point.load == 0) error_bound.ways.emplace_back();
    add(error_bound.ways.back(), point, error_bound.promise);
}

std::vector<std::string> told(const BranchErrorBounds& error_bound, ParameterUnit unit) {
    const Unit shown = unit_of(unit);
    std::vector<std::string> lines;
    for (const auto& points : error_bound.ways) {
        if (error_bound.promise)
            if (auto text = unkept(points, *error_bound.promise, unit); !text.empty())
                lines.push_back(std::move(text));
        if (const auto from = points.announced_from)
            lines.push_back(fmt::format("{}, announced from {:.5g} {} on",
                                        outlook(points.last, unit), in_unit(shown) * *from,
                                        symbol(shown)));
    }
    return lines;
}

}  // namespace elastocheck::compare
