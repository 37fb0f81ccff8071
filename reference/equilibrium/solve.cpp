// Walking along a branch: from the design pose to the settled state at load factor 0, then from load to load.
//
// Newton's method knows nothing of branches; past a limit point it is glad to land on whatever equilibrium there is. So a
// step is believed only if it is a short, nearly straight piece of one curve: the chord between two equilibria and the
// tangents at both its ends agree within a quarter, and the orientation of the Jacobian is the same at both. Otherwise the
// step is halved, and if that does not help, the branch has ended here.
#include "reference/equilibrium/solve.hpp"

#include <fmt/format.h>

#include <optional>

#include "reference/equilibrium/linearisation.hpp"
#include "reference/equilibrium/newton.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Two legs of the way, each with a parameter t: letting go of the design pose (t = 0 ... 1), and loading (t = a).
enum class Stage { settling, loading };

Loading loading_at(Stage stage, double t) {
    return stage == Stage::settling ? Loading{0, 1 - t} : Loading{t, 0};
}

// An equilibrium that has been accepted.
struct Station {
    double t = 0;
    VectorXd x;
    Linearisation linearised;
    VectorXd tangent;  // dx/dt [n]
    VectorXd mu;       // what of dE/dt cannot be answered [k]
    VectorXd E_rate;   // dE/dt [n]
};

struct Walk {
    const System& system;
    const Options& options;
    Stage stage = Stage::settling;
    Station here;
    std::optional<Station> before;
    Counts counts;
};

struct Failure {
    Outcome outcome;
    std::string what;
};

VectorXd E_rate(const System& system, Stage stage, const VectorXd& x) {
    return stage == Stage::settling ? system.at_design : load_rate(system, x);
}

void set_tangent(const System& system, Stage stage, Station& station) {
    station.E_rate = E_rate(system, stage, station.x);
    const Rate rate = answer(station.linearised, station.E_rate);
    station.tangent = rate.dx;
    station.mu = rate.mu;
}

Station station_at(Walk& walk, double t, VectorXd x, const Linearisation* last) {
    Station station;
    station.t = t;
    station.x = std::move(x);
    station.linearised =
        linearise(jacobian(walk.system, loading_at(walk.stage, t).factor, station.x, walk.counts), last, walk.counts);
    set_tangent(walk.system, walk.stage, station);
    return station;
}

// Solved as far as arithmetic allows: the residual is within tolerance, and what a further Newton step would change is
// nothing. A small residual alone says little about soft directions beside stiff ones.
bool is_solved(const Walk& walk, const Attempt& attempt) {
    return attempt.x.allFinite() && std::isfinite(attempt.residual) && attempt.residual <= walk.options.tolerance;
}
bool is_at_rest(const Walk& walk, const Station& station) {
    const VectorXd E = residual(walk.system, loading_at(walk.stage, station.t), station.x);
    const double correction = answer(station.linearised, E).dx.norm();
    return std::isfinite(correction) && correction <= 1e-8;
}

// ---- Words

std::string body_with_largest(const System& system, const VectorXd& n) {
    double largest_part = -1;
    std::string name;
    for (int body = 0; body < system.bodies; ++body) {
        const double part = n.segment<6>(6 * body).norm();
        if (part > largest_part * 1.000001) {
            largest_part = part;
            name = system.model->bodies[static_cast<std::size_t>(body)].name;
        }
    }
    return name;
}

std::string joints_in(const System& system, const VectorXd& n) {
    std::string names;
    int row = 6 * system.bodies, last = -1;
    for (const auto& constraint : system.model->constraints) {
        const double part = n.segment(row, rows(constraint.kind)).norm();
        row += rows(constraint.kind);
        if (!(part > 1e-6 * n.norm()) || constraint.joint == last) continue;
        last = constraint.joint;
        names += (names.empty() ? "'" : ", '") + system.model->joints[static_cast<std::size_t>(last)].name + "'";
    }
    return names;
}

