// Scenes as YAML files written by hand. The format is documented in models/scenes/README.md.
#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "models/scene.hpp"

namespace elastocheck {

// Bad input. what() reads "file:line: field: what is wrong, what is allowed".
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// One value of the file, replaced before it is read: what refers to a hardpoint moves with it, once.
struct Setting {
    // The keys on the way to the value, "springs.coil.rate"; in a list of three .x, .y or .z, in any other its place
    // from 1, "bushings.mount.stiffness.2.6". Only what the file has can be set.
    std::string path;
    std::string value;  // as it would stand in the file, in its units
};

// "points.tie_rod_inner.z=-0.055". Throws SceneError where there is no path or no value.
Setting parse_setting(std::string_view text);

// The shortest text that reads back as the same number.
Setting setting(std::string path, double value);

// Every body starts with its axes parallel to ground; every length, angle and rate comes out in m, rad, N.
// Scene::numbers says which numbers the file had, the settings made. Throws SceneError.
Scene read_scene(const std::filesystem::path& file, std::span<const Setting> settings = {});

// The same from text; `name` stands for the file in messages.
Scene parse_scene(std::string_view text, const std::string& name, std::span<const Setting> settings = {});

}  // namespace elastocheck
