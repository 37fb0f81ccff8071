// Runs one leg along a branch, with curve, residuals and proofs, and lists the disagreements
// of the references.
#pragma once

#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/deviation/tolerance.hpp"
#include "compare/outputs/curve.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Runs one leg. The recursion uses `recursion` (default: the published method) and records every
// step (0 steps: the branch's own number). The references visit the parameters of those steps. The
// curve has channels(model).
LegRun run(const Model& model, const Branch& branch, Leg leg,
           const recursive::Options& recursion = {});

// Whether the energy leg judges the states of the equilibrium leg although the scene is too large
// for states of its own.
bool energy_judges_states(const BranchComparison& branch);

// Reasons why the references do not agree on a branch whose runs and readings are complete;
// `requested` is the branch of the model. all_legs: a failed recursion is an objection too, since
// it prevents a verdict on the recursion; references: it is not, since it does not affect a verdict
// on a candidate.
enum class Of { all_legs, references };
Objections disagreements(const Model& model, const std::vector<Channel>& channels,
                         const Branch& requested, const BranchComparison& branch,
                         Of of = Of::all_legs);

}  // namespace elastocheck::compare
