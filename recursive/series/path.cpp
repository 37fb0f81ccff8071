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

// Newton corrections at the present point; the last factors serve the next expansion. The first
// correction is the error of the expansion. With arc length the parameter is corrected too, so that
// nothing moves along the path.
Outcome correct_at_end(Continuation& w, Certificate* certificate, double& error) {
    SteppingState& s = w.s;
    const int n = s.n();
    const auto W2 = s.system.weight.head(n).array().square();
    const double rounding = 10 * std::numeric_limits<double>::epsilon() * s.setup.length;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 8; ++k) {
        if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
            return outcome;
        double parameter_change = 0;  // [m]
        const bool free_parameter = w.by_arc() && !w.ahead.isZero(0);
        if (free_parameter) {
            drive_at(s, w.e.drive, 1.0, s.q, s.lambda);
            back_substitute(s);
            w.c.unit = s.work.x;
        }
        residual_at(s, s.q, s.lambda);
        if (k == 0 && certificate != nullptr) {
            certificate->force_end = largest_force(s);
            certificate->constraint_end = largest_violation(s);
        }
        back_substitute(s);
        if (free_parameter) {
            const auto along = w.ahead.head(n).array() * W2;
            const double da = -(along * s.work.x.head(n).array()).sum() /
                              (along * w.c.unit.head(n).array()).sum();
            s.work.x += da * w.c.unit;
            w.go_to(w.parameter_now() + da);
            parameter_change = w.per_unit * std::abs(da);
        }
        if (!s.work.x.allFinite()) return Outcome::not_finite;
        const double size = std::sqrt(size_of_solution(s));
        const double missed = std::max(size, parameter_change);
        if (const Outcome outcome = check_idle_load_here(w.s, missed);
            outcome != Outcome::converged)
            return outcome;
        if (k == 0) error = missed;
        if (!(size < before)) break;  // at rounding level
        before = size;
        s.step.dq = s.work.x.head(n);
        advance(s.q, s.step.dq);
        s.lambda += s.work.x.tail(s.m());
        // The factors belong to the point before this correction: accurate enough if it was small.
        if (size <= std::max(rounding, 1e-2 * w.options.tolerance)) break;
    }
    return became_inconsistent(s) ? Outcome::inconsistent_constraints : Outcome::converged;
}

std::vector<Pose> poses_of(const State<double>& q) {
    std::vector<Pose> poses;
    poses.reserve(q.slots.size());
    for (BodyId b = 0; b < q.bodies(); ++b) poses.push_back({q[b].r, q[b].p});
    return poses;
}

// Shortens the range to where the first deformation leaves its piece.
void stop_at_knots(const Continuation& w, End& end) {
    const double reach = end.tau;
    std::vector<std::pair<Crossing, PieceExit>> met;
    for (std::size_t k = 0; k < w.curves.size(); ++k)
        if (const auto there =
                exit_from_piece(deformation_series(w.e, w.curves[k]), w.curves[k], reach, w.near)) {
            met.push_back({{k, there->direction}, *there});
            if (there->wrong_piece) end.wrong_pieces.push_back(met.back().first);
            if (there->tau < end.tau)
                end = {.tau = there->tau, .wrong_pieces = std::move(end.wrong_pieces)};
        }
    // Several deformations may reach their knots at the same τ.
    for (const auto& [crossing, there] : met)
        if (there.tau <= end.tau ||
            is_at_knot(deformation_series(w.e, w.curves[crossing.curve]), w.curves[crossing.curve],
                       crossing.direction, end.tau, w.near))
            end.crossings.push_back(crossing);
}

// Whether a curve leaves its piece before a limit point at τ_s straight ahead. Such a limit point
// belongs to polynomials that are not valid that far. Near it x_s - x ~ (1 - τ/τ_s)^½, so that a
// deformation still moves by 2 τ_s times its present rate; the test allows twice that, for the
// terms that the square root omits.
bool meets_knot_before(const Continuation& w, double tau_s) {
    return std::ranges::any_of(w.curves, [&](const CurvePiece& f) {
        const double rate = deformation(w.e, f.elastic, f.axis, 1);
        const auto to = distance_to_knot(w.e, f, rate < 0 ? -1 : +1);
        return to && *to <= 4 * tau_s * std::abs(rate);
    });
}

