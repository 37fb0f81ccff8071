// Wheels of a scene: static alignment and wheel loads, and what each branch does to the wheels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/tables/rows.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

// What the parameter of a branch moves: "heave" (all wheels alike), "roll" (two wheels opposed),
// "travel" (other travel of wheels), "steering", "lateral force", "longitudinal force", "moment" (on
// wheels), or "other".
const char* load_case(const Model& model, const Branch& branch);

// Force or moment on each wheel in the plane of the road per unit of the parameter, positive in the
// direction of the K&C figures: inwards, to the back at the patch, forward at the wheel centre,
// towards toe-in. Empty where the branch is no such test.
struct Pushes {
    std::vector<double> per_unit;  // per wheel
    std::string positive;          // the direction in words
};
std::optional<Pushes> pushes_of(const Model& model, const Branch& branch);

// Outputs with the force or moment of the joints that the parameter moves: "rack.drive_force".
std::vector<std::string> efforts_of(const Branch& branch,
                                    const std::vector<compare::Channel>& channels);

// The branch that starts at the settled position: the first that holds no wheel, else the first.
std::size_t settled_on(const Model& model);
// Angles and loads of each wheel as drawn, and settled by the equilibrium leg.
std::vector<compare::StaticRow> static_rows(const Model& model,
                                            const compare::Comparison& comparison);

}  // namespace elastocheck::reports
