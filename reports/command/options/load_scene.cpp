#include "reports/command/options/load_scene.hpp"

#include <fmt/format.h>

#include "models/reader/document/suggestions.hpp"
#include "models/reader/plausibility.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

LoadedScene load_scene(const std::string& file, const Settings& settings, Detail detail) {
    auto [scene, warnings] = reader::read_scene_with_warnings(file, settings);
    for (const auto& warning : warnings) print_error("{} (warning)\n", warning);
    const auto where = [&, &scene = scene] {
        return scene.trim && scene.trim->line > 0
                   ? fmt::format("{}:{}: trim", file, scene.trim->line)
                   : file + ": trim";
    };
    compare::Trimmed trimmed;
    try {
        trimmed = compare::trim(scene);
    } catch (const std::invalid_argument& error) {
        throw SceneError(fmt::format("{}: {}", where(), error.what()));
    }
    if (trimmed.record && !trimmed.record->reached())
        throw NotTrimmed(fmt::format("{}: {}", where(), trimmed.record->detail));
    Model model = compile(trimmed.scene, detail);
    return {std::move(trimmed.scene), std::move(model), std::move(trimmed.record),
            std::move(warnings)};
}

const Branch& branch_named(const Model& model, const std::string& name) {
    std::vector<std::string> names;
    for (const auto& branch : model.branches) {
        if (branch.name == name) return branch;
        names.push_back(branch.name);
    }
    throw std::invalid_argument(fmt::format("--branch: the scene has no branch {}{}",
                                            reader::quote(name),
                                            reader::did_you_mean(name, names, "branches")));
}

}  // namespace elastocheck::reports
