#include "reports/command/stress_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "compare/stress.hpp"
#include "models/reader/scene_file.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/load_scene.hpp"
#include "reports/command/new_command.hpp"
#include "reports/document/document.hpp"
#include "reports/files/folder.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/stress_tables.hpp"
#include "reports/text/terminal.hpp"

namespace elastocheck::reports {
namespace {

void add(std::vector<compare::Trial>& trials, const std::string& name, const LoadedScene& loaded) {
    const auto all = compare::trials(name, loaded.scene, compare::sweeps());
    trials.insert(trials.end(), all.begin(), all.end());
}

}  // namespace

CLI::App* add_stress_command(CLI::App& app, StressRequest& request) {
    auto* command = app.add_subcommand(
        "stress", "Scenes at their extremes, by every leg and method: right, an honest outcome, or wrong");
    command->add_option("SCENE", request.scenes, "scene files (YAML); none: the built-in ones")
        ->check(a_file("*.yaml"));
    add_settings(*command, request.settings);
    return command;
}

int stress(const StressRequest& request, const Delivery& delivery,
           const std::function<void(std::string_view)>& progress) {
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const auto start = std::chrono::steady_clock::now();
    std::vector<compare::Trial> trials;
    for (const auto& file : request.scenes) {
        progress(fmt::format("{}: trim", file));
        add(trials, std::filesystem::path(file).stem().string(), load_scene(file, request.settings));
    }
    const compare::Survival survival = compare::stress(trials, {.progress = progress});
    progress("");
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    delivery.say(stress_text(survival) + fmt::format("{:.0f} s\n", elapsed.count()));
    if (delivery.wants_document()) {
        nlohmann::ordered_json document = {{"schema", stress_schema},
                                           {"reproduce", delivery.command},
                                           {"provenance", provenance_json(provenance())}};
        document.update(stress_json(survival));
        if (!delivery.folder.empty()) {
            write_folder(delivery.folder, {{"stress.json", document.dump(1) + "\n"},
                                           {"cells.csv", csv(cell_table(survival))}});
            const std::string written =
                fmt::format("Written: {0}/stress.json, {0}/cells.csv\n", delivery.folder);
            delivery.as_json ? complain(written) : print(written);
        }
        if (delivery.as_json) print_document(document);
    }
    return survival.count(compare::Verdict::wrong) > 0 ? limit_broken
           : survival.judged() == 0                    ? could_not_judge
                                                       : fine;
}

}  // namespace elastocheck::reports
