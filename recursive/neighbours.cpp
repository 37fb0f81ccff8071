#include "recursive/neighbours.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "recursive/diagnosis/analysis.hpp"
#include "recursive/linear_response.hpp"
#include "recursive/response_system.hpp"

namespace elastocheck::recursive {
namespace {

constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

struct Residual {
    Inputs<double> inputs;
    Vector<double> upper, lower;  // f_ext - f_elast - Φ_qᵀ λ, -Φ
};
Residual residual_of(const Model& model, const Branch& branch, double a, const State<double>& q,
                     const Vector<double>& lambda) {
    Residual at{inputs_at<double>(model, branch, a), {}, {}};
    Vector<double> force = Vector<double>::Zero(coordinates(model));
    at.upper = force;
    at.lower = Vector<double>::Zero(constraint_rows(model));
    external_force<double>(model, branch, at.inputs, q, at.upper);
    elastic_force<double>(model, at.inputs, q, force);
    at.upper -= force;
    constraint_force<double>(model, at.inputs, q, lambda, force, at.lower);
    at.upper -= force;
    at.lower = -at.lower;
    return at;
}

std::string failure_text(Outcome outcome, const Diagnosis& diagnosis) {
    switch (outcome) {
        case Outcome::loaded_idle_mode:
            return "the number loads a motion that no joint or element resists: " +
                   idle_modes(diagnosis);
        case Outcome::inconsistent_constraints:
            return "redundant joints close at this value of the number only";
        case Outcome::not_finite: return "the derivative is not finite";
        default: return "the tangent is singular at the state";
    }
}

// Σ w_k ΔG_k into s.work.upper and s.work.lower. Points and lengths that change together keep a row
// closed: what is left is rounding.
void difference(SteppingState& s, double a, const Residual& here, const Neighbours& stencil) {
    s.work.upper.setZero();
    s.work.lower.setZero();
    for (const Neighbour& k : stencil) {
        const Residual there = residual_of(*k.model, k.model->branches.front(), a, s.q, s.lambda);
        s.work.upper += k.weight * (there.upper - here.upper);
        s.work.lower += k.weight * (there.lower - here.lower);
    }
    const double rounding = last_digits * (1 + reach(s.q)) * amplification(stencil);
    for (double& row : s.work.lower)
        if (std::abs(row) <= rounding) row = 0;
}

}  // namespace

std::vector<NeighbourStates> neighbour_states(const Model& model, const Branch& branch,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils,
                                              const Analysis& analysis) {
    check(model, branch);
    if (state.poses.size() != model.bodies.size())
        throw std::invalid_argument("the state belongs to another model");
    SteppingState s(model, branch, analysis);
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    ResponseOrders orders;
    const Outcome ready = std::isnan(analysis.diagnosis.constraint_error)
                              ? Outcome::not_finite
                              : factorise_response(s, true, orders);
    if (ready != Outcome::converged)
        return {stencils.size(),
                NeighbourStates{ready, failure_text(ready, analysis.diagnosis), {}}};
    const Residual residual = residual_of(model, branch, state.load, s.q, s.lambda);
    const double stiffest = *std::ranges::max_element(s.system.M.values, {},
                                                      [](double x) { return std::abs(x); }),
                 rounding = last_digits * stiffest * s.setup.length;
    std::vector<NeighbourStates> neighbours;
    for (const Neighbours& stencil : stencils) {
        NeighbourStates& result = neighbours.emplace_back();
        difference(s, state.load, residual, stencil);
        result.outcome =
            solve_response(s, CheckedDirections::all, rounding * amplification(stencil));
        if (result.outcome != Outcome::converged) {
            result.detail = failure_text(result.outcome, analysis.diagnosis);
            continue;
        }
        // Chord method: Newton steps for the equations of the neighbour with the factors of the
        // state, and one more step once they are small.
        for (const Neighbour& k : stencil) {
            State<double> q = s.q;
            Vector<double> lambda = s.lambda;
            double first = 0, first_reactions = 0;
            bool converged = false, last = false;
            for (int step = 0; step < chord_steps && !last; ++step) {
                last = converged;
                const Residual there =
                    residual_of(*k.model, k.model->branches.front(), state.load, q, lambda);
                s.work.upper = there.upper - residual.upper;
                s.work.lower = there.lower - residual.lower;
                (void)solve_response(s, CheckedDirections::none);
                advance(q, s.work.x.head(s.n()));
                lambda += s.work.x.tail(s.m());
                const double size = std::sqrt(size_of_solution(s)),
                             reactions = s.work.x.tail(s.m()).norm();
                if (step == 0) {
                    first = size;
                    first_reactions = reactions;
                }
                converged =
                    size <= chord_met * first &&
                    reactions <= chord_met * first_reactions + chord_reactions * lambda.norm();
            }
            Equilibrium& there = result.states.emplace_back(state);
            const auto inputs = inputs_at<double>(*k.model, k.model->branches.front(), state.load);
            record(*k.model, inputs, q, {lambda, q}, there);
        }
    }
    return neighbours;
}

}  // namespace elastocheck::recursive
