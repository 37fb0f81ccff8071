// Points of another program or of a measurement: the branch of each, its place on that branch by
// the parameter or by an abscissa, and its output values.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "elastocheck/candidate.hpp"

namespace elastocheck::compare {

// Converts changes from the design position to absolute positions and angles: adds the value of the
// design position to each value of a column with PointColumn::change.
std::vector<PointColumn> as_absolute_values(const Model& model, const Comparison& comparison,
                                            std::vector<PointColumn> columns);

// Position in Comparison::branches of each point's branch, or -1 where none reaches it. `names` are
// the branches of the points, or empty; `x` their places: values of the channel, or without one of
// the parameter. Throws std::invalid_argument for a branch that is not in the comparison, and where
// names are needed because two branches lie on the same side of zero.
std::vector<int> branches_of(const Model& model, const Comparison& comparison,
                             const std::vector<std::string>& names, const std::vector<double>& x,
                             std::optional<std::size_t> channel);

// Place of a point: its branch, which it names or which reaches it, and the parameter there or, for a
// point without one, the value of Points::abscissa.
struct Place {
    int branch = -1;  // position in Comparison::branches; -1: none reaches it
    bool by_parameter = true;
    double x = std::numeric_limits<double>::quiet_NaN();  // NaN: the point gives no place
};
// Throws as branches_of().
std::vector<Place> places_of(const Model& model, const Comparison& comparison,
                             const Points& points);

// Values along the curve of the channel, or without one of the parameter, among which points are
// placed. Empty where the channel is not strictly monotonic.
std::vector<double> abscissa_values(const Curve& curve, std::optional<std::size_t> channel);
// Whether x lies within the range of a monotonic sequence, up to 1e-9 of that range.
bool reaches(const std::vector<double>& values, double x);

}  // namespace elastocheck::compare
