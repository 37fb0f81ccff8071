#include "reference/equilibrium/solve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reference/equilibrium/walk.hpp"

namespace elastocheck::reference::equilibrium {

EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> loads,
                      const Options& options) {
    EquilibriumPath path;
    const auto ended = [&](const Failure& failed) {
        path.outcome = failed.outcome;
        path.detail = fmt::format("branch '{}': {}", branch.name, failed.what);
        return path;
    };
    const System system = make_system(model, branch, loads);
    const Eigen::VectorXd design = design_unknowns(system);
    if (!std::all_of(loads.begin(), loads.end(), [](double load) { return std::isfinite(load); }))
        return ended({Outcome::not_finite, "a load factor is not finite"});
    if (!design.allFinite() || !system.at_design.allFinite() || !load_rate(system, design).allFinite())
        return ended(
            {Outcome::not_finite, "the equations give a number that is not finite at the design pose"});

    Walk walk = start(system, options);
    auto failed = advance(walk, 1);
    if (!failed) begin_loading(walk);
    for (auto load = loads.begin(); load != loads.end() && !failed; ++load) {
        failed = advance(walk, *load);
        if (!failed) path.points.push_back(state_of(system, loading_at(walk.stage, *load), walk.here.x));
    }
    path.counts = walk.counts;
    return failed ? ended(*failed) : path;
}

}  // namespace elastocheck::reference::equilibrium
