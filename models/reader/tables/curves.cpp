#include "models/reader/tables/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "models/kinds.hpp"
#include "models/laws.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::reader {
namespace {

constexpr double round_off = 1e-12;  // relative, of forces that should be equal

// With `outside: unknown` a branch ends at the end knots. The side of a law without force has no end:
// its end knot lies beyond any motion [m].
constexpr double beyond_motion = 1e6;

// The points with x ≥ 0, preceded by their mirror images -f(-x).
std::vector<TablePoint> with_mirror_image(const Cursor& field,
                                          const std::vector<TablePoint>& half) {
    if (half.front().x != 0 || half.front().f != 0)
        field.fail(
            "the table of a symmetric curve must begin with [0, 0]; the other half is generated");
    std::vector<TablePoint> points;
    for (std::size_t k = half.size() - 1; k > 0; --k) points.push_back({-half[k].x, -half[k].f});
    points.insert(points.end(), half.begin(), half.end());
    return points;
}

void scale(const Cursor& field, std::vector<TablePoint>& points) {
    const double factor = above_zero(field, "not a scale");
    for (TablePoint& point : points) point.f *= factor;
}

void shift(const Cursor& field, const Unit& unit, std::vector<TablePoint>& points) {
    const double offset = unit.si(field.number(unit.name));
    for (std::size_t k = 0; k < points.size(); ++k) {
        points[k].x += offset;
        if (k > 0 && !(points[k].x > points[k - 1].x))
            field.fail(
                fmt::format("{} is so large that rows of the table coincide", field.found()));
    }
}

Curve interpolated(const Cursor& curve, const std::vector<TablePoint>& points) {
    const auto between = curve.optional("interpolation");
    const bool is_linear =
        between && between->one_of("a kind of interpolation", {"monotone", "linear"}) == 1;
    return is_linear ? piecewise_linear(points) : interpolant(points);
}

bool is_known_outside(const Cursor& curve) {
    const auto outside = curve.optional("outside");
    return !outside || outside->one_of("a kind of extrapolation", {"linear", "unknown"}) == 0;
}

// The fields `rate` and `curve`, of which one must be given.
std::pair<std::optional<Cursor>, std::optional<Cursor>> rate_or_curve(const Cursor& element) {
    const auto rate = element.optional("rate"), curve = element.optional("curve");
    if (rate && curve) curve->fail("given together with rate; allowed: one of the two");
    if (!rate && !curve) element.fail("no law; required: rate or curve");
    return {rate, curve};
}

// Force of a stop over the penetration s: zero up to s = 0.
Curve read_contact(const Cursor& field, const Definitions& defs) {
    field.only_keys({"table", "file", "scale", "interpolation", "outside"});
    auto points = read_table(field, of_lengths(defs.units), defs);
    if (points.front().x != 0 || points.front().f != 0)
        field.fail("the table of a stop must begin with [0, 0], where it closes");
    if (const auto factor = field.optional("scale")) scale(*factor, points);
    Curve contact = interpolated(field, points);
    contact.pieces.front() = {};
    contact.known_outside = is_known_outside(field);
    if (!contact.known_outside) {
        contact.knots.insert(contact.knots.begin(), -beyond_motion);
        contact.pieces.insert(contact.pieces.begin(), std::array<double, 4>{});
    }
    return contact;
}

}  // namespace

Curve read_curve(const Cursor& field, const LawUnits& units, const Definitions& defs) {
    field.only_keys({"table", "file", "scale", "offset", "symmetric", "interpolation", "outside"});
    auto points = read_table(field, units, defs);
    if (const auto symmetric = field.optional("symmetric"); symmetric && symmetric->yes_or_no())
        points = with_mirror_image(*symmetric, points);
    if (const auto factor = field.optional("scale")) scale(*factor, points);
    if (const auto offset = field.optional("offset")) shift(*offset, units.deflection, points);
    Curve curve = interpolated(field, points);
    curve.known_outside = is_known_outside(field);
    return curve;
}

ScalarLaw read_law(const Cursor& element, const LawUnits& units, const Definitions& defs) {
    const auto [k, curve] = rate_or_curve(element);
    if (k) return LinearRate{rate(*k, units.rate)};
    return read_curve(*curve, units, defs);
}

