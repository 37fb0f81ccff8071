#include "compare/rates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
using recursive::series::Path;
using recursive::series::Place;
using recursive::series::Rates;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Velocity of a vector of the body that has the components u in ground axes.
Vector3d turn(const Rates& rates, BodyId body, const Vector3d& u) {
    return body == ground ? Vector3d::Zero() : Vector3d(rates.omega[static_cast<std::size_t>(body)].cross(u));
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

double rate(const Model& model, const Channel& channel, const Equilibrium& state, const Rates& rates) {
    const auto unknown = [](const auto&) { return nan; };
    return std::visit(overloaded{[&](const Coordinate& c) { return velocity(state, rates, c.at)[c.axis]; },
                                 [&](const Toe& c) {
                                     const auto [e, de, side] = spin(model, state, rates, c.wheel);
                                     return side * (e.y() * de.x() - e.x() * de.y()) /
                                            (e.x() * e.x() + e.y() * e.y());
                                 },
                                 [&](const Camber& c) {
                                     const auto [e, de, side] = spin(model, state, rates, c.wheel);
                                     return -de.z() / std::sqrt(1 - e.z() * e.z());
                                 },
                                 [&](const Effort& c) { return unknown(c); },
                                 [&](const Reaction& c) { return unknown(c); },
                                 [&](const Total& c) { return unknown(c); },
                                 [&](const Characteristic& c) { return unknown(c); }},
                      channel.reads) *
           in_unit(channel.unit);
}

}  // namespace

std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels, const Branch& branch,
                                  const Path& path, Place place) {
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
        return compare::evaluate(model, {&channel, 1}, evaluate(model, branch, path, place)).front();
    };
    const Expansion& last = path.expansions.back();
    const Place end{path.expansions.size() - 1, last.reach};
    double from = evaluate(model, branch, path, {0, 0}).load, to = evaluate(model, branch, path, end).load;
    const double first = value_at({0, 0}), final = value_at(end);
    if (!(std::min(first, final) <= value && value <= std::max(first, final))) return std::nullopt;
    double a = from + (to - from) * (final == first ? 0 : (value - first) / (final - first));
    for (int k = 0; k < 100; ++k) {
        const Place here = *find(path, a);
        const double miss = value_at(here) - value;
        ((miss < 0) == (final > first) ? from : to) = a;
        const double slope = rate(model, channel, evaluate(model, branch, path, here), rates(path, here));
        double next = a - miss / slope;
        if (!((next - from) * (next - to) <= 0)) next = from + (to - from) / 2;  // bisect where Newton leaves
        if (next == a || std::abs(next - a) <= 1e-15 * std::abs(branch.to)) break;
        a = next;
    }
    return find(path, a);
}

}  // namespace elastocheck::compare
