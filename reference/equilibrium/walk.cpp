#include "reference/equilibrium/walk.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void set_tangent(const Walk& walk, Station& station) {
    station.E_rate =
        walk.stage == Stage::settling ? walk.system.at_design : load_rate(walk.system, station.x);
    const Rate rate = answer(station.linearised, station.E_rate);
    station.tangent = rate.dx;
    station.mu = rate.mu;
}

Station station_at(Walk& walk, double t, VectorXd x, const Linearisation* last) {
    Station station;
    station.t = t;
    station.x = std::move(x);
    MatrixXd J = jacobian(walk.system, loading_at(walk.stage, t).factor, station.x, walk.counts);
    station.linearised = linearise(std::move(J), last, walk.counts);
    set_tangent(walk, station);
    return station;
}

// The tangent, bent as it has turned since the station before.
VectorXd predicted_step(const Walk& walk, double h) {
    VectorXd dx = h * walk.here.tangent;
    if (walk.before && walk.before->t != walk.here.t) {
        const VectorXd bend = (walk.here.tangent - walk.before->tangent) / (walk.here.t - walk.before->t);
        if (h * h / 2 * bend.norm() < 0.5 * dx.norm()) dx += h * h / 2 * bend;
    }
    return dx;
}

// The chord against both tangents; steps of a millionth of the model's size are not argued about.
bool is_continuation(const System& system, const Station& from, const Station& to) {
    const VectorXd chord = step_between(system, from.x, to.x);
    const double h = to.t - from.t, size = pose_size(system, chord);
    const double apart =
        std::max(pose_size(system, chord - h * from.tangent), pose_size(system, chord - h * to.tangent));
    return std::isfinite(size) && std::isfinite(apart) && apart <= std::max(0.25 * size, 1e-6);
}

Trial try_step(Walk& walk, double t) {
    const System& system = walk.system;
    const Loading loading = loading_at(walk.stage, t);
    const VectorXd dx = predicted_step(walk, t - walk.here.t);
    if (!(pose_size(system, dx) <= 0.2)) return {Verdict::out_of_reach, {}, {}};

    Trial trial{Verdict::unsolved,
                newton(system, loading, moved(system, walk.here.x, dx), walk.options, walk.counts),
                {}};
    const Attempt& attempt = trial.attempt;
    if (!(std::isfinite(attempt.residual) && attempt.residual <= walk.options.tolerance)) return trial;

    trial.station = station_at(walk, t, attempt.x, &walk.here.linearised);
    const Station& next = trial.station;
    // A small residual alone says little about soft directions beside stiff ones.
    const double correction = answer(next.linearised, residual(system, loading, next.x)).dx.norm();
    const bool same_side = walk.stage == Stage::settling || next.linearised.modes_are_new ||
                           next.linearised.orientation == walk.here.linearised.orientation;
    trial.verdict = !is_continuation(system, walk.here, next)            ? Verdict::another_branch
                    : !(std::isfinite(correction) && correction <= 1e-8) ? Verdict::unsettled
                    : !same_side                                         ? Verdict::turned_over
                                                                         : Verdict::accepted;
    return trial;
}

}  // namespace

Walk start(const System& system, const Options& options) {
    Walk walk{system, options, Stage::settling, {}, std::nullopt, {}};
    walk.here = station_at(walk, 0, design_unknowns(system), nullptr);
    return walk;
}

void begin_loading(Walk& walk) {
    walk.stage = Stage::loading;
    walk.before.reset();
    walk.here.t = 0;
    set_tangent(walk, walk.here);
}

std::optional<Failure> advance(Walk& walk, double target) {
    const double smallest = std::ldexp(std::abs(target - walk.here.t), -walk.options.halvings);
    double h = target - walk.here.t;
    while (walk.here.t != target) {
        const double rest = target - walk.here.t;
        const double unanswered = std::abs(rest) * walk.here.mu.norm(),
                     asked = std::abs(rest) * walk.here.E_rate.norm();
        if (unanswered > std::max(walk.options.tolerance, 1e-9 * asked))
            return unanswerable(walk.system, walk.here.linearised.modes.left * walk.here.mu);
        if (!walk.here.tangent.allFinite())
            return Failure{Outcome::singular, fmt::format("the system is singular at load factor {:.10g}",
                                                          loading_at(walk.stage, walk.here.t).factor)};

        if (std::abs(h) >= std::abs(rest) * (1 - 1e-9)) h = rest;
        const double t = h == rest ? target : walk.here.t + h;
        Trial trial = try_step(walk, t);
        if (trial.verdict == Verdict::accepted) {
            walk.before = std::move(walk.here);
            walk.here = std::move(trial.station);
            h *= 2;
        } else {
            h /= 2;
            if (std::abs(h) < smallest * (1 - 1e-9)) return failure(walk, t, trial);
        }
    }
    return std::nullopt;
}

}  // namespace elastocheck::reference::equilibrium
