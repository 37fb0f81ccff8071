#include "reports/command/options/load_scene.hpp"

#include <fmt/format.h>

namespace elastocheck::reports {

LoadedScene load_scene(const std::string& file, const Settings& settings, Detail detail) {
    const Scene scene = read_scene(file, settings);
    const auto where = [&] {
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
    return {std::move(trimmed.scene), std::move(model), std::move(trimmed.record)};
}

}  // namespace elastocheck::reports
