// Deviation between two curves at equal parameter and at equal abscissa (for a suspension: equal
// load and equal travel).
//
// The two readings differ: an error along the path of motion (a wrong rate) appears at equal load
// and vanishes at equal travel; an error across the path appears in both.
#pragma once

#include <vector>

#include "compare/outputs/curve.hpp"

namespace elastocheck::compare {

// Deviation b - a, number by number; `at` gives the place of each (parameter or abscissa). NaN if a
// value is not finite. The caller sets Deviation::range from the whole of a.
Deviation deviation_of(const std::vector<double>& a, const std::vector<double>& b,
                       const std::vector<double>& at);

// Points with the same parameter. A value that is not finite makes the deviation NaN, never zero.
Reading at_equal_parameter(const Curve& a, const Curve& b);

// b interpolated at the abscissa values of a, within the range of b.
Reading at_equal_abscissa(const Curve& a, const Curve& b, const Abscissa& abscissa);

// Local polynomial interpolation at `at` of y over strictly monotonic x, through the `nodes` samples
// around it.
double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at,
                   int nodes);

// ---- The worst of the main channels, by unit.

// The largest deviation of the main channels of each unit: an error or an uncertainty.
struct Accuracy {
    double mm = 0;   // positions [mm]
    double deg = 0;  // toe and camber [deg]; 0 where a scene has no angles
    // forces and moments, each relative to its extent (tolerance.hpp) [-]; 0 where not evaluated
    double share = 0;
};
double worse(double a, double b);  // the larger; NaN counts as larger than any number
Accuracy worse(const Accuracy& a, const Accuracy& b);

// Deviation of b from a, point by point along a: NaN where a value is not finite or b has no such point.
// At equal abscissa it is empty without a usable abscissa.
struct Profile {
    Unit unit = Unit::newton;
    std::vector<double> a;  // parameter [unit]
    std::vector<Accuracy> deviation;
};
Profile profile_at_equal_parameter(const std::vector<Channel>& channels, const Curve& a,
                                   const Curve& b, const std::vector<double>& extents = {});
Profile profile_at_equal_abscissa(const std::vector<Channel>& channels, const Curve& a,
                                  const Curve& b, const Abscissa& abscissa);

// Worst of the profile at equal parameter; NaN unless both curves have the same parameters. With
// `extents` (tolerance.hpp; infinite: not judged) also of forces and moments.
Accuracy distance(const std::vector<Channel>& channels, const Curve& a, const Curve& b,
                  const std::vector<double>& extents = {});

// Uncertainty due to rounding: 16 units of the last place of the largest values. Two
// references may agree to the last bit by chance; their values, summed over a path, are not
// more precise than this.
Accuracy rounding_of(const std::vector<Channel>& channels, const Curve& curve,
                     const std::vector<double>& extents = {});

}  // namespace elastocheck::compare
