// Registry of all commands of the program, in the order of --help.
#pragma once

#include <vector>

#include "reports/command/grammar/command.hpp"

namespace elastocheck::reports {

// Without the commands that print the registry itself (program.cpp: completion, man).
std::vector<Command> registry();

}  // namespace elastocheck::reports
