// Detects limit and bifurcation points that K of (19) misses and fixed steps skip.
//
// Before the method runs, the true branch is followed by a few long predictor-corrector
// steps (continuation.hpp) of at most a quarter of the branch, each corrected to an
// equilibrium. A step is accepted if the corrections are small compared with the step, the
// determinant of the consistent matrix keeps its sign, and the chord agrees with the
// tangents at its ends. No stiffness may be negative at the start and at the end of the
// branch (stiffness.hpp, stability.hpp).
//
// These tests do not detect stability that is lost inside a step and regained before its end. The
// determinant is therefore evaluated at the midpoint of the first and the last step and of the two
// steps at a node where it has a minimum, and from there to its lowest value (stability.hpp). Where
// it changes its sign or nearly vanishes, and where a tried step ends unstable, bisection locates
// the point. An unstable interval is missed if it is so short that these values of the determinant
// show no dip; no minimum length is guaranteed.
//
// The cost is about fifteen factorisations. If a step is rejected at every length, or stability is
// lost, `adaptive` follows the same branch. The method then ends where `adaptive` ends, or where
// bisection found the loss of stability, whichever comes first. Where redundant joints become
// inconsistent and `adaptive` gives up, it ends before the long step that shows it.
#pragma once

#include <optional>
#include <string>

#include "elastocheck/recursive.hpp"

namespace elastocheck::recursive {

// End of the branch at this parameter value: limit_point, bifurcation_point, singular, branch_lost,
// inconsistent_constraints, or from settling loaded_idle_mode.
struct Event {
    Outcome outcome = Outcome::singular;
    double load = 0;                  // NaN: while settling to the start of the branch
    std::string unstable_start = {};  // as in SteppingState
};

// Follows the branch with `adaptive`; none where `adaptive` reaches the end or fails
// for another reason.
std::optional<Event> find_event(const Model& model, const Branch& branch, const Analysis& analysis);

// Follows the branch by few long steps. None if they reach its end and it stays stable; else the
// failure of settling, the result of find_event(), or the loss of stability found by bisection.
std::optional<Event> watch(const Model& model, const Branch& branch, const Analysis& analysis);

}  // namespace elastocheck::recursive
