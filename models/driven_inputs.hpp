// Drivers of a branch: the values of a model that the branch changes, each start + rate · a.
#pragma once

#include <array>
#include <stdexcept>
#include <vector>

#include "models/kinds.hpp"

namespace elastocheck {

// `Affine` has `start` and `rate` of one number type.

template <class Affine>
struct DrivenElement {
    Affine free_length;             // of an element that has one [m]
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

    const auto element_with = [&](int k, bool has_it, const char* what) -> auto& {
        if (!has_it)
            throw std::invalid_argument("element '" +
                                        model.elastics.at(static_cast<std::size_t>(k)).name +
                                        "' has no " + what + " to be driven");
        return inputs.elements[static_cast<std::size_t>(k)];
    };
    for (const auto& driver : branch.drivers) {
        const auto add = [&](Affine& to, double times) {
            to.start += Value(times) * Value(driver.start);
            to.rate += Value(times) * Value(driver.rate);
        };
        const auto kind = [&](int k) -> const ElasticKind& {
            return model.elastics.at(static_cast<std::size_t>(k)).kind;
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
                    add(element_with(k, driven_number(kind(k)) != nullptr, "free length")
                            .free_length,
                        1);
                },
                [&](const Preload& wrench) {
                    const int k = wrench.elastic;
                    auto& element = element_with(k, preload(kind(k)) != nullptr, "preload");
                    for (std::size_t n = 0; n < 6; ++n)
                        add(element.preload[n], wrench.direction[static_cast<int>(n)]);
                }},
            driver.what);
    }
    return inputs;
}

}  // namespace elastocheck
