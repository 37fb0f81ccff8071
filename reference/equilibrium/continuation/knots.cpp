#include "reference/equilibrium/continuation/knots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace elastocheck::reference::equilibrium {
namespace {

// A deformation whose movement over the whole stage is below this multiple of `at_knot` is at rest.
constexpr double standing = 1e-3;

struct Ends {
    double lower, upper;
};
Ends ends(const Curve& curve, int piece) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const auto k = static_cast<std::size_t>(piece);
    return {k == 0 ? -never : curve.knots[k - 1], k == curve.knots.size() ? never : curve.knots[k]};
}

// x(s) = x₀ + s (b + s (c + s d)), 0 ≤ s ≤ 1: the cubic with x and h x' at both ends.
struct Cubic {
    double x_0, b, c, d;
    Cubic(const OnCurve& from, const OnCurve& to, double h) : x_0(from.x), b(h * from.rate) {
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

// First s at which sign · x exceeds limit by half of `tolerance`, if it exceeds it by `tolerance`
// anywhere.
std::optional<double> first_past(const Cubic& x, double sign, double limit, double tolerance) {
    const auto past = [&](double s) { return sign * (x(s) - limit); };
    const auto ends = x.extrema();
    for (std::size_t k = 1; k < ends.size(); ++k) {
        double in = ends[k - 1], out = ends[k];
        if (!(past(out) > tolerance)) continue;
        for (int n = 0; n < 60 && in < out; ++n) {
            const double middle = (in + out) / 2;
            (past(middle) > tolerance / 2 ? out : in) = middle;
        }
        return out;
    }
    return std::nullopt;
}

}  // namespace

Pieces pieces_at(const System& system, const Loading& loading, const Eigen::VectorXd& x) {
    Pieces pieces(system.elements.size(), all_by_themselves);
    for (const auto& at : on_curves(system, loading, x, Eigen::VectorXd::Zero(system.equations())))
        pieces[at.element][at.axis] = piece_at(*at.curve, at.x);
    return pieces;
}

int leaves(const OnCurve& at, int piece, double direction, double length) {
    const auto [lower, upper] = ends(*at.curve, piece);
    const double near = at_knot * at.size, onward = direction * at.rate;
    if (!(std::abs(onward) * length > standing * near)) return 0;
    if (onward > 0 && at.x >= upper - near) return +1;
    if (onward < 0 && at.x <= lower + near) return -1;
    return 0;
}

std::optional<double> first_exit(const std::vector<OnCurve>& from, const std::vector<OnCurve>& to,
                                 double h, const Pieces& pieces) {
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
