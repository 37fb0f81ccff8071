// Commands that study one scene: inspect, compare, converge, trade. Each returns the exit code;
// invalid output locations are rejected before the work.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/compare_with.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/studies/formulations.hpp"
#include "compare/studies/order_study.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/recursive.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/candidate_options.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/recursion_options.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/command.hpp"
#include "reports/document/curves.hpp"
#include "reports/document/document.hpp"
#include "reports/document/inspection.hpp"
#include "reports/files/files.hpp"
#include "reports/files/folder.hpp"
#include "reports/files/terminal.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/comparison_tables.hpp"
#include "reports/tables/judgement.hpp"
#include "reports/tables/studies/study_tables.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

struct InspectRequest : SceneRequest {
    bool verbose = false, keep_all = false;
};
struct CompareRequest : SceneRequest {
    RecursionRequest recursion{.method = ""};  // without a method: published, and no verdict
    int every = 1;                             // compares every `every`-th step
    bool keep_all = false;
    std::string within;         // tolerance of the verdict; empty: the default
    bool formulations = false;  // adds the spread over bushing formulations
    bool definitions = false;   // adds the figures by other definitions
};
struct ConvergeRequest : SceneRequest {
    std::vector<std::string> methods{"published"};
    std::vector<int> steps;
    CandidateRequest candidate;
};
struct TradeRequest : SceneRequest {
    std::string tolerance = "0.01mm,0.001deg,1%";
};

Detail detail(bool keep_all) { return keep_all ? Detail::everything : Detail::required; }

std::vector<recursive::Method> methods_named(const std::vector<std::string>& names) {
    std::vector<recursive::Method> methods;
    for (const auto& method : recursive::methods)
        if (recursive::has_steps(method) &&
            (names.front() == "all" || std::ranges::find(names, method.name) != names.end()))
            methods.push_back(method);
    return methods;
}

