// Numbers that apply to one side alone, in a scene with a mirror.
//
// A number of a mirrored part ("arm_left") is that of both sides. If one side has other numbers, the
// scene is read twice, once with the numbers of each side. The result is the first scene with its twins
// replaced by those of the second; shared parts are attached to the hardpoints of both.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "models/reader/definitions/mirror.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {

// The file with the numbers of each side.
struct Trees {
    Value written;                  // of the side that the file writes
    std::vector<Value> twins = {};  // of the twins, if their numbers differ: none or one
};

// Applies the section `one_side` of the tree, then the settings. `places`, if not null, receives the
// values that each setting replaced, one or two. Throws SceneError as apply(), and for one side of a
// number that both sides share or of a scene without a mirror.
Trees with_settings(const Value& tree, std::span<const Setting> settings, const std::string& file,
                    std::vector<std::vector<Value*>>* places = nullptr);

// Replaces the twins in `to` by those of `from`. Throws SceneError where the two differ in their parts.
void take_twins(const Mirror& mirror, const Scene& from, Scene& to);

// The mirror if the number of this path is that of both sides; else null.
const Mirror* mirror_of_number(const Mirror* mirror, const std::string& path);

}  // namespace elastocheck::reader