// Range of validity of the expansion at the parameter a_0; an outcome other than `converged` if the
// branch does not continue.
Outcome range_of_validity(Continuation& w, double a_0, const Singularity& singularity, End& end) {
    end = {.tau = reach(w.s, w.c, w.options.tolerance, w.per_unit, singularity.radius)};
    if (std::isnan(end.tau)) return Outcome::not_finite;
    const double reached = end.tau;
    if (w.by_arc()) {
        // [m]; a branch without curvature would have an infinite range
        end.tau = std::min(end.tau, 1.0);
        if (const auto first =
                first_zero([&](double t) { return polynomial(w.c.load, t) - w.end; }, end.tau))
            end = {.tau = *first, .last = true};
        stop_at_knots(w, end);
        return Outcome::converged;
    }
    const double rest = (w.end - a_0) / w.to;
    if (end.tau >= rest) end = {.tau = rest, .last = true};
    stop_at_knots(w, end);
    if (end.last || !end.crossings.empty() || !end.wrong_pieces.empty()) return Outcome::converged;
    // distance of the singularity, as a share of the branch: close; too close to resolve
    constexpr double near = 1e-4, unresolved = 1e-8;
    const bool straight_ahead = singularity.angle < 1e-3 && singularity.misfit < 1e-2;
    if (singularity.radius < near && straight_ahead &&
        (singularity.radius < unresolved || !meets_knot_before(w, singularity.radius))) {
        // A branch point straight ahead that comes nearer with each expansion is a limit point.
        w.path.limits.push_back(a_0 + singularity.radius * w.to);
        return Outcome::limit_point;
    }
    if (reached < 1e-9 && singularity.radius < 1e-6)
        return Outcome::branch_lost;  // or the order is too low for the tolerance
    return Outcome::converged;
}

// Evaluates the expansion about `from` at its midpoint and end, corrects the end by Newton's method
// and fills the certificate. If the error at the end is too large, the range is shortened
// and the evaluation repeated.
Outcome accept_expansion(Continuation& w, const State<double>& from, End& end,
                         Certificate& certificate) {
    for (int shorter = 0; shorter <= 20; ++shorter) {
        move_to(w, from, end.tau / 2);
        residual_at(w.s, w.s.q, w.s.lambda);
        certificate.force_middle = largest_force(w.s);
        certificate.constraint_middle = largest_violation(w.s);
        if (w.stable)
            w.at_middle =
                factorise_at(w.s, w.s.q, w.s.lambda) == Outcome::converged ? determinant(w) : -1;

        move_to(w, from, end.tau);
        if (end.last && !w.by_arc()) w.go_to(w.end);
        w.ahead = w.by_arc() ? derivative(w.c.x, end.tau) : Vector<double>(w.c.x.col(1));
        const Outcome outcome = correct_at_end(w, &certificate, certificate.error_end);
        const double error = certificate.error_end;
        if (outcome == Outcome::converged && error <= 10 * w.options.tolerance) return outcome;
        if (outcome == Outcome::not_finite || outcome == Outcome::loaded_idle_mode ||
            outcome == Outcome::inconsistent_constraints)
            return outcome;
        ++w.path.rejected;
        const double shrink = std::pow(w.options.tolerance / error, 1.0 / (w.e.order() + 1));
        end = {.tau = end.tau *
                      (outcome == Outcome::converged ? std::clamp(0.9 * shrink, 0.3, 0.9) : 0.5)};
    }
    return Outcome::branch_lost;
}

// Starts at the design position with the factors of the analysis.
Outcome begin_at_design(Continuation& w, const Analysis& analysis) {
    w.go_to(0);
    // Select the piece of each curve: at a knot the analysis may have used the other piece.
    if (!w.curves.empty()) {
        begin(w.e, w.s.q, w.s.lambda, w.parameter_now());
        evaluate(w.e, {0, Pass::known});
    }
    for (auto& curve : w.curves) {
        find_piece(w.e, curve);
        w.use(curve);
    }
    w.go_to(w.to);  // with all forces at the end of the branch
    if (w.e.drive == Drive::start ? loads_idle_mode(w.s)
                                  : check_idle_load_here(w.s, 0) != Outcome::converged)
        return Outcome::loaded_idle_mode;
    w.go_to(0);
    if (w.curves.empty()) return check_factors(w.s, w.s.q, analysis.pivot_ratio);
    return factorise_at(w.s, w.s.q, w.s.lambda);
}

