#include "compare/studies/profile.hpp"

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

}  // namespace elastocheck::compare
