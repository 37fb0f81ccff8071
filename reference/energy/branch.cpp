// The branch is one curve of minima. A minimiser left alone would snap through at a limit point and report
// the far side. So a step counts only if it fits the tangents t = dξ/da = -Z W⁻¹ Zᵀ ∂²V/∂ξ∂a at both its
// ends, which must fit each other (largest entries):
//
//   |Δξ - t_0 Δa| ≤ ½ |t_0 Δa|,   |t_1 Δa - t_0 Δa| ≤ ½ |t_0 Δa|,   |Δξ - ½ (t_0 + t_1) Δa| ≤ ⅒ |t_0 Δa|
//
// Along a smooth curve these fall with the first, first and second power of Δa, but not from one curve to
// another. The new pose must be a minimum (no mode of negative stiffness) and no bushing may have gone
// through half a turn, where its law ends. If any of this fails the step is halved.
#include "reference/energy/branch.hpp"

#include <cmath>
#include <numbers>

#include "reference/energy/minimise.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int halvings = 12;           // of a step, one after the other
constexpr double resolution = 1e-9;    // of the load factor: smallest step
constexpr int internal_points = 2000;  // on the way from one load to the next
constexpr double largest_step = 0.1;   // of L or 1 rad, as the tangent has it
constexpr double negligible = 1e-6;    // of L or 1 rad
constexpr double idle_push = 1e-8;     // of F or F·L: what counts as a load on an idle mode
constexpr double spent = 0.01;         // of its first stiffness: a mode about to become unstable

constexpr const char* not_finite = "a number stopped being finite";
constexpr const char* jumped = "the nearest minimum is not a continuation of the branch";
constexpr const char* unstable = "the equilibrium stops being a minimum of the potential";

VectorXd coordinate_scales(const Path& path) { return path.scales.coordinates(coordinates(path.model)); }

std::vector<Pose> moved(const Path& path, const std::vector<Pose>& from, const VectorXd& xi) {
    Chart chart = chart_about(from);
    move_to(chart, coordinate_scales(path).cwiseProduct(xi));
    return poses(chart);
}

VectorXd scaled_increment(const Path& path, const std::vector<Pose>& from, const std::vector<Pose>& to) {
    return increment(from, to).cwiseQuotient(coordinate_scales(path));
}

// The same from state to state, less what idle motions contribute: how far they go does not matter.
VectorXd resisted_increment(const Path& path, const State& from, const State& to) {
    const VectorXd xi = scaled_increment(path, from.poses, to.poses);
    const MatrixXd idle = to.modes.idle_motions();
    return xi - idle * (idle.transpose() * xi);
}

// -Z (W + ZᵀAZ)⁻¹ Zᵀ b over the modes that resist: where the balance b goes to zero, to first order. In ξ.
VectorXd newton_increment(const Path& path, const State& state, const VectorXd& b) {
    const auto resisting = state.modes.resisting();
    if (resisting.empty()) return VectorXd::Zero(b.size());
    const MatrixXd Z = state.modes.Z(Eigen::all, resisting);
    const VectorXd W = state.modes.stiffness(resisting);
    const Loading loading = path.loading(state.a);
    if (loading.moments.empty()) return -Z * (Z.transpose() * b).cwiseQuotient(W);
    MatrixXd K = Z.transpose() * moment_stiffness(loading, path.scales, static_cast<int>(b.size())) * Z;
    K.diagonal() += W;
    return -Z * K.partialPivLu().solve(Z.transpose() * b);
}

// t (a_to - a_from) at this pose.
VectorXd tangent_increment(const Path& path, const State& state, double a_from, double a_to) {
    const Chart chart = chart_about(state.poses);
    const VectorXd db = potential(path.model, path.loading(a_to), chart).gradient -
                        potential(path.model, path.loading(a_from), chart).gradient;
    return newton_increment(path, state, coordinate_scales(path).cwiseProduct(db) / path.scales.energy());
}

bool is_near(const VectorXd& actual, const VectorXd& expected) {
    return largest(actual - expected) <= std::max(0.5 * largest(expected), negligible);
}

bool is_continuous(const VectorXd& actual, const VectorXd& t_0, const VectorXd& t_1) {
    return is_near(actual, t_0) && is_near(t_1, t_0) &&
           largest(actual - 0.5 * (t_0 + t_1)) <= std::max(0.1 * largest(t_0), negligible);
}

// On the same sheet of the logarithm as before.
bool bushings_continue(const Path& path, const State& from, const State& to) {
    const Eigen::Matrix3Xd change =
        bushing_rotations(path.model, to.poses) - bushing_rotations(path.model, from.poses);
    return change.cols() == 0 || change.colwise().norm().maxCoeff() <= std::numbers::pi;
}

// A motion that nothing resists, pushed by the load at factor a.
bool idle_mode_loaded(const Path& path, const State& from, double a) {
    const Balance at = balance(path.model, path.loading(a), path.scales, chart_about(from.poses));
    const VectorXd push = from.modes.Z.transpose() * at.left;
    for (int i = 0; i < from.modes.count(); ++i)
        if (from.modes.idle(i) && std::abs(push[i]) > idle_push) return true;
    return false;
}

