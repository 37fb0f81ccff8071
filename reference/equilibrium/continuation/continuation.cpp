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
constexpr double straight = 0.25;

// Below this share of the model's size the chord is round-off and is not tested.
constexpr double too_short_to_bend = 1e-6;

// Longest step [L or rad]. A body that only translates may go farther on a straight path: as long
// as the second-order term of the predictor is at most the part `bent` of this length.
constexpr double longest_step = 0.2;
constexpr double bent = 0.1;

// Largest further Newton step from an accepted state: a small residual does not bound the error in
// soft directions beside stiff ones.
constexpr double last_correction = 1e-8;

// Rounding of the constrained quantities: a state that it moves by more than a last correction is
// not judged. At a bifurcation of a mechanism, rounding ε of the scene's numbers connects the two
// curves within a distance √ε.
constexpr double held = 2e-15;

// Relative part of a load on an idle mode that counts as round-off.
constexpr double unanswered_round_off = 1e-9;

// However close the points, a step between two of them may be halved at least this often.
constexpr int least_halvings = 6;

// Trials to locate a knot before the step is shortened like any other; the error of each is O(h⁴)
// of the previous.
constexpr int most_aims = 20;

// Steps between two requested points before the branch counts as too long: about sixty turns, or
// four hundred L.
constexpr int most_steps = 2000;

// Search past the smallest step before the branch counts as lost: length of the first probe in
// smallest steps, growth factor, number of probes. A point that is singular within 1e-12 of the
// stage shows its other side only farther on.
constexpr double past_the_end = 3, farther = 4;
constexpr int looks = 14;

Station station_at(Walk& walk, double t, VectorXd x, const Linearisation* last) {
    Station station;
    station.t = t;
    station.x = std::move(x);
    Derivatives by = derivatives(walk.system, loading_at(walk, t), station.x, walk.counts);
    station.linearised = linearise(std::move(by.J), last, walk.counts);
    if (station.linearised.modes_are_new)
        free_what_is_resisted(walk.system, loading_at(walk, t), station.x, station.linearised,
                              walk.counts);
    station.stiffness = stiffness(walk.system, station.linearised);
    station.E = std::move(by.E);
    station.E_rate = std::move(by.E_rate);
    const Rate rate = answer(station.linearised.bordered, station.E_rate);
    station.tangent = rate.dx;
    station.mu = rate.mu;
    station.curves = on_curves(walk.system, loading_at(walk, t), station.x, station.tangent);
    return station;
}

// Second-order term of the predictor over h, from the change of the tangent since the last station.
std::optional<VectorXd> bend(const Walk& walk, double h) {
    if (!walk.before || walk.before->t == walk.here.t) return std::nullopt;
    return h * h / 2 * (walk.here.tangent - walk.before->tangent) / (walk.here.t - walk.before->t);
}

// Predictor: tangent and second-order term.
VectorXd predicted_step(const Walk& walk, double h) {
    VectorXd dx = h * walk.here.tangent;
    if (const auto more = bend(walk, h); more && more->norm() < 0.5 * dx.norm()) dx += *more;
    return dx;
}

bool is_within_reach(const Walk& walk, double h, const VectorXd& dx) {
    if (pose_size(walk.system, dx) <= longest_step) return true;
    const auto more = bend(walk, h);
    if (!dx.allFinite() || !more || !(pose_size(walk.system, *more) <= bent * longest_step))
        return false;
    for (int body = 0; body < walk.system.bodies; ++body)
        if (dx.segment<3>(6 * body + 3).norm() > longest_step) return false;
    return true;
}

// Compares the chord with both tangents.
bool is_continuation(const System& system, const Station& from, const Station& to) {
    const VectorXd chord = step_between(system, from.x, to.x);
    const double h = to.t - from.t, size = pose_size(system, chord);
    const double apart = std::max(pose_size(system, chord - h * from.tangent),
                                  pose_size(system, chord - h * to.tangent));
    return std::isfinite(size) && std::isfinite(apart) &&
           apart <= std::max(straight * size, too_short_to_bend);
}

