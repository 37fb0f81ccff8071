#include "recursive/stepping/steps.hpp"

namespace elastocheck::recursive {
namespace {

// f_ext for the step, less `unreleased_share` of the imbalance R_d = f_ext - f_elast at the design
// position; the share falls from 1 to 0 while the start settles. Where the load does not
// follow, it keeps its moment, and only the increment acts at the current lever.
void apply_load(SteppingState& s, const StoredForces& forces, Drive drive, double amount,
                double unreleased_share) {
    if (forces.load_follows) {
        external_force<double>(s.model, s.branch, s.inputs, s.q, s.work.applied);
        if (unreleased_share != 0) s.work.applied -= unreleased_share * s.start.R_d;
    } else {
        add_load_rate<double>(s.branch, drive, amount, s.q, s.work.applied);
        if (drive == Drive::start) s.work.applied += amount * s.start.R_d;
    }
}

// Updates the stored forces, f_elast at the new configuration, according to `forces`:
//
//   nothing   f_elast⁺ = f_ext - Φ_q(qⁿ)ᵀ λⁿ: the upper row just solved. With it the next right-
//             hand side f_ext - f_elast is that of (29), and by induction that of (28)
//   lever     each element's sum of K_T Δr', K_R Δπ, at the current attachment points
//   axis      each element's true force, its increments added at the levers of their step
//   both      the law itself, which add_driven_change() evaluates at the inputs of the next step
void update_stored_forces(SteppingState& s, const StoredForces& forces) {
    if (forces.lever_follows && forces.axis_follows) return;
    if (!forces.lever_follows && !forces.axis_follows) {
        constraint_force(s.system.M, s.lambda, s.work.force);
        s.work.stored = s.work.applied - s.work.force;
        return;
    }
    if (forces.lever_follows) s.work.stored.setZero();
    for (std::size_t k = 0; k < s.model.elastics.size(); ++k) {
        const ElasticKind& kind = s.model.elastics[k].kind;
        const auto [i, j] = bodies_of(kind);
        ElementForce<double>& sum = s.work.element[k];
        const ElementForce<double> current = element_force<double>(kind, s.inputs.rest[k], s.q);
        const auto motion = [&](BodyId b) -> Vector6<double> {
            return b == ground ? Vector6<double>::Zero()
                               : Vector6<double>(s.step.dq.segment<6>(6 * b));
        };
        const auto k_e = element_stiffness<double>(kind, s.inputs.rest[k], s.step.before);
        if (forces.lever_follows) {
            const Vector6<double> dq_i = motion(k_e.i), dq_j = motion(k_e.j);
            Vector6<double> de;  // Δr'_j - Δr'_i, eqs. (13), (12); Δπ_j - Δπ_i
            de << dq_j.head<3>() - k_e.s_j.cross(dq_j.tail<3>()) - dq_i.head<3>() +
                      k_e.s_i.cross(dq_i.tail<3>()),
                dq_j.tail<3>() - dq_i.tail<3>();
            const Vector6<double> df = k_e.K * de;
            sum = {sum.F + df.head<3>(), sum.M + df.tail<3>(), current.lever_i, current.lever_j};
            add_element_force<double>(i, j, sum, s.work.stored);
        } else {
            const ElementForce<double> increment{current.F - sum.F, current.M - sum.M, k_e.s_i,
                                                 k_e.s_j};
            add_element_force<double>(i, j, increment, s.work.stored);
            sum = current;
        }
    }
}

// Adds the change of f_elast at qⁿ by the drivers in this step, ∂f_elast/∂a Δa, to
// the stored forces.
void add_driven_change(SteppingState& s, const StoredForces& forces, Drive drive, double amount) {
    if (forces.lever_follows && forces.axis_follows)
        return elastic_force<double>(s.model, s.inputs, s.q, s.work.stored);
    for_each_stored_rate<double>({s.model, s.branch, s.inputs, drive, amount, s.q},
                                 [&](std::size_t k, const ElementForce<double>& force) {
                                     const auto [i, j] = bodies_of(s.model.elastics[k].kind);
                                     add_element_force<double>(i, j, force, s.work.stored);
                                     if (!forces.lever_follows && !forces.axis_follows) return;
                                     s.work.element[k].F += force.F;
                                     s.work.element[k].M += force.M;
                                 });
}

// Whether the step drives an angle beyond the range of the linearised rotation. Φ itself cannot
// show it: half a turn and a whole turn look like none.
bool turns_too_far(const SteppingState& s, Drive drive, double amount) {
    for (const auto& driver : s.branch.drivers) {
        const int joint = driven_joint(driver.what);
        if (joint >= 0 && is_angle(s.model.constraints[constraint_of(s.model, {joint})].kind) &&
            !(std::abs(amount * amplitude<double>(driver, drive)) <= guard::largest_turn))
            return true;
    }
    return false;
}

}  // namespace

Outcome step(SteppingState& s, const Linear& method, Parameters next) {
    const Drive drive = next.t != s.parameters.t ? Drive::start : Drive::rate;
    const double amount = drive == Drive::start ? next.t - s.parameters.t : next.a - s.parameters.a;
    if (s.setup.end != s.branch.to && !(std::abs(next.a) <= std::abs(s.setup.end)))
        return Outcome::inconsistent_constraints;
    if (turns_too_far(s, drive, amount)) return Outcome::diverged;
    // Lower row of (29) at (qⁿ, aⁿ). The loads are those at aⁿ⁺¹, the matrix that at aⁿ; with
    // method.closed the whole system is that at aⁿ⁺¹.
    const Parameters present = s.parameters;
    if (!method.closed) {
        s.work.lower.setZero();
        add_constraint_rate<double>({s.model, s.branch, s.inputs, drive, -amount, s.q},
                                    s.work.lower);
        if (drive == Drive::start) s.work.lower -= amount * s.start.Phi_d;
    }
    go_to(s, next);
    apply_load(s, method.stored, drive, amount, 1 - next.t);
    add_driven_change(s, method.stored, drive, amount);
    if (!method.closed) go_to(s, present);
    if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
        return outcome;
    if (!method.closed) go_to(s, next);
    if (const Outcome outcome = check_idle_load(s, s.q, 0); outcome != Outcome::converged)
        return outcome;
    s.work.upper = s.work.applied - s.work.stored;
    if (method.closed) {
        s.work.lower = -s.work.Phi;
        if (next.t != 1) s.work.lower += (1 - next.t) * s.start.Phi_d;
    }
    back_substitute(s);
    ++s.counts.evaluations;
    s.step.before = s.q;
    s.lambda = s.work.x.tail(s.m());
    s.step.dq = s.work.x.head(s.n());
    if (!s.work.x.allFinite()) return Outcome::not_finite;
    if (has_diverged(s)) return Outcome::diverged;
    advance(s.q, s.step.dq);
    s.a = next.a;
    pass_kinks(s);
    update_stored_forces(s, method.stored);
    return Outcome::converged;
}

Outcome step(SteppingState& s, const Consistent& method, Parameters next) {
    const int n = s.n(), m = s.m();
    if (s.setup.end != s.branch.to && !(std::abs(next.a) <= std::abs(s.setup.end)))
        return Outcome::inconsistent_constraints;
    if (turns_too_far(s, Drive::rate, next.a - s.parameters.a)) return Outcome::diverged;
    go_to(s, next);
    // for the check of idle modes
    external_force<double>(s.model, s.branch, s.inputs, s.q, s.work.applied);
    if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
        return outcome;
    if (const Outcome outcome = check_idle_load(s, s.q, s.step.equilibrium_distance);
        outcome != Outcome::converged)
        return outcome;
    // A determinant with another sign than at a = 0 has passed through zero: there the branch
    // turned back, bifurcated or became unstable.
    if (s.system.lu.orientation != s.start.orientation) return Outcome::singular;
    residual_at(s, s.q, s.lambda);
    back_substitute(s);
    s.step.before = s.q;
    if (method.solve == Consistent::Solve::midpoint) {
        // With z = (q, λ) and G = (f_elast - f_ext + Φ_qᵀ λ, Φ), G(z⁺) = G(z) + ∂G(½(z + z⁺)) Δz
        // + O(Δ³): the same residual, the matrix half a step ahead.
        s.step.dq = s.work.x.head(n) / 2;
        advance(s.q, s.step.dq);
        if (beyond_a_kink(s, s.q)) {
            s.q = s.step.before;
        } else {
            s.step.lambda_half = s.lambda + s.work.x.tail(m) / 2;
            if (const Outcome outcome = factorise_at(s, s.q, s.step.lambda_half);
                outcome != Outcome::converged)
                return outcome;
            s.q = s.step.before;
            back_substitute(s);
            const double change = (s.work.x.head(n) - 2 * s.step.dq)
                                      .cwiseProduct(s.system.weight.head(n))
                                      .squaredNorm();
            if (disagree(s, change, size_of_solution(s), 0)) return Outcome::diverged;
        }
    }
    s.lambda += s.work.x.tail(m);
    s.step.dq = s.work.x.head(n);
    if (!s.work.x.allFinite()) return Outcome::not_finite;
    if (has_diverged(s)) return Outcome::diverged;
    advance(s.q, s.step.dq);
    const bool kinked = pass_kinks(s);
    if (method.solve == Consistent::Solve::corrected && !kinked) {
        residual_at(s, s.q, s.lambda);
        back_substitute(s);
        if (!s.work.x.allFinite()) return Outcome::not_finite;
        if (disagree(s, size_of_solution(s), s.step.last.squaredNorm(), 0))
            return Outcome::diverged;
        s.step.dq = s.work.x.head(n);
        advance(s.q, s.step.dq);
        s.lambda += s.work.x.tail(m);
        pass_kinks(s);
    }
    s.a = next.a;
    return Outcome::converged;
}

}  // namespace elastocheck::recursive
