// Event location at the knots of force curves: steps that end on a knot.
//
// A step uses one polynomial piece of every curve and continues it beyond its ends if needed
// (law.hpp), so the equations of the step are smooth and its error estimate is valid. Where a
// deflection x(p) reaches the end of its piece within the step, the step is shortened to end there:
//
//   location   x is interpolated by a cubic through four points of the step, first of the
//              predictor, then of the accepted step; its first root is the starting value for
//   landing    p ← p + (knot - x) / x', with the node corrected along z', until x equals the knot
//              to a millionth of the tolerance
//
// The next step uses the adjacent piece and the derivative of the path on that side.
#pragma once

#include "recursive/stepping/continuation.hpp"

namespace elastocheck::recursive {

// Distance within which a deflection counts as lying on the knot, on either side [m] or [rad].
template <class Real>
Real slack(const Going<Real>& going, const CurvePlace& at) {
    return Real(1e-6) * (at.angle ? going.angle_tolerance : going.length_tolerance);
}

template <class Real>
Piece& piece_of(SteppingState<Real>& s, const CurvePlace& at) {
    return s.inputs.rest[at.element].piece[at.axis];
}

// First knot reached between two nodes: its curve, the end of the piece, and the fraction of the
// step.
template <class Real>
struct KnotCrossing {
    const CurvePlace* curve = nullptr;  // nullptr: no knot is reached
    int side = 0;                       // -1 at the lower end of the piece, +1 at the upper
    Real t = 2;
    Real knot = 0;
};

// x(t) through x(0), x(⅓), x(⅔), x(1).
template <class Real>
Real cubic(const std::array<Real, 4>& x, Real t) {
    const Real a = 3 * t, b = a - 1, c = a - 2, d = a - 3;
    return -x[0] * b * c * d / 6 + x[1] * a * c * d / 2 - x[2] * a * b * d / 2 +
           x[3] * a * b * c / 6;
}

// First knot reached in the step of size h from `from`; `at(t, q)` fills q at the fraction t of the
// step.
template <class Real, class BranchSide>
KnotCrossing<Real> first_meeting(SteppingState<Real>& s, const Going<Real>& going, Real from,
                                 Real h, State<Real>& q, BranchSide&& at) {
    for (int k = 0; k < 4; ++k) {
        const Real t = static_cast<Real>(k) / 3;
        at(t, q);
        go_to(s, going.place(from + t * h));
        for (std::size_t c = 0; c < s.curves.size(); ++c)
            s.along[c][static_cast<std::size_t>(k)] =
                deflection<Real>(s.model, s.inputs, q, s.curves[c]);
    }
    constexpr int samples = 24;
    KnotCrossing<Real> first;
    for (std::size_t c = 0; c < s.curves.size(); ++c) {
        const CurvePlace& place = s.curves[c];
        const auto& knots = place.curve->knots;
        const auto piece = static_cast<std::size_t>(piece_of(s, place));
        const auto& x = s.along[c];
        const auto look = [&](double knot_at, int side) {
            const Real knot = static_cast<Real>(knot_at);
            const auto beyond = [&](Real t) {
                return static_cast<Real>(side) * (cubic(x, t) - knot);
            };
            Real before = 0;
            for (int k = 1; k <= samples; ++k) {
                const Real t = static_cast<Real>(k) / samples;
                if (t >= first.t && before >= first.t) return;
                if (!(beyond(t) > slack(going, place))) {
                    before = t;
                    continue;
                }
                Real low = before, high = t;  // not beyond, beyond
                for (int halving = 0; halving < 40; ++halving) {
                    const Real middle = (low + high) / 2;
                    (beyond(middle) > 0 ? high : low) = middle;
                }
                if (high < first.t) first = {&place, side, high, knot};
                return;
            }
        };
        if (piece > 0) look(knots[piece - 1], -1);
        if (piece < knots.size()) look(knots[piece], +1);
    }
    return first;
}

// Moves `next`, an equilibrium near the knot with its derivative, onto the knot. Returns false
// where the iteration leaves the interval between the node at p and `limit`. The factors are those
// of `next`.
template <class Real>
bool land(SteppingState<Real>& s, const Going<Real>& going, const KnotCrossing<Real>& knot, Real p,
          Real limit, Node<Real>& next, State<Real>& q) {
    const CurvePlace& at = *knot.curve;
    const Real step = next.p - p;
    for (int k = 0; k < 5; ++k) {
        go_to(s, going.place(next.p));
        const Real x = deflection<Real>(s.model, s.inputs, next.q, at);
        if (std::abs(x - knot.knot) <= slack(going, at)) return true;
        const Real ahead = step * Real(1e-4);
        q = next.q;
        advance(q, ahead * next.dq);
        go_to(s, going.place(next.p + ahead));
        const Real rate = (deflection<Real>(s.model, s.inputs, q, at) - x) / ahead;
        const Real dp = (knot.knot - x) / rate;
        if (!(std::abs(dp) <= std::abs(step)) || !((next.p + dp - p) * step > 0) ||
            !((limit - next.p - dp) * step >= 0))
            return false;
        s.dq = dp * next.dq;
        advance(next.q, s.dq);
        next.lambda += dp * next.dlambda;
        next.p += dp;
        Real size = 0;
        if (correct(s, going, next.q, next.lambda, next.p, size) != Outcome::converged ||
            !(size <= Real(0.1)))
            return false;
        differentiate(s, going, next);
    }
    return false;
}

// The step of continuation.hpp from `node` to next.p on the present pieces, shortened to the first knot
// reached, which `met` returns. `between(node, next, t, q)` interpolates the accepted step.
template <class Real, class Between>
Trial<Real> step_to_knot(SteppingState<Real>& s, const Going<Real>& going, const Node<Real>& node,
                         const Vector<Real>& curvature, const Vector<Real>& lambda_curvature,
                         Node<Real>& next, State<Real>& q, KnotCrossing<Real>& met,
                         Between&& between) {
    met = {};
    if (s.curves.empty()) return try_step(s, going, node, curvature, lambda_curvature, next);
    const Real whole = next.p;
    KnotCrossing<Real> expected =
        first_meeting(s, going, node.p, whole - node.p, q, [&](Real t, State<Real>& at) {
            const Real h = t * (whole - node.p);
            s.dq = h * node.dq + h * h / 2 * curvature;
            at = node.q;
            advance(at, s.dq);
        });
    Real h = whole - node.p;
    Trial<Real> trial;
    for (int k = 0; k < 4; ++k) {
        next.p = expected.curve ? node.p + expected.t * h : whole;
        if (next.p == node.p) {  // the node lies on the knot and the step leaves the piece
            met = expected;
            return trial;
        }
        trial = try_step(s, going, node, curvature, lambda_curvature, next);
        if (trial.verdict != Verdict::believed) return trial;
        const bool landed = expected.curve && land(s, going, expected, node.p, whole, next, q);
        if (expected.curve && !landed && k == 0) {  // the path misses the knot of the predictor
            expected = {};
            continue;
        }
        h = next.p - node.p;
        const KnotCrossing<Real> earlier = first_meeting(
            s, going, node.p, h, q, [&](Real t, State<Real>& at) { between(node, next, t, at); });
        if (!earlier.curve) {
            if (landed) met = expected;
            return trial;
        }
        expected = earlier;
    }
    trial.verdict = Verdict::unsolved;
    return trial;
}

// Selects for every curve the piece that the path follows from the node on: the piece of its
// deflection or, on a knot, the piece a little ahead.
template <class Real>
void take_pieces(SteppingState<Real>& s, const Going<Real>& going, const Node<Real>& node,
                 Real ahead, State<Real>& q) {
    q = node.q;
    s.dq = ahead * node.dq;
    advance(q, s.dq);
    for (const CurvePlace& at : s.curves) {
        go_to(s, going.place(node.p));
        const Real x = deflection<Real>(s.model, s.inputs, node.q, at);
        go_to(s, going.place(node.p + ahead));
        const bool rises = deflection<Real>(s.model, s.inputs, q, at) > x;
        const auto& knots = at.curve->knots;
        Piece piece = piece_at(*at.curve, x);
        for (std::size_t k = 0; k < knots.size(); ++k)
            if (std::abs(x - static_cast<Real>(knots[k])) <= slack(going, at))
                piece = static_cast<Piece>(rises ? k + 1 : k);
        piece_of(s, at) = piece;
    }
    go_to(s, going.place(node.p));
}

}  // namespace elastocheck::recursive
