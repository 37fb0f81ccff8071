#include "compare/outputs/rates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/outputs/positions.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
using recursive::series::Path;
using recursive::series::Place;
using recursive::series::Rates;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Rate of a vector fixed to the body with components u in ground axes.
Vector3d turn(const Rates& rates, BodyId body, const Vector3d& u) {
    return body == ground ? Vector3d::Zero()
                          : Vector3d(rates.omega[static_cast<std::size_t>(body)].cross(u));
}
Vector3d velocity(const Equilibrium& state, const Rates& rates, const Point& point) {
    if (point.body == ground) return Vector3d::Zero();
    const auto b = static_cast<std::size_t>(point.body);
    return rates.dr[b] + turn(rates, point.body, state.poses[b].p * point.s_local);
}

struct Spin {
    Vector3d e, de;
    double side;
};
Spin spin(const Model& model, const Equilibrium& state, const Rates& rates, std::size_t w) {
    const Wheel& wheel = model.wheels[w];
    const Vector3d e = state.poses[static_cast<std::size_t>(wheel.body)].p * wheel.spin_axis_local;
    return {e, turn(rates, wheel.body, e), static_cast<double>(wheel.side)};
}

// Rate of the angle of e to the x axis in top view.
double heading_rate(const Vector3d& e, const Vector3d& de) {
    return (e.x() * de.y() - e.y() * de.x()) / (e.x() * e.x() + e.y() * e.y());
}

double rate(const Model& model, const Equilibrium& state, const Rates& rates, const Steering& c) {
    if (std::isinf(evaluate(model, {{Channel{.name = {}, .reads = c}}}, state).front())) return nan;
    const Wheel& wheel = model.wheels[c.wheel];
    const Point patch{wheel.body, wheel.contact_local};
    const auto [lower, upper] = *wheel.steering_axis;
    const auto at = [&](const Point& p) { return position(state.poses, p); };
    const Vector3d l = at(lower), dl = velocity(state, rates, lower), u = at(upper) - l,
                   du = velocity(state, rates, upper) - dl, p = at(patch),
                   dp = velocity(state, rates, patch);
    const auto leaning = [&](double x, double dx) {  // atan(-x / u_z)
        return (x * du.z() - dx * u.z()) / (x * x + u.z() * u.z());
    };
    const double s = (p.z() - l.z()) / u.z(), ds = (dp.z() - dl.z() - s * du.z()) / u.z();
    const Vector3d off = l + s * u - p, doff = dl + ds * u + s * du - dp;
    const auto [e, de, side] = spin(model, state, rates, c.wheel);
    const Vector3d n = Vector3d(e.x(), e.y(), 0).normalized(),
                   h = side * n.cross(Vector3d::UnitZ());
    const Vector3d turn = heading_rate(e, de) * Vector3d::UnitZ();
    switch (c.figure) {
        case Steering::Figure::caster: return leaning(u.x(), du.x());
        case Steering::Figure::kingpin_inclination: return leaning(side * u.y(), side * du.y());
        case Steering::Figure::scrub_radius: return -n.dot(doff) - turn.cross(n).dot(off);
        case Steering::Figure::mechanical_trail: return h.dot(doff) + turn.cross(h).dot(off);
    }
    return nan;
}

double rate(const Model& model, const Equilibrium& state, const Rates& rates, const Ackermann& c) {
    if (std::isinf(evaluate(model, {{Channel{.name = {}, .reads = c}}}, state).front())) return nan;
    // d cot δ = -dδ / sin² δ, e = side (-sin δ, cos δ) in the plane
    const auto cot = [&](std::size_t w) {
        const auto [e, de, side] = spin(model, state, rates, w);
        const double sine = e.x() / std::hypot(e.x(), e.y());
        return -heading_rate(e, de) / (sine * sine);
    };
    return (cot(c.right) - cot(c.left)) * c.wheelbase_by_pivots;
}

double rate(const Model& model, const Channel& channel, const Equilibrium& state,
            const Rates& rates) {
    const auto unknown = [](const auto&) { return nan; };
    return std::visit(
               overloaded{
                   [&](const Coordinate& c) {
                       return c.sign * velocity(state, rates, c.at)[c.axis];
                   },
                   [&](const Toe& c) {
                       const auto [e, de, side] = spin(model, state, rates, c.wheel);
                       return -side * heading_rate(e, de);
                   },
                   [&](const Steering& c) { return rate(model, state, rates, c); },
                   [&](const Track& c) {
                       const auto dy = [&](std::size_t w) {
                           const Wheel& wheel = model.wheels[w];
                           return velocity(state, rates, {wheel.body, wheel.contact_local}).y();
                       };
                       return dy(c.left) - dy(c.right);
                   },
                   [&](const Ackermann& c) { return rate(model, state, rates, c); },
                   [&](const Compression& c) {
                       const Vector3d d = position(state.poses, c.j) - position(state.poses, c.i);
                       return -d.normalized().dot(velocity(state, rates, c.j) -
                                                  velocity(state, rates, c.i));
                   },
                   [&](const Camber& c) {
                       const auto [e, de, side] = spin(model, state, rates, c.wheel);
                       return -de.z() / std::sqrt(1 - e.z() * e.z());
                   },
                   [&](const Effort& c) { return unknown(c); },
                   [&](const Reaction& c) { return unknown(c); },
                   [&](const Total& c) { return unknown(c); },
                   [&](const OfElement& c) { return unknown(c); },
                   [&](const AxialForce& c) { return unknown(c); },
                   [&](const Characteristic& c) { return unknown(c); }},
               channel.reads) *
           in_unit(channel.unit);
}

}  // namespace

std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels,
                                  const Branch& branch, const Path& path, Place place) {
    const Equilibrium state = recursive::series::evaluate(model, branch, path, place);
    const Rates rates = recursive::series::rates(path, place);
    std::vector<double> result;
    for (const auto& channel : channels)
        result.push_back(rate(model, channel, state, rates) / in_unit(unit_of(branch.unit)));
    return result;
}

std::optional<Place> place_at(const Model& model, const Channel& channel, const Branch& branch,
                              const Path& path, double value) {
    using namespace recursive::series;
    if (path.expansions.empty() || !channel.kinematic()) return std::nullopt;
    const auto value_at = [&](Place place) {
        return compare::evaluate(model, {&channel, 1}, evaluate(model, branch, path, place))
            .front();
    };
    const Expansion& last = path.expansions.back();
    const Place end{path.expansions.size() - 1, last.reach};
    double from = evaluate(model, branch, path, {0, 0}).load,
           to = evaluate(model, branch, path, end).load;
    const double first = value_at({0, 0}), final = value_at(end);
    if (!(std::min(first, final) <= value && value <= std::max(first, final))) return std::nullopt;
    double a = from + (to - from) * (final == first ? 0 : (value - first) / (final - first));
    for (int k = 0; k < 100; ++k) {
        const Place here = *find(path, a);
        const double miss = value_at(here) - value;
        ((miss < 0) == (final > first) ? from : to) = a;
        const double slope =
            rate(model, channel, evaluate(model, branch, path, here), rates(path, here));
        double next = a - miss / slope;
        // bisect where Newton leaves
        if (!((next - from) * (next - to) <= 0)) next = from + (to - from) / 2;
        if (next == a || std::abs(next - a) <= 1e-15 * std::abs(branch.to)) break;
        a = next;
    }
    return find(path, a);
}

}  // namespace elastocheck::compare
