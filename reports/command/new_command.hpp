// `elastocheck new`: the scenes that come with the program, to start from.
#pragma once

#include <string>

namespace elastocheck::reports {

// Prints the template called `name`; where it is empty, what there is, a line each. Throws std::invalid_argument for a
// name that there is not, with the nearest one that there is.
int new_scene(const std::string& name);

}  // namespace elastocheck::reports
