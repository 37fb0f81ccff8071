// Settings: values of the tree replaced by name, before anything is read from it.
#pragma once

#include <span>
#include <string>

#include "models/reader/scene_file.hpp"
#include "models/reader/yaml.hpp"

namespace elastocheck::reader {

// Throws SceneError: a path that leads nowhere or not to one value, a path set twice, a value that is no line of
// plain text.
void apply(std::span<const Setting> settings, Value& tree, const std::string& file);

}  // namespace elastocheck::reader
