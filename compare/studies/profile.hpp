// The error of one configuration point by point along a branch.
#pragma once

#include "compare/studies/solves.hpp"
#include "compare/studies/work_precision.hpp"

namespace elastocheck::compare {

struct ConfigurationProfile {
    Profile profile;  // at equal parameter, from the equilibrium leg
    Outcome outcome = Outcome::converged;
};

// At every step of the configuration, or at the branch's own steps for an adaptive method.
ConfigurationProfile profile(const Model& model, const Branch& branch,
                             const TradePoint& configuration);
// The same from shared solves, at their finest points or at every step if that is coarser.
ConfigurationProfile profile(Solves& solves, std::size_t branch, const TradePoint& configuration);

}  // namespace elastocheck::compare
