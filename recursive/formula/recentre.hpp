// Moves the origin to the model's centre to avoid cancellation.
//
// The equations do not depend on the position of the origin, but their rounding does: at 1e7 m a
// double resolves a coordinate to 2e-9 m, and a correction there leaves an error of a thousand
// times the tolerance of the series.
#pragma once

#include <optional>

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// Mean design position of the bodies, in ground axes [m], if it is so far from the origin that two
// digits or more are lost; else none.
std::optional<Eigen::Vector3d> far_centre(const Model& model);

// The model with its bodies and the ground points of its joints and elements moved by -c. Its poses
// are those of `model` moved by -c; its wrenches are the same. Probes and wheels are not changed.
Model centred(const Model& model, const Eigen::Vector3d& c);

}  // namespace elastocheck::recursive
