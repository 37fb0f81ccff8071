// The drawing of a scene alone, at the design position.
#pragma once

#include <string>

#include "reports/document/drawing.hpp"

namespace elastocheck::reports {

// A stand-alone SVG file: "axonometric", "front", "side" or "top" view. Throws std::invalid_argument for
// another view, and for a scene without a point.
std::string picture(const Drawing& drawing, const std::string& view);

}  // namespace elastocheck::reports
