// Comparison of the calculated curves with measured points.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "compare/comparison/points.hpp"

namespace elastocheck::compare {

// Leg minus measurement. NaN where nothing was compared.
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
    // branch that each point was compared with; empty where no branch reaches the point
    std::vector<std::string> branch;
    std::vector<PointColumn> columns;  // as absolute positions and angles, no longer as changes
    std::vector<MeasuredReading> readings;
    int compared = 0;  // total of the compared numbers
};

// A point is compared only with the branch it names. Throws std::invalid_argument for a branch that
// is not in the comparison, or, for points without names, if two branches lie on the same side.
MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Points& measured);

}  // namespace elastocheck::compare
