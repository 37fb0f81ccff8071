#include "reports/command/options/load_scene.hpp"

#include <fmt/format.h>

#include "models/reader/document/suggestions.hpp"
#include "reports/document/document.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

LoadedScene trimmed_and_compiled(reader::SceneAndWarnings read, const std::string& file,
                                 Detail detail) {
    auto& [scene, warnings] = read;
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

LoadedScene load_scene(const std::string& file, const Settings& settings, Detail detail) {
    auto read = reader::read_scene_with_warnings(file, settings);
    for (const auto& warning : read.warnings) print_error("{} (warning)\n", warning);
    return trimmed_and_compiled(std::move(read), file, detail);
}

nlohmann::ordered_json document_of(const LoadedScene& loaded, const std::string& file) {
    auto part = scene_document(loaded.scene, read_whole(file), loaded.model);
    if (loaded.trim) add_trim(part, *loaded.trim);
    if (!loaded.warnings.empty()) part["warnings"] = loaded.warnings;
    return part;
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
