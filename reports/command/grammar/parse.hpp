// Parses the command line by the registry of commands, and runs the given command.
#pragma once

#include <string>
#include <vector>

#include "reports/command/grammar/command.hpp"

namespace elastocheck::reports {

struct Program {
    std::string name, description, version, footer;
};
inline constexpr const char *version_option = "--version",
                            *version_help = "print version, commit and libraries";
inline constexpr const char *help_option = "-h,--help",
                            *help_help = "print this help; after a command, its options";

// Returns the exit code. Prints --help and --version; reports an unknown word with the nearest
// known one (exit code 2). Throws std::invalid_argument for a word that is not one line of UTF-8
// text, and what the command throws.
int parse_and_run(const Program& program, const std::vector<Command>& commands, int argc,
                  char** argv);

}  // namespace elastocheck::reports
