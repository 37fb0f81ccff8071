#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"

#include <fmt/format.h>

#include "models/parameter_unit.hpp"
#include "recursive/diagnosis/finite.hpp"
#include "recursive/formula/load_growth.hpp"
#include "recursive/formula/recentre.hpp"
#include "recursive/series/path.hpp"
#include "recursive/singularity/branch_events.hpp"
#include "recursive/singularity/stability_limit.hpp"
#include "recursive/stepping/adaptive.hpp"
#include "recursive/stepping/sweep.hpp"

namespace elastocheck::recursive {
namespace {

// Names of the redundant joints that are inconsistent at the design position: "'upper', 'lower'";
// empty if none.
std::string in_contradiction(const Model& model, const Diagnosis& diagnosis) {
    std::string names;
    for (const auto& redundancy : diagnosis.redundant)
        if (redundancy.contradicts)
            for (const auto& [joint, share] : redundancy.shares)
                names += fmt::format("{}'{}'", names.empty() ? " " : ", ",
                                     model.joints[static_cast<std::size_t>(joint)].name);
    return names;
}

// Why a path ended, for the message after "branch 'NAME': ".
std::string reason_of_end(const Model& model, const Diagnosis& diagnosis, const Branch& branch,
                          const Method& method, Outcome outcome, const Stop& stop) {
    if (!stop.unstable_start.empty())
        return fmt::format("the equilibrium that settles at {} is unstable: {}",
                           parameter_text(branch.unit, 0), stop.unstable_start);
    std::string detail = std::isnan(stop.at) ? std::string("while the start settles")
                                             : "at " + parameter_text(branch.unit, stop.at);
    switch (outcome) {
        case Outcome::loaded_idle_mode:
        case Outcome::bifurcation_point: detail += end_by_diagnosis(outcome, diagnosis); break;
        case Outcome::singular:
            detail += ": the branch bifurcates, turns back or loses its stability before" +
                      end_by_diagnosis(outcome, diagnosis);
            break;
        case Outcome::inconsistent_constraints:
            if (const auto vanished = vanishing_length(model, branch);
                vanished && !std::isnan(stop.at) &&
                std::abs(stop.at) >= 0.99 * std::abs(vanished->parameter))
                detail = no_length(model, branch, *vanished);
            else if (!std::isnan(stop.at))
                detail += end_by_diagnosis(outcome, diagnosis);
            else
                detail = fmt::format(
                    "the joints{} cannot be closed; at the design position their gap is up to "
                    "{:.3g} mm, or mrad",
                    in_contradiction(model, diagnosis), 1e3 * diagnosis.constraint_error);
            break;
        case Outcome::limit_point:
            detail += ": a limit point, past it no equilibrium continues the branch";
            break;
        case Outcome::diverged:
            detail += std::holds_alternative<Linear>(method.kind)
                          ? ": the geometric stiffness of the stored forces exceeds that of the "
                            "elements, "
                            "the recursion is unstable from here on"
                          : ": the error of a step exceeds half of it; take more steps";
            break;
        case Outcome::converged:
        case Outcome::iteration_limit:
            detail += fmt::format(
                ": {} steps were not enough, the matrix is nearly singular or the tolerance too "
                "small",
                max_steps);
            break;
        case Outcome::not_finite:
        case Outcome::branch_lost:
        case Outcome::not_conservative:      // energy leg only
        case Outcome::too_large:             // energy leg only
        case Outcome::outside_table: break;  // set in compare/
    }
    return detail;
}

// The path by one method. Where a method with equal steps could step over the end of the branch,
// the end is located first (branch_events.hpp), and points past it are dropped.
EquilibriumPath solve_by_method(const Model& model, const Branch& branch, const Options& options,
                                const Analysis& analysis, const PointVisitor& visit) {
    if (const std::string doubt = undecided(model, analysis.diagnosis); !doubt.empty())
        return {Outcome::singular, fmt::format("branch '{}': {}", branch.name, doubt), {}, {}};
    if (const auto vanished = vanishing_length(model, branch); vanished && vanished->parameter == 0)
        return {Outcome::inconsistent_constraints,
                fmt::format("branch '{}': {}", branch.name, no_length(model, branch, *vanished)),
                {},
                {}};
    if (const auto* settings = std::get_if<Series>(&options.method.kind)) {
        const int points = options.record > 0  ? options.record
                           : options.steps > 0 ? options.steps
                                               : branch.steps;
        return series::sample(model, series::follow(model, branch, *settings, analysis), branch,
                              points, visit);
    }
    // The stiffness of eq. (19) does not show the end of the branch.
    const bool linear = std::holds_alternative<Linear>(options.method.kind);
    std::optional<Event> event;
    if (has_steps(options.method)) event = watch(model, branch, analysis);
    const auto is_past = [&](double a) { return event && !(std::abs(a) <= std::abs(event->load)); };
    const PointVisitor until = [&](const Equilibrium& point) {
        if (!is_past(point.load)) visit(point);
    };
    Stop stop;
    EquilibriumPath path = (has_steps(options.method) ? sweep : sweep_adaptive)(
        model, branch, options, analysis, visit && event ? until : visit, stop);
    // If a method with the consistent tangent stopped by itself, find_event() determines the cause.
    const bool unsure = path.outcome == Outcome::singular || path.outcome == Outcome::diverged;
    if (has_steps(options.method) && !linear && !event && unsure && !std::isnan(stop.at))
        event = find_event(model, branch, analysis);
    if (path.outcome == Outcome::converged ? event.has_value()
                                           : !std::isnan(stop.at) && is_past(stop.at)) {
        std::erase_if(path.points, [&](const Equilibrium& point) { return is_past(point.load); });
        path.outcome = event->outcome;
        stop = {event->load, event->unstable_start};
    }
    if (path.outcome != Outcome::converged)
        path.detail = fmt::format(
            "branch '{}': {}", branch.name,
            reason_of_end(model, analysis.diagnosis, branch, options.method, path.outcome, stop));
    if (path.outcome == Outcome::diverged && linear) {
        const auto limit = stability_limit(model, branch, options.method, analysis);
        path.detail +=
            limit ? "; by the model the method is stable to " + parameter_text(branch.unit, *limit)
                  : std::string("; the model sets no stability limit on this branch");
    }
    return path;
}

// Moves a point of the centred model back by c.
void move_back(Equilibrium& point, const Eigen::Vector3d& c) {
    for (Pose& pose : point.poses) pose.r += c;
}

// Whether a start that did not settle, with this outcome, may settle by the second homotopy
// (load_growth.hpp). The linear methods that store forces have no second one: their settling is a
// part of their path.
bool settles_otherwise(const Method& method, Outcome outcome) {
    const auto* linear = std::get_if<Linear>(&method.kind);
    return (!linear || linear->stored == all_follow) &&
           (outcome == Outcome::limit_point || outcome == Outcome::bifurcation_point ||
            outcome == Outcome::singular || outcome == Outcome::branch_lost ||
            outcome == Outcome::inconsistent_constraints);
}

EquilibriumPath solve_centred(const Model& model, const Eigen::Vector3d& c, const Branch& branch,
                              const Options& options, const Analysis& analysis,
                              const PointVisitor& visit) {
    Equilibrium moved;
    const PointVisitor visit_moved = [&](const Equilibrium& point) {
        moved = point;
        move_back(moved, c);
        visit(moved);
    };
    EquilibriumPath path =
        solve(centred(model, c), branch, options, analysis, visit ? visit_moved : PointVisitor{});
    for (Equilibrium& point : path.points) move_back(point, c);
    return path;
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const PointVisitor& visit) {
    check(model, branch);
    if (const auto c = far_centre(model))
        return solve_centred(model, *c, branch, options, analysis, visit);
    if (std::isnan(analysis.diagnosis.constraint_error))
        return {Outcome::not_finite,
                fmt::format("branch '{}': {}", branch.name, not_finite(model)),
                {},
                {}};
    bool begun = false;
    const PointVisitor counted = [&](const Equilibrium& point) {
        begun = true;
        visit(point);
    };
    EquilibriumPath path =
        solve_by_method(model, branch, options, analysis, visit ? counted : PointVisitor{});
    if (begun || !path.points.empty() || !settles_otherwise(options.method, path.outcome))
        return path;
    // Where a design position far from equilibrium has several equilibria nearby, the two
    // homotopies may settle at different ones.
    if (const auto other = with_growing_forces(model, branch)) {
        EquilibriumPath again =
            solve_by_method(other->model, other->branch, options, analyse(other->model),
                            visit ? counted : PointVisitor{});
        if (begun || !again.points.empty()) return again;
    }
    return path;
}

EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const PointVisitor& visit) {
    check(model, branch);
    return solve(model, branch, options, analyse(model), visit);
}

}  // namespace elastocheck::recursive
