#include "reports/command/stress_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "compare/stress.hpp"
#include "compare/trim.hpp"
#include "models/reader/scene_file.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/load_scene.hpp"
#include "reports/command/new_command.hpp"
#include "reports/document/document.hpp"
#include "reports/extremes/extremes.hpp"
#include "reports/files/folder.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/stress_tables.hpp"
#include "reports/text/terminal.hpp"

namespace elastocheck::reports {
namespace {

void add(std::vector<compare::Trial>& trials, std::vector<compare::Trial> more) {
    std::ranges::move(more, std::back_inserter(trials));
}

// The scenes of models/scenes, and those of models/extremes.
std::vector<compare::Trial> built_in(const std::function<void(std::string_view)>& progress) {
    std::vector<compare::Trial> trials;
    for (const auto& name : templates()) {
        progress(fmt::format("{}: trim", name));
        const compare::Trimmed trimmed = compare::trim(parse_scene(template_text(name), name));
        add(trials, compare::trials(name, trimmed.scene, compare::sweeps()));
    }
    add(trials, extremes());
    return trials;
}

}  // namespace

CLI::App* add_stress_command(CLI::App& app, StressRequest& request) {
    auto* command = app.add_subcommand(
        "stress", "Scenes at their extremes, by every leg and method: right, an honest outcome, or wrong");
    command
        ->add_option("SCENE", request.scenes,
                     "scene files (YAML); none: all built-in ones, and some that are extreme by their making")
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
        add(trials, compare::trials(std::filesystem::path(file).stem().string(),
                                    load_scene(file, request.settings).scene, compare::sweeps()));
    }
    if (request.scenes.empty()) {
        if (!request.settings.empty()) throw std::invalid_argument("stress: --set changes a scene; give one");
        trials = built_in(progress);
    }
    const compare::Survival survival = compare::stress(trials, {.progress = progress});
    progress("");
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    delivery.say(stress_text(survival) +
                 fmt::format("{:.0f} s, {:.0f} s of processor time; the dearest trial: {}, {}, {:.0f} s\n",
                             elapsed.count(), survival.seconds, survival.dearest.scene,
                             survival.dearest.variant, survival.dearest.seconds));
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
