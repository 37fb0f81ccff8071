// Templates hold the markup, C++ holds none. They are Mustache, live in reports/page/templates/ and are part
// of the program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// What {{value}} does to special characters; {{{value}}} leaves them.
enum class Escape { html, markdown, gnuplot, nothing };

// Fills reports/page/templates/NAME.mustache. Other templates are partials under their names,
// {{>html/table}}. Throws std::logic_error when there is no such template or it is broken.
std::string render(std::string_view name, const nlohmann::ordered_json& data, Escape escape);

}  // namespace elastocheck::reports
