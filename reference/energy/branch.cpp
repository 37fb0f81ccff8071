// The branch is one curve of minima. A minimiser left alone would snap through at a limit point and report
// the far side. So a step counts only if both the way it went and the tangent where it arrived are as
// expected, in scaled ξ:
//
//   |Δξ - Δξ_e| ≤ ½ |Δξ_e|,   |dξ/da Δa - Δξ_e| ≤ ½ |Δξ_e|      (largest entry; what is negligible always
//   passes)
//
// with Δξ_e from the step before (secant), or for the first step from the tangent -Z W⁻¹ Zᵀ ∂²V/∂ξ∂a. The new
// pose must be a minimum (no mode of negative stiffness) and no bushing may have gone through half a turn,
// where its law ends. If any of this fails the step is halved.
#include "reference/energy/branch.hpp"

#include <cmath>
#include <numbers>

#include "reference/energy/minimise.hpp"
#include "reference/energy/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int halvings = 12;           // of a step, one after the other
constexpr int internal_points = 2000;  // on the way from one load to the next
constexpr double largest_step = 0.1;   // expected, of L or 1 rad
constexpr double negligible = 1e-4;    // of L or 1 rad
constexpr const char* not_finite = "a number stopped being finite";
constexpr double half_turn = std::numbers::pi - 1e-3;  // [rad]

// -Z (W + ZᵀAZ)⁻¹ Zᵀ b over the modes that resist: where the balance b goes to zero, to first order. In ξ.
VectorXd newton_increment(const Path& path, const State& state, const VectorXd& b) {
    std::vector<int> resisting;
    for (int i = 0; i < state.modes.count(); ++i)
        if (!state.modes.idle(i)) resisting.push_back(i);
    if (resisting.empty()) return VectorXd::Zero(b.size());
    const MatrixXd Z = state.modes.Z(Eigen::all, resisting);
    const VectorXd W = state.modes.stiffness(resisting);
    const Loading loading = path.loading(state.a);
    if (loading.moments.empty()) return -Z * (Z.transpose() * b).cwiseQuotient(W);
    MatrixXd K = Z.transpose() * moment_stiffness(loading, path.scales, static_cast<int>(b.size())) * Z;
    K.diagonal() += W;
    return -Z * K.partialPivLu().solve(Z.transpose() * b);
}

// What a change of the load factor does at this pose, to first order, in ξ.
VectorXd tangent_increment(const Path& path, const State& state, double a_from, double a_to) {
    const Chart chart = chart_about(state.poses);
    const VectorXd S = path.scales.coordinates(coordinates(path.model));
    const VectorXd db = potential(path.model, path.loading(a_to), chart).gradient -
                        potential(path.model, path.loading(a_from), chart).gradient;
    return newton_increment(path, state, S.cwiseProduct(db) / path.scales.energy());
}

VectorXd expected_increment(const Path& path, const State& from, double a) {
    return from.velocity ? *from.velocity * (a - from.a) : tangent_increment(path, from, from.a, a);
}

// Whether an increment is the expected one, give or take half of it.
bool is_commensurate(const VectorXd& increment, const VectorXd& expected) {
    return largest(increment - expected) <= std::max(0.5 * largest(expected), negligible);
}

// The increment from one state to the next, in ξ, less what idle motions contribute: that is nobody's
// business.
VectorXd scaled_increment(const Path& path, const State& from, const State& to) {
    const VectorXd xi =
        increment(from.poses, to.poses).cwiseQuotient(path.scales.coordinates(coordinates(path.model)));
    const MatrixXd idle = to.modes.idle_motions();
    return xi - idle * (idle.transpose() * xi);
}

std::vector<Pose> moved(const Path& path, const std::vector<Pose>& from, const VectorXd& xi) {
    Chart chart = chart_about(from);
    move_to(chart, path.scales.coordinates(coordinates(path.model)).cwiseProduct(xi));
    return poses(chart);
}

// A motion that nothing resists, pushed by the load at factor a.
bool idle_mode_loaded(const Path& path, const State& from, double a) {
    const Balance at = balance(path.model, path.loading(a), path.scales, chart_about(from.poses));
    const VectorXd push = from.modes.Z.transpose() * at.left;
    for (int i = 0; i < from.modes.count(); ++i)
        if (from.modes.idle(i) && std::abs(push[i]) > 100 * path.options.tolerance) return true;
    return false;
}

