// Shell completion: commands, options, words of an option, files by their pattern.
#pragma once

#include <string>

#include "reports/command/grammar/grammar.hpp"

namespace elastocheck::reports {

// Completion script for bash, zsh or fish. Pre: `shell` is one of them.
std::string completion(const Grammar& grammar, const std::string& shell);

}  // namespace elastocheck::reports
