// Parts of a trim that its derivative needs (compare/sensitivity/), and trims by other means.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {

// What the conditions read, in SI after division by the unit: an angle, or a coordinate counted from
// the design position.
std::vector<Channel> condition_channels(const Model& model, const Trim& trim);

// The scene with the adjustments p as plain data, in the units of the adjusted quantities [SI], and
// without its trim.
Scene with_adjusted(Scene scene, const Eigen::VectorXd& p);

// Where a trim of a similar scene ended: its adjustments, in the units of the adjusted quantities
// [SI], and the changes of the conditions by a step of each [conditions × adjustments].
struct TrimStart {
    Eigen::VectorXd p;
    Eigen::MatrixXd J;
};

// trim() by the series alone, without a second reference: `confirmed` of its conditions is NaN, and
// `confirmed_by` is the series. For a program without the references. With a `start` the equations
// are solved from there by the method of Broyden where it converges, to the same accuracy, else as by
// trim(); a start of another size, such as an empty one, is not used. A trim that is reached
// replaces it.
Trimmed trim_by_series(const Scene& scene, TrimStart* start = nullptr);

// The same by the equilibrium leg.
Trimmed trim_not_confirmed(const Scene& scene, TrimStart* start);

}  // namespace elastocheck::compare
