// The sections of a scene file, each read by one function.
#pragma once

#include <map>
#include <string>

#include "models/reader/cursor.hpp"
#include "models/reader/definitions.hpp"
#include "models/reader/driven.hpp"
#include "models/scene.hpp"

namespace elastocheck::reader {

Joint read_joint(const std::string& name, const Cursor& at, const Definitions& defs);
bool is_held(const Cursor& joint);  // `held: true`
Elastic read_spring(const std::string& name, const Cursor& at, const Definitions& defs);
Elastic read_bushing(const std::string& name, const Cursor& at, const Definitions& defs);
Load read_load(const std::string& name, const Cursor& at, const Definitions& defs);  // numbers as written
Load read_static_load(const std::string& name, const Cursor& at, const Definitions& defs);  // SI
Wheel read_wheel(const Cursor& at, const Definitions& defs);
Probe read_probe(const std::string& name, const Cursor& at, const Definitions& defs);

// The last section: all else that the scene has must be there. Adds the branches, the joints that their drives
// need, and the loads that no branch uses to what is left out.
void read_branches(const Cursor& file, const Units& units, const std::map<std::string, Load>& loads,
                   Drivables& drivables, Scene& scene);

}  // namespace elastocheck::reader
