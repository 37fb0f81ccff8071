// The suspension of a scene in result.json, to be drawn.
#pragma once

#include <optional>

#include "reports/document/field.hpp"
#include "reports/page/views.hpp"

namespace elastocheck::reports {

// Nothing where the scene has no drawing. With the positions at the ends of the branch that leads the page.
std::optional<Suspension> suspension_of(const Field& scene);

// What it is called: a scene without a wheel is a mechanism.
const char* noun_of(const Suspension& suspension);

}  // namespace elastocheck::reports
