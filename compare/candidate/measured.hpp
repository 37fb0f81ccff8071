// Comparison of the calculated curves with measured points.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "compare/comparison/points.hpp"

namespace elastocheck::compare {

// Comparison of one output on one branch, over the points that every leg (solver) reaches.
struct MeasuredRow {
    std::string branch;
    std::size_t channel = 0;
    // Slopes of the straight lines through the measured values and through those of the equilibrium
    // leg, by least squares, in the channel's unit per unit of the parameter or abscissa; NaN where
    // all points are at one place
    double measured_gradient = 0, gradient = 0;
    // deviation of each leg from the measurement, in the order of `legs`
    std::array<Deviation, legs.size()> off;
    int compared() const { return off.front().compared; }
};
struct MeasuredReading {
    bool by_parameter = true;  // else by Points::abscissa
    std::vector<MeasuredRow> rows;
};

// An output of a branch that was measured in both directions: its values on the way out and on the
// way back differ by friction and by hysteresis of the rubber.
struct Hysteresis {
    std::string branch;
    std::size_t channel = 0;
    double width = 0;          // largest difference between both directions, in the channel's unit
    double at = 0;             // place of that difference: parameter or abscissa, in its unit
    bool by_parameter = true;  // `at` is a parameter
    int points = 0;            // points that both directions reach
};

struct MeasuredComparison {
    std::vector<Place> places;         // place of each point on its branch
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
// it has them. Where the points of a branch go out and back, their mean is compared.
//
// A column whose deviation is larger than a hundredth of its range is explained. First the sign of
// the places of a branch is tried, which turns all its columns at once: it is changed where that
// explains them better than signs of columns do. Then each column that still deviates is tried with
//
//   explain()       of judge_candidate(), with `defined`: at most a hundredth of the range of the
//                   column remains, its resolution as a measurement, and at most a twentieth of the
//                   deviation
//   nearer_with()   if that finds nothing, since a model not yet fitted leaves more: a sign, an
//                   offset or a unit factor not near one that leaves at most a quarter of the root
//                   mean square of the deviation. A sign or unit must also leave at most a quarter
//                   of the root mean square of the column about its mean
//
// Throws std::invalid_argument for a branch that is not in the comparison, or, for points without
// names, if two branches lie on the same side.
MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Points& measured, const DefinedCurves& defined = {});

}  // namespace elastocheck::compare
