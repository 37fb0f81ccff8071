#include "reference/equilibrium/continuation/settle.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

// Reactions of least norm with the least imbalance at the design pose; E is linear in them.
void balance_by_reactions(System& system, Counts& counts) {
    const Eigen::Index n = 6 * system.bodies, m = system.constraint_rows;
    if (n == 0 || m == 0 || !system.at_design.allFinite()) return;
    const Sparse J = derivatives(system, {0, 1}, design_unknowns(system), counts).J;
    if (!is_finite(J)) return;
    system.carried -= least_squares(J.topRightCorner(n, m), system.at_design.head(n));
    system.at_design = held_at_design(system);
}

void grow_forces(System& system) {
    for (std::size_t e = 0; e < system.elements.size(); ++e)
        system.elements[e].stored = stored_at_design(system, e);
    system.grows = true;
    system.carried.setZero();
    system.at_design = held_at_design(system);
}

// The additional terms change the sparsity pattern of J.
void put_on_springs(System& system) {
    system.hold = 1;
    system.pattern.reset();
}

}  // namespace

std::optional<Failure> settle(Continuation& continuation, System& system, double reach) {
    const auto settles = [&] {
        auto failed = advance(continuation, 1);
        return failed ? failed : begin_branch(continuation, reach);
    };
    const auto failed = settles();
    if (!failed) return failed;
    balance_by_reactions(system, continuation.counts);
    restart(continuation);
    if (!settles()) return std::nullopt;
    grow_forces(system);
    restart(continuation);
    if (!settles()) return std::nullopt;
    put_on_springs(system);
    restart(continuation);
    if (!settles()) return std::nullopt;
    return failed;
}

}  // namespace elastocheck::reference::equilibrium
