// Runs one leg along a branch, with curve, residuals and proofs; compares all legs, with further outputs
// such as figures by other definitions; lists the disagreements of the references.
#pragma once

#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/deviation/tolerance.hpp"
#include "compare/outputs/curve.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::recursive {
struct Diagnosis;  // recursive/diagnosis/diagnosis.hpp
}

namespace elastocheck::compare {

// Runs one leg. The recursion uses `recursion` (default: the published method) and records every
// step (recursion.steps = 0: as many as the branch states). The references are solved at the
// parameters of those steps. The curve has channels(model).
LegRun run(const Model& model, const Branch& branch, Leg leg,
           const recursive::Options& recursion = {});
// The same with these channels; `times`: measure LegRun::seconds, else NaN.
LegRun run(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
           const std::vector<BranchSide>& sides, const SolverSettings& solver, bool times);

// Outputs of a comparison: channels(), characteristics(), `also`, sums().
std::vector<Channel> compared_channels(const Model& model, const std::vector<Channel>& also);
// compare() with the outputs compared_channels().
Comparison compare(const Model& model, const Options& options, const std::vector<Channel>& also);

// Whether the scene is too large for the energy leg to solve: it then only computes the residuals of
// the equilibrium leg's states.
bool energy_judges_states(const BranchComparison& branch);

// Legs that must not fail: all for a verdict on the recursion, the references for one on a candidate.
enum class RequiredLegs { all, references };
// Reasons why the references do not agree on a branch whose runs and readings are complete, or why a
// required leg failed; `requested` is the branch of the model.
Objections disagreements(const Model& model, const std::vector<Channel>& channels,
                         const Branch& requested, const BranchComparison& branch,
                         RequiredLegs required = RequiredLegs::all);

// Per body: whether an idle mode moves it, along which its position is arbitrary.
std::vector<bool> bodies_with_idle_mode(const Model& model, const recursive::Diagnosis& diagnosis);

}  // namespace elastocheck::compare
