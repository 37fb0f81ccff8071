// Shell completion of the command: commands, options, the words that an option knows, files by their kind.
#pragma once

#include <string>

#include "reports/command/grammar.hpp"

namespace elastocheck::reports {

// The text that bash, zsh or fish reads. Pre: `shell` is one of them.
std::string completion(const Grammar& grammar, const std::string& shell);

}  // namespace elastocheck::reports
