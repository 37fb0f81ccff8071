// The error of one configuration point by point along a branch.
#pragma once

#include <vector>

#include "compare/trade.hpp"

namespace elastocheck::compare {

// At equal load, from the equilibrium leg, worst over the main channels of each unit.
struct Profile {
    std::vector<double> load;
    std::vector<double> mm, deg;  // NaN where something is not finite
    Outcome outcome = Outcome::converged;
};

// At every step of the configuration, or at the branch's own steps where it chooses its steps itself.
Profile profile(const Model& model, const Branch& branch, const TradePoint& configuration);

}  // namespace elastocheck::compare
