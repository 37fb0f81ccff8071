// Warnings about numbers that are valid and probably in another unit than the file declares.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/requested_definitions.hpp"

namespace elastocheck::reader {

// "file:line: field: what is implausible, and what may be meant", one for each cause:
//
//   size      the hardpoints extend over more than 20 m, or those of a scene with wheels over less
//             than 20 mm: a length in mm read as m, or the reverse
//   bushings  √(k_rot / k_trans), the largest rates of each kind, is a length: the radius at which
//             an element of stiffness k_trans would resist a rotation like that. For rubber
//             bushings it is some millimetres, of the order of their radius; below 0.4 mm the
//             rotational rates are probably in N·m where N·mm is declared or the default.
//   vehicle   a wheelbase or height of the centre of gravity that no car has
//   wheels    static loads that pull a wheel down, or press it up with less than 50 N or more than
//             100 kN; a contact patch above the wheel centre
//
// What needs a settled state is in compare/warnings/plausibility.hpp.
std::vector<std::string> implausible(const Cursor& scene, const Units& units, const Scene& read);

struct SceneAndWarnings {
    Scene scene;
    std::vector<std::string> warnings;
    std::vector<RequestedDefinition> definitions;
};
// of the scene's file; none if the scene is text
using Folder = std::optional<std::filesystem::path>;

// parse_scene() and read_scene() with the warnings.
SceneAndWarnings parse_scene_with_warnings(std::string_view text, const std::string& name,
                                           std::span<const Setting> settings, const Folder& folder);
SceneAndWarnings read_scene_with_warnings(const std::filesystem::path& file,
                                          std::span<const Setting> settings);

}  // namespace elastocheck::reader
