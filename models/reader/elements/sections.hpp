// Readers of the sections of a scene file, one function each.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"
#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/elements/driven.hpp"

namespace elastocheck::reader {

Joint read_joint(const std::string& name, const Cursor& field, const Definitions& defs);
bool is_held(const Cursor& joint);  // `held: true`
// And its stops. Pre: the wheels are read.
std::vector<Elastic> read_spring(const std::string& name, const Cursor& field,
                                 const Definitions& defs, const std::vector<Wheel>& wheels);
// A spring that is given at a wheel or, a bar, at two; nothing for one between two points. The body of
// a bar is added to `defs` before it is read, its joints when all others are.
std::optional<Elastic> read_at_wheel(const std::string& name, const Cursor& field,
                                     const Definitions& defs, const std::vector<Wheel>& wheels);
void add_bodies_of_bars(const Cursor& scene, const std::vector<Wheel>& wheels, Definitions& defs);
void add_joints_of_bars(const Cursor& scene, const Definitions& defs, Scene& result);
std::vector<Elastic> read_stops(const std::string& name, const Cursor& field,
                                const Definitions& defs);
Elastic read_torsion_spring(const std::string& name, const Cursor& field, const Definitions& defs);
Elastic read_bushing(const std::string& name, const Cursor& field, const Definitions& defs);
// Loads with numbers as written, static loads in SI. Pre: the wheels are read; a force at the patch
// of one that rolls acts there.
Load read_load(const std::string& name, const Cursor& field, const Definitions& defs,
               const std::vector<Wheel>& wheels);
Load read_static_load(const std::string& name, const Cursor& field, const Definitions& defs,
                      const std::vector<Wheel>& wheels);
// A wheel that rolls becomes a body of its own, added to `defs`.
Wheel read_wheel(const std::string& name, const Cursor& field, Definitions& defs);
// The joints of the wheels that roll.
void add_rolling_joints(const Cursor& scene, Scene& result);
Probe read_probe(const std::string& name, const Cursor& field, const Definitions& defs);
Damper read_damper(const std::string& name, const Cursor& field, const Definitions& defs);
Vehicle read_vehicle(const Cursor& field, const Definitions& defs);

// `gravity`, and the masses of bodies: one static load "gravity.BODY" for each.
void read_gravity(const Cursor& scene, const Definitions& defs, Scene& result);

// `tyres`: elements between ground and wheel, and the drivers of their road. Pre: the
// wheels are read.
void read_tyres(const Cursor& scene, const Definitions& defs, Drivables& drivables, Scene& result);

// `trim`. Pre: adjustable quantities, wheels and probes are read. Its loads are added to
// the static loads.
void read_trim(const Cursor& scene, const Units& units, const std::map<std::string, Load>& loads,
               Drivables& drivables, Scene& result);

// Reads the last section: all other parts must be read. Adds the branches, the joints that their
// drives need, and lists unused loads in omitted. Returns the scene compiled, without that list.
Model read_branches(const Cursor& file, const Units& units,
                    const std::map<std::string, Load>& loads, Drivables& drivables, Scene& scene);

}  // namespace elastocheck::reader