// What cannot be answered, as a left null vector of the system: a load on an idle mode, or joints against each other.
Failure unanswerable(const Walk& walk, const VectorXd& left) {
    const System& system = walk.system;
    if (left.tail(system.constraint_rows).norm() > left.head(6 * system.bodies).norm())
        return {Outcome::inconsistent_constraints,
                fmt::format("the joints {} contradict each other", joints_in(system, left))};
    return {Outcome::loaded_idle_mode, fmt::format("body '{}' is pushed along a motion that nothing resists",
                                                   body_with_largest(system, left))};
}

// Whether the constraints alone can be met near x: Gauss-Newton with minimum-norm steps, Φ_q dq = -Φ.
bool constraints_can_be_met(Walk& walk, VectorXd x) {
    const System& system = walk.system;
    const int m = system.constraint_rows;
    const auto Phi = [&] { return VectorXd(residual(system, {0, 0}, x).tail(m)); };
    for (int iteration = 0; iteration < 30; ++iteration) {
        const MatrixXd Phi_q = jacobian(system, 0, x, walk.counts).bottomLeftCorner(m, 6 * system.bodies);
        VectorXd dx = VectorXd::Zero(system.equations());
        Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
        decomposition.setThreshold(1e-10);
        dx.head(6 * system.bodies) = -decomposition.compute(Phi_q).solve(Phi());
        if (!dx.allFinite()) return false;
        x = moved(system, x, dx);
        ++walk.counts.factorisations;
    }
    const double error = largest(Phi());
    return std::isfinite(error) && error <= 1e-9;
}

// Why the branch does not go on from here towards t, judged by the last and smallest attempt.
Failure failure(Walk& walk, double t, const std::optional<Attempt>& attempt, bool turned_over) {
    const System& system = walk.system;
    const std::string where =
        walk.stage == Stage::settling
            ? fmt::format("while settling at load factor 0, {:.0f} % of the way", 100 * walk.here.t)
            : fmt::format("between load factors {:.10g} and {:.10g}", walk.here.t, t);
    if (turned_over)
        return {Outcome::singular, "the system is singular and the branch may divide or lose its stability " + where};
    if (const std::string bushing = bushing_at_half_turn(system, walk.here.x); !bushing.empty())
        return {Outcome::branch_lost, fmt::format("bushing '{}' is turned by half a turn, where its rotation has no value, {}",
                                                  bushing, where)};
    if (!attempt)  // the prediction alone was out of reach
        return {Outcome::branch_lost, "the branch becomes too steep to be followed " + where};
    if (!attempt->x.allFinite() || !std::isfinite(attempt->residual))
        return {Outcome::not_finite, "the equations gave a number that is not finite " + where};
    const bool solved = is_solved(walk, *attempt);
    if (!solved && attempt->out_of_time)
        return {Outcome::iteration_limit,
                fmt::format("{} iterations left a scaled residual of {:.1e} {}", walk.options.iteration_limit,
                            attempt->residual, where)};
    const VectorXd left_over = residual(system, loading_at(walk.stage, t), attempt->x);
    const MatrixXd& U = walk.here.linearised.modes.left;
    if (!solved && U.cols() > 0 && (U.transpose() * left_over).norm() > 0.9 * left_over.norm())
        return unanswerable(walk, U * (U.transpose() * left_over));
    if (walk.stage == Stage::settling && largest(system.at_design.tail(system.constraint_rows)) > 0 &&
        !constraints_can_be_met(walk, walk.here.x))
        return {Outcome::inconsistent_constraints, "no pose near the design pose satisfies all joints"};
    // At a limit point a good part of the load step finds no answer; a standstill far below that is one of arithmetic.
    const double step = std::abs(t - walk.here.t) * largest(walk.here.E_rate);
    if (!solved && attempt->residual <= std::max(1e-6 * step, 1e-13))
        return {Outcome::iteration_limit,
                fmt::format("the scaled residual came to rest at {:.1e} {}", attempt->residual, where)};
    return {Outcome::branch_lost, "no equilibrium continues the branch " + where};
}

// ---- Steps

