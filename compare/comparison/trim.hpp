// Parts of a trim that its derivative needs (compare/sensitivity/), and trims by one leg alone.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::recursive::series {
struct Start;  // recursive/series/path.hpp
}

namespace elastocheck::compare {

// The outputs that the conditions of the trim read, one each: an angle, or a coordinate counted
// from the design position. In the units of the channels, mm and deg.
std::vector<Channel> condition_channels(const Model& model, const Trim& trim);

// The scene with the adjustments p added to the adjusted quantities, and without its trim. p: one
// entry per Trim::adjust, in the SI unit of Trim::Adjustment::unit.
Scene with_adjusted(Scene scene, const Eigen::VectorXd& p);

// Where a trim of a similar scene ended.
struct TrimStart {
    Eigen::VectorXd p;  // adjustments, as in with_adjusted()
    // [conditions × adjustments]: change of each condition [m, rad] with a step h of each
    // adjustment (elastocheck/trim.hpp)
    Eigen::MatrixXd J;
    std::vector<int> structure = {};  // of the settled model (models/structure.hpp)
    std::shared_ptr<const recursive::series::Start> settled = {};  // by the series
};

// trim() by the series alone, for a program without the references. No second reference confirms
// it: `confirming_residual` of its conditions is NaN, and `confirmed_by` is the series.
//
// With a `start` the equations are solved from there by Broyden's method, to the same accuracy, and
// every state settles from the last one; where that does not converge, as without a start. A start of
// another structure or size, such as an empty one, is not used. A trim that is reached replaces `start`.
Trimmed trim_by_series(const Scene& scene, TrimStart* start = nullptr);

// The same by the equilibrium leg alone.
Trimmed trim_not_confirmed(const Scene& scene, TrimStart* start);

}  // namespace elastocheck::compare
