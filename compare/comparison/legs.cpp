#include "compare/comparison/legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/deviation/tolerance.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "models/branch.hpp"

namespace elastocheck::compare {
namespace {

// Whether the k-th recorded point of a branch side is requested.
bool is_requested(const Branch& side, int k, int every) {
    return k % every == 0 || k == side.steps;
}

// Requested parameters of a branch side.
std::vector<double> grid(const Branch& side, int every) {
    std::vector<double> a;
    for (int k = 0; k <= side.steps; ++k)
        if (is_requested(side, k, every)) a.push_back(side.to * k / side.steps);
    return a;
}

EquilibriumPath recursion(const BranchSide& side, recursive::Options options, int refine, int every,
                          const PointVisitor& visit) {
    options.record = side.branch.steps;
    options.steps = side.branch.steps * refine;
    const PointVisitor requested = [&, k = 0](const Equilibrium& state) mutable {
        if (is_requested(side.branch, k++, every)) visit(state);
    };
    return side.analysis
               ? recursive::solve(side.model, side.branch, options, *side.analysis, requested)
               : recursive::solve(side.model, side.branch, options, requested);
}

// Solves by a leg (one of the solvers), which extrapolates tabulated curves beyond their ends;
// solve_branch() checks those.
EquilibriumPath solve_by_leg(const BranchSide& side, const SolverSettings& solver,
                             const PointVisitor& visit) {
    const auto& [model, branch] = std::tie(side.model, side.branch);
    switch (solver.leg) {
        case Leg::recursive:
            return recursion(side, solver.recursion, solver.refine, solver.every, visit);
        case Leg::equilibrium:
            return reference::equilibrium::solve(model, branch, grid(branch, solver.every), {},
                                                 visit);
        case Leg::energy:
            return reference::energy::solve(model, branch, grid(branch, solver.every),
                                            solver.energy, visit);
        case Leg::series:
            return recursion(side, {.method = recursive::find_method("series").value()}, 1,
                             solver.every, visit);
    }
    return {};
}

// Runs solve(visit), and ends the path before the first state at which an element is deformed beyond the
// end of its tabulated curve.
template <class Solve>
EquilibriumPath solve_within_tables(const BranchSide& side, const PointVisitor& visit,
                                    const Solve& solve) {
    std::string ended;
    EquilibriumPath path = solve([&](const Equilibrium& state) {
        if (ended.empty()) ended = ends_at_table(side.model, side.branch, state);
        if (ended.empty()) visit(state);
    });
    if (!ended.empty()) {
        path.outcome = Outcome::outside_table;
        path.detail = ended;
    }
    return path;
}

// Adds the outcome and the counts of `second` to those of `first`. Path: EquilibriumPath or PathCurve.
template <class Path>
void add_outcome(const std::vector<BranchSide>& sides, Path& first, const Path& second) {
    const auto labelled = [](const BranchSide& side, const std::string& detail) {
        return fmt::format("{}: {}", side.name, detail);
    };
    // A leg that does not apply to one side does not apply to either.
    if (is_not_applicable(first.outcome) && second.outcome == first.outcome) {
        first.detail = second.detail;
        first.counts = second.counts;
        return;
    }
    if (first.outcome != Outcome::converged) first.detail = labelled(sides.front(), first.detail);
    if (second.outcome != Outcome::converged) {
        first.detail += (first.detail.empty() ? "" : "; ") + labelled(sides.back(), second.detail);
        if (first.outcome == Outcome::converged) first.outcome = second.outcome;
    }
    first.counts.factorisations += second.counts.factorisations;
    first.counts.iterations += second.counts.iterations;
    first.counts.evaluations += second.counts.evaluations;
}

// Joins both sides. The points of the reversed side are buffered as `Row` until they can
// be handed over.
template <class Row, class Read, class HandOver>
EquilibriumPath join(const std::vector<BranchSide>& sides, const SolverSettings& solver,
                     const Read& read, const HandOver& hand_over) {
    if (sides.empty()) return {Outcome::not_finite, "the branch has no length", {}, {}};
    if (sides.size() == 1)
        return solve_branch(sides.front(), solver,
                            [&](const Equilibrium& state) { hand_over(read(state)); });
    // Both sides start at a = 0 in the same settled state, which is taken from the second side unless
    // that has no point.
    std::optional<Equilibrium> start;
    std::vector<Row> reversed;
    EquilibriumPath joined = solve_branch(sides.front(), solver, [&](const Equilibrium& state) {
        if (!start)
            start = state;
        else
            reversed.push_back(read(state));
    });
    for (; !reversed.empty(); reversed.pop_back()) hand_over(std::move(reversed.back()));
    EquilibriumPath second = solve_branch(sides.back(), solver, [&](const Equilibrium& state) {
        start.reset();
        hand_over(read(state));
    });
    if (start) hand_over(read(*start));
    add_outcome(sides, joined, second);
    return joined;
}

std::string label(const Branch& side) {
    const Unit unit = unit_of(side.unit);
    return fmt::format("{} to {:.4g} {}", side.name, in_unit(unit) * side.to, symbol(unit));
}

bool is_stiffness(Unit unit) {
    return unit == Unit::newton_per_mm || unit == Unit::newton_metre_per_deg;
}

}  // namespace

const char* name(Leg leg) {
    switch (leg) {
        case Leg::recursive: return "recursive";
        case Leg::equilibrium: return "equilibrium";
        case Leg::energy: return "energy";
        case Leg::series: return "series";
    }
    return "";
}

std::vector<BranchSide> sides_of(const Model& model, Branch branch, int points) {
    if (points > 0) branch.steps = points;
    std::vector<BranchSide> result;
    const auto branches = branch_sides(branch);
    for (const auto& side : branches)
        result.push_back(
            {branches.size() > 1 ? label(side) : branch.name, on_branch(model, side), side});
    return result;
}

std::vector<double> requested_parameters(const std::vector<BranchSide>& sides, int every) {
    std::vector<double> a;
    for (std::size_t w = 0; w < sides.size(); ++w) {
        auto side = grid(sides[w].branch, every);
        const bool is_reversed = w + 1 < sides.size();
        if (is_reversed) {
            std::ranges::reverse(side);
            side.pop_back();
        }
        std::ranges::copy(side, std::back_inserter(a));
    }
    return a;
}

const BranchSide& side_at(const std::vector<BranchSide>& sides, double a) {
    const auto found = std::ranges::find_if(
        sides, [&](const BranchSide& side) { return side.branch.to * a >= 0; });
    return found == sides.end() ? sides.back() : *found;
}

EquilibriumPath solve_branch(const BranchSide& side, const SolverSettings& solver,
                             const PointVisitor& visit) {
    std::vector<Equilibrium> kept;
    const PointVisitor keep = [&](const Equilibrium& state) { kept.push_back(state); };
    EquilibriumPath path = solve_within_tables(
        side, visit ? visit : keep,
        [&](const PointVisitor& checked) { return solve_by_leg(side, solver, checked); });
    path.points = std::move(kept);
    return path;
}

bool is_not_applicable(Outcome outcome) {
    return outcome == Outcome::not_conservative || outcome == Outcome::too_large;
}

EquilibriumPath solve_branch(const std::vector<BranchSide>& sides, const SolverSettings& solver) {
    std::vector<Equilibrium> points;
    EquilibriumPath path = join<Equilibrium>(
        sides, solver, [](const Equilibrium& state) { return state; },
        [&](Equilibrium state) { points.push_back(std::move(state)); });
    path.points = std::move(points);
    return path;
}

Row row_of(const Model& model, std::span<const Channel> channels, const BranchSide& side,
           const SolverSettings& solver, const Equilibrium& state, Analyses& analyses) {
    std::optional<WheelResponse>& response = analyses.response;
    Row row{state.load, state.constraint_error, evaluate(model, side, channels, state, analyses)};
    response.reset();
    std::optional<bool> corner;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (channels[c].kind() != ChannelKind::characteristic) continue;
        // At the corner of a law a stiffness has two values; rounding would select one of them.
        if (is_stiffness(channels[c].unit) && channels[c].may_be_undefined()) {
            if (!corner) corner = at_corner(side.model, side.branch, state);
            if (*corner) {
                row.values[c] = undefined;
                continue;
            }
        }
        if (!response) {
            const bool with_free = std::ranges::any_of(channels, needs_free_response);
            response =
                wheel_response(side, solver, steering_joint(model), state, analyses, with_free);
            response->rack_per_hand_wheel = rack_per_hand_wheel(model);
        }
        row.values[c] =
            in_unit(channels[c].unit) *
            value_of(side.model, std::get<Catalogued>(channels[c].reads), state, *response);
    }
    return row;
}

