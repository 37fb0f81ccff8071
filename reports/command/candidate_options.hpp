// The options of a command that say who else is to be judged, and what came of running him.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/candidate.hpp"
#include "reports/command/load_scene.hpp"
#include "reports/document/candidate_file.hpp"

namespace elastocheck::reports {

struct CandidateRequest {
    std::vector<std::string> files;  // --candidate: FILE, or STEPS=FILE
    std::string command;             // --candidate-command
    double timeout = 60;             // --candidate-timeout [s]
    std::string map;                 // --map

    bool wanted() const { return !files.empty() || !command.empty(); }
};
void add_candidate_options(CLI::App& command, CandidateRequest& request);

// What one file or one run has to say.
struct CandidateOutput {
    std::string name;  // of the file, or of the program
    std::string file;  // that the content was read from, for messages
    int steps = 0;     // that it is said to have, or was asked for; 0: not said
    bool of_command = false;
    std::string content;
    std::string failed;  // why there is no content: the command crashed, took too long, wrote nothing
    double seconds = 0, cpu = 0;  // of the command
};

// Throws std::invalid_argument for what cannot be right whatever the candidate says: before the work.
void check(const CandidateRequest& request, const Settings& settings);

// Reads the files, and runs the command once for each number of steps. What the command does wrong is no exception.
std::vector<CandidateOutput> outputs_of(const CandidateRequest& request, const std::string& scene,
                                        const std::vector<int>& steps);

// A command that did not do what it should, or wrote what cannot be read, could not be judged; a file that cannot be read
// is bad input: throws SheetError.
compare::CandidateJudgement judged(const CandidateOutput& output, const CandidateRequest& request,
                                   const LoadedScene& loaded, const compare::Comparison& comparison,
                                   const compare::Tolerance& tolerance, bool asked);

// The steps of the recursion, which a command is asked for where nobody says how many: of the longest branch.
int steps_of(const Model& model);

}  // namespace elastocheck::reports
