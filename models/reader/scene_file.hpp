// Scenes as YAML files written by hand. The format is documented in models/scenes/README.md.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "models/scene.hpp"

namespace elastocheck {

// Bad input. what() reads "file:line: field: what is wrong, what is allowed".
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Every body starts with its axes parallel to ground; every length, angle and rate comes out in m, rad, N.
// Throws SceneError.
Scene read_scene(const std::filesystem::path& file);

// The same from text; `name` stands for the file in messages.
Scene parse_scene(std::string_view text, const std::string& name);

}  // namespace elastocheck
