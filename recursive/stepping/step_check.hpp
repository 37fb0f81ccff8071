// Checks that a long step stayed on the branch.
// Newton's method at its end may converge to another branch while the determinant keeps its sign.
#pragma once

#include "recursive/stepping/continuation.hpp"

namespace elastocheck::recursive {

template <class Real>
bool any_turned_over(const Model& model, const State<Real>& from, const State<Real>& to) {
    return std::ranges::any_of(model.elastics, [&](const auto& element) {
        return std::visit([&](const auto& e) { return turned_over(e, from, to); }, element.kind);
    });
}

// The chord between the nodes agrees with the tangents at its ends, and no element has reversed.
template <class Real>
bool is_straight(const SteppingState<Real>& s, const Going<Real>& going, const Node<Real>& from,
                 const Node<Real>& to) {
    Vector<Real> chord(s.n());
    for (BodyId b = 0; b < from.q.bodies(); ++b) {
        const Matrix3<Real> turned = to.q[b].A * from.q[b].A.transpose();
        chord.template segment<3>(6 * b) = to.q[b].r - from.q[b].r;
        chord.template segment<3>(6 * b + 3) = logarithm<Real>(turned);
    }
    const Vector<Real> mean = (to.p - from.p) / 2 * (from.dq + to.dq);
    // allowed distance of the chord from the mean tangent, as a fraction
    constexpr Real straight = Real(0.25);
    return share<Real>(going, chord - mean) <= straight * share<Real>(going, chord) + 1 &&
           !any_turned_over(s.model, from.q, to.q);
}

}  // namespace elastocheck::recursive