// Whether the softest mode that resisted where the branch starts has hardly any stiffness left.
bool is_spent(const Modes& first, const Modes& now) {
    const auto softest = first.idle_motions().cols();
    return softest < first.count() && now.stiffness[softest] <= spent * first.stiffness[softest];
}

Attempt lost(Attempt attempt, const char* why) {
    attempt.failure = {Outcome::branch_lost, why};
    return attempt;
}

// From one equilibrium to the next, `expected` by the tangent.
Attempt step(const Path& path, const State& from, double a, const VectorXd& expected) {
    Attempt attempt = minimum_from(path, a, moved(path, from.poses, expected), from.modes.idle_motions());
    const State& to = attempt.state;
    if (attempt.failure && attempt.failure->outcome == Outcome::not_finite) return attempt;
    const VectorXd actual = resisted_increment(path, from, to);
    if (!is_near(actual, expected)) return lost(attempt, jumped);
    if (attempt.failure) return attempt;
    if (!is_continuous(actual, expected, tangent_increment(path, to, from.a, a)))
        return lost(attempt, jumped);
    if (!within_half_turn(path.model, to.poses)) return lost(attempt, turned_over);
    if (!bushings_continue(path, from, to)) return lost(attempt, turned_over);
    if (to.modes.unstable()) return lost(attempt, unstable);
    return attempt;
}

}  // namespace

State state_at(const Path& path, double a, const std::vector<Pose>& poses) {
    const Loading loading = path.loading(a);
    State state{.a = a, .poses = poses, .at = {}, .H = {}, .modes = {}};
    state.at = balance(path.model, loading, path.scales, chart_about(poses));
    state.H = hessian(path.model, loading, path.scales, poses, state.at.lambda);
    state.modes = modes_of(state.at, state.H);
    path.counts.evaluations += 1 + 2 * coordinates(path.model);
    path.counts.factorisations += 1;
    return state;
}

bool is_stationary(const Path& path, const State& state) {
    const double e = excess(state.at.left, state.at.Phi, state.modes, path.scales, path.options.tolerance);
    return std::isfinite(e) && e <= path.options.tolerance;
}

Attempt minimum_from(const Path& path, double a, const std::vector<Pose>& start, const MatrixXd& idle) {
    const Options& options = path.options;
    const Loading loading = path.loading(a);
    const int per_chart = std::max(10, options.evaluation_limit / std::max(1, options.recentre_limit));
    long evaluations = 0;
    State state = state_at(path, a, start);
    for (int i = 0; i < options.recentre_limit && evaluations < options.evaluation_limit; ++i) {
        const Minimisation m = minimise(path.model, loading, path.scales, state.poses, state.at, state.H,
                                        idle, options.tolerance, per_chart);
        evaluations += m.evaluations;
        path.counts.iterations += 1;
        path.counts.evaluations += m.evaluations;
        path.counts.factorisations += m.evaluations;
        if (!std::isfinite(m.excess)) return {state, Failure{Outcome::not_finite, not_finite}};
        const VectorXd moved_by = scaled_increment(path, state.poses, m.poses);
        state = state_at(path, a, m.poses);
        if (is_stationary(path, state)) return {state, {}};
        if (largest(moved_by) <= path.scales.roundoff) break;  // the next chart would be the same again
        if (loading.moments.empty()) continue;
        // The new centre turns the moments against the bodies. Without this, charts converge only linearly.
        const VectorXd ahead = newton_increment(path, state, state.at.left);
        if (largest(ahead) <= largest_step) state = state_at(path, a, moved(path, state.poses, ahead));
    }
    return {state, Failure{Outcome::iteration_limit, "the minimisation did not reach its tolerance"}};
}

std::optional<Failure> advance(const Path& path, State& state, double to) {
    const double smallest = resolution * std::max(std::abs(to), std::abs(state.a));
    double h = to - state.a;
    int halved = 0;  // since the last equilibrium
    for (int points = 0; state.a != to; ++points) {
        if (points == internal_points)
            return Failure{Outcome::iteration_limit, "too many steps were needed on the way to this load"};
        const VectorXd tangent = tangent_increment(path, state, state.a, state.a + h);
        const double size = largest(tangent);
        if (!std::isfinite(size)) return Failure{Outcome::not_finite, not_finite};
        const double reach = h * (size > largest_step ? largest_step / size : 1);
        const double a = std::abs(to - state.a) <= std::abs(reach) ? to : state.a + reach;
        const Attempt attempt = step(path, state, a, tangent * ((a - state.a) / h));
        if (!attempt.failure) {
            h = 2 * (a - state.a);
            halved = 0;
            state = attempt.state;
            continue;
        }
        if (idle_mode_loaded(path, state, a))
            return Failure{Outcome::loaded_idle_mode, "a motion that nothing resists is pushed by the load"};
        if (attempt.failure->outcome == Outcome::not_finite) return attempt.failure;
        h = 0.5 * (a - state.a);
        if (++halved <= halvings && std::abs(h) > smallest) continue;
        if (attempt.failure->outcome == Outcome::iteration_limit && is_spent(path.first, state.modes))
            return Failure{Outcome::branch_lost, unstable};
        return attempt.failure;
    }
    return {};
}

}  // namespace elastocheck::reference::energy
