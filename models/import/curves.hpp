// How far the curve that a scene runs through points is from the one that another program runs through them.
#pragma once

#include <utility>
#include <vector>

namespace elastocheck::importer {

using Rows = std::vector<std::pair<double, double>>;

// Largest distance between the rows, of the largest force there; 0 where a scene takes no such table.
double off_akima(const Rows& rows);                                  // H. Akima, JACM 17 (1970) 589
double off_natural(const Rows& rows);                                // the natural cubic spline
double off_straight(const Rows& rows);                               // the polygon
double off_power(const Rows& rows, double factor, double exponent);  // factor · xⁿ

}  // namespace elastocheck::importer
