#include "models/branch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "models/kinds.hpp"

namespace elastocheck {
namespace {

// Joints and elements that are active on the branch.
struct ActiveParts {
    std::vector<bool> joints, elastics;
};
ActiveParts active_parts(const Model& model, const Branch& branch) {
    ActiveParts active;
    for (const auto& joint : model.joints) active.joints.push_back(!joint.active_only_where_driven);
    for (const auto& elastic : model.elastics)
        active.elastics.push_back(!elastic.active_only_where_driven);
    for (const auto& driver : branch.drivers) {
        if (const int k = driven_joint(driver.what); k >= 0)
            active.joints[static_cast<std::size_t>(k)] = true;
        if (const int k = driven_element(driver.what); k >= 0)
            active.elastics[static_cast<std::size_t>(k)] = true;
    }
    return active;
}

// The same element without law and preload.
ElasticKind without_force(ElasticKind kind) {
    each_member(kind, overloaded{[](ScalarLaw& law) { law = LinearRate{}; },
                                 [](SpatialLaw& law) { law = LinearStiffness{}; },
                                 [](ForceAndMoment<Vector6> preload) { preload.value.setZero(); }});
    return kind;
}

}  // namespace

std::vector<Branch> branch_sides(const Branch& branch) {
    if (branch.from == 0) return {branch};
    if (branch.to == 0) {
        Branch side = branch;
        std::swap(side.from, side.to);
        return {side};
    }
    const double share = std::abs(branch.from) / (std::abs(branch.from) + std::abs(branch.to));
    Branch back = branch, forth = branch;
    back.from = forth.from = 0;
    back.to = branch.from;
    back.steps = std::clamp(static_cast<int>(std::lround(branch.steps * share)), 1,
                            std::max(1, branch.steps - 1));
    forth.steps = std::max(1, branch.steps - back.steps);
    return {back, forth};
}

Model on_branch(const Model& model, const Branch& branch) {
    const ActiveParts active = active_parts(model, branch);
    Model result = model;
    result.branches = {branch};
    result.constraints.clear();
    for (auto& joint : result.joints) joint.driven = -1;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const auto joint = static_cast<std::size_t>(model.constraints[k].joint);
        if (!active.joints[joint]) continue;
        if (model.joints[joint].driven == static_cast<int>(k))
            result.joints[joint].driven = static_cast<int>(result.constraints.size());
        result.constraints.push_back(model.constraints[k]);
    }
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        if (!active.elastics[k])
            result.elastics[k] = {model.elastics[k].name, without_force(model.elastics[k].kind),
                                  false, model.elastics[k].written_as,
                                  model.elastics[k].markers_swapped};
    return result;
}

bool fits_branch(const Model& model, const Branch& branch) {
    const ActiveParts active = active_parts(model, branch);
    return branch.from == 0 && std::ranges::all_of(active.elastics, std::identity{}) &&
           std::ranges::all_of(model.constraints, [&](const Constraint& constraint) {
               return active.joints[static_cast<std::size_t>(constraint.joint)];
           });
}

}  // namespace elastocheck
