// Continuation with step acceptance by tangents. A minimiser alone would jump past a limit point
// and report the far side. So a step is accepted only if it agrees with the tangents t = dξ/da at
// both its ends, which must agree with each other (largest entries):
//
//   |Δξ - t_0 Δa| ≤ ½ |t_0 Δa|,   |t_1 Δa - t_0 Δa| ≤ ½ |t_0 Δa|,
//   |Δξ - ½ (t_0 + t_1) Δa| ≤ ⅒ |t_0 Δa|
//
// Along a smooth curve these fall with the first, first and second power of Δa; between different
// curves they do not. The new pose must be a minimum (no mode of negative stiffness), the
// stiffnesses must agree with their prediction (stability.hpp), and no bushing may have turned
// through the end of its law. Otherwise the step is halved. At a kink of the curve t jumps: the
// step over it is accepted once it is negligibly short.
//
// Tangent, by differentiating Φ(ξ; a) = 0 and Zᵀ ∂(V + λᵀΦ)/∂ξ = 0 with J = ∂Φ/∂ξ, J Z = 0, W = Zᵀ
// H Z:
//
//   J t = -∂Φ/∂a               t = p + Z y,   p = -J⁺ ∂Φ/∂a
//   Zᵀ (H t + b) = 0           y = -W⁻¹ Zᵀ (b + H p),   b = ∂²(V + λᵀΦ)/∂ξ∂a
//
// where loads without potential add their unsymmetric part A to H (balance.hpp).
#include "reference/energy/minimise/branch.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"
#include "reference/energy/minimise/cost.hpp"
#include "reference/energy/minimise/descent.hpp"
#include "reference/energy/minimise/minimise.hpp"
#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Consecutive halvings of a step. Where a stop closes, the tangent jumps, and no step over it
// agrees with both tangents: it is accepted once it is negligible, after about twenty halvings of
// the whole span.
constexpr int max_halvings = 26;
constexpr double min_step = 1e-9;  // of the parameter: smallest step
// Smallest step for laws that are almost flat at their start, which looks like a limit
// point until steps are shorter than the flat part. For other laws it would only make limit
// points more expensive.
constexpr double min_step_of_flat_laws = 1e-12;
constexpr double first_stride = 1.0 / 64;  // of the span: the first step, before any slope is known
// of the span: instabilities that appear and vanish within this length are not searched for
constexpr double min_guarded_step = 1e-3;
constexpr int max_points = 2000;        // between two requested values
constexpr double largest_step = 0.1;    // of L or 1 rad, by the tangent
constexpr double negligible = 1e-6;     // of L or 1 rad
constexpr double min_idle_load = 1e-8;  // of F or F·L: smallest load on an idle mode
// of its first stiffness: a mode with less is about to be unstable
constexpr double spent_stiffness = 0.01;

// A small gradient does not bound the error along a soft mode. Newton corrections are applied
// until the last one is at most `last_correction`; after `max_corrections` of them a last one of
// at most `accepted_correction` suffices.
constexpr double last_correction = 1e-10, accepted_correction = 1e-9;  // of L or 1 rad
constexpr int max_corrections = 4;

constexpr const char* not_finite = "a number is not finite";
constexpr const char* jumped = "the nearest minimum is not a continuation of the branch";
constexpr const char* sudden = "the stiffness changes too fast for the continuation";
constexpr const char* unstable = "the equilibrium stops being a minimum of the potential";
constexpr const char* turns_back = "a limit point, past which no equilibrium continues the branch";
constexpr const char* divides =
    "another curve of equilibria crosses the branch: the equilibrium stops being a minimum of the "
    "potential";

VectorXd coordinate_scales(const Path& path) {
    return path.scales.coordinates(coordinates(path.model));
}

VectorXd scaled_increment(const Path& path, const std::vector<Pose>& from,
                          const std::vector<Pose>& to) {
    return increment(from, to).cwiseQuotient(coordinate_scales(path));
}

// Increment between two states without the idle motions, whose size is arbitrary.
VectorXd resisted_increment(const Path& path, const State& from, const State& to) {
    const VectorXd xi = scaled_increment(path, from.poses, to.poses);
    const MatrixXd idle = to.modes.idle_motions();
    return xi - idle * (idle.transpose() * xi);
}

