// Measured points beside the calculated curves.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compare/compare.hpp"

namespace elastocheck::compare {

struct MeasuredColumn {
    std::size_t channel = 0;     // position in Comparison::channels
    bool change = false;         // counted from the design position
    std::vector<double> values;  // per point, in the channel's unit; NaN where it was not measured
};

// Where the points are, and what was measured there. All vectors have one entry a point, or none.
struct Measured {
    std::vector<std::string> branch;  // on which branch; empty: of those on different sides of a = 0, the one
                                      // that reaches the point
    std::vector<double> a;            // parameter, in the branch's unit
    std::optional<std::size_t> abscissa;  // a channel that says where a point is ...
    std::vector<double> at;               // ... by its value
    std::vector<MeasuredColumn> columns;
};

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
    bool by_parameter = true;  // else by Measured::abscissa
    std::vector<MeasuredRow> rows;
};
struct MeasuredComparison {
    std::vector<std::string> branch;      // that each point was compared with; empty where none reaches it
    std::vector<MeasuredColumn> columns;  // as positions and angles, no longer as changes
    std::vector<MeasuredReading> readings;
    int compared = 0;  // numbers in all
};

// A point is compared with the branch it names and with no other. Throws std::invalid_argument where a branch
// is not one of the comparison, or without names two branches lie on the same side.
MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Measured& measured);

}  // namespace elastocheck::compare
