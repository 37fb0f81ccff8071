// A command of the program, set up by CLI11, and the options and checks that several share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "reports/command/options/candidate_options.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/recursion_options.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/exit_code.hpp"

namespace elastocheck::reports {

// Groups of --help and of the manual, in their order.
inline constexpr const char* groups[] = {"Solve and look",      "Compare and judge",
                                         "Proofs and extremes", "What should I change",
                                         "Models in and out",   "Pages"};
enum class Group { solve, compare, prove, change, models, pages, hidden };

// Runs a command whose options are parsed, given the command line as entered; returns the exit code.
using Run = std::function<int(const std::string& command_line)>;

// A command of the program: its constructor, of an object at namespace scope, registers it. `set_up` adds
// the options, and returns the function that runs the command with their values.
struct Command {
    Command(Group group, const char* name, const char* description, Run (*set_up)(CLI::App&));
    Group group;
    const char *name, *description;
    Run (*set_up)(CLI::App&);
};
// All commands, by group, then by name.
std::vector<const Command*> commands();

// ---- Types of values. Each returns the option.

CLI::Option* as_file(CLI::Option* option);    // the name of a file, not `-`
CLI::Option* as_folder(CLI::Option* option);  // likewise
CLI::Option* as_word(CLI::Option* option, const std::vector<std::string>& words);  // one of these
CLI::Option* repeated(CLI::Option* option);  // --option A --option B
// A finite number from `low` to `high`, with a decimal point in any locale.
CLI::Option* add_number(CLI::App& command, const std::string& name, double& variable,
                        std::pair<double, double> range, const std::string& description);

// ---- Options that several commands have.

void add_scene(CLI::App& command, std::string& file);   // SCENE
void add_set(CLI::App& command, Settings& settings);    // --set
void add_json(CLI::App& command, bool& wanted);         // --json
void add_running(CLI::App& command, Running& running);  // --jobs, --quiet
void add_keep_all(CLI::App& command, bool& wanted);     // --keep-all
void add_every(CLI::App& command, int& every);          // --every
void add_output(CLI::App& command, std::string& folder, const char* description);  // -o FOLDER
// --steps, --tolerance, --order, --expansions
void add_recursion(CLI::App& command, RecursionRequest& request);
// --candidate, --candidate-command, --candidate-timeout, --map, --partial
void add_candidate(CLI::App& command, CandidateRequest& request);

}  // namespace elastocheck::reports
