// Reads tables of a scene: two columns, in the scene or in a CSV file beside it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/tables/interpolant.hpp"

namespace elastocheck::reader {

// Units of a law's deflection, force and rate.
struct LawUnits {
    Unit deflection, force, rate;
    // of a spring: its property file (.spr) counts compression and pushing forces as positive
    bool of_spring = false;
};
LawUnits of_springs(const Units& units);  // length, force, force/length
LawUnits of_lengths(const Units& units);  // length, force, force/length
LawUnits of_angles(const Units& units);   // angle, moment, moment/angle

// Rows of `table` or `file` of a curve [SI]: at least two, deflections ascending, forces non-decreasing.
std::vector<TablePoint> read_table(const Cursor& curve, const LawUnits& units,
                                   const Definitions& defs);

// FREE_LENGTH of the spring's property file (.spr) that a curve names [m]; none if it names another
// file, or the file has none.
std::optional<double> free_length_of_file(const Cursor& curve, const Definitions& defs);

// The six curves of a bushing's property file (.bus), x y z rx ry rz [SI].
std::array<std::vector<TablePoint>, 6> read_bushing_file(const Cursor& field,
                                                         const Definitions& defs);

}  // namespace elastocheck::reader