// Changes every curve in `crossings` to its neighbouring piece. The matrix is factorised again if a
// slope jumps; the direction of the motion jumps there too. With arc length the path continues on
// the side on which the product of the determinant's sign and a' is unchanged.
Outcome cross_knots(Continuation& w, const std::vector<Crossing>& crossings) {
    bool jumps = false;
    for (const auto& [k, direction] : crossings) {
        jumps = cross_knot(w.curves[k], direction) || jumps;
        w.use(w.curves[k]);
    }
    if (!jumps) return Outcome::converged;
    const Outcome outcome = factorise_at(w.s, w.s.q, w.s.lambda);
    if (w.by_arc() && !w.path.expansions.empty()) {
        w.ahead.setZero();
        w.a_1 = w.s.system.lu.orientation == w.sign_at_start ? std::abs(w.to) : -std::abs(w.to);
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
Outcome expand_here(Continuation& w, Singularity& singularity, End& end) {
    std::vector<std::vector<Piece>> tried;
    bool together = true;
    for (;;) {
        expand(w.s, w.e, w.c, w.a_1, w.by_arc(), w.ahead);
        singularity = nearest_singularity(w.s, w.c);
        if (const Outcome o = range_of_validity(w, w.parameter_now(), singularity, end);
            o != Outcome::converged)
            return o;
        if (end.wrong_pieces.empty()) return Outcome::converged;
        tried.push_back(pieces_of(w.curves));
        const auto would_repeat = [&] {
            auto next = pieces_of(w.curves);
            for (const auto& [k, direction] : end.wrong_pieces) next[k] += direction;
            return std::ranges::find(tried, next) != tried.end();
        };
        if (together && would_repeat()) {
            together = false;
            tried.assign(1, pieces_of(w.curves));
        }
        if (!together) end.wrong_pieces.resize(1);
        if (would_repeat()) {
            w.path.limits.push_back(w.parameter_now());
            return Outcome::limit_point;
        }
        if (const Outcome o = cross_knots(w, end.wrong_pieces); o != Outcome::converged) return o;
    }
}

// Maximum number of expansions: the option's number, and as many again for each crossing of a knot;
// crossings count up to the number of knots.
std::size_t max_expansions(const Continuation& w, std::size_t knots_crossed) {
    std::size_t knots = 0;
    for (const auto& curve : w.curves) knots += curve.curve->knots.size();
    return static_cast<std::size_t>(w.options.expansions) * (1 + std::min(knots_crossed, knots));
}

// What the sides of a branch share: the start, its stability and the coefficients x_k of the
// expansion there (x, load). On a side whose a_1 is r times as large, x_k is rᵏ times as large.
struct SharedStart {
    State<double> q;
    Vector<double> lambda;
    std::vector<double> held;  // Held::value
    Matrix<double> x;
    Vector<double> load;
    double log_determinant = 0;
    int determinant_sign = 0;
    StartStability stability;
};

// The expansion at the start from that of another side of the branch.
Outcome expand_shared(Continuation& w, const SharedStart& shared, Singularity& singularity,
                      End& end) {
    const double r = w.a_1 / shared.load[1];
    double power = 1;
    for (Eigen::Index k = 0; k < shared.x.cols(); ++k, power *= r)
        w.c.x.col(k) = power * shared.x.col(k);
    w.c.load = shared.load;
    w.c.load[1] = w.a_1;
    singularity = nearest_singularity(w.s, w.c);
    return range_of_validity(w, w.parameter_now(), singularity, end);
}

// Follows the path from an equilibrium, with its factors in s.system, to the end. `known`:
// stability of that equilibrium, if known. `shared`: the start of another side of the branch;
// filled if it is empty.
Outcome follow_to_end(Continuation& w, const StartStability* known = nullptr,
                      std::optional<SharedStart>* shared = nullptr) {
    SteppingState& s = w.s;
    std::size_t knots_crossed = 0;
    const std::vector<Piece> pieces = pieces_of(w.curves);
    while (w.path.expansions.size() < max_expansions(w, knots_crossed)) {
        const bool starts = w.path.expansions.empty();
        const bool has_shared = starts && shared != nullptr && *shared;
        const State<double> from = s.q;
        Singularity singularity;
        End end;
        Certificate certificate;
        if (const Outcome o = has_shared ? expand_shared(w, **shared, singularity, end)
                                         : expand_here(w, singularity, end);
            o != Outcome::converged)
            return o;
        // Crossing a knot must not have changed the sign of the determinant.
        if (const int sign_here =
                has_shared ? (*shared)->determinant_sign : determinant_sign(w, w.to);
            starts) {
            w.sign_at_start = sign_here;
            if (w.e.drive == Drive::rate && !w.by_arc()) {
                const bool is_known = known != nullptr && pieces_of(w.curves) == pieces;
                const StartStability start = has_shared ? (*shared)->stability
                                             : is_known ? *known
                                                        : start_stability(s);
                w.softest = start.softest;
                w.stable = start.least.of_energy && start.least.value > 0;
                if (const Outcome o = check_start_stability(s, start); o != Outcome::converged)
                    return o;
                if (shared != nullptr && !has_shared)
                    *shared = {s.q,       s.lambda, s.system.held.value,
                               w.c.x,     w.c.load, log_determinant(s.system),
                               sign_here, start};
            }
        } else if (sign_here != w.sign_at_start && !w.by_arc()) {
            return Outcome::singular;
        }
        w.log_begin = has_shared ? (*shared)->log_determinant : log_determinant(s.system);
        if (const Outcome o = accept_expansion(w, from, end, certificate); o != Outcome::converged)
            return o;
        const auto reversed = find_reversal(w, from, end.tau);
        if (reversed) {
            end = {.tau = *reversed};
            w.reversed = true;
        }
        // The polynomial continues past a bifurcation point, and the branch past a
        // loss of stability.
        bool past = !reversed && is_past(w, parameter_rate_ahead(w));
        if (!past && !reversed)
            if (const auto lost = find_instability(w, from, end.tau)) {
                past = true;
                end.tau = *lost;
            }
        if (past) end.tau = locate_bifurcation(w, from, end.tau);
        if (w.by_arc()) record_limit_points(w, end.tau);
        w.path.expansions.push_back({poses_of(from), w.c.x, w.c.load, end.tau,
                                     static_cast<int>(end.crossings.size()), singularity,
                                     certificate});
        knots_crossed += end.crossings.size();
        if (past) return Outcome::bifurcation_point;
        if (reversed) return Outcome::branch_lost;
        if (end.last) return w.end == w.to ? Outcome::converged : Outcome::inconsistent_constraints;
        if (w.by_arc() && !(std::abs(w.parameter_now()) <= 2 * std::abs(w.to)))
            return Outcome::branch_lost;
        if (const Outcome o = cross_knots(w, end.crossings); o != Outcome::converged) return o;
    }
    return Outcome::iteration_limit;
}

std::string failure_text(const Continuation& w, Outcome outcome, const Diagnosis& diagnosis) {
    const bool settles = w.e.drive == Drive::start;
    const std::string branch = fmt::format("branch '{}'", w.s.branch.name);
    const std::string place =
        settles
            ? fmt::format("{}: settling the start, at {:.6g} of the homotopy", branch,
                          w.parameter_now())
            : fmt::format("{}: at {}", branch, parameter_text(w.s.branch.unit, w.parameter_now()));
    if (!w.s.start.unstable.empty())
        return fmt::format("{}: the equilibrium that settles at 0 is unstable: {}", branch,
                           w.s.start.unstable);
    switch (outcome) {
        case Outcome::limit_point:
            return settles ? fmt::format(
                                 "{}: settling the start, limit point at {:.9g} of the homotopy, "
                                 "past it "
                                 "no equilibrium continues it",
                                 branch, w.path.limits.back())
                           : fmt::format(
                                 "{}: limit point near {}, past it no equilibrium continues "
                                 "the branch",
                                 branch, parameter_text(w.s.branch.unit, w.path.limits.back(), 9));
        case Outcome::iteration_limit:
            return place + fmt::format(": {} expansions were not enough", w.path.expansions.size());
        case Outcome::singular:
            return place +
                   ": the matrix is or was singular: the branch bifurcates or loses its stability" +
                   end_by_diagnosis(outcome, diagnosis);
        case Outcome::inconsistent_constraints:
            if (const auto vanishing = vanishing_length(w.s.model, w.s.branch);
                vanishing && std::abs(w.parameter_now()) >= 0.99 * std::abs(w.end))
                return fmt::format("{}: {}", branch, no_length(w.s.model, w.s.branch, *vanishing));
            return place + end_by_diagnosis(outcome, diagnosis);
        case Outcome::branch_lost:
            if (w.reversed)
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

// Settles from the design position. Pre: s.start.Phi_d is the constraint error of the analysis,
// also where SteppingState has set it to zero as closed: t = 0 is then exact.
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
// within a hundredth of L and on the same pieces of the curves. Not with idle modes, whose
// positions depend on the path.
bool settle_near(SteppingState& s, std::vector<CurvePiece>& curves,
                 const recursive::Series& options, const Start& other) {
    constexpr double near = 1e-2;
    if (s.system.held.idle > 0) return false;
    place_at_start(s, curves, other);
    Continuation w(s, curves, options, Drive::rate);
    w.go_to(0);
    for (const double limit : {near * s.setup.length, options.tolerance}) {
        double correction = 0;
        if (correct_at_end(w, nullptr, correction) != Outcome::converged || !(correction <= limit))
            return false;
    }
    begin(w.e, s.q, s.lambda, w.parameter_now());
    evaluate(w.e, {0, Pass::known});
    return std::ranges::all_of(curves, [&](CurvePiece curve) {
        const Piece piece = curve.piece;
        find_piece(w.e, curve);
        return curve.piece == piece;
    });
}

bool is_at_rest(const Branch& branch) {
    return std::ranges::all_of(branch.drivers, [](const Driver& d) { return d.rate == 0; });
}

// The path of a branch on which nothing moves: one constant expansion at its start.
Outcome stay_at_start(Continuation& w, const StartStability* known) {
    SteppingState& s = w.s;
    const Outcome outcome =
        check_start_stability(s, known != nullptr ? *known : start_stability(s));
    if (outcome != Outcome::converged) return outcome;
    Expansion here{poses_of(s.q),
                   Matrix<double>::Zero(s.n() + s.m(), 2),
                   Vector<double>::Zero(2),
                   1,
                   0,
                   {},
                   {}};
    here.x.col(0).tail(s.m()) = s.lambda;
    here.load[1] = w.to;
    w.path.expansions.push_back(std::move(here));
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
    const auto finish = [&](Continuation& w, Outcome outcome) {
        w.path.outcome = outcome;
        if (outcome != Outcome::converged)
            w.path.detail = failure_text(w, outcome, analysis.diagnosis);
        w.path.counts = s.counts;
        w.path.arc_length = options.arc_length;
        if (w.e.drive == Drive::start) w.path.expansions.clear();
        return std::move(w.path);
    };
    const auto finish_from_start = [&](const StartStability* stability) {
        Continuation w(s, curves, options, Drive::rate);
        w.go_to(0);
        if (is_at_rest(branch)) return finish(w, stay_at_start(w, stability));
        return finish(w, follow_to_end(w, stability, shared));
    };
    if (!curves.empty() || options.arc_length) shared = nullptr;
    if (shared != nullptr && *shared) {
        s.q = (*shared)->q;
        s.lambda = (*shared)->lambda;
        s.system.held.value = (*shared)->held;
        Continuation w(s, curves, options, Drive::rate);
        w.go_to(w.to);  // with all forces at the end of the branch
        const Outcome loaded = check_idle_load_here(w.s, 0);
        w.go_to(0);
        return finish(w, loaded == Outcome::converged ? follow_to_end(w, nullptr, shared) : loaded);
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
    Continuation w(s, curves, options, Drive::rate);
    if (const Outcome o = begin_at_design(w, analysis); o != Outcome::converged)
        return finish(w, o);
    return finish(w, follow_to_end(w, curves.empty() ? &analysis.start : nullptr, shared));
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