// Midpoint of two equilibria by the cubic Hermite interpolant, with error O(h⁴),
//
//   x_m = x₀ + (x₁ - x₀) / 2 + h (x₀' - x₁') / 8
Stability stability_between(Walk& walk, const Station& from, const Station& to) {
    const double h = to.t - from.t;
    const VectorXd dx =
        step_between(walk.system, from.x, to.x) / 2 + h / 8 * (from.tangent - to.tangent);
    auto by = derivatives(walk.system, loading_at(walk, from.t + h / 2),
                          moved(walk.system, from.x, dx), walk.counts);
    const Linearisation middle = linearise(std::move(by.J), &from.linearised, walk.counts);
    return over_step(from.stiffness, stiffness(walk.system, middle), to.stiffness);
}

// Whether a continuation step stays on this side of every singular point. During the homotopy from
// the design pose the bodies are held externally, and only the settled state is judged.
Verdict side_of(Walk& walk, const Station& next) {
    if (walk.stage == Stage::settling) return Verdict::accepted;
    if (next.linearised.modes.count() > walk.here.linearised.modes.count())
        return Verdict::turned_over;
    if (!next.linearised.modes_are_new &&
        next.linearised.orientation() != walk.here.linearised.orientation())
        return Verdict::turned_over;
    if (!constraints_keep_their_side(walk.system, walk.here.linearised, next.linearised))
        return Verdict::turned_over;
    switch (stability_between(walk, walk.here, next)) {
        case Stability::kept: return Verdict::accepted;
        case Stability::lost: return Verdict::turned_over;
        case Stability::uncertain: break;
    }
    return Verdict::uncertain;
}

