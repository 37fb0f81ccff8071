#include "reference/energy/minimise/descent.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

constexpr double last_step = 1e-10, accepted_step = 1e-9;  // of L or 1 rad: as in branch.cpp
constexpr double quadratic_step = 1e-6;  // likewise: smaller steps are not shortened
constexpr int shortenings = 12;          // of a step, each by half
constexpr double share_of_fall = 1e-4;   // of the predicted fall of the energy (Armijo)

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

// Part of the step x that lowers the function enough.
double share_of(const Path& path, const State& from, const VectorXd& x) {
    const double slope = from.balance.projected_gradient.dot(x) - from.balance.Phi.squaredNorm();
    double part = 1;
    if (!(slope < 0) || largest(x) <= quadratic_step) return part;
    for (int i = 0; i < shortenings; ++i, part *= 0.5)
        if (rise(path, from, part * x) <= share_of_fall * part * slope) break;
    return part;
}

}  // namespace

Attempt descend(const Path& path, double a, const std::vector<Pose>& start, const State& near) {
    const Eigen::MatrixXd idle = near.modes.idle_motions();
    State state = sparse_state_at(path, a, start, near.balance.lambda);
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < path.options.recentre_limit; ++i) {
        path.counts.iterations += 1;
        const auto [x, lambda] =
            state.quadratic->minimum(state.balance.projected_gradient, state.balance.Phi, idle);
        const double size = largest(x);
        if (!std::isfinite(size))
            return {state, Failure{Outcome::not_finite, "a number is not finite"}};
        const bool stalled = size <= accepted_step && size > 0.5 * before;
        if (size <= last_step || stalled) {
            State last = state;  // with the multipliers of minimum norm
            last.poses = moved(path, state.poses, x);
            last.balance = sparse_balance(path.model, at(path.course, a), path.scales,
                                          chart_about(last.poses));
            if (is_stationary(path, last)) {
                last.modes = state.quadratic->softest(near.modes);
                return {std::move(last), {}};
            }
        }
        before = size;
        const double part = share_of(path, state, x);
        state = sparse_state_at(path, a, moved(path, state.poses, part * x),
                                state.balance.lambda + part * lambda);
    }
    state.modes = near.modes;
    return {state,
            Failure{Outcome::iteration_limit,
                    fmt::format("the minimum is determined only to {:.1g} of the model's size",
                                before)}};
}

}  // namespace elastocheck::reference::energy
