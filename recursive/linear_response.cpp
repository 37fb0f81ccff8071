#include "recursive/linear_response.hpp"
#include "recursive/diagnosis/analysis.hpp"

#include <fmt/format.h>

#include "recursive/diagnosis/finite.hpp"
#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {
namespace {

void check(const Model& model, const Equilibrium& state,
           std::span<const Disturbance> disturbances) {
    const auto require = [](bool met, const char* what) {
        if (!met) throw std::invalid_argument(what);
    };
    require(state.poses.size() == model.bodies.size(), "the state belongs to another model");
    for (const Disturbance& disturbance : disturbances)
        std::visit(overloaded{
                       [&](const UnitWrench& wrench) {
                           require(static_cast<std::size_t>(wrench.at.body) < model.bodies.size(),
                                   "a disturbance acts on no body of the model");
                       },
                       [&](const Motion& motion) {
                           const auto at = static_cast<std::size_t>(motion.joint);
                           require(at < model.joints.size() && model.joints[at].driven >= 0,
                                   "a disturbance drives a joint without offset, length or angle");
                       },
                   },
                   disturbance);
}

// Right-hand side of one disturbance. A wrench enters the upper rows. A motion of a joint enters
// the lower row as -∂Φ/∂c and the upper rows as the change of its reaction, -∂(Φ_qᵀ λ)/∂c.
void disturb(SteppingState<double>& s, const Disturbance& disturbance) {
    s.upper.setZero();
    s.lower.setZero();
    std::visit(overloaded{
                   [&](const UnitWrench& wrench) {
                       add_load<double>(DeadForce{wrench.at, wrench.force}, 1, s.q, s.upper);
                       add_load<double>(DeadMoment{wrench.at.body, wrench.moment}, 1, s.q, s.upper);
                   },
                   [&](const Motion& motion) {
                       const std::size_t k = constraint_of(s.model, motion);
                       const int row = s.inputs.row[k];
                       const Row<double> d =
                           rate<double>(s.model.constraints[k].kind, s.inputs.offset[k], s.q);
                       s.lower[row] = -d.Phi;
                       if (d.i != ground) s.upper.segment<6>(6 * d.i) -= s.lambda[row] * d.on_i();
                       if (d.j != ground) s.upper.segment<6>(6 * d.j) -= s.lambda[row] * d.on_j();
                   },
               },
               disturbance);
}

// Load carried by the border of a held direction in the last back-substitution, b μ of
// saddle_point.hpp without the scaling: a force on an idle mode, as |W⁻¹ f|, or the gap of
// redundant constraints.
double taken_by_border(const SaddlePoint<double>& system, int c) {
    const Held<double>& held = system.held;
    const double mu = system.solution[system.n + system.m + c];
    double sum = 0;
    for (int e = held.begin(c); e < held.end(c); ++e) {
        const auto at = static_cast<std::size_t>(e);
        const double taken =
            mu * system.border()[e] / (system.scale[held.row[at]] * system.weight[held.row[at]]);
        sum += taken * taken;
    }
    return std::sqrt(sum);
}

// A held direction does not respond, so its border must carry no load. μ detects a force on an idle
// mode, and a mode that is idle in K but not in the tangent. For a wrench, redundant combinations
// are not checked: redundant joints carry it, in an undetermined distribution.
Outcome check_border(SteppingState<double>& s, const Disturbance& disturbance) {
    const Held<double>& held = s.system.held;
    if (held.size() == 0) return Outcome::converged;
    constraint_force(s.system.M, s.x.tail(s.m()), s.force);
    const double force = size_of_force(s, s.upper) + size_of_force(s, s.force);
    const double opening =
        s.lower.norm() + std::sqrt(size_of_solution(s)) / std::min(1.0, s.length);
    const double limit = guard::rounding * std::numeric_limits<double>::epsilon() +
                         guard::share_per_error * s.Phi.norm() / std::min(1.0, s.length);
    const int judged = std::holds_alternative<Motion>(disturbance) ? held.size() : held.idle;
    for (int c = 0; c < judged; ++c) {
        const bool idle = c < held.idle;
        if (!(taken_by_border(s.system, c) <= limit * (idle ? force : opening)))
            return idle ? Outcome::loaded_idle_mode : Outcome::inconsistent_constraints;
    }
    return Outcome::converged;
}

// Removes the idle part of dq (minimum norm): the border held the idle modes as they were before
// the last factorisation, which has updated them (saddle_point.hpp).
void leave_out_idle_motion(SteppingState<double>& s) {
    const Held<double>& held = s.system.held;
    for (int c = 0; c < held.idle; ++c) {
        const auto z = held.values(c);
        const auto W2 = weights(s.system, c);
        const auto at = [&](Eigen::Index e) {
            return held.row[static_cast<std::size_t>(held.begin(c) + static_cast<int>(e))];
        };
        double along = 0;
        for (Eigen::Index e = 0; e < z.size(); ++e) along += z[e] * W2(e) * s.x[at(e)];
        for (Eigen::Index e = 0; e < z.size(); ++e) s.x[at(e)] -= along * z[e];
    }
}

// Factorises the method's matrix at q.
Outcome factorise(SteppingState<double>& s, const Method& method) {
    if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
        return outcome;
    if (std::holds_alternative<Linear>(method.kind)) return Outcome::converged;
    residual_at(s, s.q, s.lambda);  // λ = 0: f_ext - f_elast
    s.lower.setZero();
    back_substitute(s);
    if (!s.x.allFinite()) return Outcome::not_finite;
    s.lambda = s.x.tail(s.m());
    s.consistent = true;
    return factorise_at(s, s.q, s.lambda);
}

std::string words(Outcome outcome, const Disturbance& disturbance, const Model& model,
                  const Diagnosis& diagnosis) {
    const std::string what = std::visit(
        overloaded{
            [&](const UnitWrench& wrench) {
                return fmt::format("a wrench on '{}'",
                                   model.bodies[static_cast<std::size_t>(wrench.at.body)].name);
            },
            [&](const Motion& motion) {
                return fmt::format("moving '{}'",
                                   model.joints[static_cast<std::size_t>(motion.joint)].name);
            }},
        disturbance);
    if (outcome == Outcome::loaded_idle_mode)
        return what +
               " acts on a motion that no joint or element resists at the design position: " +
               idle_modes(diagnosis);
    if (outcome == Outcome::inconsistent_constraints) return what + " would open redundant joints";
    return what;
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method,
                         const Analysis& analysis) {
    check(model, branch);
    check(model, state, disturbances);
    if (std::isnan(analysis.diagnosis.constraint_error))
        return {Outcome::not_finite,
                fmt::format("branch '{}': {}", branch.name, not_finite(model)),
                {}};
    SteppingState<double> s(model, branch, analysis);
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    Response response;
    const auto fail = [&](Outcome outcome, std::string detail) {
        response = {outcome, fmt::format("branch '{}': {}", branch.name, detail), {}};
        return response;
    };
    if (const Outcome outcome = factorise(s, method); outcome != Outcome::converged)
        return fail(outcome, "the response to a small disturbance is not unique at the state");
    for (const Disturbance& disturbance : disturbances) {
        disturb(s, disturbance);
        back_substitute(s);
        const Outcome outcome =
            s.x.allFinite() ? check_border(s, disturbance) : Outcome::not_finite;
        if (outcome != Outcome::converged)
            return fail(outcome, words(outcome, disturbance, model, analysis.diagnosis));
        leave_out_idle_motion(s);
        auto& increments = response.increments.emplace_back(model.bodies.size());
        for (std::size_t b = 0; b < increments.size(); ++b) {
            const auto at = static_cast<Eigen::Index>(6 * b);
            increments[b] = {s.x.segment<3>(at), s.x.segment<3>(at + 3)};
        }
    }
    return response;
}

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method) {
    check(model, branch);
    return linear_response(model, branch, state, disturbances, method, analyse(model));
}

}  // namespace elastocheck::recursive
