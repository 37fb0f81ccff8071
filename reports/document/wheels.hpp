// Wheels in result.json: static alignment, wheel loads, and what each branch does to the wheels.
#pragma once

#include <nlohmann/json.hpp>

#include "elastocheck/compare.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

// What the parameter of a branch moves: "heave" (all wheels alike), "roll" (two wheels opposed),
// "travel" (other travel of wheels), "steering", "lateral force", "longitudinal force", "moment" (on
// wheels), or "other".
const char* load_case(const Model& model, const Branch& branch);

// Outputs with the force or moment of the joints that the parameter moves: "rack.drive_force".
nlohmann::ordered_json efforts_json(const Branch& branch,
                                    const std::vector<compare::Channel>& channels);

// Vertical force of the ground on each wheel [N] at the points of the curve: jacks and loads, static
// ones included; by the wheel's name. null for a wheel on a tyre or under a follower load.
nlohmann::ordered_json wheel_loads_json(const Model& model, const Branch& branch,
                                        const std::vector<compare::Channel>& channels,
                                        const compare::Curve& curve);

// "wheels": names and sides, "vehicle", and "static": rows of compare::StaticRow, settled on the
// first branch that holds no wheel, else on the first.
nlohmann::ordered_json wheels_json(const Model& model, const compare::Comparison& comparison);

// "elements": the stops with their clearance, and the segments of beams with the beam's name.
nlohmann::ordered_json elements_json(const Model& model);

}  // namespace elastocheck::reports
