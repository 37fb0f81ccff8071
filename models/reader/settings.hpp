// Applies settings: replaces values of the tree by path before reading.
#pragma once

#include <span>
#include <string>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {

// Throws SceneError for a path that does not lead to one value, a path set twice, or a value that
// is not one line of plain text. Returns the value that is replaced.
Value& apply(const Setting& setting, Value& tree, const std::string& file);
void apply(std::span<const Setting> settings, Value& tree, const std::string& file);

}  // namespace elastocheck::reader