// Whether springs and links nearly keep their directions: on a long step one may have passed
// through zero length, which the chord between two straight paths does not show.
bool directions_are_kept(const System& system, const VectorXd& from, const VectorXd& to) {
    constexpr double nearly = 0.9;  // the cosine
    const auto kept = [&](const Point& i, const Point& j) {
        const auto between = [&](const VectorXd& x) {
            return Eigen::Vector3d(position(frame_of(system, x, j.body), j.s_local) -
                                   position(frame_of(system, x, i.body), i.s_local));
        };
        const Eigen::Vector3d a = between(from), b = between(to);
        return a.dot(b) >= nearly * a.norm() * b.norm();
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
double moved_by_rounding(const Walk& walk, const Station& at) {
    const int m = walk.system.constraint_rows;
    VectorXd E = VectorXd::Zero(walk.system.equations());
    for (int k = 0; k < m; ++k)
        E[6 * walk.system.bodies + k] =
            std::fmod(0.6180339887498949 * (k + 1), 1.) < 0.5 ? held : -held;
    if (m == 0) return 0;
    const double softer = walk.first_stiffness > 0 ? at.stiffness.least / walk.first_stiffness : 1;
    return std::clamp(softer, 0., 1.) *
           pose_size(walk.system, answer(at.linearised.bordered, E).dx);
}

Trial try_step(Walk& walk, double t) {
    const System& system = walk.system;
    const Loading loading = loading_at(walk, t);
    const VectorXd dx = predicted_step(walk, t - walk.here.t);
    if (!is_within_reach(walk, t - walk.here.t, dx)) return {Verdict::out_of_reach};

    Trial trial{Verdict::unsolved, newton(system, loading, moved(system, walk.here.x, dx),
                                          walk.here.linearised, walk.options, walk.counts)};
    const Attempt& attempt = trial.attempt;
    if (!(std::isfinite(attempt.residual) && attempt.residual <= walk.options.tolerance))
        return trial;

    trial.station = station_at(walk, t, attempt.x, &walk.here.linearised);
    Station& next = trial.station;
    const VectorXd further = answer(next.linearised.bordered, next.E).dx;
    const double correction = further.norm();
    const double h = t - walk.here.t;
    if (!is_continuation(system, walk.here, next))
        trial.verdict = Verdict::another_branch;
    else if (pose_size(system, dx) > longest_step &&
             !directions_are_kept(system, walk.here.x, next.x))
        trial.verdict = Verdict::out_of_reach;
    else if (const auto exit = first_exit(walk.here.curves, next.curves, h, walk.pieces))
        trial.verdict = Verdict::past_knot, trial.knot = walk.here.t + *exit * h;
    else if (!(std::isfinite(correction) && correction <= last_correction))
        trial.verdict = Verdict::unsettled;
    else if (walk.stage == Stage::branch && !(moved_by_rounding(walk, next) <= last_correction))
        trial.verdict = Verdict::uncertain;
    else {
        trial.verdict = side_of(walk, next);
        // The corrected state is kept: the error that a correction leaves is its square times the
        // ratio of axial to lateral member stiffness, 1e6 and more in a chain of beams.
        if (VectorXd x = moved(system, next.x, further);
            largest(residual(system, loading, x)) <= walk.options.tolerance)
            next.x = std::move(x);
    }
    return trial;
}

// No step of h is accepted. Probes beyond decide whether the branch continues past the singular
// point on its other side; a singular point that a probe hits exactly decides nothing.
Failure the_end(Walk& walk, double h, double t, Trial refused) {
    const auto is_clear = [](const Trial& at) {
        return at.verdict == Verdict::turned_over &&
               at.station.stiffness.least < -at.station.stiffness.round_off;
    };
    for (int k = 0; k < looks && walk.stage == Stage::branch && !is_clear(refused); ++k) {
        const double past = walk.here.t + past_the_end * std::pow(farther, k) * h;
        Trial probe = try_step(walk, past);
        if (is_clear(probe) ||
            (probe.verdict == Verdict::turned_over && refused.verdict != Verdict::turned_over)) {
            refused = std::move(probe);
            t = past;
        }
    }
    return failure(walk, t, refused);
}

// Switches to the next piece wherever a deformation is at the end of its piece and leaves it. The
// state stays, its tangent changes.
std::optional<Failure> change_pieces(Walk& walk, double direction) {
    const auto where = [&] {
        const std::string a = parameter(*walk.system.branch, loading_at(walk, walk.here.t).a);
        return walk.stage == Stage::settling
                   ? fmt::format("while settling at {}, {:.0f} % of the way", a, 100 * walk.here.t)
                   : "at " + a;
    };
    Pieces changed(walk.pieces.size(), ElementPieces{});  // by ±1, the others 0
    for (bool at_end = true; at_end;) {
        at_end = false;
        for (const OnCurve& at : walk.here.curves) {
            int& piece = walk.pieces[at.element][at.axis];
            const int side = leaves(at, piece, direction, walk.length);
            if (side == 0) continue;
            int& before = changed[at.element][at.axis];
            if (before == -side)
                return Failure{
                    Outcome::limit_point,
                    fmt::format("the branch turns back where the law of '{}' has a knot, {}",
                                walk.system.model->elastics[at.element].name, where())};
            before = side;
            piece += side;
            at_end = true;
            break;
        }
        if (!at_end) break;
        walk.before.reset();
        walk.here = station_at(walk, walk.here.t, walk.here.x, nullptr);
        const Stiffness& now = walk.here.stiffness;
        if (walk.stage == Stage::branch && over_step(now, now, now) != Stability::kept)
            return Failure{
                Outcome::singular,
                fmt::format("the equilibrium loses its stability where a law has a knot, {}",
                            where())};
    }
    return std::nullopt;
}

// A state at a knot may be `at_knot` past it, on the old piece. The returned state is corrected to
// an equilibrium of the system itself.
std::optional<Failure> onto_its_own_pieces(Walk& walk) {
    constexpr int attempts = 3;
    const auto open = [&] {
        Loading loading = loading_at(walk, walk.here.t);
        loading.pieces.clear();
        return largest(residual(walk.system, loading, walk.here.x));
    };
    if (walk.here.curves.empty()) return std::nullopt;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        if (open() <= walk.options.tolerance) return std::nullopt;
        walk.pieces = pieces_at(walk.system, loading_at(walk, walk.here.t), walk.here.x);
        const Attempt solved = newton(walk.system, loading_at(walk, walk.here.t), walk.here.x,
                                      walk.here.linearised, walk.options, walk.counts);
        walk.before.reset();
        walk.here = station_at(walk, walk.here.t, solved.x, nullptr);
    }
    if (open() <= walk.options.tolerance) return std::nullopt;
    return Failure{
        Outcome::iteration_limit,
        fmt::format("the scaled residual stays at {:.1e} where a law has a knot, at {}", open(),
                    parameter(*walk.system.branch, loading_at(walk, walk.here.t).a))};
}

}  // namespace

Walk start(const System& system, const Options& options) {
    Walk walk{system, options};
    hold(walk);
    return walk;
}

void hold(Walk& walk) {
    walk.stage = Stage::settling;
    walk.length = 1;
    walk.pieces = pieces_at(walk.system, loading_at(walk, 0), design_unknowns(walk.system));
    walk.before.reset();
    walk.here = station_at(walk, 0, design_unknowns(walk.system), nullptr);
}

