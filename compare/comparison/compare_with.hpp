// Comparison with further outputs, such as figures by other definitions, and one run of it.
#pragma once

#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Outputs of a comparison: channels(), characteristics(), those given, sums().
std::vector<Channel> compared_channels(const Model& model, const std::vector<Channel>& also);
// compare() with these outputs after channels() and characteristics().
Comparison compare(const Model& model, const Options& options, const std::vector<Channel>& also);

// Runs one leg with these outputs; `times`: measure LegRun::seconds, else NaN.
LegRun run(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
           const std::vector<BranchSide>& sides, const SolverSettings& solver, bool times);

}  // namespace elastocheck::compare
