// A scene as every command takes it: read, trimmed, compiled.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "compare/trim.hpp"
#include "models/compile.hpp"
#include "models/model.hpp"
#include "models/scene.hpp"
#include "reports/command/arguments.hpp"

namespace elastocheck::reports {

// A trim that was asked for and not reached, or that the second reference does not confirm: nothing is judged of a scene
// that is not where it should be. what() reads "FILE:LINE: trim: ...".
struct NotTrimmed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct LoadedScene {
    Scene scene;  // trimmed
    Model model;
    std::optional<compare::TrimRecord> trim;
};

// Throws SceneError, also for a trim that is no well-posed question; NotTrimmed.
LoadedScene load_scene(const std::string& file, const Settings& settings, Detail detail = Detail::required);

}  // namespace elastocheck::reports
