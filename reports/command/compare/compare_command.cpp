// `elastocheck compare`: all three legs on one scene, their deviations, and a verdict on a method.
#include <memory>

#include "compare/comparison/compare.hpp"
#include "compare/tables/compare_result.hpp"
#include "elastocheck/recursive.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/recursion_options.hpp"
#include "reports/command/program/command.hpp"
#include "reports/document/curves.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/judgement.hpp"

namespace elastocheck::reports {
namespace {

struct CompareRequest : SceneRequest {
    RecursionRequest recursion{.method = ""};  // without a method: published, and no verdict
    int every = 1;                             // compares every `every`-th step
    bool keep_all = false;
    std::string within;         // tolerance of the verdict; empty: the default
    bool formulations = false;  // adds the spread over bushing formulations
    bool definitions = false;   // adds the figures by other definitions
};

// Exit code 3 where the legs cannot be compared; a deviation above the tolerance is no failure.
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
    const LoadedScene loaded = load_scene(request.scene, request.settings,
                                          request.keep_all ? Detail::everything : Detail::required);
    const Model& model = loaded.model;
    check_every(model, steps, request.every);
    check_memory(model, {.steps = steps,
                         .every = request.every,
                         .legs = static_cast<int>(compare::legs.size()),
                         .written = delivery.wants_document()});
    compare::Comparison comparison = compare::compare(model, options, loaded.definitions);
    auto judgement = compare::assess(model, comparison, tolerance, given);
    judgement.requested = given || named;
    compare::Result result = result_of(model, comparison, judgement);
    result.verdict.sentence = sentence(judgement);
    if (request.definitions) add_definitions(result, model, comparison);
    if (request.formulations)
        add_formulations(result,
                         compare::formulation_study(loaded.scene, steps, request.every,
                                                    options.threads, progress),
                         comparison);
    progress("");
    std::vector<NamedContent> files;
    nlohmann::ordered_json scene;
    if (delivery.wants_document()) {
        files = {{"curves.csv", curves_csv({{loaded.scene.name, &comparison}})}};
        SceneAnalyses found = analyses_of(loaded, request.scene);
        add_comparison(found, std::move(comparison));
        add_tables(result, found);
        scene = compared_json(found);
    }
    deliver_result(delivery, std::move(scene), result, std::move(files));
    return result.verdict.grade == compare::Grade::not_judged ? could_not_judge : fine;
}

}  // namespace

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
        command.add_option(
            "--within", request->within,
            "give a verdict by this accuracy: mm, deg, N, Nm, and % of the extent "
            "of forces, moments and rates (with --method: 0.01mm,0.001deg,1%); the exit "
            "code of a failed verdict is 0, unlike that of judge");
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

}  // namespace elastocheck::reports
