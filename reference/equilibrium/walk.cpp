#include "reference/equilibrium/walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The chord and the tangents at its ends may be this far apart, over the chord.
constexpr double straight = 0.25;

// Steps of this part of the model's size are not argued about: their chord is round-off.
constexpr double too_short_to_bend = 1e-6;

// The longest step [L or rad]: a body turned further looks different from all sides. One that is moved only may go
// farther, where the way has been straight: as far as it has bent, were it to bend on, this part of it.
constexpr double longest_step = 0.2;
constexpr double bent = 0.1;

// A further Newton step from an accepted state is at most this: a small residual alone says little about soft
// directions beside stiff ones.
constexpr double last_correction = 1e-8;

// What the joints hold is known to this, and nothing is said of a state that it moves farther than a last correction. Where
// a mechanism divides, the numbers of the scene, rounded, lead over from one curve to the other within the root of it.
constexpr double held = 2e-15;

// The part of a load that an idle mode may seem to carry by round-off.
constexpr double unanswered_round_off = 1e-9;

// However close the points, a step between two is halved this often before the branch is given up.
constexpr int least_halvings = 6;

// Trials to find a knot before the step is shortened as any other; each is h⁴ better than the one before.
constexpr int most_aims = 20;

// Steps from one point asked for to the next before the branch is called too long: some sixty turns, or four hundred L.
constexpr int most_steps = 2000;

// How far past the smallest step the branch is looked for before it is called lost: the first such step, by how much the
// next ones are longer, and how many. What is singular within 1e-12 of the way shows the side that it came to farther off.
constexpr double past_the_end = 3, farther = 4;
constexpr int looks = 14;

Station station_at(Walk& walk, double t, VectorXd x, const Linearisation* last) {
    Station station;
    station.t = t;
    station.x = std::move(x);
    Derivatives by = derivatives(walk.system, loading_at(walk, t), station.x, walk.counts);
    station.linearised = linearise(std::move(by.J), last, walk.counts);
    station.stiffness = stiffness(walk.system, station.linearised);
    station.E = std::move(by.E);
    station.E_rate = std::move(by.E_rate);
    const Rate rate = answer(station.linearised.bordered, station.E_rate);
    station.tangent = rate.dx;
    station.mu = rate.mu;
    station.curves = on_curves(walk.system, loading_at(walk, t), station.x, station.tangent);
    return station;
}

// How the tangent has turned since the station before, over h: what a step bends.
std::optional<VectorXd> bend(const Walk& walk, double h) {
    if (!walk.before || walk.before->t == walk.here.t) return std::nullopt;
    return h * h / 2 * (walk.here.tangent - walk.before->tangent) / (walk.here.t - walk.before->t);
}

// The tangent, bent as it has turned.
VectorXd predicted_step(const Walk& walk, double h) {
    VectorXd dx = h * walk.here.tangent;
    if (const auto more = bend(walk, h); more && more->norm() < 0.5 * dx.norm()) dx += *more;
    return dx;
}

bool is_within_reach(const Walk& walk, double h, const VectorXd& dx) {
    if (pose_size(walk.system, dx) <= longest_step) return true;
    const auto more = bend(walk, h);
    if (!dx.allFinite() || !more || !(pose_size(walk.system, *more) <= bent * longest_step)) return false;
    for (int body = 0; body < walk.system.bodies; ++body)
        if (dx.segment<3>(6 * body + 3).norm() > longest_step) return false;
    return true;
}

// The chord against both tangents.
bool is_continuation(const System& system, const Station& from, const Station& to) {
    const VectorXd chord = step_between(system, from.x, to.x);
    const double h = to.t - from.t, size = pose_size(system, chord);
    const double apart =
        std::max(pose_size(system, chord - h * from.tangent), pose_size(system, chord - h * to.tangent));
    return std::isfinite(size) && std::isfinite(apart) &&
           apart <= std::max(straight * size, too_short_to_bend);
}

