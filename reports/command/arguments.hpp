// Words of the command line: fit to be used, or refused before anything is done.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "models/reader/scene_file.hpp"

namespace elastocheck::reports {

// Throws std::invalid_argument for a word that is not UTF-8 or has control characters (escape.hpp: flaw): it
// would go into reports, annotations and terminals. A --reason may have several lines.
void check_words(int argc, char** argv);

// The command as it was given, for a shell.
std::string command_line(int argc, char** argv);

// --set PATH=VALUE, any number of times: numbers of the scene file changed before it is read.
using Settings = std::vector<Setting>;
void add_settings(CLI::App& command, Settings& settings);

// Of an option that names a file or a folder: it names one.
CLI::Validator a_name();

}  // namespace elastocheck::reports
