// Mechanisms made of named points by templates of roles (mechanisms.yaml).
#pragma once

#include "models/import/import.hpp"

namespace elastocheck::importer {

// Gives the points of a draft, whose sources have their names in the file, the roles of the template
// options.as, and adds its bodies, joints, wheel and branches: rigid, without springs. Notes the point of
// each role and those without one. Throws SceneError for roles without a point, or with several.
void make_mechanism(const std::string& file, const Options& options, Draft& draft);

// Names of the templates; and the one that words such as those of a file ("Double Wishbone, damper to
// lower wishbone") mean, empty if none.
const std::vector<std::string>& mechanisms();
std::string mechanism_called(std::string_view words);

}  // namespace elastocheck::importer