bool has_unsymmetric_stiffness(const Path& path) {
    return path.course.start.has_unsymmetric_stiffness() ||
           path.course.rate.has_unsymmetric_stiffness();
}

// A of K = H + A; empty where no load has one.
std::optional<MatrixXd> unsymmetric_stiffness(const Path& path, const State& state) {
    if (!has_unsymmetric_stiffness(path)) return {};
    return load_stiffness(at(path.course, state.a), path.scales, state.poses);
}

// Newton increment -Z (ZᵀKZ)⁻¹ Zᵀ b over the resisting modes, in ξ. The modes are those of H, so
// without A nothing is factorised.
VectorXd newton_increment(const State& state, const std::optional<MatrixXd>& A, const VectorXd& b) {
    const auto resisting = state.modes.resisting();
    if (resisting.empty()) return VectorXd::Zero(b.size());
    const MatrixXd Z = state.modes.Z(Eigen::all, resisting);
    const VectorXd g = Z.transpose() * b;
    if (!A) return -Z * g.cwiseQuotient(state.modes.stiffness(resisting));
    const MatrixXd reduced = congruence(state.H + *A, Z);
    return -Z * VectorXd(Eigen::PartialPivLU<MatrixXd>(reduced).solve(g));
}

bool is_near(const VectorXd& actual, const VectorXd& expected) {
    return largest(actual - expected) <= std::max(0.5 * largest(expected), negligible);
}

bool is_continuous(const VectorXd& actual, const VectorXd& t_0, const VectorXd& t_1) {
    return is_near(actual, t_0) && is_near(t_1, t_0) &&
           largest(actual - 0.5 * (t_0 + t_1)) <= std::max(0.1 * largest(t_0), negligible);
}

// Whether logarithm and angles of the bushings stay on the same sheet: otherwise one of them jumps
// by half a turn or more.
bool bushings_continue(const Path& path, const State& from, const State& to) {
    const Eigen::Matrix3Xd change = rotations(path.model, path.turning, to.poses) -
                                    rotations(path.model, path.turning, from.poses);
    return change.cols() == 0 || change.colwise().norm().maxCoeff() <= std::numbers::pi / 2;
}

// Whether the prescribed loads at a push an unresisted motion.
bool idle_mode_loaded(const Path& path, const State& from, double a) {
    const Balance conditions =
        sparse_balance(path.model, at(path.course, a), path.scales, chart_about(from.poses));
    const VectorXd load = from.modes.Z.transpose() * conditions.projected_gradient;
    for (int i = 0; i < from.modes.count(); ++i)
        if (from.modes.idle(i) && std::abs(load[i]) > min_idle_load) return true;
    return false;
}

// Whether the softest mode that resists at the start of the branch has lost almost all
// of its stiffness.
bool is_spent(const Modes& at_start, const Modes& modes) {
    const auto softest = at_start.idle_motions().cols();
    return softest < at_start.count() &&
           modes.stiffness[softest] <= spent_stiffness * at_start.stiffness[softest];
}

// Classifies the singular point at which the softest mode z is spent. The tangent there is t = -z
// (z · b) / w + ..., b the rate of the balance. It grows as the stiffness w falls, and the branch
// turns back (limit point), unless z · b = 0 and another curve of equilibria crosses (bifurcation).
// So w |t| keeps its value at a limit point, and goes to zero with w at a bifurcation. Under a load
// without potential w is that of the minimum and does not classify the branch.
Failure spent_mode(const Path& path, const Continuation& continuation, const VectorXd& t) {
    if (has_unsymmetric_stiffness(path)) return Failure{Outcome::branch_lost, unstable};
    constexpr double min_product = 0.02;  // of w |t| at the start
    const auto softest = path.start_modes.idle_motions().cols();
    const double share =
        std::abs(continuation.state.modes.stiffness[softest] / path.start_modes.stiffness[softest]);
    return share * largest(t) >= min_product * continuation.first_tangent && largest(t) > 0
               ? Failure{Outcome::limit_point, turns_back}
               : Failure{Outcome::bifurcation_point, divides};
}

// Whether a law has a nonzero slope below a thousandth of its steepest.
bool has_small_slope(const Model& model) {
    constexpr double small = 1e-3;
    bool any = false;
    const auto compare_slopes = [&](std::size_t, const Curve& curve) {
        double steepest = 0;
        for (const auto& piece : curve.pieces) steepest = std::max(steepest, piece[1]);
        any |= std::ranges::any_of(curve.pieces, [&](const auto& piece) {
            return piece[1] > 0 && piece[1] < small * steepest;
        });
    };
    for (const auto& element : model.elastics) each_curve(element.kind, compare_slopes);
    return any;
}

