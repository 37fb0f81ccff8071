#include "reference/equilibrium/continuation/continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/equilibrium/linear_algebra/soft_modes.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Largest difference of the chord and the tangents at its ends, over the chord.
constexpr double max_deviation = 0.25;

// Below this share of the model's size the chord is round-off and is not tested.
constexpr double min_tested_chord = 1e-6;

// Longest step [L or rad]. A body that only translates may go farther on a straight path: as long
// as the second-order term of the predictor is at most the part `max_second_order` of this length.
constexpr double longest_step = 0.2;
constexpr double max_second_order = 0.1;

// Largest further Newton step from an accepted state: a small residual does not bound the error in
// soft directions beside stiff ones.
constexpr double last_correction = 1e-8;

// Rounding of the constrained quantities: a state that it moves by more than a last correction is
// not judged. At a bifurcation of a mechanism, rounding ε of the scene's numbers connects the two
// curves within a distance √ε.
constexpr double constrained_rounding = 2e-15;

// Relative part of a load on an idle mode that counts as round-off.
constexpr double remainder_round_off = 1e-9;

// The same on a soft mode: the rounding of a sum.
constexpr double soft_round_off = 1e-14;

// However close the points, a step between two of them may be halved at least this often.
constexpr int min_halvings = 6;

// Trials to locate a knot before the step is shortened like any other; the error of each is O(h⁴)
// of the previous.
constexpr int max_knot_trials = 20;

// Steps between two requested points before the branch counts as too long: about sixty turns, or
// four hundred L.
constexpr int max_steps = 2000;

// Search past the smallest step before the branch counts as lost: length of the first probe in
// smallest steps, growth factor, number of probes. A point that is singular within 1e-12 of the
// stage shows its other side only farther on.
constexpr double first_probe = 3, probe_growth = 4;
constexpr int max_probes = 14;

Station station_at(Continuation& continuation, double t, VectorXd x, const Linearisation* last) {
    Station station;
    station.t = t;
    station.x = std::move(x);
    Derivatives slopes = derivatives(continuation.system, loading_at(continuation, t), station.x,
                                     continuation.counts);
    station.linearised = linearise(std::move(slopes.J), last, continuation.counts);
    if (station.linearised.modes_are_new)
        remove_resisted_modes(continuation.system, loading_at(continuation, t), station.x,
                              station.linearised, continuation.counts);
    station.stiffness = stiffness(continuation.system, station.linearised);
    station.E = std::move(slopes.E);
    station.E_rate = std::move(slopes.E_rate);
    const Rate rate = solve_bordered(station.linearised.bordered, station.E_rate);
    station.tangent = rate.dx;
    station.mu = rate.mu;
    station.curves = curve_deformations(continuation.system, loading_at(continuation, t), station.x,
                                        station.tangent);
    return station;
}

// Second-order term of the predictor over h, from the change of the tangent since the last station.
std::optional<VectorXd> bend(const Continuation& continuation, double h) {
    if (!continuation.previous || continuation.previous->t == continuation.current.t)
        return std::nullopt;
    return h * h / 2 * (continuation.current.tangent - continuation.previous->tangent) /
           (continuation.current.t - continuation.previous->t);
}

