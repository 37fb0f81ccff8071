// The vocabulary of K&C rigs in measured files: names of tests and headings of columns.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::reports {

// A branch and what its parameter moves (load_case() in wheels.hpp).
struct TestBranch {
    std::string branch, moves;
    bool by_travel = false;  // its parameter is a length
};
std::vector<TestBranch> tests_of(const Model& model);

// The branches that the name of a rig test may mean, in any case and with - or _ for blanks:
//   bounce, ride, heave, parallel travel | roll | steer, steering | lateral (force), also opposed or
//   parallel | aligning torque, also opposed or parallel | braking | traction
// Of several with that load case the one whose name has the test's word, "braking", else the one whose
// parameter is a travel; empty if the name is no test.
std::vector<std::string> branches_of_test(std::string_view test,
                                          const std::vector<TestBranch>& branches);

// "Left Toe Angle (arcmin)" as "left.toe [arcmin]", "Wheel Travel RH [mm]" as "right.travel [mm]",
// "Lateral Force [kN]" as "parameter [kN]", "Vertical Force LH [N]" as "left.wheel_load [N]" where no
// branch has that parameter, "Test" as "branch"; of a scene with one wheel without a
// name "toe [arcmin]". Empty where the heading is not known, or names another side than that of the
// only wheel.
struct RigHeading {
    std::string name;  // as this program writes it
    // of a parameter: what it is the parameter of, "lateral force"; elsewhere the column is no
    // parameter, since a rig records every force in every test
    std::string moves;
};
std::optional<RigHeading> heading_of_rig(std::string_view heading,
                                         const compare::Comparison& comparison,
                                         const std::vector<TestBranch>& tests);

}  // namespace elastocheck::reports
