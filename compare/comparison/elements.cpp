#include "compare/comparison/elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compare/comparison/compliance.hpp"
#include "compare/outputs/catalogue/subject.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/compare.hpp"
#include "models/kinds.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/diagnosis/self_stress.hpp"

namespace elastocheck::compare {
namespace {

const Elastic& elastic_of(const Model& model, int k) {
    return model.elastics[static_cast<std::size_t>(k)];
}

bool is_spring(const Elastic& elastic) { return member<ScalarLaw>(elastic.kind) != nullptr; }

// ---- Evaluation

bool is_active(const Elastic& elastic, int k, const Branch& branch) {
    return !elastic.active_only_where_driven ||
           std::ranges::any_of(branch.drivers, [&](const Driver& driver) {
               return driven_element(driver.what) == k;
           });
}

// Deformation e [m, rad] and force s [N, N·m] of an element in a state; both are zero where it is not active.
struct ElementState {
    const Elastic* elastic;
    bool active;
    Vector6 e = Vector6::Zero(), s = Vector6::Zero();

    // Components 0 to 5 are those of e, 6 to 11 those of s, each along x, y, z and about x, y, z, with the sign of
    // the output; NaN for an element that is not active.
    double component(int k) const {
        if (!active) return nan;
        const bool is_force = k >= 6;
        const bool reversed = elastic->markers_swapped || is_spring(*elastic) ||
                              elastic->written_as == WrittenAs::tyre;  // positive in compression
        return (reversed ? -1 : 1) * (is_force ? s : e)[k % 6];
    }
};

ElementState state_of(const Model& model, const Branch& branch, const Equilibrium& state, int k) {
    const Elastic& elastic = elastic_of(model, k);
    ElementState result{&elastic, is_active(elastic, k, branch)};
    if (!result.active) return result;
    result.e = deformation(elastic.kind, static_cast<std::size_t>(k), branch, state);
    result.s =
        force_with_preload(elastic.kind, static_cast<std::size_t>(k), branch, state, result.e);
    return result;
}

// ---- Names

// Components of ElementState that are outputs of the element.
std::vector<int> output_components(const Elastic& elastic) {
    if (is_spring(elastic)) return {0, 6};
    if (elastic.written_as == WrittenAs::tyre) return {2, 8};
    if (elastic.written_as == WrittenAs::torsion_spring) return {5, 11};
    return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
}

Unit unit_of_component(int component) {
    const bool turns = component % 6 >= 3;
    if (component < 6) return turns ? Unit::deg : Unit::mm;
    return turns ? Unit::newton_metre : Unit::newton;
}

// Name of an output of an element, without the name of the element, and its definition.
struct Naming {
    std::string name, definition;
};

Naming naming(const Elastic& elastic, int component) {
    const bool is_force = component >= 6, turns = component % 6 >= 3;
    const std::string who = "'" + elastic.name + "'";
    if (is_spring(elastic))
        return is_force
                   ? Naming{"force", fmt::format("force of {}, positive in compression", who)}
                   : Naming{"deflection",
                            fmt::format("free length less length of {}, positive in compression",
                                        who)};
    if (elastic.written_as == WrittenAs::tyre)
        return is_force
                   ? Naming{"force",
                            fmt::format("vertical force of tyre {} on the wheel, positive up", who)}
                   : Naming{"deflection", fmt::format("reduction of the height of tyre {} under "
                                                      "load, positive in compression",
                                                      who)};
    if (elastic.written_as == WrittenAs::torsion_spring)
        return is_force
                   ? Naming{"moment",
                            fmt::format("moment of {} about its axis, positive where it turns the "
                                        "second body back against the axis",
                                        who)}
                   : Naming{"angle", fmt::format("angle of {}, of the second body relative to the "
                                                 "first about its axis, right-handed",
                                                 who)};
    const char* axis = axes[static_cast<std::size_t>(component % 3)];
    if (is_force)
        return {
            fmt::format("elastic_{}_{}", turns ? "moment" : "force", axis),
            fmt::format("{} of {} {} its own axis {}, positive where it pulls the second body back "
                        "against the axis",
                        turns ? "moment" : "force", who, turns ? "about" : "along", axis)};
    return {fmt::format("{}_{}", turns ? "rotation" : "displacement", axis),
            fmt::format("{} of {} {} its own axis {} from its undeformed position, of the second "
                        "body relative to the first, {}",
                        turns ? "rotation" : "displacement", who, turns ? "about" : "along", axis,
                        turns ? "right-handed" : "positive along the axis")};
}

// Name of an element for its output: "NAME", or "NAME#2" where NAME.output is taken.
std::string free_name(const std::string& name, const std::string& output,
                      std::set<std::string>& taken) {
    std::string who = name;
    for (int n = 2; !taken.insert(who + "." + output).second; ++n)
        who = fmt::format("{}#{}", name, n);
    return who;
}

}  // namespace

std::string element_of(const Channel& channel) {
    return channel.name.substr(0, channel.name.rfind('.'));
}

std::vector<Channel> element_channels(const Model& model) {
    std::vector<Channel> list;
    std::set<std::string> taken;
    for (int k = 0; k < static_cast<int>(model.elastics.size()); ++k) {
        const Elastic& elastic = elastic_of(model, k);
        for (const int component : output_components(elastic)) {
            const auto [name, definition] = naming(elastic, component);
            list.push_back({.name = free_name(elastic.name, name, taken) + "." + name,
                            .unit = unit_of_component(component),
                            .main = false,
                            .reads = ElementComponent{k, component},
                            .definition = definition});
        }
    }
    for (int c = 0; c < static_cast<int>(model.constraints.size()); ++c) {
        const Constraint& constraint = model.constraints[static_cast<std::size_t>(c)];
        if (!std::holds_alternative<DistanceBetween>(constraint.kind)) continue;
        const std::string& name = model.joints[static_cast<std::size_t>(constraint.joint)].name;
        list.push_back(
            {.name = free_name(name, "axial_force", taken) + ".axial_force",
             .unit = Unit::newton,
             .main = false,
             .reads = AxialForce{constraint.joint, c},
             .definition = fmt::format("force along the link '{}', positive in tension", name)});
    }
    return list;
}

std::vector<double> evaluate(const Model& model, const Branch& branch,
                             std::span<const Channel> channels, const Equilibrium& state) {
    std::vector<double> values = evaluate(model, channels, state);
    // The state of an element is computed once, since its components follow each other.
    int element = -1;
    ElementState element_state{};
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (const auto* of = std::get_if<Catalogued>(&channels[c].reads);
            of != nullptr && of->entry->kind == ChannelKind::element)
            values[c] =
                in_unit(channels[c].unit) * of->entry->formula({model, &state, of->of, &branch});
        const auto* of = std::get_if<ElementComponent>(&channels[c].reads);
        if (of == nullptr) continue;
        if (of->element != element) {
            element_state = state_of(model, branch, state, of->element);
            element = of->element;
        }
        values[c] = in_unit(channels[c].unit) * element_state.component(of->component);
    }
    return values;
}