// Levels of a candidate: files with their numbers of steps, or a run of its command for each
// number.
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
                    {output.steps, read_candidate(output.content, output.file, output.name,
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

int inspect(const InspectRequest& request, const Delivery& delivery) {
    std::exception_ptr not_trimmed;
    const LoadedScene loaded =
        load_scene(request.scene, request.settings, detail(request.keep_all), &not_trimmed);
    if (delivery.as_json) {
        json part = document_of(loaded, request.scene);
        add_inspection(part, loaded.scene, loaded.model);
        deliver(delivery, std::move(part), {});
    } else {
        print(inspection({.scene = loaded.scene,
                          .model = loaded.model,
                          .trim = loaded.trim,
                          .verbose = request.verbose}));
    }
    if (not_trimmed) std::rethrow_exception(not_trimmed);
    return fine;
}

int compare_legs(const CompareRequest& request, const Delivery& delivery) {
    RecursionRequest method = request.recursion;
    const bool named = !method.method.empty();
    if (!named) method.method = RecursionRequest{}.method;
    compare::Options options;
    options.recursion = recursion(method);
    options.every = request.every;
    options.threads = threads_of(request.running);
    options.progress = progress;
    const int steps = options.recursion.steps;
    const bool given = !request.within.empty();
    const auto tolerance =
        given ? compare::parse_tolerance(request.within, compare::ToleranceParts::with_forces)
              : compare::default_tolerance;
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const LoadedScene loaded =
        load_scene(request.scene, request.settings, detail(request.keep_all));
    const Model& model = loaded.model;
    check_every(model, steps, request.every);
    check_memory(model, {.steps = steps,
                         .every = request.every,
                         .legs = static_cast<int>(compare::legs.size()),
                         .written = delivery.wants_document()});
    compare::Comparison comparison = compare::compare(model, options, loaded.definitions);
    const bool conclusive = comparison.conclusive();
    std::optional<compare::FormulationStudy> study;
    if (request.formulations)
        study = compare::formulation_study(loaded.scene, steps, request.every, options.threads,
                                           progress);
    const auto defined = request.definitions ? compare::definition_rows(model, comparison)
                                             : std::vector<compare::DefinitionRow>{};
    progress("");
    delivery.print_text(tables(model, comparison));
    if (request.definitions) delivery.print_text(definition_text(defined));
    if (study) delivery.print_text(formulation_text(*study, comparison));
    auto judgement = compare::assess(model, comparison, tolerance, given);
    judgement.requested = given || named;
    if (delivery.wants_document()) {
        std::vector<NamedContent> files{
            {"curves.csv", curves_csv({{loaded.scene.name, &comparison}})},
            {"forces.csv", csv(force_rows(model, comparison))}};
        if (study) files.push_back({"formulations.csv", csv(formulation_rows(*study, comparison))});
        if (request.definitions) files.push_back({"definitions.csv", csv(defined)});
        SceneAnalyses found = analyses_of(loaded, request.scene);
        add_comparison(found, std::move(comparison));
        found.formulations = study;
        if (study)
            for (const auto& reason : study->inconclusive)
                found.reasons.push_back("formulations: " + reason);
        found.judgement = judgement;
        json part = scene_json(found);
        if (request.definitions) part["definitions"] = table_json(defined);
        deliver(delivery, std::move(part), std::move(files));
    }
    delivery.print_text(sentence(judgement) + "\n");
    return conclusive && (!study || study->conclusive()) ? fine : could_not_judge;
}

int converge(const ConvergeRequest& request, const Delivery& delivery) {
    const auto& names = request.methods;
    const auto& steps = request.steps;
    const auto& candidate = request.candidate;
    const int threads = threads_of(request.running);
    check(candidate, request.settings);
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Model& model = loaded.model;
    if (!steps.empty()) check_memory(model, {.steps = *std::ranges::max_element(steps)});
    compare::StudyOptions options;
    options.methods = methods_named(names);
    if (!steps.empty()) options.steps = steps;
    options.threads = threads;
    options.progress = compare::part(progress, 0, 0.4);
    std::optional<compare::Study> of_candidate;
    if (candidate.wanted())
        of_candidate = study_of(candidate, request.scene, loaded, options.steps);
    compare::Study study;
    std::vector<compare::BranchAttribution> attribution;
    if (!options.methods.empty()) {
        study = compare::study(model, options);
        attribution = compare::attribute_gap(model, threads, compare::part(progress, 0.4, 0.7));
    }
    std::vector<compare::BranchOrders> orders;
    if (names.front() == "all" || std::ranges::find(names, "series") != names.end())
        orders = compare::order_study(
            model, {.threads = threads, .progress = compare::part(progress, 0.7, 1)});
    progress("");
    if (!options.methods.empty()) delivery.print_text(study_text(model, study, attribution));
    delivery.print_text(order_text(order_rows(orders)));
    if (of_candidate)
        delivery.print_text("\nthe candidate: " + study_text(model, *of_candidate, {}));
    const bool conclusive = (!of_candidate || of_candidate->conclusive()) &&
                            (options.methods.empty() || study.conclusive()) &&
                            (orders.empty() || compare::conclusive(orders));
    if (delivery.wants_document()) {
        json part = document_of(loaded, request.scene);
        std::vector<NamedContent> files;
        if (!options.methods.empty()) {
            part["convergence"] = study_json(study, attribution);
            files.push_back({"convergence.csv", csv(study_rows(study))});
            files.push_back({"step_errors.csv", csv(step_rows(study))});
            files.push_back({"attribution.csv", csv(gap_rows(study.channels, attribution))});
        }
        if (!orders.empty()) {
            part["orders"] = table_json(order_rows(orders));
            files.push_back({"orders.csv", csv(order_rows(orders))});
        }
        auto reasons = study.inconclusive;
        if (of_candidate) {
            part["candidate_convergence"] = study_json(*of_candidate, {});
            files.push_back({"candidate_convergence.csv", csv(study_rows(*of_candidate))});
            files.push_back({"candidate_step_errors.csv", csv(step_rows(*of_candidate))});
            std::ranges::copy(of_candidate->inconclusive, std::back_inserter(reasons));
        }
        if (!conclusive && reasons.empty())
            reasons.emplace_back("no order of the series gave a result");
        add_verdict(part, 0, reasons);
        deliver(delivery, std::move(part), std::move(files));
    }
    return conclusive ? fine : could_not_judge;
}

int trade(const TradeRequest& request, const Delivery& delivery) {
    const int threads = threads_of(request.running);
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Model& model = loaded.model;
    compare::TradeOptions options;
    options.tolerance =
        compare::parse_tolerance(request.tolerance, compare::ToleranceParts::with_shares);
    options.threads = threads;
    options.progress = progress;
    const compare::Trade trade = compare::trade(model, options);
    progress("");
    delivery.print_text(trade_text(model, trade));
    if (delivery.wants_document()) {
        json part = document_of(loaded, request.scene);
        part["trade"] = trade_json(trade);
        add_verdict(part, trade.recommendation ? trade.recommendation->confirmed_numbers : 0,
                    trade.inconclusive);
        deliver(delivery, std::move(part), {{"trade.csv", csv(trade_rows(trade))}});
    }
    return trade.recommendation && trade.inconclusive.empty() ? fine : could_not_judge;
}

}  // namespace

const Command inspect_command{
    Group::solve, "inspect",
    "Show the compiled scene: bodies, coordinates, constraints, idle modes",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<InspectRequest>();
        add_scene(command, *request);
        command.add_flag("--verbose", request->verbose,
                         "long lists whole, all numbers with their sides, and the size of the "
                         "matrix, its order and its fill-in");
        add_keep_all(command, request->keep_all);
        return [request](const std::string& line) {
            return inspect(*request, request->delivery(line));
        };
    }};

