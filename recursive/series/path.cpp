#include "recursive/series/path.hpp"

#include <fmt/format.h>

#include "recursive/diagnosis/finite.hpp"
#include "recursive/series/continuation.hpp"
#include "recursive/series/events.hpp"
#include "recursive/series/polynomial.hpp"
#include "recursive/series/sides.hpp"
#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/step_check.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive::series {
namespace {

double largest_force(const SteppingState& s) { return s.work.upper.cwiseAbs().maxCoeff(); }
double largest_violation(const SteppingState& s) {
    return s.m() == 0 ? 0 : s.work.lower.cwiseAbs().maxCoeff();
}

// Whether redundant joints have become inconsistent by their drivers.
bool became_inconsistent(SteppingState& s) {
    if (!has_redundancy(s)) return false;
    residual_at(s, s.q, s.lambda);
    return is_inconsistent(s, s.q);
}

// Newton corrections at the present point; the last factors serve the next expansion. `error` is the
// size of the first correction [m], the error of the expansion. With arc length the parameter a is
// corrected too: with x_0 the correction at constant a, x̂ the solution for a unit of a and x' the
// direction of the path,
//
//   x = x_0 + x̂ Δa,   Δa = -(x'·x_0) / (x'·x̂),   a·b = aᵀ W² b over the bodies,
//
// so that x'·x = 0: nothing moves along the path.
Outcome correct_at_end(Continuation& run, Certificate* certificate, double& error) {
    SteppingState& s = run.s;
    const int n = s.n();
    const auto W2 = s.system.weight.head(n).array().square();
    const double rounding = 10 * std::numeric_limits<double>::epsilon() * s.setup.length;
    constexpr int max_corrections = 8;
    // A correction below this share of the tolerance is the last one: the factors belong to the point
    // before it, which is accurate enough for the next expansion.
    constexpr double final_share = 1e-2;
    double last_size = std::numeric_limits<double>::infinity();
    for (int k = 0; k < max_corrections; ++k) {
        if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
            return outcome;
        double parameter_change = 0;  // [m]
        const bool corrects_parameter = run.by_arc() && !run.previous_direction.isZero(0);
        if (corrects_parameter) {
            drive_at(s, run.e.drive, 1.0, s.q, s.lambda);
            back_substitute(s);
            run.c.unit = s.work.x;
        }
        residual_at(s, s.q, s.lambda);
        if (k == 0 && certificate != nullptr) {
            certificate->force_end = largest_force(s);
            certificate->constraint_end = largest_violation(s);
        }
        back_substitute(s);
        if (corrects_parameter) {
            const auto along = run.previous_direction.head(n).array() * W2;
            const double da = -(along * s.work.x.head(n).array()).sum() /
                              (along * run.c.unit.head(n).array()).sum();
            s.work.x += da * run.c.unit;
            run.go_to(run.parameter_now() + da);
            parameter_change = run.metres_per_unit * std::abs(da);
        }
        if (!s.work.x.allFinite()) return Outcome::not_finite;
        const double size = std::sqrt(size_of_solution(s));
        const double correction = std::max(size, parameter_change);
        if (const Outcome outcome = check_idle_load_here(run.s, correction);
            outcome != Outcome::converged)
            return outcome;
        if (k == 0) error = correction;
        if (!(size < last_size)) break;  // at rounding level
        last_size = size;
        s.step.dq = s.work.x.head(n);
        advance(s.q, s.step.dq);
        s.lambda += s.work.x.tail(s.m());
        if (size <= std::max(rounding, final_share * run.options.tolerance)) break;
    }
    return became_inconsistent(s) ? Outcome::inconsistent_constraints : Outcome::converged;
}

std::vector<Pose> poses_of(const State<double>& q) {
    std::vector<Pose> poses;
    poses.reserve(q.slots.size());
    for (BodyId b = 0; b < q.bodies(); ++b) poses.push_back({q[b].r, q[b].p});
    return poses;
}

// Shortens the range to where the first deformation leaves its piece. The branch does not end there:
// `reaches_end` becomes false.
void stop_at_knots(const Continuation& run, Range& range) {
    const double reach = range.tau;
    std::vector<std::pair<Crossing, PieceExit>> exits;
    for (std::size_t k = 0; k < run.curves.size(); ++k) {
        const auto exit = exit_from_piece(deformation_series(run.e, run.curves[k], run.c.order),
                                          run.curves[k], reach, run.knot_tolerance);
        if (!exit) continue;
        exits.push_back({{k, exit->direction}, *exit});
        if (exit->wrong_piece) range.wrong_pieces.push_back(exits.back().first);
        if (exit->tau < range.tau)
            range = {.tau = exit->tau, .wrong_pieces = std::move(range.wrong_pieces)};
    }
    // Several deformations may reach their knots at the same τ.
    for (const auto& [crossing, exit] : exits)
        if (exit.tau <= range.tau ||
            is_at_knot(deformation_series(run.e, run.curves[crossing.curve], run.c.order),
                       run.curves[crossing.curve], crossing.direction, range.tau,
                       run.knot_tolerance))
            range.crossings.push_back(crossing);
}

// Whether a curve leaves its piece before a limit point at τ_s straight ahead. Such a limit point
// belongs to polynomials that are not valid that far. Near it x_s - x ~ (1 - τ/τ_s)^½, so that a
// deformation still moves by 2 τ_s times its present rate; the test allows twice that, for the
// terms that the square root omits.
bool meets_knot_before(const Continuation& run, double tau_s) {
    return std::ranges::any_of(run.curves, [&](const CurvePiece& f) {
        const double rate = deformation(run.e, f.elastic, f.axis, 1);
        const auto distance = distance_to_knot(run.e, f, rate < 0 ? -1 : +1);
        return distance && *distance <= 4 * tau_s * std::abs(rate);
    });
}

// Range of validity of the expansion at the parameter a_0; an outcome other than `converged` if the
// branch does not continue. The range ends at the truncation tolerance, at the end of the branch or
// at a knot, whichever comes first.
Outcome range_of_validity(Continuation& run, double a_0, const Singularity& singularity,
                          Range& range) {
    // Truncation.
    const double accurate_range =
        reach(run.s, run.c, run.options.tolerance, run.metres_per_unit, singularity.radius);
    range = {.tau = accurate_range};
    if (std::isnan(range.tau)) return Outcome::not_finite;

    // End of the branch, then knots.
    if (run.by_arc()) {
        constexpr double max_arc = 1;  // [m]; a branch without curvature has an infinite range
        range.tau = std::min(range.tau, max_arc);
        if (const auto end =
                first_zero([&](double t) { return polynomial(run.c.load, t) - run.last_parameter; },
                           range.tau))
            range = {.tau = *end, .reaches_end = true};
        stop_at_knots(run, range);
        return Outcome::converged;
    }
    const double tau_end = (run.last_parameter - a_0) / run.branch_end;
    if (range.tau >= tau_end) range = {.tau = tau_end, .reaches_end = true};
    stop_at_knots(run, range);
    if (range.reaches_end || !range.crossings.empty() || !range.wrong_pieces.empty())
        return Outcome::converged;

    // Limit point. τ is a share of the branch here, as a_1 is branch_end. Ranges that follow one
    // another shrink with the distance τ_s of the limit point, so that a singularity straight ahead
    // at a small τ_s is taken for one; at the very small τ_s whatever the knots.
    constexpr double small_distance = 1e-4, very_small_distance = 1e-8;
    constexpr double max_angle = 1e-3, max_misfit = 1e-2;  // of a singularity straight ahead
    const bool straight_ahead = singularity.angle < max_angle && singularity.misfit < max_misfit;
    if (singularity.radius < small_distance && straight_ahead &&
        (singularity.radius < very_small_distance || !meets_knot_before(run, singularity.radius))) {
        run.path.limits.push_back(a_0 + singularity.radius * run.branch_end);
        return Outcome::limit_point;
    }
    // Another singularity so near that the path cannot be resolved, or too low an order for the
    // tolerance.
    constexpr double min_range = 1e-9, min_radius = 1e-6;
    if (accurate_range < min_range && singularity.radius < min_radius) return Outcome::branch_lost;
    return Outcome::converged;
}

// Evaluates the expansion about `from` at its midpoint and end, corrects the end by Newton's method
// and fills the certificate. If the error at the end is above the limit, the range is shortened and
// the evaluation repeated: the error of order p grows as τᵖ⁺¹, so that (tolerance / error)^(1/(p+1))
// times the range meets the tolerance.
Outcome accept_expansion(Continuation& run, const State<double>& from, Range& range,
                         Certificate& certificate) {
    constexpr int max_shortenings = 20;
    constexpr double accepted = 10;  // times the tolerance: the error is only estimated before
    constexpr double safety = 0.9, min_factor = 0.3, max_factor = 0.9;
    constexpr double factor_without_error = 0.5;  // Newton's method did not converge
    for (int shortening = 0; shortening <= max_shortenings; ++shortening) {
        move_to(run, from, range.tau / 2);
        residual_at(run.s, run.s.q, run.s.lambda);
        certificate.force_middle = largest_force(run.s);
        certificate.constraint_middle = largest_violation(run.s);
        if (run.stable)
            run.middle_determinant =
                factorise_at(run.s, run.s.q, run.s.lambda) == Outcome::converged ? determinant(run)
                                                                                 : -1;

        move_to(run, from, range.tau);
        if (range.reaches_end && !run.by_arc()) run.go_to(run.last_parameter);
        run.previous_direction = run.by_arc() ? derivative(run.c.polynomial(), range.tau)
                                              : Vector<double>(run.c.x.col(1));
        const Outcome outcome = correct_at_end(run, &certificate, certificate.error_end);
        const double error = certificate.error_end;
        if (outcome == Outcome::converged && error <= accepted * run.options.tolerance)
            return outcome;
        if (outcome == Outcome::not_finite || outcome == Outcome::loaded_idle_mode ||
            outcome == Outcome::inconsistent_constraints)
            return outcome;
        ++run.path.rejected;
        const double factor = std::pow(run.options.tolerance / error, 1.0 / (run.c.order + 1));
        range = {.tau = range.tau * (outcome == Outcome::converged
                                         ? std::clamp(safety * factor, min_factor, max_factor)
                                         : factor_without_error)};
    }
    return Outcome::branch_lost;
}

// Starts at the design position with the factors of the analysis.
Outcome begin_at_design(Continuation& run, const Analysis& analysis) {
    run.go_to(0);
    // Select the piece of each curve: at a knot the analysis may have used the other piece.
    if (!run.curves.empty()) {
        begin(run.e, run.s.q, run.s.lambda, run.parameter_now());
        evaluate(run.e, {0, Pass::known});
    }
    for (auto& curve : run.curves) {
        find_piece(run.e, curve);
        run.use_piece(curve);
    }
    run.go_to(run.branch_end);  // with all forces at the end of the branch
    if (run.e.drive == Drive::start ? loads_idle_mode(run.s)
                                    : check_idle_load_here(run.s, 0) != Outcome::converged)
        return Outcome::loaded_idle_mode;
    run.go_to(0);
    if (run.curves.empty()) return check_factors(run.s, run.s.q, analysis.pivot_ratio);
    return factorise_at(run.s, run.s.q, run.s.lambda);
}

// Changes every curve in `crossings` to its neighbouring piece. The matrix is factorised again if a
// slope jumps; the direction of the motion jumps there too. With arc length the path continues on
// the side on which the product of the determinant's sign and a' is unchanged.
Outcome cross_knots(Continuation& run, const std::vector<Crossing>& crossings) {
    bool jumps = false;
    for (const auto& [k, direction] : crossings) {
        jumps = cross_knot(run.curves[k], direction) || jumps;
        run.use_piece(run.curves[k]);
    }
    if (!jumps) return Outcome::converged;
    const Outcome outcome = factorise_at(run.s, run.s.q, run.s.lambda);
    if (run.by_arc() && !run.path.expansions.empty()) {
        run.previous_direction.setZero();
        run.a_1 = run.s.system.lu.orientation == run.sign_at_start ? std::abs(run.branch_end)
                                                                   : -std::abs(run.branch_end);
    }
    return outcome;
}

std::vector<Piece> pieces_of(const std::vector<CurvePiece>& curves) {
    std::vector<Piece> all;
    for (const auto& curve : curves) all.push_back(curve.piece);
    return all;
}

// Expands at the present point on the pieces that the motion enters. A deformation that starts at a
// knot and leaves its piece at once belongs to the neighbouring piece. Each change of piece changes
// the motion: a linear complementarity problem. All such curves change piece together; once a set
// of pieces would repeat, only the first of them does, which ends where a solution exists (Murty
// 1974). Where no set agrees with its motion, the path turns back at the knot.
Outcome expand_here(Continuation& run, Singularity& singularity, Range& range) {
    std::vector<std::vector<Piece>> tried;
    bool together = true;
    for (;;) {
        const double rest = (run.last_parameter - run.parameter_now()) / run.a_1;
        expand(run.s, run.e, run.c,
               {.a_1 = run.a_1,
                .order = run.options.order,
                .rest = run.by_arc() ? std::numeric_limits<double>::infinity() : rest,
                .tolerance = run.options.tolerance,
                .metres_per_unit = run.metres_per_unit,
                .arc_length = run.by_arc()},
               run.previous_direction);
        singularity = nearest_singularity(run.s, run.c);
        if (const Outcome o = range_of_validity(run, run.parameter_now(), singularity, range);
            o != Outcome::converged)
            return o;
        if (range.wrong_pieces.empty()) return Outcome::converged;
        tried.push_back(pieces_of(run.curves));
        const auto repeats_pieces = [&] {
            auto next = pieces_of(run.curves);
            for (const auto& [k, direction] : range.wrong_pieces) next[k] += direction;
            return std::ranges::find(tried, next) != tried.end();
        };
        if (together && repeats_pieces()) {
            together = false;
            tried.assign(1, pieces_of(run.curves));
        }
        if (!together) range.wrong_pieces.resize(1);
        if (repeats_pieces()) {
            run.path.limits.push_back(run.parameter_now());
            return Outcome::limit_point;
        }
        if (const Outcome o = cross_knots(run, range.wrong_pieces); o != Outcome::converged)
            return o;
    }
}

// Maximum number of expansions: the option's number, and as many again for each crossing of a knot;
// crossings count up to the number of knots.
std::size_t max_expansions(const Continuation& run, std::size_t knots_crossed) {
    std::size_t knots = 0;
    for (const auto& curve : run.curves) knots += curve.curve->knots.size();
    return static_cast<std::size_t>(run.options.expansions) * (1 + std::min(knots_crossed, knots));
}

// What the sides of a branch share: the start, its stability and the coefficients x_k of the
// expansion there (x, load). On a side whose a_1 is r times as large, x_k is rᵏ times as large.
struct SharedStart {
    State<double> q;
    Vector<double> lambda;
    std::vector<double> held_values;  // Held::value
    Matrix<double> x;
    Vector<double> load;
    double log_determinant = 0;
    int determinant_sign = 0;
    StartStability stability;
};

// The expansion at the start from that of another side of the branch.
Outcome expand_shared(Continuation& run, const SharedStart& shared, Singularity& singularity,
                      Range& range) {
    const double r = run.a_1 / shared.load[1];
    double power = 1;
    for (Eigen::Index k = 0; k < shared.x.cols(); ++k, power *= r)
        run.c.x.col(k) = power * shared.x.col(k);
    run.c.order = static_cast<int>(shared.x.cols()) - 1;
    run.c.load = shared.load;
    run.c.load[1] = run.a_1;
    singularity = nearest_singularity(run.s, run.c);
    return range_of_validity(run, run.parameter_now(), singularity, range);
}

// Determinant and stability at the start of a path.
struct StartConditions {
    // the start of another side of the branch (null: none); with a value, expand_shared() has used it
    std::optional<SharedStart>* shared = nullptr;
    bool uses_shared = false;
    const StartStability* stability = nullptr;  // where it is known
};

// Notes the determinant's sign at the start of the path and, with the load as parameter, checks the
// stability there. Fills the empty shared start for the other side of the branch.
Outcome note_start(Continuation& run, const StartConditions& conditions) {
    SteppingState& s = run.s;
    const auto& [shared, uses_shared, known_stability] = conditions;
    run.sign_at_start =
        uses_shared ? (*shared)->determinant_sign : determinant_sign(run, run.branch_end);
    if (run.e.drive != Drive::rate || run.by_arc()) return Outcome::converged;
    const StartStability stability = uses_shared                  ? (*shared)->stability
                                     : known_stability != nullptr ? *known_stability
                                                                  : start_stability(s);
    run.softest_modes = stability.softest;
    run.stable = stability.least.of_energy && stability.least.value > 0;
    if (const Outcome outcome = check_start_stability(s, stability); outcome != Outcome::converged)
        return outcome;
    if (shared != nullptr && !uses_shared)
        *shared = {s.q,
                   s.lambda,
                   s.system.held.value,
                   run.c.polynomial(),
                   run.c.load,
                   log_determinant(s.system),
                   run.sign_at_start,
                   stability};
    return Outcome::converged;
}

// Shortens the range to the first event inside it, which the polynomial passes smoothly, and moves
// the state there. The outcome of the path at that event, `converged` if there is none.
Outcome stop_at_event(Continuation& run, const State<double>& from, Range& range) {
    if (const auto reversal = find_reversal(run, from, range.tau)) {
        range = {.tau = *reversal};
        run.reversed = true;
        return Outcome::branch_lost;
    }
    bool singular = is_past(run, parameter_rate_ahead(run));
    if (!singular)
        if (const auto instability = find_instability(run, from, range.tau)) {
            singular = true;
            range.tau = *instability;
        }
    if (!singular) return Outcome::converged;
    range.tau = locate_bifurcation(run, from, range.tau);
    return Outcome::bifurcation_point;
}

// Follows the path from an equilibrium, with its factors in s.system, to the end. `known`:
// stability of that equilibrium, if known. `shared`: the start of another side of the branch;
// filled if it is empty.
Outcome follow_to_end(Continuation& run, const StartStability* known = nullptr,
                      std::optional<SharedStart>* shared = nullptr) {
    // With arc length the path may return; beyond this multiple of the branch it does not.
    constexpr double max_excursion = 2;
    SteppingState& s = run.s;
    std::size_t knots_crossed = 0;
    const std::vector<Piece> pieces = pieces_of(run.curves);
    while (run.path.expansions.size() < max_expansions(run, knots_crossed)) {
        // Expansion and its range of validity.
        const bool starts = run.path.expansions.empty();
        const bool uses_shared = starts && shared != nullptr && *shared;
        const State<double> from = s.q;
        Singularity singularity;
        Range range;
        Certificate certificate;
        if (const Outcome o = uses_shared ? expand_shared(run, **shared, singularity, range)
                                          : expand_here(run, singularity, range);
            o != Outcome::converged)
            return o;

        // Determinant and stability where the expansion starts. Crossing a knot must not have
        // changed the sign of the determinant.
        if (starts) {
            // A stability that is known belongs to the pieces before expand_here().
            const bool is_known = known != nullptr && pieces_of(run.curves) == pieces;
            if (const Outcome o =
                    note_start(run, {shared, uses_shared, is_known ? known : nullptr});
                o != Outcome::converged)
                return o;
        } else if (!run.by_arc() && determinant_sign(run, run.branch_end) != run.sign_at_start) {
            return Outcome::singular;
        }
        run.start_log_determinant =
            uses_shared ? (*shared)->log_determinant : log_determinant(s.system);

        // Correction at the end of the range, and events inside it.
        if (const Outcome o = accept_expansion(run, from, range, certificate);
            o != Outcome::converged)
            return o;
        const Outcome event = stop_at_event(run, from, range);
        if (run.by_arc()) record_limit_points(run, range.tau);
        run.path.expansions.push_back(
            {poses_of(from), run.c.polynomial(), run.c.load.head(run.c.order + 1), range.tau,
             static_cast<int>(range.crossings.size()), singularity, certificate});
        knots_crossed += range.crossings.size();
        if (event != Outcome::converged) return event;

        // End of the branch, or the next pieces of the curves. A branch that is cut at
        // last_parameter ends where a driven length vanishes.
        if (range.reaches_end)
            return run.last_parameter == run.branch_end ? Outcome::converged
                                                        : Outcome::inconsistent_constraints;
        if (run.by_arc() &&
            !(std::abs(run.parameter_now()) <= max_excursion * std::abs(run.branch_end)))
            return Outcome::branch_lost;
        if (const Outcome o = cross_knots(run, range.crossings); o != Outcome::converged) return o;
    }
    return Outcome::iteration_limit;
}

std::string failure_text(const Continuation& run, Outcome outcome, const Diagnosis& diagnosis) {
    const bool settles = run.e.drive == Drive::start;
    const std::string branch = fmt::format("branch '{}'", run.s.branch.name);
    const std::string place =
        settles ? fmt::format("{}: settling the start, at {:.6g} of the homotopy", branch,
                              run.parameter_now())
                : fmt::format("{}: at {}", branch,
                              parameter_text(run.s.branch.unit, run.parameter_now()));
    if (!run.s.start.unstable.empty())
        return fmt::format("{}: the equilibrium that settles at 0 is unstable: {}", branch,
                           run.s.start.unstable);
    switch (outcome) {
        case Outcome::limit_point:
            return settles
                       ? fmt::format(
                             "{}: settling the start, limit point at {:.9g} of the homotopy, "
                             "past it "
                             "no equilibrium continues it",
                             branch, run.path.limits.back())
                       : fmt::format(
                             "{}: limit point near {}, past it no equilibrium continues "
                             "the branch",
                             branch, parameter_text(run.s.branch.unit, run.path.limits.back(), 9));
        case Outcome::iteration_limit:
            return place +
                   fmt::format(": {} expansions were not enough", run.path.expansions.size());
        case Outcome::singular:
            return place +
                   ": the matrix is or was singular: the branch bifurcates or loses its stability" +
                   end_by_diagnosis(outcome, diagnosis);
        case Outcome::inconsistent_constraints:
            if (const auto vanishing = vanishing_length(run.s.model, run.s.branch);
                vanishing && std::abs(run.parameter_now()) >= 0.99 * std::abs(run.last_parameter))
                return fmt::format("{}: {}", branch,
                                   no_length(run.s.model, run.s.branch, *vanishing));
            return place + end_by_diagnosis(outcome, diagnosis);
        case Outcome::branch_lost:
            if (run.reversed)
                return place +
                       ": a spring passes through zero length or a bushing through half a turn, "
                       "where its force jumps";
            return place;
        default: return place + end_by_diagnosis(outcome, diagnosis);
    }
}

SteppingState series_state(const Model& model, const Branch& branch, const Analysis& analysis) {
    SteppingState s(model, branch, analysis);
    s.setup.consistent = true;
    s.system.lu.largest_multiplier = 1e4;  // Newton corrections at every end restore accuracy
    return s;
}

// Finds the equilibrium at load factor 0 by a homotopy t from the design position (t = 0) to it
// (t = 1). Pre: s.start.Phi_d is the constraint error of the analysis, also where SteppingState has
// set it to zero because it is below guard::closed: t = 0 is then exact. At t = 1 such an error
// counts as zero again.
Outcome settle(Continuation& settling, const Analysis& analysis) {
    SteppingState& s = settling.s;
    if (const Outcome o = begin_at_design(settling, analysis); o != Outcome::converged) return o;
    const Outcome outcome = follow_to_end(settling);
    if (s.start.Phi_d.norm() <= guard::closed) s.start.Phi_d.setZero();
    return settled(s, outcome, 0.0);
}

void place_at_start(SteppingState& s, std::vector<CurvePiece>& curves, const Start& start) {
    s.q = start.q;
    s.lambda = start.lambda;
    s.start.Phi_d = start.Phi_d;
    s.system = start.system;
    for (std::size_t k = 0; k < curves.size(); ++k) curves[k].piece = start.pieces[k];
}

// Newton's method from the start of another branch. Returns whether it converges to the tolerance,
// within a hundredth of L and on the same pieces of the curves. Not used with idle modes: their
// positions would depend on the start of Newton's method.
bool settle_near(SteppingState& s, std::vector<CurvePiece>& curves,
                 const recursive::Series& options, const Start& other) {
    constexpr double max_distance = 1e-2;  // in L
    if (s.system.held.idle > 0) return false;
    place_at_start(s, curves, other);
    Continuation run(s, curves, options, Drive::rate);
    run.go_to(0);
    for (const double limit : {max_distance * s.setup.length, options.tolerance}) {
        double correction = 0;
        if (correct_at_end(run, nullptr, correction) != Outcome::converged ||
            !(correction <= limit))
            return false;
    }
    begin(run.e, s.q, s.lambda, run.parameter_now());
    evaluate(run.e, {0, Pass::known});
    return std::ranges::all_of(curves, [&](CurvePiece curve) {
        const Piece piece = curve.piece;
        find_piece(run.e, curve);
        return curve.piece == piece;
    });
}

bool has_no_rate(const Branch& branch) {
    return std::ranges::all_of(branch.drivers, [](const Driver& d) { return d.rate == 0; });
}

// The path of a branch on which nothing moves: one constant expansion at its start.
Outcome stay_at_start(Continuation& run, const StartStability* known) {
    SteppingState& s = run.s;
    const Outcome outcome =
        check_start_stability(s, known != nullptr ? *known : start_stability(s));
    if (outcome != Outcome::converged) return outcome;
    Expansion constant{poses_of(s.q),
                       Matrix<double>::Zero(s.n() + s.m(), 2),
                       Vector<double>::Zero(2),
                       1,
                       0,
                       {},
                       {}};
    constant.x.col(0).tail(s.m()) = s.lambda;
    constant.load[1] = run.branch_end;
    run.path.expansions.push_back(std::move(constant));
    return Outcome::converged;
}

// The drivers that act at load factor 0.
std::vector<Driver> start_values(const Branch& branch) {
    std::vector<Driver> list;
    std::ranges::copy_if(branch.drivers, std::back_inserter(list),
                         [](const Driver& driver) { return driver.start != 0; });
    return list;
}

// Follows one side. `shared` (null: not used): empty, or the start of another side with the same
// drivers; filled where both sides can use it.
Path follow(const Model& model, const Branch& branch, const recursive::Series& options,
            const Analysis& analysis, std::optional<SharedStart>* shared) {
    check(model, branch);
    if (std::isnan(analysis.diagnosis.constraint_error)) {
        Path none;
        none.outcome = Outcome::not_finite;
        none.detail = not_finite(model);
        return none;
    }
    SteppingState s = series_state(model, branch, analysis);
    std::vector<CurvePiece> curves = curves_of(model);
    const auto finish = [&](Continuation& run, Outcome outcome) {
        run.path.outcome = outcome;
        if (outcome != Outcome::converged)
            run.path.detail = failure_text(run, outcome, analysis.diagnosis);
        run.path.counts = s.counts;
        run.path.arc_length = options.arc_length;
        if (run.e.drive == Drive::start) run.path.expansions.clear();
        return std::move(run.path);
    };
    const auto finish_from_start = [&](const StartStability* stability) {
        Continuation run(s, curves, options, Drive::rate);
        run.go_to(0);
        if (has_no_rate(branch)) return finish(run, stay_at_start(run, stability));
        return finish(run, follow_to_end(run, stability, shared));
    };
    if (!curves.empty() || options.arc_length) shared = nullptr;
    if (shared != nullptr && *shared) {
        s.q = (*shared)->q;
        s.lambda = (*shared)->lambda;
        s.system.held.value = (*shared)->held_values;
        Continuation run(s, curves, options, Drive::rate);
        run.go_to(run.branch_end);  // with all forces at the end of the branch
        const Outcome loaded = check_idle_load_here(run.s, 0);
        run.go_to(0);
        return finish(run,
                      loaded == Outcome::converged ? follow_to_end(run, nullptr, shared) : loaded);
    }
    if (const Start* start = analysis.settled.get();
        start != nullptr && same_values(start->drivers, start_values(branch))) {
        place_at_start(s, curves, *start);
        return finish_from_start(&start->stability);
    }
    // The factors of the analysis belong to the design position. If that is no equilibrium,
    // settling starts there; if it is, the branch does.
    if (!analysis.at_rest || !starts_as_drawn(branch)) {
        s.start.Phi_d = analysis.Phi_d;
        Continuation settling(s, curves, options, Drive::start);
        if (const Outcome o = settle(settling, analysis); o != Outcome::converged)
            return finish(settling, o);
        return finish_from_start(nullptr);
    }
    Continuation run(s, curves, options, Drive::rate);
    if (const Outcome o = begin_at_design(run, analysis); o != Outcome::converged)
        return finish(run, o);
    return finish(run, follow_to_end(run, curves.empty() ? &analysis.start : nullptr, shared));
}

}  // namespace