Attempt lost_branch(Attempt attempt, const char* why) {
    attempt.failure = {Outcome::branch_lost, why};
    return attempt;
}

// Start of the minimisation. Without an equilibrium before the last, t h. With it, ξ is the cubic
// t h + c h² + d h³ through both equilibria and their tangents t_0 and t, without idle motions.
// With D from the one before to the last and ξ_0 the increment back,
//
//   A = ξ_0 + D t,   B = D (t_0 - t),   D² c = 3 A + B,   D³ d = 2 A + B
//
// t_0 in the chart of the last, where a rotation φ changes by J⁻¹(φ) δπ. At a kink it is wrong: it
// is used where it changes little.
VectorXd predicted(const Path& path, const Continuation& continuation, const VectorXd& t,
                   double h) {
    constexpr double max_change = 0.5;  // of t h
    const State &last = continuation.state, &previous = continuation.previous;
    VectorXd xi = t * h;
    if (continuation.previous_tangent.size() == 0 || last.a == previous.a) return xi;
    const double D = last.a - previous.a, ratio = h / D;
    const VectorXd step_back = scaled_increment(path, last.poses, previous.poses);
    VectorXd t_0 = continuation.previous_tangent;
    for (Eigen::Index b = 3; b < t_0.size(); b += 6)
        t_0.segment<3>(b) =
            (inverse_turn_jacobian(step_back.segment<3>(b)) * t_0.segment<3>(b)).eval();
    const VectorXd A = step_back + D * t, B = D * (t_0 - t);
    VectorXd higher_terms = ratio * ratio * (3 * A + B + ratio * (2 * A + B));
    const MatrixXd idle = last.modes.idle_motions();
    higher_terms -= idle * (idle.transpose() * higher_terms).eval();
    if (largest(higher_terms) < max_change * largest(xi)) xi += higher_terms;
    return xi;
}

// One continuation step; `expected` is the predictor along the tangent.
Attempt step(const Path& path, const Continuation& continuation, double a, const VectorXd& expected,
             const VectorXd& start) {
    const State& from = continuation.state;
    Attempt attempt = minimum_from(path, a, moved(path, from.poses, start), from);
    const State& to = attempt.state;
    if (attempt.failure && attempt.failure->outcome == Outcome::not_finite) return attempt;
    const VectorXd actual = resisted_increment(path, from, to);
    if (!is_near(actual, expected)) return lost_branch(attempt, jumped);
    if (attempt.failure) return attempt;
    if (!is_continuous(actual, expected, tangent(path, to) * (a - from.a)))
        return lost_branch(attempt, jumped);
    if (!within_laws(path.model, path.turning, to.poses)) return lost_branch(attempt, law_ended);
    if (!bushings_continue(path, from, to)) return lost_branch(attempt, law_ended);
    if (to.modes.unstable()) return lost_branch(attempt, unstable);
    if (std::abs(a - from.a) > min_guarded_step * path.span &&
        !meets_prediction(continuation.record, a, to.modes))
        return lost_branch(attempt, sudden);
    return attempt;
}

// Next value towards `to`: limited by the stride, by the range of the tangent and by
// the predicted stability.
double next_value(const Path& path, const Continuation& continuation, const VectorXd& t,
                  double to) {
    const double rest = to - continuation.state.a;
    double h = std::copysign(std::min(std::abs(rest), continuation.next_step), rest);
    const double size = largest(t) * std::abs(h);
    if (size > largest_step) h *= largest_step / size;
    const double guarded =
        std::max(std::abs(limited_step(continuation.record, h)), min_guarded_step * path.span);
    h = std::copysign(std::min(std::abs(h), guarded), rest);
    return std::abs(rest) <= std::abs(h) ? to : continuation.state.a + h;
}

}  // namespace

std::vector<Pose> moved(const Path& path, const std::vector<Pose>& from, const VectorXd& xi) {
    Chart chart = chart_about(from);
    move_to(chart, coordinate_scales(path).cwiseProduct(xi));
    return poses(chart);
}

