// Checks that a long step stayed on the branch.
// Newton's method at its end may converge to another branch while the determinant keeps its sign.
#pragma once

#include "recursive/stepping/continuation.hpp"

namespace elastocheck::recursive {

// Whether an element has reversed within the step. A spring that points the other way has passed
// through zero length, a bushing with reversed rotation through half a turn. The force jumps there,
// and Newton's method converges beyond the jump.
template <class Real>
bool reversed(const AxialSpring& e, const State<Real>& from, const State<Real>& to) {
    return !(deformation<Real>(e, from).D.dot(deformation<Real>(e, to).D) > 0);
}
template <class Real>
bool reversed(const Bushing& e, const State<Real>& from, const State<Real>& to) {
    constexpr Real quarter = 1.5;  // about a quarter of a turn [rad]
    const Vector3<Real> before = deformation<Real>(e, from).theta(),
                        after = deformation<Real>(e, to).theta();
    return before.norm() > quarter && after.norm() > quarter && !(before.dot(after) > 0);
}
template <class Real>
bool any_reversed(const Model& model, const State<Real>& from, const State<Real>& to) {
    return std::ranges::any_of(model.elastics, [&](const auto& element) {
        return std::visit([&](const auto& e) { return reversed(e, from, to); }, element.kind);
    });
}

// The chord between the nodes agrees with the tangents at its ends, and no element has reversed.
template <class Real>
bool is_straight(const SteppingState<Real>& s, const ContinuationSettings<Real>& settings,
                 const Node<Real>& from, const Node<Real>& to) {
    Vector<Real> chord(s.n());
    for (BodyId b = 0; b < from.q.bodies(); ++b) {
        const Matrix3<Real> turned = to.q[b].A * from.q[b].A.transpose();
        chord.template segment<3>(6 * b) = to.q[b].r - from.q[b].r;
        chord.template segment<3>(6 * b + 3) = logarithm<Real>(turned);
    }
    const Vector<Real> mean = (to.p - from.p) / 2 * (from.dq + to.dq);
    // allowed distance of the chord from the mean tangent, as a fraction
    constexpr Real straight = Real(0.25);
    return share<Real>(settings, chord - mean) <= straight * share<Real>(settings, chord) + 1 &&
           !any_reversed(s.model, from.q, to.q);
}

}  // namespace elastocheck::recursive
