// Lookup tables of outputs, as vehicle models take them (`export`).
#pragma once

#include <string>
#include <vector>

#include "elastocheck/channels.hpp"

namespace elastocheck::reports {

// Outputs on a grid: the parameter of a branch, and values at which something is held on it.
struct MapTable {
    std::vector<compare::Channel> channels;
    std::vector<double> x;  // parameter, in the branch's unit, increasing
    std::vector<double> y;  // held values, increasing; one: no second variable
    // [y][x][channel]; NaN where the branch does not reach the parameter
    std::vector<std::vector<std::vector<double>>> values;
};

// What the two variables of a table are: "travel [mm]", and "joints.rack [mm]" or empty.
struct MapAxes {
    std::string scene;  // its name
    std::string x, y;
};

// First line of the file; others that begin like this may be overwritten.
inline constexpr const char* lookup_head = "# Lookup table of elastocheck";

// A remark for each output with its definition, sign and unit, the head, a line per point.
std::string lookup_csv(const MapTable& table, const MapAxes& axes);

}  // namespace elastocheck::reports