Continuation start_continuation(const Path& path, const State& state) {
    Continuation continuation{state, first_stride * path.span, {}};
    continuation.record.add(state.a, state.modes);
    return continuation;
}

namespace {

void count_state(const Path& path) {
    path.counts.evaluations += 2;  // the balance, the Hessian
    path.counts.factorisations += 1;
}

}  // namespace

State sparse_state_at(const Path& path, double a, const std::vector<Pose>& poses,
                      const VectorXd& lambda) {
    count_state(path);
    const Prescribed prescribed = at(path.course, a);
    const Chart chart = chart_about(poses);
    State state{
        a, poses, sparse_balance(path.model, prescribed, path.scales, chart, lambda), {}, {}};
    const Jacobian Phi_q = constraints(path.model, prescribed, chart).Phi_q;
    state.quadratic = std::make_shared<Quadratic>(
        scaled(hessian_blocks(path.model, prescribed, path.scales, poses, state.balance.lambda),
               path.scales),
        scaled(load_blocks(prescribed, poses), path.scales),
        scaled(Phi_q, path.scales.rows(path.model), coordinate_scales(path)));
    return state;
}

State state_at(const Path& path, double a, const std::vector<Pose>& poses) {
    if (is_large(path.model)) {
        State state = sparse_state_at(path, a, poses);
        state.modes = state.quadratic->softest({});
        return state;
    }
    return dense_state_at(path, a, poses);
}

State dense_state_at(const Path& path, double a, const std::vector<Pose>& poses) {
    count_state(path);
    const Prescribed prescribed = at(path.course, a);
    Balance conditions = balance(path.model, prescribed, path.scales, chart_about(poses));
    MatrixXd H = hessian(path.model, prescribed, path.scales, poses, conditions.lambda);
    Modes modes = modes_of(conditions, H);
    return {a, poses, std::move(conditions), std::move(H), std::move(modes)};
}

// p = -J⁺ Φ,   y = -W⁻¹ Zᵀ (gradient + H p)
VectorXd correction(const Path& path, const State& state, const VectorXd& gradient,
                    const VectorXd& Phi) {
    if (state.quadratic)
        return state.quadratic->minimum(gradient, Phi, state.modes.idle_motions()).x;
    const auto A = unsymmetric_stiffness(path, state);
    if (Phi.isZero(0)) return newton_increment(state, A, gradient);
    const VectorXd p = shortest(state.balance, -Phi);
    VectorXd b = gradient + state.H * p;
    if (A) b += *A * p;
    return p + newton_increment(state, A, b);
}

VectorXd tangent(const Path& path, const State& state) {
    const Prescribed prescribed = at(path.course, state.a);
    const Prescribed& rate = path.course.rate;
    const Chart chart = chart_about(state.poses);
    const VectorXd S = coordinate_scales(path), D = path.scales.rows(path.model);
    VectorXd b =
        S.cwiseProduct(gradient_rate(path.model, prescribed, rate, chart)) / path.scales.energy();
    if (rate.offset.isZero(0) && rate.gap.isZero(0)) return correction(path, state, b, VectorXd());
    const ConstraintRates rates = constraint_rates(path.model, prescribed, rate, chart);
    b += S.cwiseProduct(transposed_times(rates.Phi_qa, D.cwiseProduct(state.balance.lambda)));
    return correction(path, state, b, D.cwiseProduct(rates.Phi_a));
}

bool is_stationary(const Path& path, const State& state) {
    if (state.quadratic)
        return excess(state.balance, state.quadratic->stiffness(), path.scales,
                      path.options.tolerance) <= path.options.tolerance;
    const double e = excess(state.balance.projected_gradient, state.balance.Phi, state.modes,
                            path.scales, path.options.tolerance);
    return std::isfinite(e) && e <= path.options.tolerance;
}

namespace {

// Newton corrections of a stationary state along its soft modes.
Attempt corrected(const Path& path, State state) {
    for (int k = 0;; ++k) {
        const VectorXd xi = newton_increment(state, unsymmetric_stiffness(path, state),
                                             state.balance.projected_gradient);
        const double size = largest(xi);
        if (size <= last_correction) {
            // The balance stays that of the poses before: its change is of second order.
            state.poses = moved(path, state.poses, xi);
            return {std::move(state), {}};
        }
        if (k == max_corrections && size <= accepted_correction) return {std::move(state), {}};
        if (k == max_corrections || !(size <= largest_step))
            return {std::move(state),
                    Failure{Outcome::iteration_limit,
                            fmt::format("beside stiff elements the minimum along a soft motion is "
                                        "determined only to {:.1g} of the model's size",
                                        size)}};
        state = state_at(path, state.a, moved(path, state.poses, xi));
    }
}

}  // namespace

