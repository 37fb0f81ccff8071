// Runs a leg along a branch: the only place where a leg is called, a branch is split into its
// sides, and the sides are joined into one path.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/deviation/agreement.hpp"
#include "compare/deviation/deviation.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace elastocheck::compare {

// The three legs, and the series as substitute for the energy leg where a load or a formulation has
// no energy or the scene is too large: the branch as a power series at the tightest tolerance.
enum class Leg { recursive, equilibrium, energy, series };
inline constexpr std::array legs{Leg::recursive, Leg::equilibrium, Leg::energy};
const char* name(Leg leg);

// One side of a branch, starting at a = 0, with the model that applies to it: the input of a leg.
struct BranchSide {
    std::string name;  // "jounce"; "bounce to -80 mm" for one side of a two-sided branch
    Model model;
    Branch branch;  // `steps`: number of recorded equal increments of a
};

// Sides of a branch. They share `points` recorded equal increments of a over the whole branch; 0:
// as many as the branch has steps.
std::vector<BranchSide> sides_of(const Model& model, Branch branch, int points = 0);

// Solver settings of a run. The recursion takes `refine` equal steps between two recorded points,
// which determines `recursion.steps` and `.record`. Of the recorded points every `every`-th,
// counted from a = 0, and the last are requested: the recursion passes through the others, the
// references skip them.
struct SolverSettings {
    Leg leg = Leg::recursive;
    recursive::Options recursion = {};
    int refine = 1;
    int every = 1;
    // every point carries its error bound and remaining stiffness, as the leg estimates them
    bool error_bound = false;
};

// Requested values of the parameter, in the order of the points: from a = 0 for one side, from
// `from` to `to` for two.
std::vector<double> asked_for(const std::vector<BranchSide>& ways, int every);

// Runs one branch side by any leg. Ends before the first point at which an element is deformed
// beyond the end of a curve that is not extrapolated: Outcome::outside_table. With a `visit`,
// points are not kept.
EquilibriumPath walk(const BranchSide& way, const SolverSettings& solver, const Visit& visit = {});

// Whether the outcome means that the energy leg does not apply here, in contrast to a failure.
bool is_not_asked(Outcome outcome);

// Joins the sides into one path from `from` to `to`; one side is returned as it was run. The path
// has the outcome of the first side that failed, and the points reached on either side of a = 0.
EquilibriumPath walk(const std::vector<BranchSide>& ways, const SolverSettings& solver);

// Requested numbers of a point, in place of all its poses and wrenches.
struct Row {
    double load = 0;              // as in Equilibrium
    double constraint_error = 0;  // likewise
    std::vector<double> values;   // per channel, in its unit
};
// Cached analyses of the recursion for the response models of a branch side (compliance.hpp); they are
// independent of the state.
struct Analyses {
    std::optional<recursive::Analysis> free, jacked, tied;  // computed on first use
};
// Evaluates the channels at one point. A characteristic is computed by the leg that found the
// state, with these settings.
Row row_of(const Model& model, std::span<const Channel> channels, const BranchSide& way,
           const SolverSettings& solver, const Equilibrium& state, Analyses& analyses);
inline Row row_of(const Model& model, std::span<const Channel> channels, const BranchSide& way,
                  const SolverSettings& solver,
                  const Equilibrium& state) {  // for a single state
    Analyses analyses;
    return row_of(model, channels, way, solver, state, analyses);
}

// The same path without keeping points: `read` converts each point when it is found, and
// `hand_over` receives the rows in the order of the path. The rows of the first of two sides are
// buffered, since that side runs backwards.
EquilibriumPath walk(const std::vector<BranchSide>& ways, const SolverSettings& solver,
                     const std::function<Row(const Equilibrium&)>& read,
                     const std::function<void(Row)>& hand_over);

// The same path as a curve.
struct Walked {
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    Counts counts = {};
    Curve curve = {};
    std::vector<double> constraint_error = {};  // per point, as in Equilibrium
    double seconds = 0;                         // of the leg alone
};
// `also` is called with every point when it is found.
Walked walk(const Model& model, std::span<const Channel> channels, const Branch& branch,
            const std::vector<BranchSide>& ways, const SolverSettings& solver,
            const Visit& also = {});

// Start of a branch side by this leg: one point, the settled state at a = 0; no point where it does
// not settle.
EquilibriumPath rest(const BranchSide& way, Leg leg);

// Residuals of the state in the equations of a leg.
Residuals judge(Leg by, const BranchSide& way, const Equilibrium& state);

// ---- The references along a branch.

// The equilibrium leg, and the energy leg; or the series, where the energy leg does not apply.
struct References {
    // of the equilibrium leg and of the second reference, on the requested channels
    Curve truth, other;
    Outcome truth_ended = Outcome::converged;
    Leg second_leg = Leg::energy;
    std::string not_asked;        // why the energy leg does not apply, if second_leg is the series
    Scale scale;                  // of the acting forces on the branch, from the equilibrium leg
    std::vector<double> extents;  // of the channels (tolerance.hpp); infinite: not determined here
    // distance of the two references on the main channels, forces and moments, at least their
    // rounding; NaN on failure
    Accuracy uncertainty;
    // why there is no reference: a leg failed, nothing drives the branch, or no output moves
    std::vector<std::string> failures;
};

References references(const Model& model, const std::vector<Channel>& channels,
                      const Branch& branch, const std::vector<BranchSide>& ways);

// Reason why a branch gives no information: it has no driver left, or no main channel moves by more
// than its rounding. Empty otherwise.
std::string nothing_moves(const Model& model, const std::vector<Channel>& channels,
                          const Branch& branch, const Curve& truth);

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
