// The page of the manual, elastocheck(1), as roff: what --help says, of all commands.
#pragma once

#include <string>

#include "reports/command/grammar.hpp"

namespace elastocheck::reports {

std::string manual(const Grammar& grammar, const std::string& version);

}  // namespace elastocheck::reports
