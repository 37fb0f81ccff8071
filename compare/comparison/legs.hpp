// Runs a leg along a branch: the only place where `solve` and `residuals` of a leg are called, a branch
// is split into its sides, and the sides are joined into one path. (A leg's linear response:
// compliance.cpp; batches of variants: variants/solve_variants.cpp.)
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/deviation/deviation.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Requested values of the parameter [SI], every `every`-th step of each side and its end, in the order
// of the points: from a = 0 for one side, from `from` to `to` for two.
std::vector<double> requested_parameters(const std::vector<BranchSide>& sides, int every);

// The side that contains a; the last one if none does.
const BranchSide& side_at(const std::vector<BranchSide>& sides, double a);

// Whether the outcome means that the energy leg does not apply (no energy, too large), not a failure.
bool is_not_applicable(Outcome outcome);

// Outputs of a point, kept in place of its poses and wrenches.
struct Row {
    double load = 0;              // Equilibrium::load
    double constraint_error = 0;  // Equilibrium::constraint_error
    std::vector<double> values;   // per channel, in its unit
};
struct Analyses;       // compliance.hpp
struct WheelResponse;  // compare/outputs/wheel_response.hpp
// Evaluates the channels at one point. Characteristics are read from the response of the wheels,
// which the leg that found the state computes with these settings and leaves in Analyses::response.
// `analyses` are reused over the points of a branch side.
Row row_of(const Model& model, std::span<const Channel> channels, const BranchSide& side,
           const SolverSettings& solver, const Equilibrium& state, Analyses& analyses);
Row row_of(const Model& model, std::span<const Channel> channels, const BranchSide& side,
           const SolverSettings& solver, const Equilibrium& state);

// solve_branch() of elastocheck/legs.hpp without keeping points: `read` converts each point when it
// is found, and `hand_over` receives the rows in the order of the path. The rows of the first of
// two sides are buffered, since that side runs backwards.
EquilibriumPath solve_branch(const std::vector<BranchSide>& sides, const SolverSettings& solver,
                             const std::function<Row(const Equilibrium&)>& read,
                             const std::function<void(Row)>& hand_over);

// The same path as a curve. `also` receives every point when it is found, and the response of the
// wheels there if an output is read from it.
using VisitResponse = std::function<void(const Equilibrium&, const WheelResponse*)>;
PathCurve solve_branch(const Model& model, std::span<const Channel> channels, const Branch& branch,
                       const std::vector<BranchSide>& sides, const SolverSettings& solver,
                       const VisitResponse& also = {});

// Joins the runs of the sides of a branch to one, as solve_branch() does.
PathCurve joined(const std::vector<BranchSide>& sides, const std::vector<PathCurve>& curves);

// Equilibrium at a = 0, where a branch side begins, as a path of one point; without a point where the leg finds
// none.
EquilibriumPath settle_start(const BranchSide& side, Leg leg);

// States of a leg at these values of the parameter [SI], of the sign of the side and in ascending
// size. As in solve_branch(), the path ends where a tabulated curve ends.
EquilibriumPath solve_at(const BranchSide& side, Leg leg, std::span<const double> points,
                         const PointVisitor& visit);

// ---- The references along a branch.

// Runs of the equilibrium leg and of the energy leg, or of the series where the energy leg does not
// apply, on the requested channels; and their judgement.
struct References {
    PathCurve truth, other;
    Leg second_leg = Leg::energy;
    Scale scale;                  // of the acting forces on the branch, from the equilibrium leg
    std::vector<double> extents;  // of the channels (tolerance.hpp); infinite: not determined here
    // distance of the two references on the main channels, forces and moments, at least their
    // rounding; NaN on failure
    Accuracy uncertainty;
    // why there is no reference: a leg failed, or nothing drives the branch
    std::vector<std::string> failures;
};
// references() = run_references(), then judge_references().
References run_references(const Model& model, const std::vector<Channel>& channels,
                          const Branch& branch, const std::vector<BranchSide>& sides);
void judge_references(const Model& model, const std::vector<Channel>& channels,
                      const Branch& branch, const std::vector<BranchSide>& sides,
                      References& references);
References references(const Model& model, const std::vector<Channel>& channels,
                      const Branch& branch, const std::vector<BranchSide>& sides);
// Runs the second reference alone; `leg` receives which leg that is.
PathCurve second_reference(const Model& model, const std::vector<Channel>& channels,
                           const Branch& branch, const std::vector<BranchSide>& sides, Leg& leg);

// Message if compile() has left a branch without a driver; else empty.
std::string nothing_drives(const Model& model, const Branch& branch);

// ---- Start of a branch: the state at a = 0, settled under the constant loads.

struct Settled {
    std::string branch;
    Outcome outcome = Outcome::converged;
    std::string detail;
    // per channel: value at a = 0 minus its design value, in its unit; NaN unless converged
    std::vector<double> displacement;
};
Settled settled(const Model& model, const std::vector<Channel>& channels, const Branch& branch);

}  // namespace elastocheck::compare
