// What the templates of pages take: tables, colours.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/page/page.hpp"

namespace elastocheck::reports {

nlohmann::ordered_json table_data(const Table& table);
nlohmann::ordered_json tints();  // of the palette (svg.hpp), for the style sheet

}  // namespace elastocheck::reports
