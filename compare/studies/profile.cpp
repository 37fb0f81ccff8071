#include "compare/studies/profile.hpp"

#include <algorithm>

namespace elastocheck::compare {

ConfigurationProfile profile(const Model& model, const Branch& branch,
                             const TradePoint& configuration) {
    const int points = configuration.steps > 0 ? configuration.steps : branch.steps;
    const auto ways = sides_of(model, branch, points);
    const auto all = channels(model);
    const auto truth = walk(ways, {.leg = Leg::equilibrium}),
               path = walk(ways, gait_of(configuration, points));
    return {profile_at_equal_parameter(all, curve(model, all, branch, truth.points),
                                       curve(model, all, branch, path.points)),
            path.outcome};
}

ConfigurationProfile profile(Solves& solves, std::size_t branch, const TradePoint& configuration) {
    const int steps = configuration.steps / solves.base,
              points = steps > 0 ? std::min(steps, solves.finest) : solves.finest;
    const References known = references_on_branch(solves, branch, points);
    const PathCurve path = run(solves, branch, configuration, points);
    return {profile_at_equal_parameter(solves.channels, known.truth, path.curve), path.outcome};
}

}  // namespace elastocheck::compare
