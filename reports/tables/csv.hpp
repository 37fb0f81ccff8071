// Curves of one leg as CSV, row by row, one column per channel, with 17 significant digits.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"

namespace elastocheck::reports {

// Branch, leg, parameter and its unit, then every channel with its unit.
std::string curves_header(const std::vector<compare::Channel>& channels);
std::string curves_row(const std::string& branch, compare::Leg leg, compare::Unit unit,
                       const compare::Row& row);

// Derivatives of the series in a separate file, by branch side; `a` in SI.
std::string rates_header(const std::vector<compare::Channel>& channels);
std::string rates_row(const std::string& side, compare::Unit unit, double a,
                      const std::vector<double>& slopes);

}  // namespace elastocheck::reports
