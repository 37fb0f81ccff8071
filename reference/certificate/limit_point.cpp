// Certifies a limit point: a is an unknown, and the curve of equilibria is parametrised by σ along
// its tangent t,
//
//   E(z; a) + U μ = 0,   gᵀ (z - z_g) = 0,   tᵀ (y - ỹ) = σ,     y = (z, μ, a)
//
// One box that contracts for every σ in [-δ, δ] contains one equilibrium y(σ) at each: a curve. Its
// derivative dy/dσ solves F' dy/dσ = e, e the unit vector of the last row, so
//
//   |dy/dσ - Y e| ≤ |I - Y F'| |Y e| + |I - Y F'| |dy/dσ - Y e|      (the last term bounds itself)
//
// Where da/dσ has opposite signs at -δ and δ, a has its extremum between: the limit, which for a
// maximum is at least a(±δ) and at most the largest a of the box.
#include <fmt/format.h>

#include <optional>

#include "reference/certificate/certificate.hpp"
#include "reference/certificate/krawczyk.hpp"
#include "reference/certificate/state.hpp"

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Tangent v and gauge t = W v with tᵀ v = 1, W the weights of origins (1/L²) and quaternions (1).
// The length along v, in origins over L and quaternions, is σ = tᵀ (y - ỹ).
struct Tangent {
    VectorXd v, t;
};
Tangent normalised(const System& system, const VectorXd& along) {
    VectorXd weighted = VectorXd::Zero(along.size());
    for (int b = 0; b < system.bodies; ++b) {
        const int k = system.pose(b);
        weighted.segment<3>(k) = along.segment<3>(k) / (system.length * system.length);
        weighted.segment<4>(k + 3) = along.segment<4>(k + 3);
    }
    const double size = std::sqrt(weighted.dot(along));
    return {along / size, weighted / size};
}

// A point of the curve with its inverse, whose last column is a tangent.
struct CurvePoint {
    VectorXd y;
    MatrixXd Y;
    bool found = false;
    VectorXd v() const { return Y.col(Y.cols() - 1); }
    double slope() const { return Y(Y.rows() - 1, Y.cols() - 1); }  // da/dσ
};
CurvePoint point_on_curve(const Problem& problem) {
    Approximate point = newton(problem, problem.y_t, 0);
    return {std::move(point.y), inverse(point.J), point.settled};
}

// Secant method for da/dσ = 0 (`slope`), steps in σ. The point and tangent of the
// problem are updated.
constexpr double first_step = 1e-4, small_step = 1e-10, longest_step = 0.2;
CurvePoint turning_point(Problem& problem) {
    double slope = 0, step = 0;
    CurvePoint point = point_on_curve(problem);
    for (int iteration = 0; iteration < 40 && point.found; ++iteration) {
        problem.y_t = point.y;
        problem.t = normalised(problem.system, point.v()).t;
        point = point_on_curve(problem);
        if (!point.found) return point;
        const double new_slope = point.slope(), rate = step == 0 ? 0 : (new_slope - slope) / step;
        const double next = rate == 0 ? first_step : -new_slope / rate;
        if (new_slope == 0 || std::abs(next) < small_step) return point;
        slope = new_slope;
        step = std::clamp(next, -longest_step, longest_step);
        problem.y_t = point.y + step * point.v();
        point = point_on_curve(problem);
    }
    point.found = false;
    return point;
}

// Bounds of da/dσ over the box: the last entry of dy/dσ = Y e ± r.
struct SlopeBounds {
    double middle = 0, radius = std::numeric_limits<double>::infinity();
};
SlopeBounds slope_of_a(const MatrixXd& Y, const Contraction& rest) {
    const Index n = Y.rows();
    const VectorXd tangent = Y.col(n - 1);
    VectorXd r = rest(tangent.cwiseAbs()) * 1.01;
    r = r.cwiseMax(1e-300);
    for (int k = 0; k < 20; ++k) {
        const VectorXd next = (rest(tangent.cwiseAbs()) + rest(r)) * (1 + 1e-13);
        if (all_less(next, r * (1 + 1e-12)) || (next.array() <= r.array()).all())
            return {tangent[n - 1], next[n - 1] * (1 + 1e-12)};
        r = (next * 1.1).cwiseMax(r);
    }
    return {};
}

// Box ỹ ± r that contains y(σ) for every |σ| ≤ δ: |Y F(ỹ; σ)| + |I - Y F'(ỹ ± r)| r < r, F(ỹ; σ)
// over all these σ.
struct Segment {
    bool proved = false;
    VectorXd r;
    Contraction rest;
};
Segment segment(const Problem& problem, const VectorXd& y, const MatrixXd& Y, double delta) {
    Values<Interval> F = residual(problem, thin(y), Interval(0));
    F.E.back() += Interval(-delta, delta);
    const VectorXd defect = defect_bound(Y, F);
    Segment result;
    if (!defect.allFinite()) return result;
    // The box of a point (δ = 0) must fit into that of a segment, even where both are only
    // rounding.
    const double least = delta > 0 ? 1e-22 : 1e-25, wider = delta > 0 ? 1.3 : 1.01;
    VectorXd r = (defect * 1.5).cwiseMax(least);
    for (int trial = 0; trial < 8; ++trial) {
        result.rest = contraction(Y, evaluate(problem, box(y, r), Interval(0), Slopes::yes).J);
        if (!result.rest.finite) return result;
        VectorXd next = (defect * wider).cwiseMax(least);
        for (int k = 0; k < 3; ++k) next = ((defect + result.rest(next)) * wider).cwiseMax(least);
        if ((next.array() <= r.array()).all() &&
            all_less((defect + result.rest(next)) * (1 + 1e-14), next)) {
            result.r = next;
            result.proved = true;
            return result;
        }
        r = (2 * next).cwiseMax(r);
        if (!r.allFinite()) return result;
    }
    return result;
}

