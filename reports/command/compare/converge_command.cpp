// `elastocheck converge`: step error, formulation gap and reference uncertainty over the steps.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "compare/comparison/compare.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/studies/converge.hpp"
#include "elastocheck/recursive.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/candidate_options.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/program/command.hpp"

namespace elastocheck::reports {
namespace {

struct ConvergeRequest : SceneRequest {
    std::vector<std::string> methods{"published"};
    std::vector<int> steps;
    CandidateRequest candidate;

    bool wants(std::string_view method) const {
        return methods.front() == "all" || std::ranges::find(methods, method) != methods.end();
    }
};

// Levels of a candidate: files with numbers of steps, or a run of its command for each number.
compare::Study study_of(const CandidateRequest& request, const std::string& file,
                        const LoadedScene& loaded, const std::vector<int>& steps) {
    for (const auto& text : request.files)
        if (text.find('=') == text.npos)
            throw std::invalid_argument(fmt::format(
                "--candidate {}: the number of steps is missing; allowed: 75={}", text, text));
    if (!request.files.empty() && !request.command.empty())
        throw std::invalid_argument("converge: --candidate or --candidate-command, one of the two");
    const compare::Comparison outline = compare::outline(loaded.model);
    const ColumnMap map = map_of(request);
    std::vector<compare::CandidateLevel> levels;
    std::string name;
    auto outputs = outputs_of(request, file, steps);
    std::ranges::stable_sort(outputs, {}, &CandidateOutput::steps);
    compare::Study failed;
    for (const auto& output : outputs) {
        if (name.empty()) name = output.name;
        const auto refuse = [&](const std::string& why) {
            failed.inconclusive.push_back(fmt::format("{}: {}", output.file, why));
        };
        try {
            if (output.failed.empty())
                levels.push_back(
                    {output.steps, read_candidate({output.name, output.file, output.content},
                                                  loaded.scene, loaded.model, outline, map)
                                       .points});
            else
                refuse(output.failed);
        } catch (const SheetError& error) {
            if (!output.of_command) throw;
            refuse(error.what());
        }
    }
    if (!failed.inconclusive.empty()) return failed;
    return compare::study_candidate(loaded.model, name, levels, progress);
}

int converge(const ConvergeRequest& request, const Delivery& delivery) {
    check(request.candidate, request.settings);
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Model& model = loaded.model;
    compare::StudyOptions options;
    if (!request.steps.empty()) {
        check_memory(model, {.steps = std::ranges::max(request.steps)});
        options.steps = request.steps;
    }
    options.methods.clear();
    for (const auto& method : recursive::methods)
        if (recursive::has_steps(method) && request.wants(method.name))
            options.methods.push_back(method);
    options.threads = threads_of(request.running);
    options.progress = compare::part(progress, 0, 0.4);
    compare::ConvergenceStudies studies;
    if (request.candidate.wanted())
        studies.candidate = study_of(request.candidate, request.scene, loaded, options.steps);
    if (!options.methods.empty()) {
        studies.methods = compare::study(model, options);
        studies.attribution =
            compare::attribute_gap(model, options.threads, compare::part(progress, 0.4, 0.7));
    }
    if (request.wants("series"))
        studies.orders = compare::order_study(
            model, {.threads = options.threads, .progress = compare::part(progress, 0.7, 1)});
    progress("");
    return deliver_result(delivery, document_of(loaded, request.scene), result_of(model, studies));
}

}  // namespace

const Command converge_command{
    Group::compare, "converge",
    "Convergence study: split the recursion's error into step error, formulation gap and "
    "reference uncertainty",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<ConvergeRequest>();
        std::vector<std::string> known{"all"};
        for (const auto& method : recursive::methods)
            if (!std::holds_alternative<recursive::Adaptive>(method.kind))
                known.emplace_back(method.name);
        add_scene_and_run(command, *request);
        as_word(command
                    .add_option("--method", request->methods,
                                "published (default), closed, balanced, tangent, chord, "
                                "midpoint, series, or all")
                    ->delimiter(','),
                known);
        command
            .add_option("--steps", request->steps,
                        "step counts per branch, at least five, increasing (default: "
                        "75,150,...,2400)")
            ->delimiter(',')
            ->check(CLI::Range(1, max_steps));
        add_output(command, request->folder,
                   "folder for result.json, convergence.csv, step_errors.csv and attribution.csv");
        add_candidate(command, request->candidate);
        return [request](const std::string& line) {
            return converge(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
