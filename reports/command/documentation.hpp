// Where the documentation is that this program came with.
#pragma once

#include <string>

namespace elastocheck::reports {

// A file of the sources, by its name there: as installed (PREFIX/share/doc/elastocheck/NAME), where this program is one
// that was; in the tree that it was built in; or, of a program that was copied away from both, its name.
std::string documentation(const std::string& name);

}  // namespace elastocheck::reports