Row row_of(const Model& model, std::span<const Channel> channels, const BranchSide& side,
           const SolverSettings& solver, const Equilibrium& state) {
    Analyses analyses;
    return row_of(model, channels, side, solver, state, analyses);
}

EquilibriumPath solve_branch(const std::vector<BranchSide>& sides, const SolverSettings& solver,
                             const std::function<Row(const Equilibrium&)>& read,
                             const std::function<void(Row)>& hand_over) {
    return join<Row>(sides, solver, read, hand_over);
}

PathCurve solve_branch(const Model& model, std::span<const Channel> channels, const Branch& branch,
                       const std::vector<BranchSide>& sides, const SolverSettings& solver,
                       const VisitResponse& also) {
    PathCurve path_curve;
    path_curve.curve.unit = unit_of(branch.unit);
    double reading = 0;
    Analyses analyses;
    const double start = processor_time();
    const EquilibriumPath path = solve_branch(
        sides, solver,
        [&](const Equilibrium& state) {
            const double state_found = processor_time();
            Row row = row_of(model, channels, sides.front(), solver, state, analyses);
            if (also) also(state, analyses.response ? &*analyses.response : nullptr);
            reading += processor_time() - state_found;
            return row;
        },
        [&](Row row) {
            append(path_curve.curve, row.load, std::move(row.values));
            path_curve.constraint_error.push_back(row.constraint_error);
        });
    path_curve.seconds = processor_time() - start - reading;
    path_curve.outcome = path.outcome;
    path_curve.detail = path.detail;
    path_curve.counts = path.counts;
    return path_curve;
}

