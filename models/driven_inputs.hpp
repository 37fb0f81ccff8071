// Drivers of a branch: the values of a model that the branch changes, each start + rate · a.
#pragma once

#include <array>
#include <stdexcept>
#include <vector>

#include "models/kinds.hpp"

namespace elastocheck {

// `Affine` is a leg's type for start + rate · a: two members `start` and `rate` of one number type.
template <class Affine>
struct DrivenElement {
    Affine free_length;             // of a spring; added to the undeformed d_z of a bushing [m]
    std::array<Affine, 6> preload;  // [N, N·m]
};
template <class Affine>
struct DrivenLoad {
    LoadKind kind;
    Affine factor;  // 1 for static loads
};
template <class Affine>
struct DrivenInputs {
    std::vector<Affine> values;  // per constraint: offset or length [m], angle [rad], or 0
    std::vector<DrivenElement<Affine>> elements;  // per element
    std::vector<DrivenLoad<Affine>> loads;        // static loads, then those of the drivers
};

// The inputs of the model on the branch: the values at the design position plus those of the
// drivers. Throws std::invalid_argument if a driver has no target.
template <class Affine>
DrivenInputs<Affine> driven_inputs(const Model& model, const Branch& branch) {
    using Value = decltype(Affine::start);
    DrivenInputs<Affine> inputs;
    for (const auto& constraint : model.constraints) {
        const double* value = driven_number(constraint.kind);
        inputs.values.push_back({Value(value != nullptr ? *value : 0), Value(0)});
    }
    for (const auto& elastic : model.elastics) {
        auto& element = inputs.elements.emplace_back();
        if (const double* length = driven_number(elastic.kind)) element.free_length.start = *length;
        if (const Vector6* wrench = preload(elastic.kind))
            for (std::size_t k = 0; k < 6; ++k)
                element.preload[k].start = (*wrench)[static_cast<int>(k)];
    }
    for (const auto& load : model.static_loads)
        inputs.loads.push_back({load.kind, {Value(1), Value(0)}});

    for (const auto& driver : branch.drivers) {
        const auto add = [&](Affine& to, double times) {
            to.start += Value(times) * Value(driver.start);
            to.rate += Value(times) * Value(driver.rate);
        };
        std::visit(
            overloaded{
                [&](const Load& load) {
                    inputs.loads.push_back({load.kind, {Value(driver.start), Value(driver.rate)}});
                },
                [&](const Motion& motion) {
                    const auto& joint = model.joints.at(static_cast<std::size_t>(motion.joint));
                    if (joint.driven < 0)
                        throw std::invalid_argument("joint '" + joint.name +
                                                    "' has no offset that a branch can drive");
                    add(inputs.values[static_cast<std::size_t>(joint.driven)], 1);
                },
                [&](const FreeLength& length) {
                    const int k = length.elastic;
                    add(inputs.elements.at(static_cast<std::size_t>(k)).free_length, 1);
                },
                [&](const Preload& wrench) {
                    const int k = wrench.elastic;
                    const Elastic& elastic = model.elastics.at(static_cast<std::size_t>(k));
                    if (preload(elastic.kind) == nullptr)
                        throw std::invalid_argument("element '" + elastic.name +
                                                    "' has no preload to be driven");
                    auto& element = inputs.elements[static_cast<std::size_t>(k)];
                    for (std::size_t n = 0; n < 6; ++n)
                        add(element.preload[n], wrench.direction[static_cast<int>(n)]);
                }},
            driver.what);
    }
    return inputs;
}

}  // namespace elastocheck
