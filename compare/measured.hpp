// Measured points beside the calculated curves.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "compare/points.hpp"

namespace elastocheck::compare {

// Leg less measurement. NaN where nothing was compared.
struct MeasuredDeviation {
    double signed_max = 0, rms = 0;
};
struct MeasuredRow {
    std::size_t channel = 0;
    int compared = 0;                                // points that every leg reaches
    std::array<MeasuredDeviation, legs.size()> off;  // in the order of `legs`
};
struct MeasuredReading {
    bool by_parameter = true;  // else by Points::abscissa
    std::vector<MeasuredRow> rows;
};
struct MeasuredComparison {
    std::vector<std::string> branch;   // that each point was compared with; empty where none reaches it
    std::vector<PointColumn> columns;  // as positions and angles, no longer as changes
    std::vector<MeasuredReading> readings;
    int compared = 0;  // numbers in all
};

// A point is compared with the branch it names and with no other. Throws std::invalid_argument where a branch
// is not one of the comparison, or without names two branches lie on the same side.
MeasuredComparison compare_measured(const Model& model, const Comparison& comparison, const Points& measured);

}  // namespace elastocheck::compare
