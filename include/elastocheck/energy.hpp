// Reference leg 2: minimisation of the potential energy subject to the full nonlinear constraints,
// by NLopt, for large models by Newton steps of a sparse quadratic model.
//
//   V(q; a) → min   subject to   Φ(q; a) = 0
//
// The cost of SLSQP, which is dense, grows with the cube of the number of bodies, that of the sparse steps
// with the bodies and the fill of the factors. Both are predicted before they start. Judging states of
// other legs is sparse, for models of any size.
//
// Units are SI: m, N, rad; the parameter a in Branch::unit. Calls share no state: any number of
// threads may solve and judge at once, also on one model.
#pragma once

#include <span>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reference::energy {

struct Options {
    // on the projected gradient and the constraints, scaled; a solver's status is never used
    double tolerance = 1e-12;
    int evaluation_limit = 2000;  // per equilibrium, requested or internal
    int recentre_limit = 20;      // charts of the rotations, likewise
    // predicted operations above which a branch is not solved: about a minute of a desktop computer
    double operation_limit = 1e11;
};

// Equilibria at `values` of the branch's parameter, in the order of the visit. They are minima on the curve
// that starts where the scene settles from its design position under the drivers at a = 0. The continuation
// between them controls its own steps, so that the detection of singular points does not depend on the values.
//
// Throws std::invalid_argument unless fits_branch(model, branch) (models/branch.hpp).
//
// Outcomes, each with the branch and the value of its parameter in `detail`:
//   converged                 every value has its equilibrium
//   branch_lost               the curve ends or ceases to consist of minima, whatever other minima
//                             exist; or a bushing turns by half a turn or to the end of its
//                             angles' range
//   inconsistent_constraints  the joints cannot be closed at their held and driven values; a joint
//                             is named
//   loaded_idle_mode          a load pushes an unresisted motion
//   not_finite                a NaN or infinity, in the model, the values or on the way
//   iteration_limit           Options' limits were met first
//   not_conservative          a follower load or a bushing's formulation, named, has no potential:
//                             not solved
//   too_large                 the predicted operations (cost.hpp) exceed Options' limit: not solved
//
// Reactions of redundant joints are not unique; those of minimum norm are returned. The reaction of a driven
// joint is the effort of its driver: jack force, rack force, steering moment. Counts: `evaluations` of energy
// or constraints with derivatives, `iterations` the charts of the rotations, `factorisations` by QR.
//
// Thread-safe: calls share nothing except a model that must not change meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> values,
                      const Options& options = {}, const PointVisitor& visit = {});

// Residuals of a state from any leg in this leg's conditions at its parameter value: the constraints, and the
// gradient of the potential projected by the least-squares multipliers. `direction` includes the deviation of
// orientations from unit quaternions; it is 2 for a driven angle in the reversed direction. All residuals of a
// state that is not finite are NaN; so are the forces where a bushing has turned to the end of its angles'
// range, and where `solve` would return not_conservative. Sparse, for models of any size; the cost is
// proportional to the bodies of a chain or a tree. Throws as `solve` does.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::reference::energy
