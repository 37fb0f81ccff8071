// Shell completion: commands, options, words of an option, files by their pattern. The script of a
// shell asks the program for the offers of each line.
#pragma once

#include <string>
#include <vector>

#include "reports/command/grammar/command.hpp"

namespace elastocheck::reports {

// Completion script for bash, zsh or fish. Pre: `shell` is one of them.
std::string completion(const std::string& shell);

// What may stand in place of the last word of a command line, by line: "WORD<TAB>description"; or
// one line ":folders", ":files PATTERN". Empty for free text.
std::string offers(const std::vector<Command>& commands, const std::string& line);

}  // namespace elastocheck::reports
