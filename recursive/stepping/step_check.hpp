// Checks that a long step stayed on the branch.
// Newton's method at its end may converge to another branch while the determinant keeps its sign.
#pragma once

#include "recursive/stepping/continuation.hpp"

namespace elastocheck::recursive {

// Whether an element has reversed within the step. A spring that points the other way has passed
// through zero length, a bushing with reversed rotation through half a turn. The force jumps there,
// and Newton's method converges beyond the jump.
inline bool reversed(const AxialSpring& e, const State<double>& from, const State<double>& to) {
    return !(deformation<double>(e, from).D.dot(deformation<double>(e, to).D) > 0);
}
inline bool reversed(const Bushing& e, const State<double>& from, const State<double>& to) {
    constexpr double quarter = 1.5;  // about a quarter of a turn [rad]
    const Vector3<double> before = deformation<double>(e, from).theta(),
                          after = deformation<double>(e, to).theta();
    return before.norm() > quarter && after.norm() > quarter && !(before.dot(after) > 0);
}
inline bool any_reversed(const Model& model, const State<double>& from, const State<double>& to) {
    return std::ranges::any_of(model.elastics, [&](const auto& element) {
        return std::visit([&](const auto& e) { return reversed(e, from, to); }, element.kind);
    });
}

// The chord between the nodes agrees with the tangents at its ends, and no element has reversed.
bool is_straight(const SteppingState& s, const ContinuationSettings& settings, const Node& from,
                 const Node& to);

}  // namespace elastocheck::recursive