std::vector<double> evaluate(const Model& model, const BranchSide& side,
                             std::span<const Channel> channels, const Equilibrium& state,
                             Analyses& analyses) {
    // A reaction takes part in a self-stress of 1 N if it exceeds `rounding` [N, N·m] plus this multiple of the
    // imbalance of the self-stress, which is due to the constraint error of the state.
    constexpr double rounding = 1e-6, imbalance_factor = 10;
    std::vector<double> values = evaluate(model, side.branch, channels, state);
    auto& dependent = analyses.dependent_rows;
    if (!dependent) dependent = recursive::dependent_rows(side.model);
    if (dependent->empty()) return values;
    Equilibrium stressed = state;
    for (auto& stress : recursive::self_stresses(side.model, side.branch, *dependent, state)) {
        stressed.reactions = std::move(stress.wrenches);
        const auto shared = evaluate(model, channels, stressed);
        const double smallest_share = rounding + imbalance_factor * stress.remainder;
        for (std::size_t c = 0; c < channels.size(); ++c)
            if (!channels[c].joints().empty() && std::abs(shared[c]) > smallest_share)
                values[c] = undefined;
    }
    return values;
}

bool is_undefined_somewhere(std::size_t channel, const Curve& curve) {
    return std::ranges::any_of(curve.values,
                               [&](const auto& values) { return values[channel] == undefined; });
}