// Predictor: tangent and second-order term; or, where it hardly differs, the cubic
// h x' + c h² + d h³ with the state before and its tangent as well, with error O(h⁴). With D from
// there to here, x the step back and x₀' its tangent as a rate of that step,
//
//   A = x + D x',   B = D (x₀' - x'),   D² c = 3 A + B,   D³ d = 2 A + B
//
// For a rotation θ the rate is J⁻¹(θ) ω = ω - ½ θ × ω + O(θ²) ω. Idle motion and self-stress are
// removed from A and B: their tangents are zero and no equation corrects them, so that the cubic
// would multiply them by -5 in each step (h = D, x' = x₀' = 0).
VectorXd predicted_step(const Continuation& continuation, double h) {
    const Station& current = continuation.current;
    VectorXd dx = h * current.tangent;
    const auto second_order = bend(continuation, h);
    if (!second_order || !(second_order->norm() < 0.5 * dx.norm())) return dx;
    dx += *second_order;
    const Station& previous = *continuation.previous;
    const double D = current.t - previous.t, ratio = h / D;
    const VectorXd step_back = step_between(continuation.system, current.x, previous.x);
    VectorXd rate = previous.tangent;
    for (int body = 0; body < continuation.system.bodies; ++body) {
        const Eigen::Vector3d theta = step_back.segment<3>(6 * body + 3);
        auto angular_rate = rate.segment<3>(6 * body + 3);
        const Eigen::Vector3d theta_x_rate = cross(theta, Eigen::Vector3d(angular_rate));
        angular_rate += -theta_x_rate / 2 + cross(theta, theta_x_rate) / 12;
    }
    const Sparse& V = current.linearised.modes.right;
    const auto resisted = [&](const VectorXd& v) -> VectorXd {
        return v - V * (V.transpose() * v);
    };
    const VectorXd A = resisted(step_back + D * current.tangent),
                   B = resisted(D * (rate - current.tangent));
    const VectorXd cubic = h * current.tangent + ratio * ratio * (3 * A + B + ratio * (2 * A + B));
    return (cubic - dx).norm() < 0.5 * second_order->norm() ? cubic : dx;
}

bool is_within_reach(const Continuation& continuation, double h, const VectorXd& dx) {
    if (pose_size(continuation.system, dx) <= longest_step) return true;
    const auto second_order = bend(continuation, h);
    if (!dx.allFinite() || !second_order ||
        !(pose_size(continuation.system, *second_order) <= max_second_order * longest_step))
        return false;
    for (int body = 0; body < continuation.system.bodies; ++body)
        if (dx.segment<3>(6 * body + 3).norm() > longest_step) return false;
    return true;
}

// Compares the chord with both tangents.
bool is_continuation(const System& system, const Station& from, const Station& to) {
    const VectorXd chord = step_between(system, from.x, to.x);
    const double h = to.t - from.t, size = pose_size(system, chord);
    const double deviation = std::max(pose_size(system, chord - h * from.tangent),
                                      pose_size(system, chord - h * to.tangent));
    return std::isfinite(size) && std::isfinite(deviation) &&
           deviation <= std::max(max_deviation * size, min_tested_chord);
}

// Midpoint of two equilibria by the cubic Hermite interpolant, with error O(h⁴),
//
//   x_m = x₀ + (x₁ - x₀) / 2 + h (x₀' - x₁') / 8
Stability stability_between(Continuation& continuation, const Station& from, const Station& to) {
    const double h = to.t - from.t;
    const VectorXd dx =
        step_between(continuation.system, from.x, to.x) / 2 + h / 8 * (from.tangent - to.tangent);
    auto at_middle = derivatives(continuation.system, loading_at(continuation, from.t + h / 2),
                                 moved(continuation.system, from.x, dx), continuation.counts);
    const Eigen::Index redundant = from.stiffness.redundant;
    const auto has_determinant = [](const Stiffness& stiffness) {
        return !std::isnan(stiffness.log_determinant);
    };
    if (has_determinant(from.stiffness) && has_determinant(to.stiffness))
        if (const auto middle_stiffness =
                stiffness_of_few(continuation.system, at_middle.J,
                                 from.linearised.modes.count() - redundant, redundant))
            return over_step(from.stiffness, *middle_stiffness, to.stiffness,
                             {from.stiffness.log_determinant, middle_stiffness->log_determinant,
                              to.stiffness.log_determinant});
    const Linearisation middle =
        linearise(std::move(at_middle.J), &from.linearised, continuation.counts);
    return over_step(from.stiffness, stiffness(continuation.system, middle), to.stiffness,
                     {from.linearised.bordered.log_determinant(), middle.bordered.log_determinant(),
                      to.linearised.bordered.log_determinant()});
}

