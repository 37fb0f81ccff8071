// Settling: homotopy from the design position to the equilibrium at the start of the branch.
// t goes from 0 to 1 (stepping_state.hpp), under preloads, static loads, start values of drivers
// and joints that are open at the design position.
#pragma once

#include "recursive/stepping/continuation.hpp"
#include "recursive/stepping/steps.hpp"

namespace elastocheck::recursive {

// Whether no driver moves the start, so that a design position in equilibrium is the start.
inline bool starts_as_drawn(const Branch& branch) {
    return std::ranges::all_of(branch.drivers,
                               [](const Driver& driver) { return driver.start == 0; });
}

// Whether the forces load an idle mode, tested at the design position, where the modes
// are most accurate.
bool loads_idle_mode(const SteppingState& s);

// Outcome of settling that ended with `outcome`: inconsistent_constraints where joints that were
// open at the design position still have more than `share` of their gap, since that explains other
// failures.
Outcome settled(const SteppingState& s, Outcome outcome, double share);

// Settles with the stiffness of (19): in one step where the design position is an equilibrium,
// which gives λ⁻¹; else in `steps` steps, as on the branch.
Outcome settle(SteppingState& s, const Linear& method, int steps);

// Settles with the consistent tangent and the true forces: variable steps, each halved until
// accepted, and Newton corrections down to round-off at the end.
Outcome settle(SteppingState& s);

}  // namespace elastocheck::recursive