Path follow(const Model& model, const Branch& branch, const recursive::Series& options,
            const Analysis& analysis) {
    return follow(model, branch, options, analysis, nullptr);
}

void keep_start(const Model& model, const Branch& branch, const recursive::Series& options,
                Analysis& analysis) {
    check(model, branch);
    const auto last = std::move(analysis.settled);
    const bool as_drawn = analysis.at_rest && starts_as_drawn(branch);
    if (as_drawn || std::isnan(analysis.diagnosis.constraint_error)) return;
    const auto keep = [&](SteppingState& s, const std::vector<CurvePiece>& curves) {
        go_to(s, {1, 0});
        analysis.settled =
            std::make_shared<const Start>(start_values(branch), s.q, s.lambda, s.start.Phi_d,
                                          s.system, pieces_of(curves), start_stability(s));
    };
    if (last) {
        SteppingState s = series_state(model, branch, analysis);
        std::vector<CurvePiece> curves = curves_of(model);
        if (settle_near(s, curves, options, *last)) return keep(s, curves);
    }
    SteppingState s = series_state(model, branch, analysis);
    std::vector<CurvePiece> curves = curves_of(model);
    s.start.Phi_d = analysis.Phi_d;
    Continuation settling(s, curves, options, Drive::start);
    if (settle(settling, analysis) == Outcome::converged) keep(s, curves);
}

std::vector<Path> follow_sides(const Model& model, std::span<const Branch> sides,
                               const recursive::Series& options, const Analysis& analysis) {
    std::vector<Path> paths;
    std::optional<SharedStart> shared;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        if (k > 0 && !same_drivers(sides[k - 1], sides[k])) shared.reset();
        paths.push_back(follow(model, sides[k], options, analysis, &shared));
    }
    return paths;
}

Path follow(const Model& model, const Branch& branch, const recursive::Series& options) {
    return follow(model, branch, options, analyse(model));
}

}  // namespace elastocheck::recursive::series
