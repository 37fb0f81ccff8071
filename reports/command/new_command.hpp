// `elastocheck new`: the scenes that come with the program, to start from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// Prints the template called `name`; where it is empty, what there is, a line each. Throws std::invalid_argument for a
// name that there is not, with the nearest one that there is. As JSON: schema, and templates, that one with its text.
int new_scene(const std::string& name, bool as_json);
inline constexpr const char* templates_schema = "elastocheck/templates/1";

std::vector<std::string> templates();                     // their names
std::string_view template_text(const std::string& name);  // empty where there is none

}  // namespace elastocheck::reports
