#include "reference/energy/minimise/descent.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

constexpr double last_step = 1e-10, accepted_step = 1e-9;  // of L or 1 rad: as in branch.cpp
constexpr double quadratic_step = 1e-6;     // likewise: smaller steps are not shortened
constexpr int max_step_halvings = 12;       // of a step, each by half
constexpr double min_share_of_fall = 1e-4;  // of the predicted fall of the energy (Armijo)

// By how much V + λᵀΦ + ½ |Φ|² rises with the step x.
double rise(const Path& path, const State& from, const VectorXd& x) {
    const Prescribed prescribed = at(path.course, from.a);
    const VectorXd D = path.scales.rows(path.model);
    Chart chart = chart_about(from.poses);
    move_to(chart, path.scales.coordinates(coordinates(path.model)).cwiseProduct(x));
    const ConstraintValues values = constraints(path.model, prescribed, chart);
    path.counts.evaluations += 1;
    return potential(path.model, prescribed, chart).change / path.scales.energy() +
           from.balance.lambda.dot(D.cwiseProduct(values.dPhi)) +
           0.5 * (D.cwiseProduct(values.Phi).squaredNorm() - from.balance.Phi.squaredNorm());
}

// Share 1, ½, ¼, ... of the step x that lowers V + λᵀΦ + ½ |Φ|² enough (Armijo).
double step_length(const Path& path, const State& from, const VectorXd& x) {
    const double slope = from.balance.projected_gradient.dot(x) - from.balance.Phi.squaredNorm();
    double share = 1;
    if (!(slope < 0) || largest(x) <= quadratic_step) return share;
    for (int i = 0; i < max_step_halvings; ++i, share *= 0.5)
        if (rise(path, from, share * x) <= min_share_of_fall * share * slope) break;
    return share;
}

}  // namespace

Attempt descend(const Path& path, double a, const std::vector<Pose>& start, const State& near) {
    const Eigen::MatrixXd idle = near.modes.idle_motions();
    State state = sparse_state_at(path, a, start, near.balance.lambda);
    double last_size = std::numeric_limits<double>::infinity();
    for (int i = 0; i < path.options.recentre_limit; ++i) {
        path.counts.iterations += 1;
        const auto [x, lambda] =
            state.quadratic->minimum(state.balance.projected_gradient, state.balance.Phi, idle);
        const double size = largest(x);
        if (!std::isfinite(size))
            return {state, Failure{Outcome::not_finite, "a number is not finite"}};
        const bool has_stalled = size <= accepted_step && size > 0.5 * last_size;
        if (size <= last_step || has_stalled) {
            State last = state;  // with the multipliers of minimum norm
            last.poses = moved(path, state.poses, x);
            last.balance = sparse_balance(path.model, at(path.course, a), path.scales,
                                          chart_about(last.poses));
            if (is_stationary(path, last)) {
                last.modes = state.quadratic->softest(near.modes);
                return {std::move(last), {}};
            }
        }
        last_size = size;
        const double share = step_length(path, state, x);
        state = sparse_state_at(path, a, moved(path, state.poses, share * x),
                                state.balance.lambda + share * lambda);
    }
    state.modes = near.modes;
    return {state,
            Failure{Outcome::iteration_limit,
                    fmt::format("the minimum is determined only to {:.1g} of the model's size",
                                last_size)}};
}

}  // namespace elastocheck::reference::energy
