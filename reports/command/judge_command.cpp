// `elastocheck judge`: judges another solver's results by the references.

#include <memory>

#include "compare/comparison/compare.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/candidate_options.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/program/command.hpp"
#include "reports/document/curves.hpp"
#include "reports/document/document.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/candidate_tables.hpp"

namespace elastocheck::reports {

namespace {

struct JudgeRequest : SceneRequest {
    CandidateRequest candidate;
    int steps = 0;  // of the candidate's command and of the references; 0: as in the scene
    std::string tolerance = "0.01mm,0.001deg,1%";
};

// Exit code: 0 all pass, 1 one fails, 3 none fails and one could not be judged.
int judge(const JudgeRequest& request, const Delivery& delivery) {
    if (!request.candidate.wanted())
        throw std::invalid_argument(
            "judge: no candidate; give --candidate FILE or --candidate-command");
    const auto tolerance =
        compare::parse_tolerance(request.tolerance, compare::ToleranceParts::with_forces);
    const bool given = request.tolerance != JudgeRequest{}.tolerance;
    check(request.candidate, request.settings);
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Model& model = loaded.model;
    check_memory(model, {.steps = request.steps,
                         .legs = static_cast<int>(compare::legs.size()),
                         .written = delivery.wants_document()});
    const int steps = request.steps > 0 ? request.steps : steps_of(model);
    const auto outputs = outputs_of(request.candidate, request.scene, {steps});
    check_tables(outputs, request.candidate, loaded);
    compare::Options options;
    options.times = false;
    options.recursion.steps = request.steps;
    options.progress = progress;
    compare::Comparison comparison = compare::compare(model, options, loaded.definitions);
    progress("");
    int code = fine;
    std::vector<JudgedCandidate> candidates;
    std::vector<std::string> reasons;
    int compared = 0;
    for (const auto& output : outputs) {
        auto judgement = judged(output, request.candidate, loaded, comparison, tolerance, given);
        const compare::Result result = result_of(judgement, comparison);
        delivery.print_text(text(result));
        compared += judgement.compared;
        for (const auto& reason : judgement.reasons)
            reasons.push_back(judgement.name + ": " + reason);
        if (judgement.verdict == compare::Grade::fail) code = limit_broken;
        if (judgement.verdict == compare::Grade::not_judged && code == fine) code = could_not_judge;
        candidates.push_back({std::move(judgement), result.verdict.sentence});
    }
    if (delivery.wants_document()) {
        std::string curves = curves_csv({{loaded.scene.name, &comparison}});
        SceneAnalyses found = analyses_of(loaded, request.scene);
        add_comparison(found, std::move(comparison));
        found.judgement = compare::assess(model, found.comparison, tolerance, given);
        found.judgement->requested = false;
        found.candidates = std::move(candidates);
        auto part = scene_json(found);
        add_verdict(part, compared, reasons);
        deliver(delivery, std::move(part), {{"curves.csv", std::move(curves)}});
    }
    return code;
}

}  // namespace

const Command judge_command{
    Group::compare, "judge", "Judge the results of another solver by the references: pass or fail",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<JudgeRequest>();
        add_scene(command, *request);
        add_candidate(command, request->candidate);
        command
            .add_option("--steps", request->steps,
                        "steps per branch passed to the command (default: of the scene)")
            ->check(CLI::Range(1, max_steps));
        command.add_option("--tolerance", request->tolerance,
                           "required accuracy: mm, deg, N, Nm, and % of the extent of forces, "
                           "moments and rates (default: 0.01mm,0.001deg,1%)");
        add_output(command, request->folder, "folder for result.json and curves.csv");
        return
            [request](const std::string& line) { return judge(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
