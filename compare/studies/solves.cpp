#include "compare/studies/solves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compare/deviation/agreement.hpp"
#include "compare/outputs/curve.hpp"
#include "models/overloaded.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace elastocheck::compare {
namespace {

// Key of a method: all that its result depends on, which excludes its name and formal order.
std::string key(const recursive::Method& method) {
    return std::visit(overloaded{[](const recursive::Linear& m) {
                                     return fmt::format(
                                         "linear {:d} {:d} {:d} {:d}", m.stored.lever_follows,
                                         m.stored.axis_follows, m.stored.load_follows, m.closed);
                                 },
                                 [](const recursive::Consistent& m) {
                                     return fmt::format("consistent {}", static_cast<int>(m.solve));
                                 },
                                 [](const recursive::Adaptive& m) {
                                     return fmt::format("adaptive {:a} {:a}", m.length_tolerance,
                                                        m.angle_tolerance);
                                 },
                                 [](const recursive::Series& m) {
                                     return fmt::format("series {} {:a} {} {:d}", m.order,
                                                        m.tolerance, m.expansions, m.arc_length);
                                 }},
                      method.kind);
}

std::string key(const BranchSide& side) {
    return fmt::format("{} to {:a} at {}", side.branch.name, side.branch.to, side.branch.steps);
}

// The run of this name, made by the first thread that requests it.
template <class Make>
Solves::Run& run_once(Solves& solves, const std::string& name, const Make& make) {
    ++solves.requests;
    Solves::Run* run = nullptr;
    {
        const std::lock_guard guard(solves.lock);
        run = &solves.runs[name];
    }
    std::call_once(run->once, [&] { make(*run); });
    return *run;
}

const References& reference_runs(Solves& solves, const BranchSide& side) {
    const BranchSide at = at_points(side, solves.finest);
    return run_once(solves, key(at) + " by the references",
                    [&](Solves::Run& run) {
                        run.references =
                            run_references(solves.model, solves.channels, at.branch, {at});
                    })
        .references;
}

References read_references(Solves& solves, const Branch& branch, std::vector<BranchSide> sides,
                           int multiple) {
    std::vector<PathCurve> truth, other;
    References references;
    for (const auto& side : sides) {
        const References& runs = reference_runs(solves, side);
        truth.push_back(runs.truth);
        other.push_back(runs.other);
        references.scale = larger(references.scale, runs.scale);
        references.second_leg = runs.second_leg;
    }
    references.truth = joined(sides, truth);
    references.other = joined(sides, other);
    const auto stride = static_cast<std::size_t>(solves.finest / multiple);
    for (PathCurve* path : {&references.truth, &references.other})
        if (stride > 1) path->curve = thinned(path->curve, stride);
    for (auto& side : sides) side = at_points(std::move(side), multiple);
    judge_references(solves.model, solves.channels, branch, sides, references);
    return references;
}

}  // namespace

Solves::Solves(const Model& of, int base_points, int finest_multiple)
    : model(of), base(base_points), finest(finest_multiple), channels(compare::channels(of)) {
    for (const auto& branch : model.branches) {
        sides.push_back(sides_of(model, branch, base));
        for (auto& side : sides.back())
            side.analysis =
                std::make_shared<const recursive::Analysis>(recursive::analyse(side.model));
    }
}

BranchSide at_points(BranchSide side, int multiple) {
    side.branch.steps *= multiple;
    return side;
}

const PathCurve& solved(Solves& solves, const BranchSide& side, const SolverSettings& solver) {
    const std::string run_name = fmt::format(
        "{} by {} {} refined {}", key(side), name(solver.leg),
        solver.leg == Leg::recursive ? key(solver.recursion.method) : "", solver.refine);
    return run_once(solves, run_name,
                    [&](Solves::Run& run) {
                        run.curve = solve_branch(solves.model, solves.channels, side.branch, {side},
                                                 solver);
                    })
        .curve;
}

const PathCurve& solved(Solves& solves, const BranchSide& side, const recursive::Method& method,
                        int steps) {
    const int recorded = std::min(steps, solves.finest);
    return solved(solves, at_points(side, recorded),
                  {.recursion = {.method = method}, .refine = steps / recorded});
}

References references_on_branch(Solves& solves, std::size_t branch, int multiple) {
    return read_references(solves, solves.model.branches[branch], solves.sides[branch], multiple);
}

References references_on_side(Solves& solves, const BranchSide& side, int multiple) {
    return read_references(solves, side.branch, {side}, multiple);
}

}  // namespace elastocheck::compare
