// A chart of a result as a figure of the page.
#pragma once

#include <string>

#include "compare/result/result.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Curves over the columns of the table: one for each ordinate and each combination of values of
// `chart.by`. Points without a place on a logarithmic axis are left out. `y`: name of the ordinate with
// its unit; empty: that of the only column. The other kinds have no `by` and no logarithmic axes.
Figure figure_of(const compare::Chart& chart, const Table& table, const std::string& y = "");

// Shades what is within a tolerance; the axis ends above it and the curves, and begins below them, or so
// many decades lower. Curves that lie below are left out.
void add_tolerance(Figure& figure, double tolerance, const std::string& unit, int decades = 30);

}  // namespace elastocheck::reports
