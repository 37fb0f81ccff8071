// Command-line options for external candidates, and their outputs.
#pragma once

#include <string>
#include <vector>

#include "compare/candidate/candidate.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/given/candidate_file.hpp"

namespace elastocheck::reports {

struct CandidateRequest {
    std::vector<std::string> files;  // --candidate: FILE, or STEPS=FILE
    std::string command;             // --candidate-command
    double timeout = 60;             // --candidate-timeout [s]
    std::string map;                 // --map
    bool partial = false;            // --partial: may pass without some branches or parts of them

    bool wanted() const { return !files.empty() || !command.empty(); }
};

// The file of --map; empty without one.
ColumnMap map_of(const CandidateRequest& request);

// Output of one file or one run.
struct CandidateOutput {
    std::string name;  // of the file or of the program
    std::string file;  // source of the content, for messages
    int steps = 0;     // given or requested number of steps; 0: not given
    bool of_command = false;
    std::string content;
    // reason for missing content: the command crashed, took too long, wrote nothing
    std::string failed;
};

// Before the work: throws std::invalid_argument for a request that is invalid for any candidate.
void check(const CandidateRequest& request, const Settings& settings);

// Reads the files; runs the command once per number of steps, whose failure is not an exception.
std::vector<CandidateOutput> outputs_of(const CandidateRequest& request, const std::string& scene,
                                        const std::vector<int>& steps);

// Throws SheetError for the table of a file that cannot be read, before anything is solved.
void check_tables(const std::vector<CandidateOutput>& outputs, const CandidateRequest& request,
                  const LoadedScene& loaded);

// Judges an output. A failed command or an unreadable output of it is not judged; an unreadable file is
// bad input and throws SheetError. `given`: the user gave the tolerance.
compare::CandidateJudgement judged(const CandidateOutput& output, const CandidateRequest& request,
                                   const LoadedScene& loaded, const compare::Comparison& comparison,
                                   const compare::Tolerance& tolerance, bool given);

// Default number of steps for a command: the largest of the branches.
int steps_of(const Model& model);

}  // namespace elastocheck::reports
