#include "reports/command/certify_command.hpp"

#include <algorithm>
#include <memory>

#include "compare/certify.hpp"
#include "recursive/diagnosis.hpp"
#include "reports/command/arguments.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/limits.hpp"
#include "reports/command/load_scene.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/certify_tables.hpp"

namespace elastocheck::reports {
namespace {

struct Request {
    std::string scene, tolerance = compare::claimed_accuracy, folder;
    std::vector<std::string> solvers;
    int points = compare::CertifyOptions{}.points;
    Settings settings;
    bool as_json = false;
};

compare::Gait gait_of(const std::string& solver) {
    for (const auto leg : {compare::Leg::equilibrium, compare::Leg::energy, compare::Leg::series})
        if (solver == name(leg)) return {.leg = leg};
    compare::Gait gait;
    gait.recursion.method = *recursive::find_method(solver);
    return gait;
}

int certify(const Request& request, const std::string& command) {
    compare::CertifyOptions options;
    options.tolerance = compare::claim(request.tolerance);  // what is wrong with it is said before the work
    if (!request.folder.empty()) Staging::check(request.folder);
    for (const auto& solver : request.solvers) options.solvers.push_back(gait_of(solver));
    options.points = request.points;
    options.progress = progress;
    const Delivery delivery{.folder = request.folder, .as_json = request.as_json, .command = command};
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const compare::CertifyStudy study = compare::certify(loaded.model, options);
    progress("");
    delivery.say(certify_text(study));
    const bool conclusive = study.conclusive();
    if (delivery.wants_document()) {
        nlohmann::ordered_json part = scene_document(loaded.scene, read_whole(request.scene), loaded.model,
                                                     recursive::diagnose(loaded.model));
        if (loaded.trim) add_trim(part, *loaded.trim);
        part["certify"] = certify_json(study);
        add_verdict(part, study.points(),
                    conclusive ? std::vector<std::string>{} : std::vector<std::string>{sentence(study)});
        deliver(delivery, std::move(part), {{"certify.csv", csv(certify_table(study))}});
    }
    delivery.say(sentence(study) + "\n");
    return study.excluded() ? limit_broken : conclusive ? fine : could_not_judge;
}

}  // namespace

CertifyCommand add_certify(CLI::App& app) {
    auto* command = app.add_subcommand(
        "certify", "Prove by interval arithmetic that what a solver found are equilibria, and alone");
    const auto request = std::make_shared<Request>();
    command->add_option("SCENE", request->scene, "scene file (YAML)")->required()->check(a_file("*.yaml"));
    add_settings(*command, request->settings);
    std::vector<std::string> known{"equilibrium", "energy"};
    for (const auto& method : recursive::methods) known.emplace_back(method.name);
    command
        ->add_option(
            "--method", request->solvers,
            "whose points: equilibrium, energy, series (default: these three), or a method of the recursion")
        ->delimiter(',')
        ->check(one_of(known));
    command->add_option("--tolerance", request->tolerance,
                        "accuracy that is to be proved (default: 1e-6mm,1e-6deg)");
    command
        ->add_option("--points", request->points, "of each way of a branch, besides its start (default: 20)")
        ->check(CLI::Range(1, most_steps));
    command->add_option("-o,--output", request->folder, "folder for result.json and certify.csv")
        ->check(a_folder());
    add_json(*command, request->as_json);
    return {command, [request](const std::string& line) { return certify(*request, line); }};
}

}  // namespace elastocheck::reports
