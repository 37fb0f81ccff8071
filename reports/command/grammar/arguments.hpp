// Validation of command-line words.
#pragma once

#include <string>

namespace elastocheck::reports {

// Throws std::invalid_argument for a word that is not UTF-8 or has control characters (escape.hpp:
// flaw), since words appear in reports, annotations and terminals. A --reason may have several
// lines.
void check_words(int argc, char** argv);

// The command as it was given, for a shell; without what does not change a result (--jobs,
// --quiet).
std::string command_line(int argc, char** argv);

}  // namespace elastocheck::reports
