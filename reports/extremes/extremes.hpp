// Scenes that are extreme by their making, models/extremes/, and the numbers that make them so: all but singular geometry,
// joints that repeat or contradict each other, stops that just touch, curves that are flat or steep, limit points.
#pragma once

#include <vector>

#include "compare/stress.hpp"

namespace elastocheck::reports {

// One a value, in the order of the table. Of the sweep compare::extreme.
std::vector<compare::Trial> extremes();

}  // namespace elastocheck::reports
