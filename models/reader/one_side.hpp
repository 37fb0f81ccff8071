// Numbers of one side alone, in a scene with a mirror.
//
// The mirror makes the twins of what is written, so that a number of "arm_left" is one of both sides.
// With other numbers on one side the scene is read twice, with those of the written side and with
// those of its twins: the twins are those of the second scene, all else is of the first, where what
// both sides share is attached to the hardpoints of both.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "models/reader/definitions/mirror.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {

// The trees of both sides: one where they are the same.
struct Trees {
    Value written;
    std::vector<Value> twins = {};  // none or one
    const Value& of_twins() const { return twins.empty() ? written : twins.front(); }
};

// Applies settings, after those of the section `one_side` of the tree. Throws SceneError as apply(),
// and for one side of a number that both sides share or of a scene without a mirror. The places of
// the settings of a number are added to `places`, if not null.
Trees with_settings(const Value& tree, std::span<const Setting> settings, const std::string& file,
                    std::vector<std::vector<Value*>>* places = nullptr);

// Moves the twins of `from` into `to`. Throws SceneError where the two differ in their parts.
void take_twins(const Mirror& mirror, const Scene& from, Scene& to);

// The words of the mirror where the number makes both sides.
const Mirror* sides_of(const Mirror* mirror, const std::string& path);

}  // namespace elastocheck::reader
