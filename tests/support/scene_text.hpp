// Scenes in files beside the tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/mistakes.hpp"

namespace elastocheck::support {

// tests/NAME.yaml, without and with settings.
inline std::filesystem::path scene_path(const std::string& name) {
    return std::filesystem::path(ELASTOCHECK_SCENES) / "../../tests" / (name + ".yaml");
}
inline std::string scene_text(const std::string& name) { return text_of(scene_path(name)); }
// The text of the scene with each $WORD replaced: {"A", "[0, 0, 1]"} for $A.
using Places = std::vector<std::pair<std::string, std::string>>;
inline std::string filled_text(const std::string& name, const Places& places) {
    std::string text = scene_text(name);
    for (const auto& [word, by] : places) text = replaced(text, "$" + word, by);
    return text;
}
inline Scene filled_scene(const std::string& name, const Places& places) {
    return parse_scene(filled_text(name, places), name);
}
inline Scene scene_of(const std::string& name, const std::vector<Setting>& settings = {}) {
    return read_scene(scene_path(name), settings);
}

}  // namespace elastocheck::support
