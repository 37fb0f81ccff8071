#include "compare/outputs/rates.hpp"

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

}  // namespace elastocheck::compare
