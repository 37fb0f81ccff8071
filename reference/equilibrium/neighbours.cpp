#include "reference/equilibrium/neighbours.hpp"

#include <limits>
#include <stdexcept>

#include "reference/equilibrium/state_tangent.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

// The system of a neighbour in the scales of `of`.
System in_scales_of(const System& of, const Model& model, double a) {
    System system = make_system(model, model.branches.front(), {&a, 1});
    if (system.equations() != of.equations())
        throw std::invalid_argument("a neighbour has other parts than the model");
    system.centre = of.centre;
    system.length = of.length;
    system.force = of.force;
    return system;
}

}  // namespace

std::vector<NeighbourStates> neighbour_states(const Model& model, const Branch& branch,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils) {
    Orders none;
    const StateTangent tangent = tangent_at(model, branch, state, none);
    if (tangent.outcome != Outcome::converged)
        return {stencils.size(), NeighbourStates{tangent.outcome, tangent.what, {}}};
    const Eigen::VectorXd own_residual = residual(tangent.system, tangent.loading, tangent.x);
    const double rounding = last_digits * largest_entry(tangent.at.J);
    std::vector<NeighbourStates> neighbours;
    for (const Neighbours& stencil : stencils) {
        NeighbourStates& result = neighbours.emplace_back();
        std::vector<System> systems;
        Eigen::VectorXd E_rate = Eigen::VectorXd::Zero(own_residual.size());
        for (const Neighbour& k : stencil) {
            systems.push_back(in_scales_of(tangent.system, *k.model, state.load));
            E_rate +=
                k.weight * (residual(systems.back(), tangent.loading, tangent.x) - own_residual);
        }
        const Solved solved = solve_at_state(tangent, E_rate, rounding * amplification(stencil));
        if (solved.outcome != Outcome::converged) {
            result.outcome = solved.outcome;
            result.detail = solved.what;
            continue;
        }
        // Chord method: Newton steps for the equations of the neighbour with the factors of the
        // state, and one more step once they are small. Second-order terms need not be in the range
        // of J.
        constexpr double not_judged = std::numeric_limits<double>::infinity();
        for (const System& system : systems) {
            Eigen::VectorXd x = tangent.x;
            double first = 0, first_reactions = 0, size = 0;
            bool converged = false, last = false;
            for (int step = 0; step < chord_steps && !last; ++step) {
                last = converged;
                const Solved by = solve_at_state(
                    tangent, residual(system, tangent.loading, x) - own_residual, not_judged);
                if (by.outcome != Outcome::converged) break;
                x = moved(system, x, by.dx);
                size = pose_size(system, by.dx);
                const auto m = system.constraint_rows;
                const double reactions = by.dx.tail(m).norm();
                if (step == 0) {
                    first = size;
                    first_reactions = reactions;
                }
                converged =
                    size <= chord_met * first &&
                    reactions <= chord_met * first_reactions + chord_reactions * x.tail(m).norm();
            }
            result.settled = result.settled && (converged || size <= chord_rounding);
            result.states.push_back(state_of(system, tangent.loading, x));
        }
    }
    return neighbours;
}

}  // namespace elastocheck::reference::equilibrium
