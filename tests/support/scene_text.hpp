// Scenes that stand in files beside the tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::support {

// tests/NAME.yaml, without and with settings.
inline std::filesystem::path scene_path(const std::string& name) {
    return std::filesystem::path(ELASTOCHECK_SCENES) / "../../tests" / (name + ".yaml");
}
inline std::string scene_text(const std::string& name) { return text_of(scene_path(name)); }
inline Scene scene_of(const std::string& name, const std::vector<Setting>& settings = {}) {
    return read_scene(scene_path(name), settings);
}

}  // namespace elastocheck::support
