// The sections of a scene file, each read by one function.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/reader/cursor.hpp"
#include "models/reader/definitions.hpp"
#include "models/scene.hpp"

namespace elastocheck::reader {

Joint read_joint(const std::string& name, const Cursor& at, const Definitions& defs);
Elastic read_spring(const std::string& name, const Cursor& at, const Definitions& defs);
Elastic read_bushing(const std::string& name, const Cursor& at, const Definitions& defs);

// Loads and branches together: what a moment in `loads` means depends on the branch that uses it.
void read_loads(const Cursor& scene, const Definitions& defs, std::vector<Load>& static_loads,
                std::vector<Branch>& branches);

Wheel read_wheel(const Cursor& at, const Definitions& defs);
Probe read_probe(const std::string& name, const Cursor& at, const Definitions& defs);

}  // namespace elastocheck::reader