std::optional<Failure> begin_branch(Walk& walk, double reach) {
    walk.stage = Stage::branch;
    walk.length = std::max(std::abs(walk.system.branch->to), reach);
    walk.before.reset();
    walk.here = station_at(walk, 0, walk.here.x, &walk.here.linearised);
    // A motion held only by a released load becomes idle only here.
    if (std::abs(walk.here.stiffness.least) <= walk.here.stiffness.round_off)
        walk.here = station_at(walk, 0, walk.here.x, nullptr);
    walk.first_stiffness = walk.here.stiffness.least;
    walk.first_tangent = pose_size(walk.system, walk.here.tangent);
    const std::string at_0 = parameter(*walk.system.branch, 0);
    switch (over_step(walk.here.stiffness, walk.here.stiffness, walk.here.stiffness)) {
        case Stability::kept: return std::nullopt;
        case Stability::lost:
            return Failure{Outcome::singular,
                           fmt::format("the equilibrium that settles at {} is unstable", at_0)};
        case Stability::uncertain: break;
    }
    return Failure{Outcome::iteration_limit,
                   fmt::format("arithmetic cannot tell what the joints leave free of the "
                               "equilibrium that settles at {}",
                               at_0)};
}

namespace {
Failure too_long(const Walk& walk, double target) {
    const auto at = [&](double t) {
        return walk.stage == Stage::settling
                   ? fmt::format("{:.0f} % of the way to what settles", 100 * t)
                   : parameter(*walk.system.branch, t);
    };
    return {Outcome::iteration_limit, fmt::format("{} steps have come to {}, and {} is too far",
                                                  most_steps, at(walk.here.t), at(target))};
}
}  // namespace

std::optional<Failure> advance(Walk& walk, double target) {
    double h = target - walk.here.t;
    const double smallest = std::min(std::ldexp(walk.length, -walk.options.halvings),
                                     std::ldexp(std::abs(h), -least_halvings));
    std::optional<Trial> refused;  // most informative trial since the last step
    double knot = 0;               // a piece ends here, before the end of the step ...
    int aims = 0;                  // ... number of attempts to locate it: 0 for the whole step
    int steps = 0;
    while (walk.here.t != target) {
        if (auto failed = change_pieces(walk, target > walk.here.t ? 1 : -1)) return failed;
        const double rest = target - walk.here.t;
        const double unanswered = std::abs(rest) * walk.here.mu.norm(),
                     asked = std::abs(rest) * walk.here.E_rate.norm();
        // A load below the tolerance is harmless on an idle motion, but not on a soft one.
        const bool soft = walk.here.linearised.modes_are_soft;
        if (unanswered >
            std::max(soft ? 0 : walk.options.tolerance, unanswered_round_off * asked)) {
            const VectorXd left = walk.here.linearised.modes.left * walk.here.mu;
            return soft ? too_soft(walk.system, left) : unanswerable(walk.system, left);
        }
        if (!walk.here.tangent.allFinite())
            return Failure{
                Outcome::singular,
                fmt::format("the system is singular at {}",
                            parameter(*walk.system.branch, loading_at(walk, walk.here.t).a))};

        if (std::abs(h) >= std::abs(rest) * (1 - 1e-9)) h = rest;
        const double t = aims > 0 ? knot : h == rest ? target : walk.here.t + h;
        Trial trial = try_step(walk, t);
        if (trial.verdict == Verdict::past_knot && aims < most_aims && trial.knot != walk.here.t) {
            knot = trial.knot;
            ++aims;
        } else if (trial.verdict == Verdict::accepted) {
            walk.before = std::move(walk.here);
            walk.here = std::move(trial.station);
            refused.reset();
            if (++steps == most_steps && walk.here.t != target) return too_long(walk, target);
            if (aims == 0) h *= 2;
            aims = 0;
        } else {
            const bool says_more = !refused || (refused->verdict != Verdict::turned_over &&
                                                trial.verdict != Verdict::uncertain);
            if (says_more) refused = std::move(trial);
            h = aims > 0 ? (t - walk.here.t) / 2 : h / 2;
            aims = 0;
            if (std::abs(h) < smallest * (1 - 1e-9))
                return the_end(walk, h, t, std::move(*refused));
        }
    }
    return onto_its_own_pieces(walk);
}

}  // namespace elastocheck::reference::equilibrium
