// Wheels in result.json: static alignment and wheel loads, and what each branch does to the wheels.
#pragma once

#include <nlohmann/json.hpp>

#include "elastocheck/compare.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

// What the parameter of a branch moves: "heave" (all wheels alike), "roll" (two wheels opposed),
// "travel" (other travel of wheels), "steering", "lateral force", "longitudinal force", "moment" (on
// wheels), or "other".
const char* load_case(const Model& model, const Branch& branch);

// Force or moment on each wheel in the plane of the road per unit of the parameter, and the
// direction, as the K&C figures count it: inwards, to the back at the patch, forward at the wheel
// centre, towards toe-in. Null where the branch is no such test.
nlohmann::ordered_json pushes_json(const Model& model, const Branch& branch);

// Outputs with the force or moment of the joints that the parameter moves: "rack.drive_force".
nlohmann::ordered_json efforts_json(const Branch& branch,
                                    const std::vector<compare::Channel>& channels);

// "wheels": names and sides, "vehicle", and "static": rows of compare::StaticRow, settled on the
// first branch that holds no wheel, else on the first.
nlohmann::ordered_json wheels_json(const Model& model, const compare::Comparison& comparison);

// "elements": the stops with their clearance, and the segments of beams with the beam's name.
nlohmann::ordered_json elements_json(const Model& model);

}  // namespace elastocheck::reports
