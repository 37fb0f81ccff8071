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

// What may stand for a value: what checks it says to shell completion what to offer, by its name, so that the two never
// differ. A file or a folder is refused that has no name, or the name `-`: whoever writes that means standard output.
CLI::Validator a_file(const std::string& pattern);             // "files *.yaml"
CLI::Validator a_folder();                                     // "folder"
CLI::Validator one_of(const std::vector<std::string>& words);  // "words published closed ..."
CLI::Validator such_as(
    const std::vector<std::string>& words);  // the same, and others: checked by whoever uses them

// A number from `low` to `high`, which may be infinite though no number is, with a point whatever the locale: CLI11 itself
// asks that for its comma.
CLI::Option* add_number(CLI::App& command, const std::string& name, double& number, double low, double high,
                        const std::string& text);

// --json; `wanted` is set where it is given.
void add_json(CLI::App& command, bool& wanted);

}  // namespace elastocheck::reports
