// Tables of a scene: two columns, in the scene or in a CSV file beside it.
#pragma once

#include <array>
#include <vector>

#include "models/reader/cursor.hpp"
#include "models/reader/definitions.hpp"
#include "models/reader/interpolant.hpp"

namespace elastocheck::reader {

// What a law relates, and the units of its numbers.
struct LawUnits {
    Unit deflection, force, rate;
    bool of_spring =
        false;  // whose property file (.spr) counts what it is shorter by, and what pushes its ends apart
};
LawUnits of_springs(const Units& units);  // of lengths
LawUnits of_lengths(const Units& units);  // length, force, force/length
LawUnits of_angles(const Units& units);   // angle, moment, moment/angle

// The rows of `table` or `file` of a curve [SI]: at least two, deflections rising, forces not falling.
std::vector<TablePoint> read_table(const Cursor& curve, const LawUnits& units, const Definitions& defs);

// The six curves of a bushing's property file (.bus), x y z rx ry rz [SI].
std::array<std::vector<TablePoint>, 6> read_bushing_file(const Cursor& at, const Definitions& defs);

}  // namespace elastocheck::reader
