// Reads scenes from YAML files. The format is documented in models/scenes/README.md.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "elastocheck/scene.hpp"

namespace elastocheck {

// Error in the input. what() reads "file:line: field: what is wrong, what is allowed".
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Replacement of one value of the file before reading: all references to a hardpoint then use it.
struct Setting {
    // Path of keys to the value, "springs.coil.rate"; in a list of three .x, .y or .z, in any other
    // list its position from 1, "bushings.mount.stiffness.2.6". Only existing values can be set. Under
    // a mirror "points.arm_left.z" sets both sides, "points.arm_left.z@left" or "...@right" one of them,
    // both as the file writes it for the left one.
    std::string path;
    std::string value;  // as written in the file, in its units
};

// Parses "points.tie_rod_inner.z=-0.055". Throws SceneError if path or value is missing.
Setting parse_setting(std::string_view text);

// The number of this path, "PATH" or "PATH@left"; none if the scene has no such number.
std::optional<Number> find_number(const Scene& scene, std::string_view path);

// A setting with the shortest text that reads back as the same number.
Setting setting(std::string path, double value);

// Reads a scene. Every body starts with its axes parallel to ground; all values are converted to m,
// rad, N. Scene::numbers lists the numbers of the file after the settings. Throws SceneError.
Scene read_scene(const std::filesystem::path& file, std::span<const Setting> settings = {});

// The same from text; `name` replaces the file name in messages.
Scene parse_scene(std::string_view text, const std::string& name,
                  std::span<const Setting> settings = {});

// The text of a scene file with these values replaced where they are written, each old value in a comment at
// the end of its line; numbers of one side alone become entries of the section `one_side`. All else is
// unchanged. Throws SceneError for text that is not YAML, settings that read_scene() rejects, and values
// that are not written as one word.
std::string rewrite_scene(std::string_view text, const std::string& name,
                          std::span<const Setting> settings);

}  // namespace elastocheck
