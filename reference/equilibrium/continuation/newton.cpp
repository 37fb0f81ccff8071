#include "reference/equilibrium/continuation/newton.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::VectorXd;

// After a correction of this size the next one would be of its square, which is round-off.
constexpr double quadratic_step = 1e-8;

// A damped step is accepted if it reduces the level by at least this part of
// the predicted reduction.
constexpr double min_promise_kept = 1e-3;

// Limit of the damping: at stagnation no shorter step is an improvement.
constexpr int max_damping_halvings = 10;

// Newton's steps are invariant under multiplication of the equations by a regular matrix; a
// monotonicity test is not. A member rotated along its tangent by δ is stretched by ½ δ². Measured
// in forces, a long step increases the residual of stiff members, and rejecting it would make the
// iteration creep; and the residual of a soft direction is hidden by the round-off of stiff ones.
// So the test uses
//
//   | ⎡ J  U ⎤⁻¹ ⎧ E ⎫ |
//   | ⎣ Vᵀ 0 ⎦   ⎩ 0 ⎭ |
//
// the corrections for E with the matrix at the start of the step: the natural level function of the
// natural monotonicity test (Deuflhard 1974; linearisation.hpp has J and its border). It is zero
// where E is.
double level(const Linearisation& near, const VectorXd& E) {
    const Rate corrections = solve_bordered(near.bordered, E);
    return std::hypot(corrections.dx.norm(), corrections.mu.norm());
}

}  // namespace

Attempt newton(const System& system, const Loading& loading, const VectorXd& start,
               const Linearisation& near, const Options& options, Counts& counts) {
    Attempt attempt{start, 0, false};
    VectorXd& x = attempt.x;
    Derivatives derivative = derivatives(system, loading, x, counts);
    attempt.residual = largest(derivative.E);
    if (!std::isfinite(attempt.residual) || system.equations() == 0) return attempt;

    double last_level = level(near, derivative.E);
    for (int iteration = 0;; ++iteration) {
        if (iteration == options.iteration_limit) {
            attempt.out_of_time = true;
            return attempt;
        }
        if (!is_finite(derivative.J)) return attempt;
        ++counts.factorisations;
        ++counts.iterations;
        const VectorXd dx = solve_bordered(bordered_like(near, derivative.J), derivative.E).dx;
        if (!dx.allFinite()) return attempt;

        double damping = 1, next_level = 0;
        VectorXd next_x, E;
        for (int halving = 0;; ++halving, damping /= 2) {
            next_x = moved(system, x, damping * dx);
            ++counts.evaluations;
            E = residual(system, loading, next_x);
            next_level = level(near, E);
            if (next_level <= (1 - min_promise_kept * damping) * last_level) break;
            if (halving == max_damping_halvings) return attempt;
        }
        x = std::move(next_x);
        attempt.residual = largest(E);
        last_level = next_level;
        if (attempt.residual <= options.tolerance && damping * dx.norm() <= quadratic_step)
            return attempt;
        derivative = derivatives(system, loading, x, counts);
    }
}

}  // namespace elastocheck::reference::equilibrium
