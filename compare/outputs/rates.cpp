#include "compare/outputs/rates.hpp"

#include <algorithm>
#include <cmath>

#include "recursive/series/path.hpp"

namespace elastocheck::compare {
namespace {

using recursive::series::Path;
using recursive::series::Place;

// First-order motion of the bodies per unit of the parameter.
std::vector<Increment> motion_along(const Path& path, Place place) {
    const recursive::series::Rates rates = recursive::series::rates(path, place);
    std::vector<Increment> motion;
    for (std::size_t b = 0; b < rates.dr.size(); ++b)
        motion.push_back({rates.dr[b], rates.omega[b]});
    return motion;
}

}  // namespace

std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels,
                                  const Branch& branch, const Path& path, Place place) {
    const Equilibrium state = recursive::series::evaluate(model, branch, path, place);
    const auto motion = motion_along(path, place);
    std::vector<double> result;
    for (const auto& channel : channels)
        result.push_back(rate_of(model, channel.reads, state, motion) * in_unit(channel.unit) /
                         in_unit(unit_of(branch.unit)));
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
        const double slope = in_unit(channel.unit) * rate_of(model, channel.reads,
                                                             evaluate(model, branch, path, here),
                                                             motion_along(path, here));
        double next = a - miss / slope;
        // bisect where Newton leaves
        if (!((next - from) * (next - to) <= 0)) next = from + (to - from) / 2;
        if (next == a || std::abs(next - a) <= 1e-15 * std::abs(branch.to)) break;
        a = next;
    }
    return find(path, a);
}

}  // namespace elastocheck::compare