const Command compare_command{
    Group::compare, "compare", "Solve a scene with all three methods and show the deviations",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<CompareRequest>();
        std::vector<std::string> methods;
        for (const auto& method : recursive::methods) methods.emplace_back(method.name);
        add_scene_and_run(command, *request);
        add_keep_all(command, request->keep_all);
        command.add_flag("--formulations", request->formulations,
                         "add the spread of the outputs over the bushing formulations of tools");
        command.add_flag("--definitions", request->definitions,
                         "add the figures by other definitions, of standards and tools");
        command.add_option("--within", request->within,
                           "give a verdict by this accuracy: mm, deg, N, Nm, and % of the extent "
                           "of forces, moments and rates (with --method: 0.01mm,0.001deg,1%)");
        add_recursion(command, request->recursion);
        as_word(command.add_option(
                    "--method", request->recursion.method,
                    "give a verdict on this method: published (shown without a verdict by "
                    "default), closed, balanced, tangent, chord, midpoint, adaptive or series"),
                methods);
        add_every(command, request->every);
        add_output(command, request->folder, "folder for result.json and curves.csv");
        return [request](const std::string& line) {
            return compare_legs(*request, request->delivery(line));
        };
    }};

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
            ->check(CLI::Range(1, most_steps));
        add_output(command, request->folder,
                   "folder for result.json, convergence.csv, step_errors.csv and attribution.csv");
        add_candidate(command, request->candidate);
        return [request](const std::string& line) {
            return converge(*request, request->delivery(line));
        };
    }};

const Command trade_command{
    Group::compare, "trade",
    "Cost of accuracy: every method against both references, and a recommendation",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<TradeRequest>();
        add_scene_and_run(command, *request);
        command.add_option("--tolerance", request->tolerance,
                           "required accuracy (default: 0.01mm,0.001deg,1%)");
        add_output(command, request->folder, "folder for result.json, trade.csv and precision.csv");
        return
            [request](const std::string& line) { return trade(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
