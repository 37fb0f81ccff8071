// Parts of a trim that its derivative needs (compare/sensitivity/trim_rates.hpp).
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

// trim() by the series alone, without a second reference: `confirmed` of its conditions is NaN, and
// `confirmed_by` is the series. For a program without the references.
Trimmed trim_by_series(const Scene& scene);

}  // namespace elastocheck::compare
