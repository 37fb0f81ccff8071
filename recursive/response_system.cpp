#include "recursive/response_system.hpp"

#include <cmath>
#include <limits>

#include "recursive/linear_response.hpp"

namespace elastocheck::recursive {
namespace {

// Load |W⁻¹ D⁻¹ b μ| on the border b of held direction c in the last back-substitution, b scaled by D
// (border()), μ its multiplier (saddle_point.hpp): a force on an idle mode, or the gap of redundant
// constraints.
double border_load(const SaddlePoint<double>& system, int c) {
    const Held<double>& held = system.held;
    const double mu = system.solution[system.n + system.m + c];
    double sum = 0;
    for (int e = held.begin(c); e < held.end(c); ++e) {
        const auto at = static_cast<std::size_t>(e);
        const double load =
            mu * system.border()[e] / (system.scale[held.row[at]] * system.weight[held.row[at]]);
        sum += load * load;
    }
    return std::sqrt(sum);
}

// A held direction does not respond, so its border must carry no load: a load is a force on an idle
// mode (loaded_idle_mode), also where the mode is idle in K but not in the tangent, or a gap of
// redundant constraints (inconsistent_constraints). The limits are `limit` times
//
//   force     size of the forces that act on the bodies, for idle modes; `rounding` [same unit] is
//             added for their rounding
//   opening   size of the constraint residual and of the motion that would close it, for redundant
//             constraints [m]
//
// `limit` is round-off (guard::rounding) plus a share of the constraint error Φ of the state. As rows of
// Φ are lengths or directions, the motion and Φ are divided by the lesser of 1 and L.
Outcome check_border(SteppingState& s, CheckedDirections checked, double rounding) {
    const Held<double>& held = s.system.held;
    if (held.size() == 0 || checked == CheckedDirections::none) return Outcome::converged;
    constraint_force(s.system.M, s.work.x.tail(s.m()), s.work.force);
    const double force = size_of_force(s, s.work.upper) + size_of_force(s, s.work.force);
    const double opening =
        s.work.lower.norm() + std::sqrt(size_of_solution(s)) / std::min(1.0, s.setup.length);
    const double limit = guard::rounding * std::numeric_limits<double>::epsilon() +
                         guard::share_per_error * s.work.Phi.norm() / std::min(1.0, s.setup.length);
    const int count = checked == CheckedDirections::all ? held.size() : held.idle;
    for (int c = 0; c < count; ++c) {
        const bool idle = c < held.idle;
        if (!(border_load(s.system, c) <= limit * (idle ? force : opening) + (idle ? rounding : 0)))
            return idle ? Outcome::loaded_idle_mode : Outcome::inconsistent_constraints;
    }
    return Outcome::converged;
}

// Removes the idle part of dq (minimum norm): the border held the idle modes as they were before
// the last factorisation, which has updated them (saddle_point.hpp).
void leave_out_idle_motion(SteppingState& s) {
    const Held<double>& held = s.system.held;
    for (int c = 0; c < held.idle; ++c) {
        const auto z = held.values(c);
        const auto W2 = weights(s.system, c);
        const auto at = [&](Eigen::Index e) {
            return held.row[static_cast<std::size_t>(held.begin(c) + static_cast<int>(e))];
        };
        double along = 0;
        for (Eigen::Index e = 0; e < z.size(); ++e) along += z[e] * W2(e) * s.work.x[at(e)];
        for (Eigen::Index e = 0; e < z.size(); ++e) s.work.x[at(e)] -= along * z[e];
    }
}

// Factorises at (s.q, s.lambda), in the elimination order `order` if it is set; sets it to the order
// used.
Outcome factorise_in(SteppingState& s, EliminationOrder& order) {
    SparseLU<double>& lu = s.system.lu;
    if (order) take_order(lu, order);
    const Outcome outcome = factorise_at(s, s.q, s.lambda);
    order = lu.order;
    return outcome;
}

}  // namespace

Outcome factorise_response(SteppingState& s, bool consistent, ResponseOrders& orders) {
    if (const Outcome outcome = factorise_in(s, orders.with_K); outcome != Outcome::converged)
        return outcome;
    if (!consistent) return Outcome::converged;
    residual_at(s, s.q, s.lambda);  // the caller's λ is 0, so that this is f_ext - f_elast
    s.work.lower.setZero();
    back_substitute(s);
    if (!s.work.x.allFinite()) return Outcome::not_finite;
    s.lambda = s.work.x.tail(s.m());
    s.setup.consistent = true;
    return factorise_in(s, orders.with_tangent);
}

Outcome solve_response(SteppingState& s, CheckedDirections checked, double rounding) {
    back_substitute(s);
    if (!s.work.x.allFinite()) return Outcome::not_finite;
    const Outcome outcome = check_border(s, checked, rounding);
    if (outcome == Outcome::converged) leave_out_idle_motion(s);
    return outcome;
}

}  // namespace elastocheck::recursive
