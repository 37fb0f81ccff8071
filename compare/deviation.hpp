// How far two curves are apart, read at equal parameter and at equal abscissa: for a suspension at equal load
// and at equal travel.
//
// Both readings are true and differ: an error along the path of motion (a wrong rate) shows at equal load and
// vanishes at equal travel; an error across it shows in both.
#pragma once

#include <string>
#include <vector>

#include "compare/curve.hpp"

namespace elastocheck::compare {

struct Deviation {
    double max = 0;         // largest |b - a|, in the channel's unit
    double signed_max = 0;  // b - a where it is largest
    double at = 0;          // there: the parameter, or the abscissa, in its unit
    double end = 0;         // b - a at the last compared point, signed
    double rms = 0;
    double range = 0;  // of the channel over curve a
    double interpolation =
        0;             // equal abscissa: how uncertain the interpolation of b is, largest over the points
    int compared = 0;  // numbers compared; 0 means nothing was
};

struct Reading {
    std::vector<Deviation> channels;  // one per channel
    std::string not_compared;         // why there is none, empty when there is
    int outside = 0;                  // points of a that b does not reach (equal abscissa)
};

// Of b from a, number by number; `at` says where. Its `range` is left to who knows the whole of a.
Deviation deviation_of(const std::vector<double>& a, const std::vector<double>& b,
                       const std::vector<double>& at);

// Points with the same parameter. Values that are not finite make the deviation NaN, never zero.
Reading at_equal_parameter(const Curve& a, const Curve& b);

// b interpolated at the abscissa of a, where it reaches it.
Reading at_equal_abscissa(const Curve& a, const Curve& b, const Abscissa& by);

// Local polynomial interpolation of y over strictly monotonic x through the `nodes` samples around `at`.
double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at, int nodes);

// ---- The worst of the main channels, by unit.

// Lengths in mm and angles in deg: an error, an uncertainty.
struct Accuracy {
    double mm = 0;   // positions
    double deg = 0;  // toe and camber; 0 where a scene has no angles
};
double worse(double a, double b);  // the larger; NaN is larger than anything
Accuracy worse(const Accuracy& a, const Accuracy& b);

// Point by point along a. NaN where something is not finite, or b does not reach.
struct Profile {
    Unit unit = Unit::newton;
    std::vector<double> a;  // parameter [unit]
    std::vector<Accuracy> apart;
};
Profile profile_at_equal_parameter(const std::vector<Channel>& channels, const Curve& a, const Curve& b);
Profile profile_at_equal_abscissa(const std::vector<Channel>& channels, const Curve& a, const Curve& b,
                                  const Abscissa& by);  // empty where it cannot be read

// The worst of the profile at equal parameter; NaN unless both curves are as long as each other and at the
// same parameters.
Accuracy distance(const std::vector<Channel>& channels, const Curve& a, const Curve& b);

// Two references may agree to the last bit by luck; values of this size, summed over a path, know no more than some
// units of it: 16.
Accuracy rounding_of(const std::vector<Channel>& channels, const Curve& curve);

}  // namespace elastocheck::compare
