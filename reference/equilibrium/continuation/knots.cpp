#include "reference/equilibrium/continuation/knots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace elastocheck::reference::equilibrium {
namespace {

// A deformation whose movement over the whole stage is below this multiple of `at_knot` is at rest.
constexpr double min_movement = 1e-3;

struct Ends {
    double lower, upper;
};
Ends ends(const Curve& curve, int piece) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    const auto k = static_cast<std::size_t>(piece);
    return {k == 0 ? -unbounded : curve.knots[k - 1],
            k == curve.knots.size() ? unbounded : curve.knots[k]};
}

// x(s) = x₀ + s (b + s (c + s d)), 0 ≤ s ≤ 1: the cubic with x and h x' at both ends.
struct Cubic {
    double x_0, b, c, d;
    Cubic(const CurveDeformation& from, const CurveDeformation& to, double h)
        : x_0(from.x), b(h * from.rate) {
        const double chord = to.x - from.x, b_1 = h * to.rate;
        c = 3 * chord - 2 * b - b_1;
        d = b + b_1 - 2 * chord;
    }
    double operator()(double s) const { return x_0 + s * (b + s * (c + s * d)); }
    // 0, 1, and the extrema of x in between.
    std::array<double, 4> extrema() const {
        std::array<double, 4> s = {0, 0, 0, 1};
        const double root = std::sqrt(c * c - 3 * b * d), q = -(c + std::copysign(root, c));
        const auto within = [](double at) { return at > 0 && at < 1 ? at : 0; };  // false for NaN
        s[1] = within(q / (3 * d));
        s[2] = within(b / q);
        std::ranges::sort(s);
        return s;
    }
};

// First s at which x is past `limit` in the direction `sign` by half of `tolerance`, if it is past it
// by `tolerance` at an end or an extremum. Bisection, until no number lies between the bounds.
std::optional<double> first_past(const Cubic& x, double sign, double limit, double tolerance) {
    const auto excess = [&](double s) { return sign * (x(s) - limit); };
    const auto ends = x.extrema();
    for (std::size_t k = 1; k < ends.size(); ++k) {
        double inside = ends[k - 1], outside = ends[k];
        if (!(excess(outside) > tolerance)) continue;
        for (int n = 0; n < 60 && inside < outside; ++n) {
            const double middle = (inside + outside) / 2;
            (excess(middle) > tolerance / 2 ? outside : inside) = middle;
        }
        return outside;
    }
    return std::nullopt;
}

}  // namespace

Pieces pieces_at(const System& system, const Loading& loading, const Eigen::VectorXd& x) {
    Pieces pieces(system.elements.size(), all_by_themselves);
    for (const auto& component :
         curve_deformations(system, loading, x, Eigen::VectorXd::Zero(system.equations())))
        pieces[component.element][component.axis] = piece_at(*component.curve, component.x);
    return pieces;
}

int exit_side(const CurveDeformation& component, int piece, double direction, double length) {
    const auto [lower, upper] = ends(*component.curve, piece);
    const double near = at_knot * component.size, rate = direction * component.rate;
    if (!(std::abs(rate) * length > min_movement * near)) return 0;
    if (rate > 0 && component.x >= upper - near) return +1;
    if (rate < 0 && component.x <= lower + near) return -1;
    return 0;
}

std::optional<double> first_exit(const std::vector<CurveDeformation>& from,
                                 const std::vector<CurveDeformation>& to, double h,
                                 const Pieces& pieces) {
    std::optional<double> first;
    for (std::size_t n = 0; n < from.size(); ++n) {
        const auto [lower, upper] = ends(*from[n].curve, pieces[from[n].element][from[n].axis]);
        const Cubic x(from[n], to[n], h);
        const double tolerance = at_knot * from[n].size;
        for (const auto& s :
             {first_past(x, +1, upper, tolerance), first_past(x, -1, lower, tolerance)})
            if (s && (!first || *s < *first)) first = s;
    }
    return first;
}

}  // namespace elastocheck::reference::equilibrium