// Verdict on a solved step: whether it stays on this side of every singular point. During the
// homotopy from the design pose the bodies are held externally, and only the settled state is
// judged.
Verdict singular_point_verdict(Continuation& continuation, const Station& next) {
    if (continuation.stage == Stage::settling) return Verdict::accepted;
    if (next.linearised.modes.count() > continuation.current.linearised.modes.count())
        return Verdict::past_singular_point;
    if (!next.linearised.modes_are_new &&
        next.linearised.orientation() != continuation.current.linearised.orientation())
        return Verdict::past_singular_point;
    if (!constraints_keep_their_side(continuation.system, continuation.current.linearised,
                                     next.linearised))
        return Verdict::past_singular_point;
    switch (stability_between(continuation, continuation.current, next)) {
        case Stability::kept: return Verdict::accepted;
        case Stability::lost: return Verdict::past_singular_point;
        case Stability::uncertain: break;
    }
    return Verdict::uncertain;
}

// Whether springs and links nearly keep their directions: on a long step one may have passed
// through zero length, which the chord between two straight paths does not show.
bool directions_are_kept(const System& system, const VectorXd& from, const VectorXd& to) {
    constexpr double min_cosine = 0.9;
    const auto kept = [&](const Point& i, const Point& j) {
        const auto between = [&](const VectorXd& x) {
            return Eigen::Vector3d(position(frame_of(system, x, j.body), j.s_local) -
                                   position(frame_of(system, x, i.body), i.s_local));
        };
        const Eigen::Vector3d a = between(from), b = between(to);
        return a.dot(b) >= min_cosine * a.norm() * b.norm();
    };
    for (const auto& elastic : system.model->elastics)
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind);
            spring && !kept(spring->i, spring->j))
            return false;
    for (const auto& constraint : system.model->constraints)
        if (const auto* link = std::get_if<DistanceBetween>(&constraint.kind);
            link && !kept(link->i, link->j))
            return false;
    return true;
}

// Movement of a state under a rounding error of all constrained quantities; the signs come from
// fractions of multiples of the golden ratio, which are independent of the system. A soft mode
// moves more and is judged by its stiffness: its softening since the start is divided out.
double moved_by_rounding(const Continuation& continuation, const Station& station) {
    const int m = continuation.system.constraint_rows;
    VectorXd E = VectorXd::Zero(continuation.system.equations());
    for (int k = 0; k < m; ++k)
        E[6 * continuation.system.bodies + k] = std::fmod(0.6180339887498949 * (k + 1), 1.) < 0.5
                                                    ? constrained_rounding
                                                    : -constrained_rounding;
    if (m == 0) return 0;
    const double softer = continuation.first_stiffness > 0
                              ? station.stiffness.least / continuation.first_stiffness
                              : 1;
    return std::clamp(softer, 0., 1.) *
           pose_size(continuation.system, solve_bordered(station.linearised.bordered, E).dx);
}

// Whether the correction of a predicted state, with the matrix of the last one, is much smaller
// than a last correction has to be.
bool needs_one_correction(Continuation& continuation, const Loading& loading, const VectorXd& x) {
    constexpr double much_smaller = 0.1;
    ++continuation.counts.evaluations;
    const VectorXd E = residual(continuation.system, loading, x);
    return E.allFinite() && solve_bordered(continuation.current.linearised.bordered, E).dx.norm() <=
                                much_smaller * last_correction;
}

