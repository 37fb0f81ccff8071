// The curves of one leg as CSV, a column a channel: what `elastocheck solve` prints.
#pragma once

#include <string>
#include <vector>

#include "compare/compare.hpp"

namespace elastocheck::reports {

// Header and rows: branch, leg, parameter and its unit,
// then every channel with its unit; 17 significant digits.
std::string curves_header(const std::vector<compare::Channel>& channels);
std::string curves_rows(const std::string& branch, const compare::LegRun& run);

}  // namespace elastocheck::reports
