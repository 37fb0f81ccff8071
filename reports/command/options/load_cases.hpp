// Load cases from a CSV file: a row a case, a column an input.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/loads/loads.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

// Columns, with a unit as in other tables ("left.patch_force_z [kN]", "travel_mm"). An empty cell
// is no input. Where the scene has a single wheel without a name, "WHEEL." is left out:
//
//   case                            name of the case, once each
//   WHEEL.patch_force_x, _y, _z     total force of the road on the tyre [N], the static wheel load
//                                   included; along x its torque is taken by a brake on the carrier
//   WHEEL.centre_force_x, _y, _z    force at the wheel centre [N]
//   WHEEL.moment_x, _y, _z          moment on the wheel carrier [N·m]
//   WHEEL.travel                    height of the wheel centre above the design position, held [mm]
//   BODY.force_x, _y, _z            force at the centre of mass of a body [N]
//   acceleration_x, _y, _z [g]      of the vehicle, in parts of the scene's gravity
//
// Throws SheetError "file:line: ..." for an unknown column or unit, a cell that is not a number, a missing
// column or name of the case, and a name that occurs twice.
std::vector<compare::LoadCase> read_load_cases(std::string_view csv, const std::string& file,
                                               const Scene& scene);

}  // namespace elastocheck::reports