Attempt minimum_from(const Path& path, double a, const std::vector<Pose>& start,
                     const State& near) {
    if (is_large(path.model)) return descend(path, a, start, near);
    const Options& options = path.options;
    const MatrixXd idle = near.modes.idle_motions();
    const Prescribed prescribed = at(path.course, a);
    const int per_chart =
        std::max(10, options.evaluation_limit / std::max(1, options.recentre_limit));
    long evaluations = 0;
    State state = state_at(path, a, start);
    for (int i = 0; i < options.recentre_limit && evaluations < options.evaluation_limit; ++i) {
        const Minimisation m = minimise(path, state, idle, per_chart);
        evaluations += m.evaluations;
        path.counts.iterations += 1;
        path.counts.evaluations += m.evaluations;
        path.counts.factorisations += m.evaluations;
        if (!std::isfinite(m.excess)) return {state, Failure{Outcome::not_finite, not_finite}};
        const VectorXd xi = scaled_increment(path, state.poses, m.poses);
        state = state_at(path, a, m.poses);
        if (is_stationary(path, state)) {
            Attempt attempt = corrected(path, state);
            if (attempt.failure || is_stationary(path, attempt.state)) return attempt;
            state = std::move(attempt.state);
        }
        if (largest(xi) <= path.scales.roundoff) break;  // the next chart would be the same
        if (!prescribed.has_unsymmetric_stiffness()) continue;
        // A new centre rotates the moments relative to the bodies, and moves the patches. Without
        // this Newton increment the charts converge only linearly.
        const VectorXd newton_xi = newton_increment(state, unsymmetric_stiffness(path, state),
                                                    state.balance.projected_gradient);
        if (largest(newton_xi) <= largest_step)
            state = state_at(path, a, moved(path, state.poses, newton_xi));
    }
    return {state,
            Failure{Outcome::iteration_limit, "the minimisation did not reach its tolerance"}};
}

std::optional<Failure> advance(const Path& path, Continuation& continuation, double to) {
    State& state = continuation.state;
    const double smallest = min_step * std::max(std::abs(to), std::abs(state.a));
    int halvings = 0;  // since the last equilibrium
    for (int points = 0; state.a != to; ++points) {
        if (points == max_points) return Failure{Outcome::iteration_limit, "too many steps"};
        const VectorXd t = tangent(path, state);
        if (!std::isfinite(largest(t))) return Failure{Outcome::not_finite, not_finite};
        if (continuation.record.samples.size() == 1) continuation.first_tangent = largest(t);
        const double a = next_value(path, continuation, t, to), h = a - state.a;
        Attempt attempt = step(path, continuation, a, t * h, predicted(path, continuation, t, h));
        if (!attempt.failure) {
            continuation.next_step =
                std::max(a == to ? continuation.next_step : 0.0, 2 * std::abs(h));
            halvings = 0;
            continuation.previous = std::move(state);
            continuation.previous_tangent = t;
            state = std::move(attempt.state);
            continuation.record.add(a, state.modes);
            continue;
        }
        if (idle_mode_loaded(path, state, a))
            return Failure{Outcome::loaded_idle_mode,
                           "the load acts on a motion that nothing resists"};
        if (attempt.failure->outcome == Outcome::not_finite) return attempt.failure;
        continuation.next_step = 0.5 * std::abs(h);
        if (++halvings <= max_halvings &&
            (continuation.next_step > smallest ||
             (continuation.next_step > min_step_of_flat_laws / min_step * smallest &&
              has_small_slope(path.model))))
            continue;
        // The end of a bushing's law takes precedence as the reason.
        const bool may_be_spent = attempt.failure->outcome == Outcome::iteration_limit ||
                                  (attempt.failure->outcome == Outcome::branch_lost &&
                                   attempt.failure->what != law_ended);
        if (may_be_spent && is_spent(path.start_modes, state.modes))
            return spent_mode(path, continuation, t);
        return attempt.failure;
    }
    return {};
}

}  // namespace elastocheck::reference::energy
