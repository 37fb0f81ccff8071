#include "compare/outputs/rates.hpp"

#include <algorithm>
#include <array>

#include "compare/outputs/not_a_number.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::compare {

Equilibrium moved_by(Equilibrium state, std::span<const Increment> motion, double t) {
    for (std::size_t b = 0; b < motion.size(); ++b) {
        const Eigen::Vector3d turn = t * motion[b].dpi;
        state.poses[b].r += t * motion[b].dr;
        if (const double angle = turn.norm(); angle > 0)
            state.poses[b].p = Eigen::AngleAxisd(angle, turn / angle) * state.poses[b].p;
    }
    return state;
}

std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels,
                                  const Branch& branch, const recursive::series::Path& path,
                                  recursive::series::Place place) {
    const Equilibrium state = recursive::series::evaluate(model, branch, path, place);
    const recursive::series::Rates rates = recursive::series::rates(path, place);
    std::vector<Increment> motion;
    double largest = 1e-12;
    for (std::size_t b = 0; b < rates.dr.size(); ++b) {
        motion.push_back({rates.dr[b], rates.omega[b]});
        largest = std::max({largest, rates.dr[b].norm(), rates.omega[b].norm()});
    }
    // y' = (y(-2h) - 8 y(-h) + 8 y(h) - y(2h)) / 12h, the largest motion by h 1e-4 m or rad
    const double h = 1e-4 / largest;
    constexpr std::array offsets{-2., -1., 1., 2.}, weights{1., -8., 8., -1.};
    std::vector<double> result(channels.size(), 0);
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        const auto values = evaluate(model, channels, moved_by(state, motion, offsets[k] * h));
        for (std::size_t c = 0; c < values.size(); ++c)
            result[c] += weights[k] / (12 * h) / in_unit(unit_of(branch.unit)) * values[c];
    }
    for (std::size_t c = 0; c < result.size(); ++c)
        result[c] = channels[c].kinematic() ? finite_or_nan(result[c]) : nan;
    return result;
}

}  // namespace elastocheck::compare
