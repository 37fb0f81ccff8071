// Manual page elastocheck(1) in roff: the --help texts of all commands.
#pragma once

#include <string>
#include <vector>

#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/parse.hpp"

namespace elastocheck::reports {

std::string manual(const Program& program, const std::vector<Command>& commands,
                   const std::string& version);

}  // namespace elastocheck::reports
