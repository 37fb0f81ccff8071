#include "reports/command/options/solving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "recursive/soft_motion.hpp"

namespace elastocheck::reports {
namespace {

using compare::Channel;

// Largest differences between two states in the main outputs, in words: "2.2 mm (wheel_centre_z)
// and 0.0068 deg (toe)".
std::string differences(const Model& model, const Branch& branch, const Equilibrium& state,
                        const Equilibrium& truth) {
    auto main = compare::channels(model);
    std::erase_if(main, [](const Channel& c) { return !c.main || !c.kinematic(); });
    const auto given = compare::evaluate(model, branch, main, state),
               expected = compare::evaluate(model, branch, main, truth);
    std::string text;
    for (const auto unit : {compare::Unit::mm, compare::Unit::deg}) {
        const Channel* worst = nullptr;
        double largest = 0;
        for (std::size_t c = 0; c < main.size(); ++c) {
            const double distance = compare::worse(std::abs(given[c] - expected[c]), largest);
            if (main[c].unit != unit || (worst != nullptr && distance == largest)) continue;
            worst = &main[c];
            largest = distance;
        }
        if (worst != nullptr)
            text += fmt::format("{}{:.2g} {} ({})", text.empty() ? "" : " and ", largest,
                                symbol(unit), worst->name);
    }
    return text;
}

// Whether a recorded parameter is the end of a branch side, up to rounding.
bool is_end(const Branch& side, double load) {
    return std::abs(load - side.to) <= 1e-12 * std::abs(side.to);
}

}  // namespace

std::vector<std::string> solvers() {
    std::vector<std::string> names;
    for (const auto leg : compare::legs) names.emplace_back(name(leg));
    for (const auto& method : recursive::methods) names.emplace_back(method.name);
    return names;
}

compare::SolverSettings solver_of(const SolverRequest& request) {
    RecursionRequest with_method = request.recursion;
    const auto leg = std::ranges::find(compare::legs, request.method,
                                       [](auto l) { return std::string(name(l)); });
    if (leg == compare::legs.end()) with_method.method = request.method;
    compare::SolverSettings solver;
    solver.recursion = recursion(with_method);
    solver.leg = leg == compare::legs.end() ? compare::Leg::recursive : *leg;
    solver.every = request.every;
    return solver;
}

std::vector<std::string> certified_solvers() {
    auto names = solvers();
    std::erase(names, name(compare::Leg::recursive));  // the same as its method `published`
    return names;
}

compare::SolverSettings certified_solver(const std::string& solver) {
    for (const auto leg : {compare::Leg::equilibrium, compare::Leg::energy, compare::Leg::series})
        if (solver == name(leg)) return {.leg = leg};
    compare::SolverSettings settings;
    settings.recursion.method = *recursive::find_method(solver);
    return settings;
}

SolvedBranch solve_branch(const Model& model, const Branch& branch,
                          const std::vector<Channel>& channels,
                          const compare::SolverSettings& solver,
                          const std::function<void(const Equilibrium&, compare::Row&)>& change_row,
                          const std::function<void(compare::Row)>& hand_over) {
    const auto sides = compare::sides_of(model, branch, solver.recursion.steps);
    compare::Analyses analyses;
    // The last state of each side; the start, a = 0, belongs to a side until that has another state.
    std::vector<std::optional<Equilibrium>> last_states(sides.size());
    const auto row_at = [&](const Equilibrium& state) {
        const auto side_index =
            static_cast<std::size_t>(&compare::side_at(sides, state.load) - sides.data());
        if (!last_states[side_index] || state.load != 0) last_states[side_index] = state;
        auto row = compare::row_of(model, channels, sides.front(), solver, state, analyses);
        change_row(state, row);
        return row;
    };
    SolvedBranch solved{compare::solve_branch(sides, solver, row_at, hand_over)};
    // A method with steps of equal size has no error control.
    const bool approximate =
        solver.leg == compare::Leg::recursive && recursive::has_steps(solver.recursion.method);
    for (std::size_t side_index = 0; side_index < sides.size(); ++side_index) {
        if (!last_states[side_index]) continue;
        const bool reaches_end = is_end(sides[side_index].branch, last_states[side_index]->load);
        if (reaches_end && approximate)
            solved.ends.emplace_back(sides[side_index], *last_states[side_index]);
        if (!reaches_end && solved.softest_motion.empty() &&
            solved.path.outcome != Outcome::converged)
            solved.softest_motion = recursive::softest_motion(
                sides[side_index].model, sides[side_index].branch, *last_states[side_index]);
    }
    return solved;
}

std::string error_at_end(const Model& model, compare::BranchSide side, const Equilibrium& state) {
    const compare::Unit unit = compare::unit_of(side.branch.unit);
    const std::string where =
        fmt::format("at {:g} {}, the end", compare::in_unit(unit) * side.branch.to, symbol(unit));
    side.branch.steps = 1;  // only the end is solved
    std::optional<Equilibrium> truth;
    const EquilibriumPath path = compare::solve_branch(
        side, {.leg = compare::Leg::equilibrium}, [&](const Equilibrium& found) { truth = found; });
    if (path.outcome != Outcome::converged || !truth)
        return fmt::format("its error {} is not known: equilibrium leg: {}: {}", where,
                           name(path.outcome), path.detail);
    return fmt::format("off by {} {}, from the equilibrium leg there",
                       differences(model, side.branch, state, *truth), where);
}

}  // namespace elastocheck::reports
