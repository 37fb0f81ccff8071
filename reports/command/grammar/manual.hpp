// Manual page elastocheck(1) in roff: the --help texts of all commands.
#pragma once

#include <string>

#include "reports/command/grammar/grammar.hpp"

namespace elastocheck::reports {

std::string manual(const Grammar& grammar, const std::string& version);

}  // namespace elastocheck::reports
