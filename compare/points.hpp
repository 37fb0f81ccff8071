// Points that somebody else found, measured or computed: where each is on which branch, and what was found there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/compare.hpp"

namespace elastocheck::compare {

struct PointColumn {
    std::size_t channel = 0;  // position in Comparison::channels
    bool change = false;      // counted from the design position
    std::vector<double>
        values;  // per point, in the channel's unit; NaN where nothing is said, infinite where what
                 // is said is no number
};

// All vectors have one entry a point, or none.
struct Points {
    std::vector<std::string> branch;  // on which branch; empty: of those on different sides of a = 0, the one
                                      // that reaches the point
    std::vector<double> a;            // parameter, in the branch's unit
    std::optional<std::size_t> abscissa;  // a channel that says where a point is ...
    std::vector<double> at;               // ... by its value
    std::vector<PointColumn> columns;
};

// As positions and angles, no longer as changes.
std::vector<PointColumn> as_they_stand(const Model& model, const Comparison& comparison,
                                       std::vector<PointColumn> columns);

// Position in Comparison::branches of each point's branch, or -1 where none reaches it; `x` places the points, by the
// parameter or by the channel. Throws std::invalid_argument where a branch is not one of the comparison, or without names
// two branches lie on the same side.
std::vector<int> branches_of(const Model& model, const Comparison& comparison,
                             const std::vector<std::string>& names, const std::vector<double>& x,
                             std::optional<std::size_t> channel);

// What the points of a leg are placed by: the parameter, or a channel; empty where that turns back.
std::vector<double> placed_by(const Curve& curve, std::optional<std::size_t> channel);
// Whether a sequence that rises or falls throughout reaches x.
bool reaches(const std::vector<double>& over, double x);

}  // namespace elastocheck::compare
