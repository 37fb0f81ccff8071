// The survival map of `elastocheck stress` as a part of the page.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/document/field.hpp"

namespace elastocheck::reports {

// What the templates survival.mustache say it with; null where the document has none. Throws ResultError where a sign is
// none of compare::sign.
nlohmann::ordered_json survival(const Field& result);

}  // namespace elastocheck::reports