// The tangent, bent as it has turned since the station before.
VectorXd predicted_step(const Walk& walk, double h) {
    VectorXd dx = h * walk.here.tangent;
    if (walk.before && walk.before->t != walk.here.t) {
        const VectorXd bend = (walk.here.tangent - walk.before->tangent) / (walk.here.t - walk.before->t);
        if (h * h / 2 * bend.norm() < 0.5 * dx.norm()) dx += h * h / 2 * bend;
    }
    return dx;
}

bool is_continuation(const System& system, const Station& from, const Station& to) {
    const VectorXd chord = step_between(system, from.x, to.x);
    const double h = to.t - from.t, size = pose_size(system, chord);
    const double apart = std::max(pose_size(system, chord - h * from.tangent), pose_size(system, chord - h * to.tangent));
    return std::isfinite(size) && std::isfinite(apart) && apart <= std::max(0.25 * size, 1e-6);
}

// From here to t = target, by as few steps as it takes.
std::optional<Failure> advance(Walk& walk, double target) {
    const System& system = walk.system;
    const double whole = target - walk.here.t;
    const double smallest = std::ldexp(std::abs(whole), -walk.options.halvings);
    double h = whole;
    while (walk.here.t != target) {
        const double rest = target - walk.here.t;
        const double unanswered = std::abs(rest) * walk.here.mu.norm();
        if (unanswered > std::max(walk.options.tolerance, 1e-9 * std::abs(rest) * walk.here.E_rate.norm()))
            return unanswerable(walk, walk.here.linearised.modes.left * walk.here.mu);

        if (std::abs(h) >= std::abs(rest) * (1 - 1e-9)) h = rest;
        const double t = h == rest ? target : walk.here.t + h;
        std::optional<Attempt> attempt;
        bool turned_over = false;
        const VectorXd dx = predicted_step(walk, h);
        if (!dx.allFinite()) return Failure{Outcome::singular, fmt::format("the system is singular at {:.10g}", walk.here.t)};
        if (pose_size(system, dx) <= 0.2) {
            attempt = newton(system, loading_at(walk.stage, t), moved(system, walk.here.x, dx), walk.options, walk.counts);
            if (is_solved(walk, *attempt)) {
                Station next = station_at(walk, t, attempt->x, &walk.here.linearised);
                const bool continues = is_at_rest(walk, next) && is_continuation(system, walk.here, next);
                turned_over = continues && walk.stage == Stage::loading && !next.linearised.modes_are_new &&
                              next.linearised.orientation != walk.here.linearised.orientation;
                if (continues && !turned_over) {
                    walk.before = std::move(walk.here);
                    walk.here = std::move(next);
                    h *= 2;
                    continue;
                }
            }
        }
        h /= 2;
        if (std::abs(h) < smallest * (1 - 1e-9)) return failure(walk, t, attempt, turned_over);
    }
    return std::nullopt;
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> loads, const Options& options) {
    EquilibriumPath path;
    const auto stop = [&](Outcome outcome, const std::string& what) {
        path.outcome = outcome;
        path.detail = fmt::format("branch '{}': {}", branch.name, what);
    };
    const System system = make_system(model, branch, loads);
    const VectorXd design = design_unknowns(system);
    for (const double load : loads)
        if (!std::isfinite(load)) return stop(Outcome::not_finite, "a load factor is not finite"), path;
    if (!design.allFinite() || !system.at_design.allFinite() || !load_rate(system, design).allFinite())
        return stop(Outcome::not_finite, "the equations give a number that is not finite at the design pose"), path;

    Walk walk{system, options, Stage::settling, {}, std::nullopt, {}};
    walk.here = station_at(walk, 0, design, nullptr);
    auto failed = advance(walk, 1);

    walk.stage = Stage::loading;
    walk.before.reset();
    walk.here.t = 0;
    if (!failed) set_tangent(system, walk.stage, walk.here);
    for (auto load = loads.begin(); load != loads.end() && !failed; ++load) {
        failed = advance(walk, *load);
        if (!failed) path.points.push_back(state_of(system, loading_at(walk.stage, *load), walk.here.x));
    }
    path.counts = walk.counts;
    if (failed) stop(failed->outcome, failed->what);
    return path;
}

}  // namespace elastocheck::reference::equilibrium