Curve read_stop(const Cursor& field, Stop stop, const Definitions& defs) {
    field.only_keys({"clearance", "rate", "curve"});
    const Unit& length = defs.units.length;
    const double clearance = length.si(field.require("clearance").number(length.name));
    const auto [k, curve] = rate_or_curve(field);
    Curve law =
        k ? Curve{{0}, {{}, {0, rate(*k, defs.units.rate), 0, 0}}} : read_contact(*curve, defs);
    for (double& knot : law.knots) knot += clearance;
    for (std::size_t n = 1; n < law.knots.size(); ++n)
        if (!(law.knots[n] > law.knots[n - 1]))
            field.require("clearance")
                .fail(fmt::format("{} is so large that rows of the curve coincide",
                                  field.require("clearance").found()));
    return stop == Stop::rebound ? law : reversed(law);
}

namespace {

// The deflection at which a non-decreasing curve has the force: outside the knots by its linear
// extrapolation, between them by bisection to the last bit.
double deflection_at(const Cursor& field, const Curve& curve, double force, const Unit& unit) {
    const auto& x = curve.knots;
    const auto at_knot = [&](std::size_t k) { return curve.pieces[k + 1][0]; };
    const std::size_t last = x.size() - 1;
    const double below = curve.pieces.front()[1], above = curve.pieces.back()[1];  // slopes
    const double largest = std::max(std::abs(at_knot(0)), std::abs(at_knot(last)));
    const auto is_equal = [&](std::size_t k) {
        return std::abs(at_knot(k) - force) <= round_off * largest;
    };
    const auto fail_ambiguous = [&] {
        field.fail(fmt::format(
            "the curve has {:g} {} at more than one deflection; give free_length instead",
            unit.written(force), unit.name));
    };
    const bool extrapolates = curve.known_outside;
    if (extrapolates && ((below == 0 && is_equal(0)) || (above == 0 && is_equal(last))))
        fail_ambiguous();
    for (std::size_t k = 0; k < last; ++k)
        if (is_equal(k) && is_equal(k + 1)) fail_ambiguous();

    const bool is_below = at_knot(0) > force, is_above = force > at_knot(last);
    if ((is_below && (!extrapolates || below == 0)) || (is_above && (!extrapolates || above == 0)))
        field.fail(fmt::format("the curve never has {:g} {}; its table goes from {:g} to {:g}",
                               unit.written(force), unit.name, unit.written(at_knot(0)),
                               unit.written(at_knot(last))));
    if (is_below) return x[0] + (force - at_knot(0)) / below;
    if (is_above) return x[last] + (force - at_knot(last)) / above;
    std::size_t k = 0;
    while (k + 1 < last && at_knot(k + 1) < force) ++k;
    const auto& c = curve.pieces[k + 1];
    const auto f = [&](double t) -> double { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
    double low = 0, high = x[k + 1] - x[k];
    for (;;) {
        const double t = low + (high - low) / 2;
        if (!(t > low && t < high)) return x[k] + high;
        (f(t) < force ? low : high) = t;
    }
}

}  // namespace

double deflection_at(const Cursor& field, const ScalarLaw& law, double force, const Unit& unit) {
    const auto of_rate = [&](const LinearRate& u) {
        if (u.k == 0)
            field.fail("a spring of rate zero cannot have a preload; remove it or give a rate");
        return force / u.k;
    };
    return std::visit(
        overloaded{of_rate, [&](const Curve& u) { return deflection_at(field, u, force, unit); }},
        law);
}

ScalarLaw pushing_only(const Cursor& field, const ScalarLaw& law, const Unit& unit) {
    if (is_zero(law)) return law;
    if (const double* k = rate_of(law)) return Curve{{0}, {{0, *k, 0, 0}, {}}};
    Curve curve = *curve_of(law);
    std::size_t n = 0;  // number of knots at which it pushes
    while (n < curve.knots.size() && curve.pieces[n + 1][0] < 0) ++n;
    const bool always_pushes = n == curve.knots.size();
    if (always_pushes && (!curve.known_outside || curve.pieces.back()[1] == 0)) return law;
    const bool zero_at_knot = !always_pushes && curve.pieces[n + 1][0] == 0;
    const double release = zero_at_knot ? curve.knots[n] : deflection_at(field, law, 0, unit);
    if (n == 0) curve.pieces[0][0] = 0;  // the linear first piece, now about `release`
    curve.knots.resize(n);
    curve.pieces.resize(n + 1);
    curve.knots.push_back(release);
    curve.pieces.emplace_back();
    if (!curve.known_outside) {
        curve.knots.push_back(release + beyond_motion);
        curve.pieces.emplace_back();
    }
    return curve;
}

}  // namespace elastocheck::reader
