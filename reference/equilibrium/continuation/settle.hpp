// Homotopies from the design pose to the equilibrium at a = 0.
//
// Each follows E(x; 0, held) = held · E(design) from held = 1, where the design pose is a solution,
// to held = 0. No single homotopy always succeeds: with dead forces and moments as E(design), a
// body may become unstable on the way, or the path may turn back. So four are tried in this order
// until one ends at a stable equilibrium:
//
//   held bodies      dead forces and moments balance every body in the design pose
//   joint reactions  least-norm reactions with the least imbalance; the rest as above
//   growing forces   loads grow as 1 - held; held · (design forces of the elements) is subtracted
//                    from the forces of the elements, in their own axes
//   on springs       as before, and every body is on a spring to the ground of stiffness
//                    held · (F / L, F L): for a motion that only a growing weight stabilises
//
// In each of them the constraints close as Φ = held · Φ(design).
#pragma once

#include "reference/equilibrium/continuation/continuation.hpp"

namespace elastocheck::reference::equilibrium {

// Settles at a = 0, ready for a branch whose points extend to `reach`. Returns the failure of the
// first homotopy if all fail.
// Pre: `continuation` is at its start, on `system`.
std::optional<Failure> settle(Continuation& continuation, System& system, double reach);

}  // namespace elastocheck::reference::equilibrium
