// Built-in scenes as templates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

std::vector<std::string> templates();                     // their names
std::string_view template_text(const std::string& name);  // empty for an unknown name

}  // namespace elastocheck::reports