// The point of the segment at one end.
struct SegmentEnd {
    double sign = 0;  // of da/dσ
    Interval a;
};
// The end σ = `sigma` of the segment `curve` through `top`, |σ| < δ: a box of its own contains one
// equilibrium, which is that of the segment. Empty if this or the sign is not proved.
std::optional<SegmentEnd> segment_end(const Problem& problem, const CurvePoint& top,
                                      const Segment& curve, double delta, double sigma) {
    Problem at_end = problem;
    at_end.y_t = top.y + sigma * top.v();
    const CurvePoint end = point_on_curve(at_end);
    if (!end.found) return {};
    const Segment point = segment(at_end, end.y, end.Y, 0);
    if (!point.proved) return {};
    const Index n = problem.size();
    Interval sigma_of_point;
    for (Index i = 0; i < n; ++i)
        sigma_of_point +=
            Interval(problem.t[i]) * (around(end.y[i], point.r[i]) - Interval(top.y[i]));
    const bool on_segment = mag(sigma_of_point) <= delta && sigma_of_point.lo * sigma > 0 &&
                            sigma_of_point.hi * sigma > 0 &&
                            all_less(((end.y - top.y).cwiseAbs() + point.r) * (1 + 1e-14), curve.r);
    const SlopeBounds slope = slope_of_a(end.Y, point.rest);
    if (!on_segment || !(std::abs(slope.middle) > slope.radius)) return {};
    return SegmentEnd{slope.middle > 0 ? 1. : -1., around(end.y[n - 1], point.r[n - 1])};
}

// The problem with a among the unknowns at the state z, σ along its tangent there. Empty if the
// curve has no tangent.
std::optional<Problem> problem_along_curve(const System& system, const VectorXd& z, double a) {
    const Problem at_fixed_a{system, border_at(system, z, a, loose_zero_tolerance), z, false, {},
                             {}};
    const Index n = at_fixed_a.size() + 1;
    VectorXd y = VectorXd::Zero(n);
    y.head(system.n()) = z;
    const Values<double> values = evaluate(at_fixed_a, doubles(y.head(n - 1)), a, Slopes::yes);
    VectorXd along = VectorXd::Ones(n), right = VectorXd::Zero(n - 1);
    right.head(system.n()) = Eigen::Map<const VectorXd>(values.E_a.data(), system.n());
    along.head(n - 1) = -factors(middle(values.J)).solve(right);
    if (!along.allFinite() || along.head(n - 1).isZero(0)) return {};
    y[n - 1] = a;
    return Problem{system, at_fixed_a.border, z, true, normalised(system, along).t, y};
}

}  // namespace

LimitPoint certify_limit_point(const Model& model, const Branch& branch, const Equilibrium& state,
                               const Tolerance& tolerance) {
    LimitPoint limit;
    const auto open = [&](const std::string& why) {
        limit.detail = why;
        return limit;
    };
    const System system = make_system(model, branch);
    if (const auto why = why_not_tried(system, max_unknowns_of_curves); !why.empty())
        return open(why);
    const StateAt mapped = state_at(system, state);
    if (!mapped.z.allFinite() || !std::isfinite(state.load)) return open("the state is not finite");

    // 1. The limit point in floating point.
    std::optional<Problem> along_curve = problem_along_curve(system, mapped.z, state.load);
    if (!along_curve) return open("the curve has no tangent at the state");
    Problem& problem = *along_curve;
    const Index n = problem.size();
    const CurvePoint top = turning_point(problem);
    if (!top.found) return open("no limit point is found near the state");
    if (!check_border(problem, top.y, top.y[n - 1]).sound)
        return open(
            "a held motion or constraint is not idle or redundant at the limit point, is loaded, "
            "or has a gap");

    // 2. The shortest segment of the curve on whose ends da/dσ has opposite signs.
    problem.y_t = top.y;
    constexpr double inside = 0.999;  // of δ: the ends lie inside the segment
    for (double delta = 1e-9; delta < 1e-3; delta *= 4) {
        const Segment curve = segment(problem, top.y, top.Y, delta);
        if (!curve.proved) continue;
        const auto lower_end = segment_end(problem, top, curve, delta, -inside * delta);
        if (!lower_end) continue;
        const auto upper_end = segment_end(problem, top, curve, delta, inside * delta);
        if (!upper_end || !(lower_end->sign * upper_end->sign < 0)) continue;

        // 3. Bounds of the limit, and the distance of its box from the state.
        const bool maximum = lower_end->sign > 0;
        const Interval range_of_a = around(top.y[n - 1], curve.r[n - 1]);
        limit.from = maximum ? std::max(lower_end->a.lo, upper_end->a.lo) : range_of_a.lo;
        limit.to = maximum ? range_of_a.hi : std::min(lower_end->a.hi, upper_end->a.hi);
        const auto whole = box(top.y, curve.r);
        limit.error = distance(mapped, {whole.begin(), whole.begin() + system.n()});
        if (is_within(limit.error, tolerance))
            limit.state = ProofState::proved;
        else
            limit.detail =
                fmt::format("a limit point is proved, {} from the state, beyond the tolerance",
                            as_text(limit.error));
        return limit;
    }
    return open("Krawczyk's operator contracts in no box on both sides of the limit point");
}

}  // namespace elastocheck::reference::certificate
