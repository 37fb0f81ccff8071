// Readers of the sections of a scene file, one function each.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastocheck/model.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/elements/driven.hpp"

namespace elastocheck::reader {

Joint read_joint(const std::string& name, const Cursor& field, const Definitions& defs);
bool is_held(const Cursor& joint);  // `held: true`
// A spring and its stops. Pre: the wheels are read.
std::vector<Elastic> read_spring(const std::string& name, const Cursor& field,
                                 const Definitions& defs, const std::vector<Wheel>& wheels);
// A spring given at a wheel, or at two (an anti-roll bar); none for a spring between two points. Before
// it is read, add_bodies_of_bars() adds the bodies of bars to `defs`; add_joints_of_bars() adds their
// joints after all others.
std::optional<Elastic> read_at_wheel(const std::string& name, const Cursor& field,
                                     const Definitions& defs, const std::vector<Wheel>& wheels);
void add_bodies_of_bars(const Cursor& scene, const std::vector<Wheel>& wheels, Definitions& defs);
void add_joints_of_bars(const Cursor& scene, const Definitions& defs, Scene& result);
std::vector<Elastic> read_stops(const std::string& name, const Cursor& field,
                                const Definitions& defs);
Elastic read_torsion_spring(const std::string& name, const Cursor& field, const Definitions& defs);
Elastic read_bushing(const std::string& name, const Cursor& field, const Definitions& defs);
// Loads have numbers as written, static loads are in SI. A force on a carrier at the patch of its
// rolling wheel acts on that wheel. Pre: the wheels are read.
Load read_load(const std::string& name, const Cursor& field, const Definitions& defs,
               const std::vector<Wheel>& wheels);
Load read_static_load(const std::string& name, const Cursor& field, const Definitions& defs,
                      const std::vector<Wheel>& wheels);
// The body of a rolling wheel is added to `defs`.
Wheel read_wheel(const std::string& name, const Cursor& field, Definitions& defs);
void add_rolling_joints(const Cursor& scene, Scene& result);
Probe read_probe(const std::string& name, const Cursor& field, const Definitions& defs);
Damper read_damper(const std::string& name, const Cursor& field, const Definitions& defs);
Vehicle read_vehicle(const Cursor& field, const Definitions& defs);

// `gravity`, and the masses of bodies: one static load "gravity.BODY" for each.
void read_gravity(const Cursor& scene, const Definitions& defs, Scene& result);

// `tyres`: elements between ground and wheel, and the drivers of their road. Pre: the wheels are read.
void read_tyres(const Cursor& scene, const Definitions& defs, Drivables& drivables, Scene& result);

// `trim`. Pre: adjustable quantities, wheels and probes are read. Its loads are added to the static loads.
void read_trim(const Cursor& scene, const Units& units, const std::map<std::string, Load>& loads,
               Drivables& drivables, Scene& result);

// Error of a branch that drives a length to zero. A study records it as the outcome of a variant.
struct LengthVanishes : SceneError {
    using SceneError::SceneError;
};

// Adds the branches and the joints that their drivers need, and lists unused loads in Scene::omitted.
// Returns the compiled scene, without that list. Pre: all other parts are read.
Model read_branches(const Cursor& file, const Units& units,
                    const std::map<std::string, Load>& loads, Drivables& drivables, Scene& scene);

}  // namespace elastocheck::reader