Trial try_step(Continuation& continuation, double t) {
    const System& system = continuation.system;
    const Loading loading = loading_at(continuation, t);
    const VectorXd dx = predicted_step(continuation, t - continuation.current.t);
    if (!is_within_reach(continuation, t - continuation.current.t, dx))
        return {Verdict::out_of_reach};

    Trial trial{Verdict::unsolved};
    Station& next = trial.station;
    VectorXd next_correction;
    const auto evaluate_at = [&](VectorXd x) {
        next = station_at(continuation, t, std::move(x), &continuation.current.linearised);
        next_correction = solve_bordered(next.linearised.bordered, next.E).dx;
    };
    const auto is_solved = [&](const VectorXd& x) {
        return largest(residual(system, loading, x)) <= continuation.options.tolerance;
    };
    // A predicted state that is as good as the last but one of Newton's method needs no more than
    // the correction from the matrix there, which the station has anyway.
    const VectorXd predicted = moved(system, continuation.current.x, dx);
    bool solved = needs_one_correction(continuation, loading, predicted);
    if (solved) {
        evaluate_at(predicted);
        solved = is_solved(moved(system, next.x, next_correction));
        continuation.counts.iterations += solved;
    }
    if (!solved) {
        trial.attempt = newton(system, loading, predicted, continuation.current.linearised,
                               continuation.options, continuation.counts);
        if (!(trial.attempt.residual <= continuation.options.tolerance)) return trial;
        evaluate_at(trial.attempt.x);
    }
    const double correction = next_correction.norm();
    const double h = t - continuation.current.t;
    // The corrected state is kept: the error that a correction leaves is its square times the
    // ratio of axial to lateral member stiffness, 1e6 and more in a chain of beams. Knots are
    // located in its deformations, since a predicted state may be off by more than `at_knot`.
    if (VectorXd x = moved(system, next.x, next_correction); is_solved(x)) {
        next.x = std::move(x);
        next.curves = curve_deformations(system, loading, next.x, next.tangent);
    }
    if (!is_continuation(system, continuation.current, next))
        trial.verdict = Verdict::another_branch;
    else if (pose_size(system, dx) > longest_step &&
             !directions_are_kept(system, continuation.current.x, next.x))
        trial.verdict = Verdict::out_of_reach;
    else if (const auto exit =
                 first_exit(continuation.current.curves, next.curves, h, continuation.pieces)) {
        trial.verdict = Verdict::past_knot;
        trial.knot = continuation.current.t + *exit * h;
    } else if (!(std::isfinite(correction) && correction <= last_correction))
        trial.verdict = Verdict::unsettled;
    else if (continuation.stage == Stage::branch &&
             !(moved_by_rounding(continuation, next) <= last_correction))
        trial.verdict = Verdict::uncertain;
    else
        trial.verdict = singular_point_verdict(continuation, next);
    return trial;
}

// No step of h is accepted. Probes beyond decide whether the branch continues past the singular
// point on its other side; a singular point that a probe hits exactly decides nothing.
Failure diagnose_end(Continuation& continuation, double h, double t, Trial refused) {
    const auto is_clear = [](const Trial& trial) {
        return trial.verdict == Verdict::past_singular_point &&
               trial.station.stiffness.least < -trial.station.stiffness.round_off;
    };
    for (int k = 0; k < max_probes && continuation.stage == Stage::branch && !is_clear(refused);
         ++k) {
        const double t_probe = continuation.current.t + first_probe * std::pow(probe_growth, k) * h;
        Trial probe = try_step(continuation, t_probe);
        if (is_clear(probe) || (probe.verdict == Verdict::past_singular_point &&
                                refused.verdict != Verdict::past_singular_point)) {
            refused = std::move(probe);
            t = t_probe;
        }
    }
    return failure(continuation, t, refused);
}

