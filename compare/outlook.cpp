#include "compare/outlook.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compare/channels.hpp"

namespace elastocheck::compare {
namespace {

// Of a quantity at three places: where the line through the last two is zero, and how far the first is off it, as a share.
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

std::string outlook(std::span<const Equilibrium> points, ParameterUnit unit) {
    const auto gone = stiffness_gone_near(points);
    if (!gone || !(std::abs(*gone - points.back().load) <= std::abs(points.back().load))) return {};
    const Unit shown = unit_of(unit);
    return fmt::format("at this rate the stiffness is gone near {:.5g} {}", in_unit(shown) * *gone,
                       symbol(shown));
}

}  // namespace elastocheck::compare