std::string why_undefined(const Channel& channel) {
    if (!channel.joints().empty())
        return "redundant joints share it in a way that the loads do not determine; their sum, as "
               "A+B.force_x, is determined";
    if (channel.kind() == ChannelKind::characteristic && channel.undefined.empty())
        return "the joints hold the wheel: it does not rise";
    if (const auto* of = std::get_if<Catalogued>(&channel.reads);
        of != nullptr && of->entry->kind == ChannelKind::element)
        return "another force on the wheel's body may be the road's or not";
    return channel.undefined;
}

std::vector<bool> active_channels(std::span<const Channel> channels, const Model& side_model) {
    std::vector<bool> active(side_model.joints.size(), false), list;
    for (const auto& constraint : side_model.constraints)
        active[static_cast<std::size_t>(constraint.joint)] = true;
    for (const auto& channel : channels)
        list.push_back(std::ranges::all_of(
            channel.joints(), [&](int k) { return active[static_cast<std::size_t>(k)]; }));
    return list;
}

std::vector<Channel> sums(const Model& model) {
    std::vector<std::vector<int>> groups;
    for (const Branch& branch : model.branches) {
        const Model side_model = sides_of(model, branch).front().model;
        for (const auto& group : recursive::diagnose(side_model).redundant_sets)
            if (std::ranges::find(groups, group) == groups.end()) groups.push_back(group);
    }
    return totals(model, groups);
}

LargestForces::LargestForces(const Model& of_model, const BranchSide& on_side)
    : model(&of_model), side(&on_side), analyses(std::make_shared<Analyses>()) {
    for (auto& channel : element_channels(of_model)) {
        const auto* of = std::get_if<ElementComponent>(&channel.reads);
        if (of != nullptr && of->component < 6) continue;
        const std::string element = element_of(channel);
        if (largest.empty() || largest.back().element != element ||
            largest.back().unit != channel.unit) {
            LargestForce none{.element = element, .output = {}, .unit = channel.unit};
            none.deformation = nan;
            largest.push_back(std::move(none));
        }
        entry.push_back(largest.size() - 1);
        channels.push_back(std::move(channel));
    }
}

void LargestForces::add(const Equilibrium& state) {
    const Branch& branch = side->branch;
    const auto values = evaluate(*model, *side, channels, state, *analyses);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        LargestForce& largest_force = largest[entry[c]];
        if (std::isnan(largest_force.value) || std::isnan(values[c]) ||
            !(std::abs(values[c]) > std::max(zero_value, std::abs(largest_force.value))))
            continue;
        largest_force.output = channels[c].name;
        if (values[c] == undefined) {
            largest_force.value = nan;
            continue;
        }
        largest_force.value = values[c];
        largest_force.a = parameter_in(unit_of(branch.unit), state.load);
        const auto* read = std::get_if<ElementComponent>(&channels[c].reads);
        if (read == nullptr) continue;
        largest_force.deformation_unit = unit_of_component(read->component - 6);
        largest_force.deformation =
            in_unit(largest_force.deformation_unit) *
            state_of(*model, branch, state, read->element).component(read->component - 6);
    }
}

std::vector<LargestForce> LargestForces::list() const {
    std::vector<LargestForce> list;
    for (const auto& one : largest)
        if (!one.output.empty()) list.push_back(one);
    return list;
}

}  // namespace elastocheck::compare
