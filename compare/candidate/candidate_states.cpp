// Candidates that are given as states: their outputs, and their residuals by the legs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/equilibrium.hpp"

namespace elastocheck::compare {
namespace {

bool is_finite(const Pose& pose) { return pose.r.allFinite() && pose.p.coeffs().allFinite(); }
// NaN marks a pose that is not given, infinity one that is given and not finite.
bool is_broken(const Pose& pose) {
    const auto infinite = [](double x) { return std::isinf(x); };
    return std::ranges::any_of(pose.r, infinite) || std::ranges::any_of(pose.p.coeffs(), infinite);
}
// The pose, marked as broken by an infinite position if it is not finite.
Pose marked_if_not_finite(Pose pose) {
    if (!is_finite(pose)) pose.r.setConstant(INFINITY);
    return pose;
}

}  // namespace

Comparison outline(const Model& model) {
    Comparison result;
    result.channels = channels(model);
    std::ranges::move(characteristics(model), std::back_inserter(result.channels));
    for (const auto& branch : model.branches) {
        BranchComparison& compared = result.branches.emplace_back();
        compared.branch = branch.name;
        compared.unit = unit_of(branch.unit);
        compared.steps = branch.steps;
        compared.determined.assign(result.channels.size(), true);
    }
    return result;
}

Candidate candidate_of(const Model& model, const Comparison& comparison, std::string name,
                       const std::vector<CandidateState>& states) {
    Candidate result;
    result.name = std::move(name);
    result.every_output = true;
    std::vector<Channel> channels;  // all but characteristics, which need the tangent of a leg
    std::vector<std::size_t> position;
    for (std::size_t c = 0; c < comparison.channels.size(); ++c)
        if (comparison.channels[c].kind() != ChannelKind::characteristic) {
            channels.push_back(comparison.channels[c]);
            position.push_back(c);
        }
    for (const std::size_t c : position) result.points.columns.push_back({c, false, {}});

    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        const Branch& branch = model.branches[b];
        const auto sides = sides_of(model, branch);
        StateResiduals residuals;
        residuals.branch = branch.name;
        residuals.unit = unit_of(branch.unit);
        residuals.second = comparison.branches[b].second;
        for (const auto& state : states) {
            if (state.branch != branch.name) continue;
            const double a = parameter_in(residuals.unit, state.load);
            result.points.branch.push_back(branch.name);
            result.points.a.push_back(a);
            Equilibrium equilibrium;
            equilibrium.load = state.load;
            equilibrium.poses = state.poses;
            equilibrium.reactions.assign(model.joints.size(), {Eigen::Vector3d::Constant(nan),
                                                               Eigen::Vector3d::Constant(nan)});
            const bool is_complete = std::ranges::all_of(equilibrium.poses, is_finite);
            if (is_complete && std::isfinite(state.load)) {
                const BranchSide& side = side_at(sides, state.load);
                equilibrium.reactions = reference::equilibrium::reactions_at(
                    side.model, side.branch, state.load, equilibrium.poses);
                const Leg second = residuals.second == Leg::energy ? Leg::energy : Leg::recursive;
                residuals.a.push_back(a);
                residuals.truth.push_back(judge(Leg::equilibrium, side, equilibrium));
                residuals.by_second.push_back(judge(second, side, equilibrium));
            } else {
                residuals.why_not = "it does not give the position of every body";
            }
            const bool broken =
                !std::isfinite(state.load) || std::ranges::any_of(equilibrium.poses, is_broken);
            auto values = evaluate(model, sides.front().branch, channels, equilibrium);
            if (broken) std::ranges::fill(values, INFINITY);
            for (std::size_t c = 0; c < values.size(); ++c)
                result.points.columns[c].values.push_back(values[c]);
        }
        if (!residuals.a.empty() || !residuals.why_not.empty())
            result.state_residuals.push_back(std::move(residuals));
    }
    // Columns without any value are those of bodies whose poses are not given.
    std::erase_if(result.points.columns, [](const PointColumn& column) {
        return std::ranges::all_of(column.values, [](double v) { return std::isnan(v); });
    });
    return result;
}

Candidate candidate_of(const Model& model, const Comparison& comparison, std::string name,
                       const CandidateSolver& solver) {
    std::vector<CandidateState> states;
    std::vector<std::string> notes;
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        const Branch& branch = model.branches[b];
        bool first = true;
        for (const auto& side : sides_of(model, branch, comparison.branches[b].steps)) {
            const EquilibriumPath path =
                solver(side.model, side.branch,
                       requested_parameters({side}, comparison.branches[b].every));
            for (const auto& point : path.points) {
                if (!first && point.load == 0) continue;
                CandidateState& state =
                    states.emplace_back(CandidateState{branch.name, point.load, point.poses});
                std::ranges::transform(state.poses, state.poses.begin(), marked_if_not_finite);
            }
            if (path.outcome != Outcome::converged)
                notes.push_back(fmt::format("{}: {}: {}", side.name,
                                            elastocheck::name(path.outcome), path.detail));
            first = false;
        }
    }
    for (const auto& state : states)
        if (state.poses.size() != model.bodies.size())
            throw std::invalid_argument(
                fmt::format("a state of branch '{}' has {} poses, the model {} bodies",
                            state.branch, state.poses.size(), model.bodies.size()));
    Candidate result = candidate_of(model, comparison, std::move(name), states);
    result.complete = true;
    result.notes = std::move(notes);
    return result;
}

}  // namespace elastocheck::compare
