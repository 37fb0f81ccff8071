#include "recursive/stepping/event_location.hpp"

namespace elastocheck::recursive {

void interpolate(const Node& from, const Node& to, double t, State<double>& q,
                 Vector<double>& lambda) {
    const double h = to.p - from.p;
    // Hermite basis; h00 = 1 - h01 acts on no difference from the start
    const double h01 = t * t * (3 - 2 * t), h10 = t * (1 - t) * (1 - t) * h,
                 h11 = t * t * (t - 1) * h;
    lambda = from.lambda + h01 * (to.lambda - from.lambda) + h10 * from.dlambda + h11 * to.dlambda;
    for (BodyId b = 0; b < from.q.bodies(); ++b) {
        const auto d0 = from.dq.segment<6>(6 * b), d1 = to.dq.segment<6>(6 * b);
        const Matrix3<double> rotation = to.q[b].A * from.q[b].A.transpose();
        const Vector3<double> pi = logarithm<double>(rotation);
        const Vector3<double> pi1 = inverse_left_jacobian<double>(pi) * d1.tail<3>();
        q[b].r =
            from.q[b].r + h01 * (to.q[b].r - from.q[b].r) + h10 * d0.head<3>() + h11 * d1.head<3>();
        const Vector3<double> pi_t = h01 * pi + h10 * d0.tail<3>() + h11 * pi1;
        q[b].p = (exponential<double>(pi_t) * from.q[b].p).normalized();
        q[b].A = q[b].p.toRotationMatrix();
    }
}

namespace {

// Distance within which a deflection counts as lying on the knot, on either side [m] or [rad].
double knot_tolerance(const ContinuationSettings& settings, const CurvePlace& curve) {
    return 1e-6 * (curve.angle ? settings.angle_tolerance : settings.length_tolerance);
}

// x(t) through x(0), x(⅓), x(⅔), x(1).
double cubic(const std::array<double, 4>& x, double t) {
    const double a = 3 * t, b = a - 1, c = a - 2, d = a - 3;
    return -x[0] * b * c * d / 6 + x[1] * a * c * d / 2 - x[2] * a * b * d / 2 +
           x[3] * a * b * c / 6;
}

// First knot reached in the step of size h from `from`; `set_state(t, q)` sets q to the state at the
// fraction t of the step. Each deflection is interpolated by a cubic in t; its first sample beyond the
// knot brackets the crossing, which bisection locates.
template <class SetState>
KnotCrossing first_crossing(SteppingState& s, const ContinuationSettings& settings, double from,
                            double h, State<double>& q, SetState&& set_state) {
    for (int k = 0; k < 4; ++k) {
        const double t = static_cast<double>(k) / 3;
        set_state(t, q);
        go_to(s, settings.at(from + t * h));
        for (std::size_t c = 0; c < s.kinks.curves.size(); ++c)
            s.kinks.deflections[c][static_cast<std::size_t>(k)] =
                deflection(s.model, s.inputs, q, s.kinks.curves[c]);
    }
    constexpr int samples = 24, halvings = 40;
    KnotCrossing first;
    for (std::size_t c = 0; c < s.kinks.curves.size(); ++c) {
        const CurvePlace& place = s.kinks.curves[c];
        const auto& knots = place.curve->knots;
        const auto piece = static_cast<std::size_t>(piece_of(s, place));
        const auto& x = s.kinks.deflections[c];
        const auto search = [&](double knot, int side) {
            const auto beyond = [&](double t) { return side * (cubic(x, t) - knot); };
            double inside = 0;  // last sample not beyond the knot
            for (int k = 1; k <= samples; ++k) {
                const double t = static_cast<double>(k) / samples;
                if (t >= first.t && inside >= first.t) return;
                if (!(beyond(t) > knot_tolerance(settings, place))) {
                    inside = t;
                    continue;
                }
                double low = inside, high = t;  // not beyond, beyond
                for (int halving = 0; halving < halvings; ++halving) {
                    const double middle = (low + high) / 2;
                    (beyond(middle) > 0 ? high : low) = middle;
                }
                if (high < first.t) first = {&place, side, high, knot};
                return;
            }
        };
        if (piece > 0) search(knots[piece - 1], -1);
        if (piece < knots.size()) search(knots[piece], +1);
    }
    return first;
}

// Moves stride.next, an equilibrium near the knot with its derivative, onto the knot. Returns false
// where the iteration leaves the interval between the node and `limit`. The factors are those of
// `next`.
bool move_to_knot(SteppingState& s, const ContinuationSettings& settings, const KnotCrossing& knot,
                  double limit, Stride& stride) {
    const CurvePlace& place = *knot.curve;
    Node& next = stride.next;
    const double p = stride.node.p, step = next.p - p;
    constexpr int max_corrections = 5;  // secant steps
    for (int k = 0; k < max_corrections; ++k) {
        go_to(s, settings.at(next.p));
        const double x = deflection(s.model, s.inputs, next.q, place);
        if (std::abs(x - knot.knot) <= knot_tolerance(settings, place)) return true;
        const double ahead = step * 1e-4;
        stride.q = next.q;
        advance(stride.q, ahead * next.dq);
        go_to(s, settings.at(next.p + ahead));
        const double rate = (deflection(s.model, s.inputs, stride.q, place) - x) / ahead;
        const double dp = (knot.knot - x) / rate;
        if (!(std::abs(dp) <= std::abs(step)) || !((next.p + dp - p) * step > 0) ||
            !((limit - next.p - dp) * step >= 0))
            return false;
        s.step.dq = dp * next.dq;
        advance(next.q, s.step.dq);
        next.lambda += dp * next.dlambda;
        next.p += dp;
        double size = 0;
        if (correct(s, settings, next.q, next.lambda, next.p, size) != Outcome::converged ||
            !(size <= 0.1))
            return false;
        differentiate(s, settings, next);
    }
    return false;
}

}  // namespace

Trial step_to_knot(SteppingState& s, const ContinuationSettings& settings, Stride& stride,
                   KnotCrossing& met) {
    const Node& node = stride.node;
    Node& next = stride.next;
    const auto &curvature = stride.curvature, &lambda_curvature = stride.lambda_curvature;
    met = {};
    if (s.kinks.curves.empty())
        return try_step(s, settings, node, curvature, lambda_curvature, next);
    const double requested = next.p;
    KnotCrossing expected = first_crossing(s, settings, node.p, requested - node.p, stride.q,
                                           [&](double t, State<double>& q) {
                                               const double h = t * (requested - node.p);
                                               s.step.dq = h * node.dq + h * h / 2 * curvature;
                                               q = node.q;
                                               advance(q, s.step.dq);
                                           });
    double h = requested - node.p;
    Trial trial;
    for (int k = 0; k < 4; ++k) {
        next.p = expected.curve ? node.p + expected.t * h : requested;
        if (next.p == node.p) {  // the node lies on the knot and the step leaves the piece
            met = expected;
            return trial;
        }
        trial = try_step(s, settings, node, curvature, lambda_curvature, next);
        if (trial.verdict != Verdict::accepted) return trial;
        const bool at_knot =
            expected.curve && move_to_knot(s, settings, expected, requested, stride);
        if (expected.curve && !at_knot && k == 0) {  // the path misses the knot of the predictor
            expected = {};
            continue;
        }
        h = next.p - node.p;
        const KnotCrossing earlier = first_crossing(
            s, settings, node.p, h, stride.q,
            [&](double t, State<double>& q) { interpolate(node, next, t, q, stride.lambda); });
        if (!earlier.curve) {
            if (at_knot) met = expected;
            return trial;
        }
        expected = earlier;
    }
    trial.verdict = Verdict::unsolved;
    return trial;
}

void take_pieces(SteppingState& s, const ContinuationSettings& settings, const Node& node,
                 double ahead, State<double>& q) {
    q = node.q;
    s.step.dq = ahead * node.dq;
    advance(q, s.step.dq);
    for (const CurvePlace& place : s.kinks.curves) {
        go_to(s, settings.at(node.p));
        const double x = deflection(s.model, s.inputs, node.q, place);
        go_to(s, settings.at(node.p + ahead));
        const bool rises = deflection(s.model, s.inputs, q, place) > x;
        const auto& knots = place.curve->knots;
        Piece piece = piece_at(*place.curve, x);
        for (std::size_t k = 0; k < knots.size(); ++k)
            if (std::abs(x - knots[k]) <= knot_tolerance(settings, place))
                piece = static_cast<Piece>(rises ? k + 1 : k);
        piece_of(s, place) = piece;
    }
    go_to(s, settings.at(node.p));
}

bool find_sides(const Model& model, const Inputs<double>& inputs, const State<double>& q,
                const std::vector<CurvePlace>& curves, std::vector<int>& sides) {
    bool changed = false;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const auto& kinks = curves[c].kinks;
        if (kinks.empty()) continue;
        const double x = deflection(model, inputs, q, curves[c]);
        const auto side = static_cast<int>(
            std::count_if(kinks.begin(), kinks.end(), [&](double kink) { return kink <= x; }));
        changed = changed || side != sides[c];
        sides[c] = side;
    }
    return changed;
}

}  // namespace elastocheck::recursive