EquilibriumPath solve_at(const BranchSide& side, Leg leg, std::span<const double> points,
                         const PointVisitor& visit) {
    EquilibriumPath path = solve_within_tables(side, visit, [&](const PointVisitor& checked) {
        EquilibriumPath solved;
        switch (leg) {
            case Leg::equilibrium:
                return reference::equilibrium::solve(side.model, side.branch, points, {}, checked);
            case Leg::energy:
                return reference::energy::solve(side.model, side.branch, points, {}, checked);
            case Leg::recursive:
            case Leg::series:
                // These solvers record equal increments only: one run to each value.
                for (const double a : points) {
                    BranchSide shorter;
                    if (a != 0) {
                        shorter = side;
                        shorter.branch.to = a;
                        shorter.branch.steps = 1;
                    }
                    solved = solve_by_leg(a == 0 ? side : shorter, {.leg = leg},
                                          [&](const Equilibrium& state) {
                                              if (state.load == a) checked(state);
                                          });
                    if (solved.outcome != Outcome::converged) break;
                }
        }
        return solved;
    });
    path.points.clear();
    return path;
}

EquilibriumPath settle_start(const BranchSide& side, Leg leg) {
    constexpr std::array at_start{0.0};
    std::optional<Equilibrium> start;
    EquilibriumPath path = solve_at(side, leg, at_start, [&](const Equilibrium& state) {
        if (!start) start = state;
    });
    if (!start) return path;
    // The outcome beyond the start does not matter.
    path.outcome = Outcome::converged;
    path.detail.clear();
    path.points.push_back(std::move(*start));
    return path;
}

Residuals judge(Leg by, const BranchSide& side, const Equilibrium& state) {
    switch (by) {
        case Leg::recursive:
        case Leg::series: return recursive::residuals(side.model, side.branch, state);
        case Leg::equilibrium:
            return reference::equilibrium::residuals(side.model, side.branch, state);
        case Leg::energy: return reference::energy::residuals(side.model, side.branch, state);
    }
    return {};
}

std::string nothing_drives(const Model& model, const Branch& branch) {
    if (!branch.drivers.empty()) return {};
    std::string why;
    for (const auto& omission : model.omitted)
        if (omission.why.find("(branch '" + branch.name + "')") != std::string::npos)
            why += fmt::format("{}{}: {}", why.empty() ? ": " : "; ", omission.what, omission.why);
    return fmt::format("nothing drives branch '{}'{}", branch.name, why);
}