// Half way between two equilibria the cubic through both with their tangents is h⁴ from the curve,
//
//   x_m = x₀ + (x₁ - x₀) / 2 + h (x₀' - x₁') / 8
Stability stability_between(Walk& walk, const Station& from, const Station& to) {
    const double h = to.t - from.t;
    const VectorXd dx = step_between(walk.system, from.x, to.x) / 2 + h / 8 * (from.tangent - to.tangent);
    auto by = derivatives(walk.system, loading_at(walk, from.t + h / 2), moved(walk.system, from.x, dx),
                          walk.counts);
    const Linearisation middle = linearise(std::move(by.J), &from.linearised, walk.counts);
    return over_step(from.stiffness, stiffness(walk.system, middle), to.stiffness);
}

// Whether a continuation is on this side of every singular point. On the way from the design pose somebody
// holds the bodies, and only the settled state is judged.
Verdict side_of(Walk& walk, const Station& next) {
    if (walk.stage == Stage::settling) return Verdict::accepted;
    if (next.linearised.modes.count() > walk.here.linearised.modes.count()) return Verdict::turned_over;
    if (!next.linearised.modes_are_new && next.linearised.orientation() != walk.here.linearised.orientation())
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

// Whether springs and links point where they did, nearly: on a long step one may have gone through where it has no length,
// and the chord between two straight ways does not tell.
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

// How far a rounding of all that the joints hold moves a state; its signs are those of fractions of multiples of the golden
// ratio, which know nothing of the system.
// What is soft answers with more, and is judged as a stiffness: as far as it has become softer it does not count.
double moved_by_rounding(const Walk& walk, const Station& at) {
    const int m = walk.system.constraint_rows;
    VectorXd E = VectorXd::Zero(walk.system.equations());
    for (int k = 0; k < m; ++k)
        E[6 * walk.system.bodies + k] = std::fmod(0.6180339887498949 * (k + 1), 1.) < 0.5 ? held : -held;
    if (m == 0) return 0;
    const double softer = walk.first_stiffness > 0 ? at.stiffness.least / walk.first_stiffness : 1;
    return std::clamp(softer, 0., 1.) * pose_size(walk.system, answer(at.linearised.bordered, E).dx);
}

Trial try_step(Walk& walk, double t) {
    const System& system = walk.system;
    const Loading loading = loading_at(walk, t);
    const VectorXd dx = predicted_step(walk, t - walk.here.t);
    if (!is_within_reach(walk, t - walk.here.t, dx)) return {Verdict::out_of_reach};

    Trial trial{Verdict::unsolved, newton(system, loading, moved(system, walk.here.x, dx),
                                          walk.here.linearised, walk.options, walk.counts)};
    const Attempt& attempt = trial.attempt;
    if (!(std::isfinite(attempt.residual) && attempt.residual <= walk.options.tolerance)) return trial;

    trial.station = station_at(walk, t, attempt.x, &walk.here.linearised);
    Station& next = trial.station;
    const VectorXd further = answer(next.linearised.bordered, next.E).dx;
    const double correction = further.norm();
    const double h = t - walk.here.t;
    if (!is_continuation(system, walk.here, next))
        trial.verdict = Verdict::another_branch;
    else if (pose_size(system, dx) > longest_step && !directions_are_kept(system, walk.here.x, next.x))
        trial.verdict = Verdict::out_of_reach;
    else if (const auto exit = first_exit(walk.here.curves, next.curves, h, walk.pieces))
        trial.verdict = Verdict::past_knot, trial.knot = walk.here.t + *exit * h;
    else if (!(std::isfinite(correction) && correction <= last_correction))
        trial.verdict = Verdict::unsettled;
    else if (walk.stage == Stage::branch && !(moved_by_rounding(walk, next) <= last_correction))
        trial.verdict = Verdict::uncertain;
    else {
        trial.verdict = side_of(walk, next);
        // It is taken: what a correction leaves behind is its square times how much stiffer members are along than
        // across, 1e6 and more in a chain of beams.
        if (VectorXd x = moved(system, next.x, further);
            largest(residual(system, loading, x)) <= walk.options.tolerance)
            next.x = std::move(x);
    }
    return trial;
}

// No step of h is believed. A singular point that a step happens to hit says nothing; past it there is the
// branch, on the other side, or there is not.
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

// Onto the next piece wherever a deformation is at the end of its own and leaves it. The state stays, where it goes
// from here changes.
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
                return Failure{Outcome::limit_point,
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
                fmt::format("the equilibrium loses its stability where a law has a knot, {}", where())};
    }
    return std::nullopt;
}

