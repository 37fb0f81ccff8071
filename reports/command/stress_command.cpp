// `elastocheck stress`: runs every leg and method on extreme scenes and prints the survival map.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "compare/stress/stress.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/command.hpp"
#include "reports/command/templates.hpp"
#include "reports/extremes/extremes.hpp"
#include "reports/files/folder.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

struct StressRequest : Request {
    std::vector<std::string> scenes;  // files; none: the built-in ones
};

void add(std::vector<compare::Trial>& trials, std::vector<compare::Trial> more) {
    std::ranges::move(more, std::back_inserter(trials));
}

// The scenes of models/scenes, and those of models/extremes.
std::vector<compare::Trial> built_in() {
    std::vector<compare::Trial> trials;
    for (const auto& name : templates()) {
        progress(fmt::format("{}: trim", name));
        const compare::Trimmed trimmed = compare::trim(parse_scene(template_text(name), name));
        add(trials, compare::trials(name, trimmed.scene));
    }
    add(trials, extremes());
    return trials;
}

// Exit code: 0 no wrong result, 1 a wrong result, 3 nothing could be judged.
int stress(const StressRequest& request, const Delivery& delivery) {
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    std::vector<compare::Trial> trials;
    for (const auto& file : request.scenes) {
        progress(fmt::format("{}: trim", file));
        add(trials, compare::trials(std::filesystem::path(file).stem().string(),
                                    load_scene(file, request.settings).scene));
    }
    if (request.scenes.empty()) {
        if (!request.settings.empty())
            throw std::invalid_argument("stress: --set changes a scene; give one");
        trials = built_in();
    }
    const compare::Survival survival =
        compare::stress(trials, threads_of(request.running), progress);
    progress("");
    return deliver_result(
        delivery, {{"name", request.scenes.empty() ? "all built-in scenes" : "the given scenes"}},
        result_of(survival));
}

}  // namespace

const Command stress_command{
    Group::prove, "stress",
    "Stress test: solve transformed and extreme scenes by every leg and method",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<StressRequest>();
        as_file(command.add_option(
            "SCENE", request->scenes,
            "scene files (YAML); default: all built-in scenes and those with extreme geometry"));
        add_set(command, request->settings);
        add_output(command, request->folder,
                   "folder for result.json, map.csv, cells.csv and counts.csv");
        add_json(command, request->as_json);
        add_running(command, request->running);
        return [request](const std::string& line) {
            return stress(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
