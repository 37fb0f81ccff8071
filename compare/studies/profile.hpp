// The error of one configuration point by point along a branch.
#pragma once

#include "compare/studies/work_precision.hpp"

namespace elastocheck::compare {

struct ConfigurationProfile {
    Profile profile;  // at equal parameter, from the equilibrium leg
    Outcome outcome = Outcome::converged;
};

// At every step of the configuration, or at the branch's own steps for an adaptive method.
ConfigurationProfile profile(const Model& model, const Branch& branch,
                             const TradePoint& configuration);

}  // namespace elastocheck::compare
