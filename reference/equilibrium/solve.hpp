// Reference leg 1: the full nonlinear constraint and equilibrium equations, differentiated by Ceres, solved by Newton's
// method. Its cost grows with the scene, as long as what connects the bodies is sparse.
//
// Everything is SI (m, N, N·m, rad). Nothing is kept between calls and nothing is shared: any number of
// threads may solve and judge one model at the same time.
#pragma once

#include <span>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::reference::equilibrium {

struct Options {
    double tolerance =
        1e-12;  // on the largest scaled residual; a point is accepted on this, never on a solver's word
    int iteration_limit = 100;  // per solve
    int halvings = 40;          // of the whole branch: the smallest step, before the branch is given up
    bool account =
        false;  // every point carries its bound, and the stiffness that is left there (account.hpp)
};

// The equilibria of `model` at `points`, values of the parameter a of `branch` in its unit, in the order they
// are to be visited: E(x; a) = 0, each warm-started from the one before. Before the first, all that stands at
// a = 0 is settled: static loads and preloads, what the drivers hold, constraints that the design pose
// misses.
//
// The path has one Equilibrium a point, or `visit` is handed it, up to the first that is not reached. It ends, whatever the points,
// where the branch does: `branch_lost` where it turns back or steepens, `singular` where it divides or loses
// its stability, `inconsistent_constraints` where the joints cannot be closed, by name, `loaded_idle_mode`
// where a load meets no resistance. `not_finite` and `iteration_limit` are failures of numbers. An outcome
// has its reason in `detail`.
//
// Throws std::invalid_argument unless stands_on(model, branch), and where a driver moves what its joint or element does
// not have.
//
// Thread-safe: calls keep nothing between them and may share a model, as long as nobody changes it meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> points,
                      const Options& options = {}, const Visit& visit = {});

// How well a state, from any leg, satisfies this leg's equations at a = state.load; balances are formed from
// Equilibrium::reactions. NaN where the state has not one pose a body and one reaction a joint. Throws as
// `solve` does.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

// The reactions, one a joint, that leave the least of the balances where the bodies are at these poses; of smallest size
// where joints share a load as they like. Whoever finds poses alone is judged with them. Throws as `solve` does, and
// unless there is one pose a body; NaN where a pose or a force is none.
std::vector<Wrench> reactions_at(const Model& model, const Branch& branch, double a,
                                 const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::equilibrium