// A state at a knot may be `at_knot` past it, on the piece before. What is handed on is an equilibrium of the
// system itself.
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
    return Failure{Outcome::iteration_limit,
                   fmt::format("the scaled residual stays at {:.1e} where a law has a knot, at {}", open(),
                               parameter(*walk.system.branch, loading_at(walk, walk.here.t).a))};
}

}  // namespace

Walk start(const System& system, const Options& options) {
    Walk walk{system, options};
    walk.pieces = pieces_at(system, loading_at(walk, 0), design_unknowns(system));
    walk.here = station_at(walk, 0, design_unknowns(system), nullptr);
    return walk;
}

// E is linear in the reactions, and E at the design pose holds what they are to answer.
void let_joints_carry(System& system, Counts& counts) {
    const Eigen::Index n = 6 * system.bodies, m = system.constraint_rows;
    if (n == 0 || m == 0 || !system.at_design.allFinite()) return;
    const Sparse J = derivatives(system, {0, 1}, design_unknowns(system), counts).J;
    if (!is_finite(J)) return;
    system.carried -= least_squares(J.topRightCorner(n, m), system.at_design.head(n));
    system.at_design = held_at_design(system);
}

std::optional<Failure> begin_branch(Walk& walk, double reach) {
    walk.stage = Stage::branch;
    walk.length = std::max(std::abs(walk.system.branch->to), reach);
    walk.before.reset();
    walk.here = station_at(walk, 0, walk.here.x, &walk.here.linearised);
    // What hung on a load that has been let go of is idle only now.
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
    return Failure{
        Outcome::iteration_limit,
        fmt::format("arithmetic cannot tell what the joints leave free of the equilibrium that settles at {}",
                    at_0)};
}

namespace {
Failure too_long(const Walk& walk, double target) {
    const auto at = [&](double t) {
        return walk.stage == Stage::settling ? fmt::format("{:.0f} % of the way to what settles", 100 * t)
                                             : parameter(*walk.system.branch, t);
    };
    return {Outcome::iteration_limit, fmt::format("{} steps have come to {}, and {} is too far", most_steps,
                                                  at(walk.here.t), at(target))};
}
}  // namespace

std::optional<Failure> advance(Walk& walk, double target) {
    double h = target - walk.here.t;
    const double smallest =
        std::min(std::ldexp(walk.length, -walk.options.halvings), std::ldexp(std::abs(h), -least_halvings));
    std::optional<Trial> refused;  // the most telling since the last step
    double knot = 0;               // where a piece ends before the end of the step ...
    int aims = 0;                  // ... and how often it was aimed at: 0 where the whole step is tried
    int steps = 0;
    while (walk.here.t != target) {
        if (auto failed = change_pieces(walk, target > walk.here.t ? 1 : -1)) return failed;
        const double rest = target - walk.here.t;
        const double unanswered = std::abs(rest) * walk.here.mu.norm(),
                     asked = std::abs(rest) * walk.here.E_rate.norm();
        if (unanswered > std::max(walk.options.tolerance, unanswered_round_off * asked))
            return unanswerable(walk.system, walk.here.linearised.modes.left * walk.here.mu);
        if (!walk.here.tangent.allFinite())
            return Failure{Outcome::singular,
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
            const bool says_more =
                !refused || (refused->verdict != Verdict::turned_over && trial.verdict != Verdict::uncertain);
            if (says_more) refused = std::move(trial);
            h = aims > 0 ? (t - walk.here.t) / 2 : h / 2;
            aims = 0;
            if (std::abs(h) < smallest * (1 - 1e-9)) return the_end(walk, h, t, std::move(*refused));
        }
    }
    return onto_its_own_pieces(walk);
}

}  // namespace elastocheck::reference::equilibrium
