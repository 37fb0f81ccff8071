// Whether a branch goes on as far as it is asked for: what K of (19) cannot see, and a method that steps along it steps
// over.
//
// The true branch is followed ahead of the method by a few long tangents (walk.hpp): steps of a quarter of the way at
// most, each corrected to an equilibrium, believed where the corrections are small beside the step, the determinant of
// the consistent matrix keeps its sign and the chord agrees with the tangents at its ends; and at the end no stiffness is
// negative (stiffness.hpp, inertia.hpp), nor is one where it begins. That is a handful of factorisations. Where a step is not believed however it is halved,
// `adaptive` goes the same way with all its care, and its word is taken: the method ends where the branch does.
#pragma once

#include <optional>

#include "recursive/solve.hpp"

namespace elastocheck::recursive {

// Where the branch ends: limit_point, dividing_point, singular or branch_lost, at this value of its parameter.
struct Event {
    Outcome outcome = Outcome::singular;
    double load = 0;               // NaN: while what is held at its start settles
    bool begins_unstable = false;  // what settles there
};

// Looked for with all care; none where `adaptive` comes through, or fails for another reason.
std::optional<Event> find_event(const Model& model, const Branch& branch, const Analysis& analysis);

// None where the few tangents come through, else that; or how settling ended.
std::optional<Event> watch(const Model& model, const Branch& branch, const Analysis& analysis);

}  // namespace elastocheck::recursive
