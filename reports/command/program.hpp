// The program as a whole: its name and description, and all of its commands.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/parse.hpp"

namespace elastocheck::reports {

// `place` returns where a document of the source tree is found, for the last lines of --help.
Program program(const std::function<std::string(const std::string&)>& place);

// The commands of the registry, and the two that print their description: completion, man.
std::vector<Command> commands();

}  // namespace elastocheck::reports
