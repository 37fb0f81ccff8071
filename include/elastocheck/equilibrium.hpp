// Reference leg 1: full nonlinear constraint and equilibrium equations, differentiated by Ceres,
// solved by Newton's method with continuation. The cost grows linearly with the scene as long as
// the connections of the bodies are sparse.
//
// All quantities are SI (m, N, N·m, rad). No state is kept between calls: any number of threads may
// solve and judge one model at the same time.
#pragma once

#include <span>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reference::equilibrium {

struct Options {
    // on the largest scaled residual; a point is accepted by this residual, never by a solver's status
    double tolerance = 1e-12;
    int iteration_limit = 100;  // per solve
    // smallest step: the whole branch halved this often; then the branch counts as ended
    int halvings = 40;
};

// Equilibria of `model` at `points`, values of the parameter a of `branch` in its unit, in the order of the
// visit: E(x; a) = 0, each warm-started from the one before. Before the first point, everything present at a =
// 0 is settled: static loads and preloads, values held by the drivers, constraints violated by the design pose.
//
// The path has one Equilibrium per point, or passes it to `visit`, up to the first that is not reached. It ends
// where the branch ends, independently of the points: `branch_lost` where it turns back or steepens, `singular`
// where it bifurcates or loses stability, `inconsistent_constraints` where the joints cannot be closed (named),
// `loaded_idle_mode` where a load acts on an unresisted motion. `not_finite` and `iteration_limit` are
// numerical failures. `detail` has the reason of an outcome.
//
// Throws std::invalid_argument unless fits_branch(model, branch) (models/branch.hpp), and where a driver moves
// a quantity that its joint or element does not have.
//
// Thread-safe: calls share nothing except a model that must not change meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> points,
                      const Options& options = {}, const PointVisitor& visit = {});

// Residuals of a state from any leg in this leg's equations at a = state.load; balances use
// Equilibrium::reactions. NaN unless the state has one pose per body and one reaction per joint.
// Throws as `solve` does.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

// Reactions, one per joint, with the least imbalance at these poses; of minimum norm where
// redundant joints share a load. Used to judge legs that compute poses only. Throws as `solve`
// does, and unless there is one pose per body; NaN where a pose or a force is NaN.
std::vector<Wrench> reactions_at(const Model& model, const Branch& branch, double a,
                                 const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::equilibrium
