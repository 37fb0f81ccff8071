// Location of the documentation of this program.
#pragma once

#include <string>

namespace elastocheck::reports {

// Path of a source file by its name in the tree: the installed one
// (PREFIX/share/doc/elastocheck/NAME) for an installed program; the one in the source tree for a
// program in its build tree; else only its name.
std::string documentation(const std::string& name);

}  // namespace elastocheck::reports
