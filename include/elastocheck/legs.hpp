// Runs any of the legs along a branch.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive.hpp"

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
    // of the model, shared by runs of the recursion; empty: each run computes it
    std::shared_ptr<const recursive::Analysis> analysis = {};
};

// Sides of a branch. They share `points` recorded equal increments of a over the whole branch; 0:
// as many as the branch has steps.
std::vector<BranchSide> sides_of(const Model& model, Branch branch, int points = 0);

// Solver settings of a run. The recursion takes `refine` equal steps between two recorded points, which
// determines `recursion.steps` and `.record`. Of the recorded points every `every`-th, counted from a = 0, and
// the last are requested: the recursion passes through the others, the references skip them.
struct SolverSettings {
    Leg leg = Leg::recursive;
    recursive::Options recursion = {};
    int refine = 1;
    int every = 1;
    reference::energy::Options energy = {};
};

// Runs one branch side by any leg. Ends with Outcome::outside_table before the first point at which an element
// is deformed beyond the end of a curve that is not extrapolated. With a `visit`, points are not kept.
EquilibriumPath solve_branch(const BranchSide& side, const SolverSettings& solver,
                             const PointVisitor& visit = {});

// Joins the sides into one path from `from` to `to`; one side is returned as it was run. The path
// has the outcome of the first side that failed, and the points reached on either side of a = 0.
EquilibriumPath solve_branch(const std::vector<BranchSide>& sides, const SolverSettings& solver);

// Residuals of the state in the equations of a leg.
Residuals judge(Leg by, const BranchSide& side, const Equilibrium& state);

}  // namespace elastocheck::compare
