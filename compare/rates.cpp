#include "compare/rates.hpp"

#include <cmath>
#include <numbers>

#include "compare/channels.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
using recursive::series::Path;
using recursive::series::Place;
using recursive::series::Rates;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double millimetres = 1e3;

Vector3d turn(const Rates& rates, BodyId body, const Vector3d& u) {
    return body == ground ? Vector3d::Zero() : Vector3d(rates.omega[static_cast<std::size_t>(body)].cross(u));
}
Vector3d velocity(const Equilibrium& state, const Rates& rates, const Point& point) {
    if (point.body == ground) return Vector3d::Zero();
    const auto b = static_cast<std::size_t>(point.body);
    return rates.dr[b] + turn(rates, point.body, state.poses[b].p * point.s_local);
}

}  // namespace

ChannelRates channel_rates(const Model& model, const Branch& branch, const Path& path, Place place) {
    const Equilibrium state = recursive::series::evaluate(model, path, place);
    const Rates rates = recursive::series::rates(path, place);
    ChannelRates result;
    const auto add = [&](const Vector3d& v) {
        for (int c = 0; c < 3; ++c) result.slope.push_back(millimetres * v[c]);
    };
    std::optional<Vector3d> leading;
    if (model.wheel) {
        const Wheel& wheel = *model.wheel;
        leading = velocity(state, rates, {wheel.body, wheel.centre_local});
        add(*leading);
        const Vector3d e = state.poses[static_cast<std::size_t>(wheel.body)].p * wheel.spin_axis_local,
                       de = turn(rates, wheel.body, e);
        result.slope.push_back(degrees * wheel.side * (e.y() * de.x() - e.x() * de.y()) /
                               (e.x() * e.x() + e.y() * e.y()));
        result.slope.push_back(degrees * -de.z() / std::sqrt(1 - e.z() * e.z()));
    }
    for (const auto& probe : model.probes) {
        const Vector3d v = velocity(state, rates, probe.at);
        if (!leading) leading = v;
        add(v);
    }
    if (const auto direction = travel_direction(branch); direction && leading)
        result.travel = millimetres * direction->dot(*leading);
    return result;
}

std::optional<Place> place_at_travel(const Model& model, const Branch& branch, const Path& path,
                                     double travel) {
    using namespace recursive::series;
    if (path.expansions.empty() || !travel_direction(branch)) return std::nullopt;
    const Equilibrium start = evaluate(model, path, {0, 0});
    const auto travel_at = [&](double load) {
        return curve(model, branch, {start, evaluate(model, path, *find(path, load))}).travel.back();
    };
    const Expansion& last = path.expansions.back();
    double from = start.load, to = evaluate(model, path, {path.expansions.size() - 1, last.reach}).load;
    const double first = 0, final = travel_at(to);
    if (!(std::min(first, final) <= travel && travel <= std::max(first, final))) return std::nullopt;
    double load = from + (to - from) * (final == 0 ? 0 : travel / final);
    for (int k = 0; k < 100; ++k) {
        const double miss = travel_at(load) - travel;
        ((miss < 0) == (final > 0) ? from : to) = load;
        const double slope = channel_rates(model, branch, path, *find(path, load)).travel;
        double next = load - miss / slope;
        if (!((next - from) * (next - to) <= 0)) next = from + (to - from) / 2;  // bisect where Newton leaves
        if (next == load || std::abs(next - load) <= 1e-15 * std::abs(branch.to)) break;
        load = next;
    }
    return find(path, load);
}

}  // namespace elastocheck::compare
