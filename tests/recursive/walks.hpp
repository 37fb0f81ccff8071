// Branch sides of a model, and the model active on each: the input of a leg.
#pragma once

#include <vector>

#include "models/branch.hpp"

namespace elastocheck::recursive {

struct OneWay {
    Model model;
    Branch branch;
};

inline std::vector<OneWay> one_ways(const Model& model) {
    std::vector<OneWay> all;
    for (const auto& branch : model.branches)
        for (const auto& way : ways(branch)) all.push_back({on_branch(model, way), way});
    return all;
}

}  // namespace elastocheck::recursive
