// The program as a whole: its name and description, and all of its commands.
#pragma once

#include <string>
#include <vector>

#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/parse.hpp"

namespace elastocheck::reports {

// For --help: documents of the source tree are named by the path at which they are installed, or at
// which they are in the source tree for a program in its build tree.
Program program();

// In the order of --help; then the hidden one that prints this description: man.
std::vector<Command> commands();

}  // namespace elastocheck::reports
