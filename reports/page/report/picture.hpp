// The drawing of a scene alone, at the design position.
#pragma once

#include <string>

#include "reports/json/json_cursor.hpp"

namespace elastocheck::reports {

// A stand-alone SVG file: "axonometric", "front", "side" or "top" view of a scene with its
// `drawing`. Throws std::invalid_argument for another view, and for a scene without a point.
std::string picture(const JsonCursor& scene, const std::string& view);

}  // namespace elastocheck::reports
