// The program: all commands behind one command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace elastocheck::reports {

// Returns the exit code of the command. Prints --help and --version; reports an unknown word with
// the nearest known one (exit code 2). Throws std::invalid_argument for a word that is not one line
// of UTF-8 text, and what the command throws.
int parse_and_run(int argc, char** argv);

// The end of --help: exit codes, and where the documents are, by the path of each.
std::string footer(std::string (*path_of)(const std::string& document));

}  // namespace elastocheck::reports
