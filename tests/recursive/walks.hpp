// What a leg is given of a model: the ways of each branch, and the model as it stands on them.
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
