// Built-in scenes as templates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

std::vector<std::string> templates();                     // their names
std::string_view template_text(const std::string& name);  // empty for an unknown name
std::string_view template_title(std::string_view scene);  // `name` of a scene's text
// The text of a template. Throws std::invalid_argument for an unknown name, with the nearest.
std::string_view template_named(const std::string& name);

}  // namespace elastocheck::reports
