// Comparison of the calculated curves with measured points.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "compare/comparison/points.hpp"

namespace elastocheck::compare {

// An output of one test: the points of one branch that every leg reaches.
struct MeasuredRow {
    std::string branch;
    std::size_t channel = 0;
    // slope of the straight line through these points, of the measured values and of the equilibrium
    // leg's; per unit of what places them; NaN for fewer than two places
    double measured_gradient = 0, gradient = 0;
    std::array<Deviation, legs.size()>
        off;  // of each leg from the measurement, in the order of `legs`
    int compared() const { return off.front().compared; }
};
struct MeasuredReading {
    bool by_parameter = true;  // else by Points::abscissa
    std::vector<MeasuredRow> rows;
};

// A branch that was measured in both directions: the outputs of the way out and of the way back
// differ by friction and rubber.
struct Hysteresis {
    std::string branch;
    std::size_t channel = 0;
    double width = 0;  // largest difference of both ways, in the channel's unit
    double at = 0;     // where it is: parameter or abscissa of the point
    bool by_parameter = true;
    int points = 0;  // that have both ways
};

struct MeasuredComparison {
    std::vector<Place> places;         // of the points
    std::vector<bool> used;            // per point: a value of it is compared
    std::vector<PointColumn> columns;  // as absolute positions and angles, no longer as changes
    std::vector<MeasuredReading> readings;
    int compared = 0;  // total of the compared numbers
    std::vector<Hysteresis> loops;
    // What is wrong with a column that deviates, in words: "toe agrees to 0.01 deg with its sign
    // turned", "camber agrees to 0.008 deg by another definition: camber@kingpin"
    std::vector<std::string> explanations;
};

// Curves of figures by other definitions, of the equilibrium leg along each branch of a comparison.
struct DefinedCurves {
    std::vector<Channel> channels;
    std::vector<Curve> branches;  // empty: none
};
DefinedCurves defined_curves(const Model& model, const Comparison& comparison);

// A point is compared only with the branch it names, by its parameter and by its abscissa as far as
// it has them. Where the points of a branch go out and back, each is compared by the mean of both
// ways.
//
// A column whose deviation is larger than a hundredth of its range is tried as judge_candidate()
// does, with `defined`; right means that at most a hundredth of the range remains, since it was
// measured, and a twentieth of the deviation. A model that is not yet fitted leaves more. What then
// remains is compared with the deviation before: a sign, a unit that is not near one or an offset is
// named if it leaves a quarter of the root mean square, and a quarter of the column's own scatter. So
// is the sign of what places the points of a branch, which turns all its columns at once, if it
// explains them better than signs of columns do.
//
// Throws std::invalid_argument for a branch that is not in the comparison, or, for points without
// names, if two branches lie on the same side.
MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Points& measured, const DefinedCurves& defined = {});

}  // namespace elastocheck::compare