// Switches to the next piece wherever a deformation is at the end of its piece and leaves it. The
// state stays, its tangent changes.
std::optional<Failure> change_pieces(Continuation& continuation, double direction) {
    const auto place = [&] {
        const std::string a = parameter(*continuation.system.branch,
                                        loading_at(continuation, continuation.current.t).a);
        return continuation.stage == Stage::settling
                   ? fmt::format("while settling at {}, at {:.0f} % of the homotopy", a,
                                 100 * continuation.current.t)
                   : "at " + a;
    };
    // The pieces and the motion that belong together are those of a linear complementarity problem.
    // Changing the first piece that its deformation leaves ends there where a solution exists
    // (Murty 1974); a set of pieces that repeats has none.
    std::vector<Pieces> tried;
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (const CurveDeformation& component : continuation.current.curves) {
            int& piece = continuation.pieces[component.element][component.axis];
            const int side = exit_side(component, piece, direction, continuation.length);
            if (side == 0) continue;
            if (std::ranges::find(tried, continuation.pieces) != tried.end())
                return Failure{
                    Outcome::limit_point,
                    fmt::format("the branch turns back where the law of '{}' has a knot, {}",
                                continuation.system.model->elastics[component.element].name,
                                place())};
            tried.push_back(continuation.pieces);
            piece += side;
            has_changed = true;
            break;
        }
        if (!has_changed) break;
        continuation.previous.reset();
        continuation.current =
            station_at(continuation, continuation.current.t, continuation.current.x, nullptr);
    }
    const Stiffness& stiffness = continuation.current.stiffness;
    if (!tried.empty() && continuation.stage == Stage::branch &&
        over_step(stiffness, stiffness, stiffness) != Stability::kept)
        return Failure{
            Outcome::singular,
            fmt::format("the equilibrium loses its stability where a law has a knot, {}", place())};
    return std::nullopt;
}

// A state at a knot may be `at_knot` past it, on the old piece. Corrects the current state to an
// equilibrium of the system itself, in which every deformation is on the piece that contains it.
std::optional<Failure> correct_to_current_pieces(Continuation& continuation) {
    constexpr int attempts = 3;
    const auto residual_on_own_pieces = [&] {
        Loading loading = loading_at(continuation, continuation.current.t);
        loading.pieces.clear();
        return largest(residual(continuation.system, loading, continuation.current.x));
    };
    if (continuation.current.curves.empty()) return std::nullopt;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        if (residual_on_own_pieces() <= continuation.options.tolerance) return std::nullopt;
        continuation.pieces =
            pieces_at(continuation.system, loading_at(continuation, continuation.current.t),
                      continuation.current.x);
        const Attempt corrected =
            newton(continuation.system, loading_at(continuation, continuation.current.t),
                   continuation.current.x, continuation.current.linearised, continuation.options,
                   continuation.counts);
        continuation.previous.reset();
        continuation.current =
            station_at(continuation, continuation.current.t, corrected.x, nullptr);
    }
    if (residual_on_own_pieces() <= continuation.options.tolerance) return std::nullopt;
    return Failure{Outcome::iteration_limit,
                   fmt::format("the scaled residual stays at {:.1e} where a law has a knot, at {}",
                               residual_on_own_pieces(),
                               parameter(*continuation.system.branch,
                                         loading_at(continuation, continuation.current.t).a))};
}

}  // namespace

Continuation start(const System& system, const Options& options) {
    Continuation continuation{system, options};
    restart(continuation);
    return continuation;
}

void restart(Continuation& continuation) {
    continuation.stage = Stage::settling;
    continuation.length = 1;
    continuation.pieces = pieces_at(continuation.system, loading_at(continuation, 0),
                                    design_unknowns(continuation.system));
    continuation.previous.reset();
    continuation.current =
        station_at(continuation, 0, design_unknowns(continuation.system), nullptr);
}

std::optional<Failure> begin_branch(Continuation& continuation, double reach) {
    continuation.stage = Stage::branch;
    continuation.length = std::max(std::abs(continuation.system.branch->to), reach);
    continuation.previous.reset();
    continuation.current =
        station_at(continuation, 0, continuation.current.x, &continuation.current.linearised);
    // A motion held only by a released load becomes idle only here.
    if (std::abs(continuation.current.stiffness.least) <= continuation.current.stiffness.round_off)
        continuation.current = station_at(continuation, 0, continuation.current.x, nullptr);
    continuation.first_stiffness = continuation.current.stiffness.least;
    continuation.first_tangent = pose_size(continuation.system, continuation.current.tangent);
    const std::string at_0 = parameter(*continuation.system.branch, 0);
    switch (over_step(continuation.current.stiffness, continuation.current.stiffness,
                      continuation.current.stiffness)) {
        case Stability::kept: return std::nullopt;
        case Stability::lost:
            return Failure{
                Outcome::singular,
                fmt::format("the equilibrium that settles at {} is unstable: {}", at_0,
                            softest_motion(continuation.system, continuation.current.linearised))};
        case Stability::uncertain: break;
    }
    return Failure{Outcome::iteration_limit,
                   fmt::format("the motions that the joints leave free at the equilibrium that "
                               "settles at {} cannot be computed in double precision",
                               at_0)};
}