// Within half a turn, and on the same sheet of the logarithm as before.
bool bushings_within_half_turn(const Path& path, const State& from, const State& to) {
    const Eigen::Matrix3Xd before = bushing_rotations(path.model, from.poses);
    const Eigen::Matrix3Xd now = bushing_rotations(path.model, to.poses);
    for (int i = 0; i < now.cols(); ++i) {
        if (!(now.col(i).norm() <= half_turn) || !((now.col(i) - before.col(i)).norm() <= half_turn))
            return false;
    }
    return true;
}

Attempt step(const Path& path, const State& from, double a, const VectorXd& expected) {
    Attempt attempt = minimum_from(path, a, moved(path, from.poses, expected), from.modes.idle_motions());
    if (attempt.failure && attempt.failure->outcome == Outcome::not_finite) return attempt;
    const VectorXd actual = scaled_increment(path, from, attempt.state);
    if (!is_commensurate(actual, expected) ||
        (!attempt.failure && !is_commensurate(tangent_increment(path, attempt.state, from.a, a), expected)))
        attempt.failure = {Outcome::branch_lost, "the nearest minimum is not a continuation of the branch"};
    else if (!attempt.failure && !bushings_within_half_turn(path, from, attempt.state))
        attempt.failure = {Outcome::branch_lost, "a bushing has turned by half a turn, where its law ends"};
    else if (!attempt.failure && attempt.state.modes.unstable())
        attempt.failure = {Outcome::branch_lost, "the equilibrium stops being a minimum of the potential"};
    if (!attempt.failure) attempt.state.velocity = actual / (a - from.a);
    return attempt;
}

}  // namespace

State state_at(const Path& path, double a, const std::vector<Pose>& poses) {
    State state;
    state.a = a;
    state.poses = poses;
    const Loading loading = path.loading(a);
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
    const Loading loading = path.loading(a);
    const int per_chart =
        std::max(10, path.options.evaluation_limit / std::max(1, path.options.recentre_limit));
    long evaluations = 0;
    State state = state_at(path, a, start);
    for (int i = 0; i < path.options.recentre_limit && evaluations < path.options.evaluation_limit; ++i) {
        const Minimisation m = minimise(path.model, loading, path.scales, state.poses, state.at, state.H,
                                        idle, path.options.tolerance, per_chart);
        evaluations += m.evaluations;
        path.counts.iterations += 1;
        path.counts.evaluations += m.evaluations;
        path.counts.factorisations += m.evaluations;
        if (!std::isfinite(m.excess)) return {state, Failure{Outcome::not_finite, not_finite}};
        state = state_at(path, a, m.poses);
        if (is_stationary(path, state)) return {state, {}};
        if (loading.moments.empty()) continue;
        // The new centre turns the moments against the bodies. Without this the charts converge, but only
        // linearly.
        const VectorXd ahead = newton_increment(path, state, state.at.left);
        if (largest(ahead) <= largest_step) state = state_at(path, a, moved(path, state.poses, ahead));
    }
    return {state, Failure{Outcome::iteration_limit, "the minimisation did not reach its tolerance"}};
}

std::optional<Failure> advance(const Path& path, State& state, double to) {
    const double resolution = 1e-14 * (std::abs(to) + std::abs(state.a));  // of the load factor
    double h = to - state.a;
    int halved = 0;  // since the last equilibrium
    for (int points = 0; state.a != to; ++points) {
        if (points == internal_points)
            return Failure{Outcome::iteration_limit, "too many steps were needed on the way to this load"};
        VectorXd expected = expected_increment(path, state, state.a + h);
        const double size = largest(expected);
        if (!std::isfinite(size)) return Failure{Outcome::not_finite, not_finite};
        if (size > largest_step) h *= largest_step / size;
        const double a = std::abs(to - state.a) <= std::abs(h) ? to : state.a + h;
        expected = expected_increment(path, state, a);
        Attempt attempt = step(path, state, a, expected);
        if (!attempt.failure) {
            state = std::move(attempt.state);
            h *= 2;
            halved = 0;
            continue;
        }
        if (idle_mode_loaded(path, state, a))
            return Failure{Outcome::loaded_idle_mode, "a motion that nothing resists is pushed by the load"};
        if (attempt.failure->outcome == Outcome::not_finite || ++halved > halvings) return attempt.failure;
        h = 0.5 * (a - state.a);
        if (std::abs(h) <= resolution) return attempt.failure;
    }
    return {};
}

}  // namespace elastocheck::reference::energy
