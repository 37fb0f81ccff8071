// Reference leg 2: the potential energy minimised subject to the full nonlinear constraints, by NLopt.
//
//   V(q; a) → min   subject to   Φ(q; a) = 0
//
// The solver, SLSQP, is dense: its work grows with the cube of the scene and is foreseen before it begins. Judging
// others' states is sparse, at any size.
//
// Units are SI, as everywhere: m, N, rad; the parameter a in Branch::unit. Nothing here is shared between
// calls: any number of threads may solve and judge at once, on one model too.
#pragma once

#include <span>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Options {
    double tolerance = 1e-12;  // on the projected gradient and the constraints, scaled; never a solver's word
    int evaluation_limit = 2000;  // per equilibrium, asked for or internal
    int recentre_limit = 20;      // charts, likewise
    bool account =
        false;  // every point carries its bound, and the stiffness that is left there (account.hpp)
};

// The equilibria at `values` of the branch's parameter, in the order they are to be visited. They are minima
// on the curve that starts where the scene as drawn settles under what the drivers hold at a = 0. The walk
// between them takes steps of its own, so that what it notices on the way does not depend on where the values
// lie.
//
// Pre: the model stands on the branch (on_branch, ways); std::invalid_argument otherwise.
//
// Outcomes, each with the branch and the value of its parameter in `detail`:
//   converged                 every value has its equilibrium
//   branch_lost               the curve ends, or stops being one of minima, whatever minima there may be elsewhere; or a
//                             bushing turns to where its law ends
//   inconsistent_constraints  the joints cannot be closed, held and driven as they are; a joint is named
//   loaded_idle_mode          a motion that nothing resists is pushed
//   not_finite                a NaN or infinity, in the model, the values or on the way
//   iteration_limit           Options' limits were met first
//   not_conservative          a follower load or a bushing's formulation has no potential: nothing was solved; it is named
//   too_large                 more operations are foreseen than the leg is worth (cost.hpp says how they are counted, and
//                             how many that is): nothing was solved
//
// Reactions of joints that repeat each other are not unique; these share the load with the smallest norm. The
// reaction of a driven joint is what its drive exerts: the jack's force, the rack's, the steering moment.
// Counts: `evaluations` of energy or constraints with derivatives, `iterations` are charts, `factorisations`
// are QR.
//
// Thread-safe: calls keep nothing between them and may share a model, as long as nobody changes it meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> values,
                      const Options& options = {}, const Visit& visit = {});

// How well a state, from any leg, satisfies this leg's conditions at its value of the parameter: the
// constraints, and the gradient of the potential left over after the best multipliers. `direction` includes
// that orientations are unit quaternions, and a driven angle's is 2 where it lies the other way round. What
// cannot be judged is NaN: states that are no numbers, forces once a bushing has turned to where its law ends, and
// forces wherever `solve` would say not_conservative: constraints are judged there as everywhere.
// Whatever the size of the model: sparse, and its cost in proportion to a chain's or a tree's bodies.
// Pre: as for `solve`.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::reference::energy
