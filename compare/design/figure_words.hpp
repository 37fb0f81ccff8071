// Parses names of figures: "OUTPUT", "OUTPUT@BRANCH" or "OUTPUT@BRANCH:PARAMETER". Throws
// std::invalid_argument for a name that the scene lacks, with the nearest name that it has.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

// "BRANCH" or "BRANCH:PARAMETER", the parameter in N, N·m, mm or deg.
struct Station {
    const Branch* branch = nullptr;  // of the model
    std::optional<double> at = {};   // [SI], within the branch
};
Station parse_station(std::string_view words, const Model& model);

struct FigureWords {
    const Channel* output = nullptr;  // of `outputs`
    Station station;                  // without an "@", the first branch
    bool placed = false;              // whether there is an "@"
};
FigureWords parse_figure_words(std::string_view words, const Model& model,
                               std::span<const Channel> outputs);

}  // namespace elastocheck::compare
