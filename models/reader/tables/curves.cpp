#include "models/reader/tables/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/kinds.hpp"
#include "models/laws.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::reader {
namespace {

constexpr double round_off = 1e-12;  // relative, of forces that should be equal

// Where there is no force the law is known: its last knot there lies beyond any motion [m].
constexpr double beyond_all = 1e6;

// The points with x ≥ 0, preceded by their mirror images -f(-x).
std::vector<TablePoint> odd(const Cursor& field, const std::vector<TablePoint>& half) {
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

Curve through(const Cursor& curve, const std::vector<TablePoint>& points) {
    const auto between = curve.optional("interpolation");
    const bool is_linear =
        between && between->one_of("a kind of interpolation", {"monotone", "linear"}) == 1;
    return is_linear ? polygon(points) : interpolant(points);
}

bool is_known_outside(const Cursor& curve) {
    const auto outside = curve.optional("outside");
    return !outside || outside->one_of("a kind of extrapolation", {"linear", "unknown"}) == 0;
}

// Force over the penetration s: zero up to s = 0.
Curve read_contact(const Cursor& field, const Definitions& defs) {
    field.only_keys({"table", "file", "scale", "interpolation", "outside"});
    auto points = read_table(field, of_lengths(defs.units), defs);
    if (points.front().x != 0 || points.front().f != 0)
        field.fail("the table of a stop must begin with [0, 0], where it closes");
    if (const auto factor = field.optional("scale")) scale(*factor, points);
    Curve contact = through(field, points);
    contact.pieces.front() = {};
    contact.known_outside = is_known_outside(field);
    if (!contact.known_outside) {
        contact.knots.insert(contact.knots.begin(), -beyond_all);
        contact.pieces.insert(contact.pieces.begin(), std::array<double, 4>{});
    }
    return contact;
}

}  // namespace

Curve read_curve(const Cursor& field, const LawUnits& units, const Definitions& defs) {
    field.only_keys({"table", "file", "scale", "offset", "symmetric", "interpolation", "outside"});
    auto points = read_table(field, units, defs);
    if (const auto symmetric = field.optional("symmetric"); symmetric && symmetric->yes_or_no())
        points = odd(*symmetric, points);
    if (const auto factor = field.optional("scale")) scale(*factor, points);
    if (const auto offset = field.optional("offset")) shift(*offset, units.deflection, points);
    Curve curve = through(field, points);
    curve.known_outside = is_known_outside(field);
    return curve;
}

ScalarLaw read_law(const Cursor& element, const LawUnits& units, const Definitions& defs) {
    const auto k = element.optional("rate"), curve = element.optional("curve");
    if (k && curve) curve->fail("given together with rate; allowed: one of the two");
    if (!k && !curve) element.fail("no law; required: rate or curve");
    if (k) return LinearRate{rate(*k, units.rate)};
    return read_curve(*curve, units, defs);
}

Curve read_stop(const Cursor& field, Stop stop, const Definitions& defs) {
    field.only_keys({"clearance", "rate", "curve"});
    const Unit& length = defs.units.length;
    const double clearance = length.si(field.require("clearance").number(length.name));
    const auto k = field.optional("rate"), curve = field.optional("curve");
    if (k && curve) curve->fail("given together with rate; allowed: one of the two");
    if (!k && !curve) field.fail("no law; required: rate or curve");
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

// f is non-decreasing. Outside the knots it is linear; inside the interval that brackets the force,
// bisection runs to the last bit.
double deflection_at(const Cursor& field, const Curve& curve, double force, const Unit& unit) {
    const auto& x = curve.knots;
    const auto at_knot = [&](std::size_t k) { return curve.pieces[k + 1][0]; };
    const std::size_t last = x.size() - 1;
    const double below = curve.pieces.front()[1], above = curve.pieces.back()[1];  // slopes
    const double largest = std::max(std::abs(at_knot(0)), std::abs(at_knot(last)));
    const auto is_equal = [&](std::size_t k) {
        return std::abs(at_knot(k) - force) <= round_off * largest;
    };
    const auto many = [&] {
        field.fail(fmt::format(
            "the curve has {:g} {} at more than one deflection; give free_length instead",
            unit.written(force), unit.name));
    };
    const bool goes_on = curve.known_outside;
    if (goes_on && ((below == 0 && is_equal(0)) || (above == 0 && is_equal(last)))) many();
    for (std::size_t k = 0; k < last; ++k)
        if (is_equal(k) && is_equal(k + 1)) many();

    const bool is_below = force<at_knot(0), is_above = force> at_knot(last);
    if ((is_below && (!goes_on || below == 0)) || (is_above && (!goes_on || above == 0)))
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
    std::size_t n = 0;  // knots where it pushes
    while (n < curve.knots.size() && curve.pieces[n + 1][0] < 0) ++n;
    const bool always = n == curve.knots.size();
    if (always && (!curve.known_outside || curve.pieces.back()[1] == 0)) return law;
    const bool at_knot = !always && curve.pieces[n + 1][0] == 0;
    const double leaves = at_knot ? curve.knots[n] : deflection_at(field, law, 0, unit);
    if (n == 0) curve.pieces[0][0] = 0;  // about the new first knot, straight
    curve.knots.resize(n);
    curve.pieces.resize(n + 1);
    curve.knots.push_back(leaves);
    curve.pieces.emplace_back();
    if (!curve.known_outside) {
        curve.knots.push_back(leaves + beyond_all);
        curve.pieces.emplace_back();
    }
    return curve;
}

}  // namespace elastocheck::reader
