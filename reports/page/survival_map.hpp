// Survival map of `elastocheck stress` as a part of the page.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/json/json_cursor.hpp"

namespace elastocheck::reports {

// Data of the templates survival.mustache: the part "stress" of the document, with its signs grouped
// by colour; null if the document has none. Throws ResultError for a sign that is not one of
// compare::sign.
nlohmann::ordered_json survival(const JsonCursor& result);

}  // namespace elastocheck::reports
