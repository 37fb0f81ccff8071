#include "elastocheck/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reference/equilibrium/continuation/settle.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

// Two points cannot be at a distance of zero or less.
std::optional<Failure> vanishing_link(const System& system, double a) {
    for (std::size_t c = 0; c < system.values.size(); ++c) {
        const Constraint& constraint = system.model->constraints[c];
        if (!std::holds_alternative<DistanceBetween>(constraint.kind) || system.values[c].at(a) > 0)
            continue;
        const auto joint = static_cast<std::size_t>(constraint.joint);
        return Failure{Outcome::inconsistent_constraints,
                       fmt::format("joint '{}' would have no length at {}",
                                   system.model->joints[joint].name, parameter(*system.branch, a))};
    }
    return std::nullopt;
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> points,
                      const Options& options, const PointVisitor& visit) {
    EquilibriumPath path;
    const auto ended = [&](const Failure& failed) {
        path.outcome = failed.outcome;
        path.detail = fmt::format("branch '{}': {}", branch.name, failed.what);
        return path;
    };
    System system = make_system(model, branch, points);
    if (!std::ranges::all_of(points, [](double a) { return std::isfinite(a); }))
        return ended({Outcome::not_finite, "a point of the branch is not finite"});

    Continuation continuation = start(system, options);
    if (!continuation.current.x.allFinite() || !system.at_design.allFinite() ||
        !continuation.current.E_rate.allFinite())
        return ended({Outcome::not_finite,
                      "the equations give a number that is not finite at the design pose"});
    double reach = 0;
    for (const double a : points) reach = std::max(reach, std::abs(a));
    auto failed = vanishing_link(system, 0);
    if (!failed) failed = settle(continuation, system, reach);
    for (auto a = points.begin(); a != points.end() && !failed; ++a) {
        failed = vanishing_link(system, *a);
        if (!failed) failed = advance(continuation, *a);
        if (failed) break;
        Equilibrium point = state_of(system, loading_at(continuation, *a), continuation.current.x);
        if (visit)
            visit(point);
        else
            path.points.push_back(std::move(point));
    }
    path.counts = continuation.counts;
    return failed ? ended(*failed) : path;
}

}  // namespace elastocheck::reference::equilibrium
