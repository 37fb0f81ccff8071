// The curves of one leg as CSV, a column a channel: what `elastocheck solve` prints.
#pragma once

#include <string>
#include <vector>

#include "compare/compare.hpp"

namespace elastocheck::reports {

// Of the load factors of all branches: "N", "N·m", or "N;N·m".
std::string load_units(const Model& model);

// Header and rows: branch, leg, load factor [N], travel [mm], then every channel with its unit; 17
// significant digits.
std::string curves_header(const Model& model);
std::string curves_rows(const std::string& branch, const compare::LegRun& run);

}  // namespace elastocheck::reports
