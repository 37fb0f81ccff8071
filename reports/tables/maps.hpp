// Lookup tables and polynomials of outputs, as vehicle models take them (`export`).
#pragma once

#include <string>
#include <vector>

#include "compare/design/maps.hpp"

namespace elastocheck::reports {

// What the two variables of a table are: "travel [mm]", and "joints.rack [mm]" or empty.
struct MapAxes {
    std::string scene;  // its name
    std::string x, y;
};

// First lines of both files; others that begin like this may be overwritten.
inline constexpr const char* lookup_head = "# Lookup table of elastocheck";
inline constexpr const char* polynomial_head = "# Polynomials of elastocheck";

// A remark for each output with its definition, sign and unit, the head, a line per point.
std::string lookup_csv(const compare::MapTable& table, const MapAxes& axes);

// A remark for each output, then a line for each coefficient: output, unit, i, j, c_ij, and the
// scales and the error of its polynomial. `every` as in polynomial_maps().
std::string polynomial_csv(const compare::MapTable& table,
                           const std::vector<compare::PolynomialMap>& maps, const MapAxes& axes,
                           int every);

}  // namespace elastocheck::reports
