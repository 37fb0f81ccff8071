#include "reports/command/options/candidate_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "compare/comparison/compare.hpp"
#include "reports/files/files.hpp"
#include "reports/files/subprocess.hpp"
#include "reports/files/terminal.hpp"
#include "reports/given/state_file.hpp"

namespace elastocheck::reports {
namespace {

// "75=a.csv", or "a.csv" without a number.
std::pair<int, std::string> steps_and_file(const std::string& text) {
    const auto at = text.find('=');
    int steps = 0;
    if (at != text.npos) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + at, steps);
        if (error == std::errc{} && end == text.data() + at && steps > 0)
            return {steps, text.substr(at + 1)};
    }
    return {0, text};
}

std::string replaced(std::string text, std::string_view old, const std::string& replacement) {
    for (auto at = text.find(old); at != text.npos; at = text.find(old, at + replacement.size()))
        text.replace(at, old.size(), replacement);
    return text;
}

std::vector<std::string> command_words(const std::string& command) {
    std::vector<std::string> words;
    try {
        words = words_of(command);
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("--candidate-command: {}", error.what()));
    }
    if (words.empty()) throw std::invalid_argument("--candidate-command: no program given");
    if (std::ranges::none_of(words,
                             [](const std::string& w) { return w.find("{output}") != w.npos; }))
        throw std::invalid_argument(
            "--candidate-command: {output} is missing; allowed: words with {scene}, {steps} and "
            "{output}, the file that the program writes");
    return words;
}

}  // namespace

ColumnMap map_of(const CandidateRequest& request) {
    if (request.map.empty()) return {};
    return read_column_map(read_whole(request.map, largest_baseline), request.map);
}

void check(const CandidateRequest& request, const Settings& settings) {
    if (!request.map.empty() && !request.wanted())
        throw std::invalid_argument("--map: only with --candidate or --candidate-command");
    (void)map_of(request);
    if (request.partial && !request.wanted())
        throw std::invalid_argument("--partial: only with --candidate or --candidate-command");
    if (request.command.empty()) return;
    (void)command_words(request.command);
    if (!settings.empty())
        throw std::invalid_argument(
            "--candidate-command: not with --set: the program reads the scene file; change the "
            "file");
}

std::vector<CandidateOutput> outputs_of(const CandidateRequest& request, const std::string& scene,
                                        const std::vector<int>& steps) {
    std::vector<CandidateOutput> list;
    for (const auto& text : request.files) {
        const auto [n, file] = steps_and_file(text);
        // Reading a pipe without a writer would block; the pipes of a shell, in /dev, have one.
        std::error_code ignored;
        if (std::filesystem::is_fifo(file, ignored) && !file.starts_with("/dev/"))
            throw FileError(file + ": is a pipe; a candidate is a regular file");
        list.push_back({.name = std::filesystem::path(file).stem().string(),
                        .file = file,
                        .steps = n,
                        .content = read_whole(file, largest_measurement),
                        .failed = {}});
    }
    if (request.command.empty()) return list;
    const auto words = command_words(request.command);
    const TemporaryFolder folder;
    for (const int n : steps) {
        const std::string output = folder.path() + fmt::format("/{}", n);
        auto given = words;
        for (auto& word : given)
            word =
                replaced(replaced(replaced(word, "{steps}", std::to_string(n)), "{output}", output),
                         "{scene}", scene);
        CandidateOutput& run_output = list.emplace_back();
        run_output.name = std::filesystem::path(words.front()).filename().string();
        run_output.file = fmt::format("{} with {} steps", run_output.name, n);
        run_output.steps = n;
        run_output.of_command = true;
        progress(run_output.file);
        const ProcessResult result = run(given, request.timeout);
        if (!result.succeeded()) {
            run_output.failed =
                fmt::format("'{}' {}", words.front(), describe(result, request.timeout));
            if (!result.output_text.empty())
                print_error("{}: output of the command:\n{}\n", run_output.file,
                            result.output_text);
            continue;
        }
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(output, ignored))
            run_output.failed = fmt::format("'{}' wrote no output file", words.front());
        else
            try {
                run_output.content = read_whole(output, largest_measurement);
                if (run_output.content.find_first_not_of(" \t\r\n") == std::string::npos)
                    run_output.failed = fmt::format("'{}' wrote nothing", words.front());
            } catch (const FileError& error) {
                run_output.failed = error.what();
            }
        if (!run_output.failed.empty() && !result.output_text.empty())
            print_error("{}: output of the command:\n{}\n", run_output.file, result.output_text);
    }
    progress("");
    return list;
}

void check_tables(const std::vector<CandidateOutput>& outputs, const CandidateRequest& request,
                  const LoadedScene& loaded) {
    compare::Comparison unsolved;
    unsolved.channels = compare::compared_channels(loaded.model, loaded.definitions);
    for (const auto& output : outputs)
        if (!output.of_command && !holds_states(output.content))
            (void)read_candidate({output.name, output.file, output.content}, loaded.scene,
                                 loaded.model, unsolved, map_of(request));
}

compare::CandidateJudgement judged(const CandidateOutput& output, const CandidateRequest& request,
                                   const LoadedScene& loaded, const compare::Comparison& comparison,
                                   const compare::Tolerance& tolerance, bool given) {
    compare::CandidateJudgement unjudged;
    unjudged.name = output.name;
    unjudged.tolerance = tolerance;
    unjudged.tolerance_given = given;
    if (!output.failed.empty()) {
        unjudged.reasons.push_back(output.failed);
        return unjudged;
    }
    const ColumnMap map = map_of(request);
    try {
        auto candidate = read_candidate({output.name, output.file, output.content}, loaded.scene,
                                        loaded.model, comparison, map);
        candidate.complete = !request.partial;
        return compare::judge_candidate(loaded.model, comparison, candidate, tolerance, given);
    } catch (const SheetError& error) {
        if (!output.of_command) throw;
        unjudged.reasons.emplace_back(error.what());
    } catch (const std::invalid_argument& error) {  // points that cannot be placed
        if (!output.of_command) throw SheetError(fmt::format("{}: {}", output.file, error.what()));
        unjudged.reasons.emplace_back(error.what());
    }
    return unjudged;
}

int steps_of(const Model& model) {
    int most = 1;
    for (const auto& branch : model.branches) most = std::max(most, branch.steps);
    return most;
}

}  // namespace elastocheck::reports
