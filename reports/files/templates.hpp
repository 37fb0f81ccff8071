// Mustache templates of reports/page/templates/, all markup of a report, compiled into the program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// Escaping of {{value}}; {{{value}}} is not escaped.
enum class Escape { html, markdown, nothing };

// Renders reports/page/templates/NAME.mustache. Other templates are available as partials,
// {{>html/table}}. Throws std::logic_error for a missing or invalid template.
std::string render(std::string_view name, const nlohmann::ordered_json& data, Escape escape);

}  // namespace elastocheck::reports