namespace {
Failure too_long(const Continuation& continuation, double target) {
    const auto at = [&](double t) {
        return continuation.stage == Stage::settling
                   ? fmt::format("{:.0f} % of the homotopy", 100 * t)
                   : parameter(*continuation.system.branch, t);
    };
    return {Outcome::iteration_limit, fmt::format("{} steps reached {}, too far from {}", max_steps,
                                                  at(continuation.current.t), at(target))};
}
}  // namespace

std::optional<Failure> advance(Continuation& continuation, double target) {
    double h = target - continuation.current.t;
    const double smallest =
        std::min(std::ldexp(continuation.length, -continuation.options.halvings),
                 std::ldexp(std::abs(h), -min_halvings));
    std::optional<Trial> refused;  // most informative trial since the last step
    double knot = 0;               // a piece ends here, before the end of the step ...
    int knot_trials = 0;           // ... number of attempts to locate it: 0 for the whole step
    int steps = 0;
    while (continuation.current.t != target) {
        if (auto failed = change_pieces(continuation, target > continuation.current.t ? 1 : -1))
            return failed;
        const double rest = target - continuation.current.t;
        const double remainder = std::abs(rest) * continuation.current.mu.norm(),
                     applied = std::abs(rest) * continuation.current.E_rate.norm();
        // A load below the tolerance is harmless on an idle motion, but not on a soft one.
        // Soft ones may move far under a part of the load that is not exactly zero.
        const bool soft = continuation.current.linearised.modes_are_soft;
        if (remainder >
            (soft ? soft_round_off * applied
                  : std::max(continuation.options.tolerance, remainder_round_off * applied))) {
            const VectorXd left =
                continuation.current.linearised.modes.left * continuation.current.mu;
            return soft ? too_soft(continuation.system, left)
                        : unsolvable_load(continuation.system, left);
        }
        if (!continuation.current.tangent.allFinite())
            return Failure{
                Outcome::singular,
                fmt::format("the system is singular at {}",
                            parameter(*continuation.system.branch,
                                      loading_at(continuation, continuation.current.t).a))};

        if (std::abs(h) >= std::abs(rest) * (1 - 1e-9)) h = rest;
        const double t = knot_trials > 0 ? knot : h == rest ? target : continuation.current.t + h;
        Trial trial = try_step(continuation, t);
        if (trial.verdict == Verdict::past_knot && knot_trials < max_knot_trials &&
            trial.knot != continuation.current.t) {
            knot = trial.knot;
            ++knot_trials;
        } else if (trial.verdict == Verdict::accepted) {
            continuation.previous = std::move(continuation.current);
            continuation.current = std::move(trial.station);
            refused.reset();
            if (++steps == max_steps && continuation.current.t != target)
                return too_long(continuation, target);
            if (knot_trials == 0) h *= 2;
            knot_trials = 0;
        } else {
            const bool more_informative =
                !refused || (refused->verdict != Verdict::past_singular_point &&
                             trial.verdict != Verdict::uncertain);
            if (more_informative) refused = std::move(trial);
            h = knot_trials > 0 ? (t - continuation.current.t) / 2 : h / 2;
            knot_trials = 0;
            if (std::abs(h) < smallest * (1 - 1e-9))
                return diagnose_end(continuation, h, t, std::move(*refused));
        }
    }
    return correct_to_current_pieces(continuation);
}

}  // namespace elastocheck::reference::equilibrium
