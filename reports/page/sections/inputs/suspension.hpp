// Drawing data of a suspension from result.json.
#pragma once

#include <optional>

#include "reports/json/json_cursor.hpp"
#include "reports/page/views.hpp"

namespace elastocheck::reports {

// Empty if the scene has no drawing. Includes the positions at the ends of the leading branch.
std::optional<Suspension> suspension_of(const JsonCursor& scene);

// "suspension", or "mechanism" for a scene without a wheel.
const char* noun_of(const Suspension& suspension);

}  // namespace elastocheck::reports