PathCurve joined(const std::vector<BranchSide>& sides, const std::vector<PathCurve>& curves) {
    if (curves.size() == 1) return curves.front();
    const PathCurve &first = curves.front(), &second = curves.back();
    PathCurve whole = second;
    whole.outcome = first.outcome;
    whole.detail = first.detail;
    whole.counts = first.counts;
    whole.seconds += first.seconds;
    add_outcome(sides, whole, second);
    // As in join(), the start is taken from the second side unless that has no point.
    const std::size_t from = second.curve.a.empty() ? 0 : 1, size = first.curve.a.size();
    const auto prepend = [&](auto& list, const auto& more) {
        for (std::size_t k = from; k < size; ++k) list.insert(list.begin(), more[k]);
    };
    prepend(whole.curve.a, first.curve.a);
    prepend(whole.curve.values, first.curve.values);
    prepend(whole.constraint_error, first.constraint_error);
    whole.curve.start = size > 0 ? size - 1 : 0;
    return whole;
}

PathCurve second_reference(const Model& model, const std::vector<Channel>& channels,
                           const Branch& branch, const std::vector<BranchSide>& sides, Leg& leg) {
    leg = Leg::energy;
    PathCurve path = solve_branch(model, channels, branch, sides, {.leg = leg});
    if (!is_not_applicable(path.outcome)) return path;
    leg = Leg::series;
    return solve_branch(model, channels, branch, sides, {.leg = leg});
}

References run_references(const Model& model, const std::vector<Channel>& channels,
                          const Branch& branch, const std::vector<BranchSide>& sides) {
    References runs;
    const Model& side_model = sides.front().model;
    runs.scale = scale_of(side_model, branch, {});
    runs.truth =
        solve_branch(model, channels, branch, sides, {.leg = Leg::equilibrium},
                     [&](const Equilibrium& state, const WheelResponse*) {
                         runs.scale = larger(runs.scale, scale_of(side_model, branch, {&state, 1}));
                     });
    runs.other = second_reference(model, channels, branch, sides, runs.second_leg);
    return runs;
}

void judge_references(const Model& model, const std::vector<Channel>& channels,
                      const Branch& branch, const std::vector<BranchSide>& sides,
                      References& references) {
    for (const auto& [leg, run] : {std::pair{Leg::equilibrium, &references.truth},
                                   {references.second_leg, &references.other}})
        if (run->outcome != Outcome::converged)
            references.failures.push_back(fmt::format(
                "{} leg: {}: {}", name(leg), elastocheck::name(run->outcome), run->detail));
    references.uncertainty = {nan, nan, nan};
    if (!references.failures.empty()) return;
    const Curve &truth = references.truth.curve, &other = references.other.curve;
    auto& extents = references.extents = extents_of(channels, truth, references.scale);
    const auto active = active_channels(channels, sides.front().model);
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (!active[c] || is_undefined_somewhere(c, truth) || is_undefined_somewhere(c, other))
            extents[c] = std::numeric_limits<double>::infinity();
    references.uncertainty =
        worse(distance(channels, truth, other, extents), rounding_of(channels, truth, extents));
    if (const auto why = nothing_drives(model, branch); !why.empty())
        references.failures.push_back(why);
}

References references(const Model& model, const std::vector<Channel>& channels,
                      const Branch& branch, const std::vector<BranchSide>& sides) {
    References both = run_references(model, channels, branch, sides);
    judge_references(model, channels, branch, sides, both);
    return both;
}

Settled settled(const Model& model, const std::vector<Channel>& channels, const Branch& branch) {
    const BranchSide side = sides_of(model, branch).front();
    const auto path = settle_start(side, Leg::equilibrium);
    Settled result{branch.name, path.outcome, path.detail,
                   std::vector<double>(channels.size(), nan)};
    if (path.outcome != Outcome::converged || path.points.empty()) return result;
    const auto at_design = evaluate(model, channels, design_state(model)),
               at_start = evaluate(model, channels, path.points.front());
    for (std::size_t c = 0; c < channels.size(); ++c)
        result.displacement[c] = at_start[c] - at_design[c];
    return result;
}

}  // namespace elastocheck::compare
