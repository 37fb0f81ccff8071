// Applies settings: replaces values of the tree by path before reading.
#pragma once

#include <string>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {

enum class Repeated { rejected, allowed };

// Throws SceneError for a path that does not lead to one value, a path set twice unless allowed, or a
// value that is not one line of plain text. Returns the value that is replaced.
Value& apply(const Setting& setting, Value& tree, const std::string& file,
             Repeated repeated = Repeated::rejected);

}  // namespace elastocheck::reader
