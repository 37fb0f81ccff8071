// How far two curves are apart, read at equal load and at equal travel.
//
// Both readings are true and differ: an error along the path of motion (a wrong rate) shows at equal load and
// vanishes at equal travel; an error across it shows in both.
#pragma once

#include <string>
#include <vector>

#include "compare/channels.hpp"

namespace elastocheck::compare {

struct Deviation {
    double max = 0;         // largest |b - a|, in the channel's unit
    double signed_max = 0;  // b - a where it is largest
    double at = 0;          // there: load factor, or travel [mm]
    double end = 0;         // b - a at the last compared point, signed
    double rms = 0;
    double range = 0;  // of the channel over curve a
    double interpolation =
        0;             // equal travel: how uncertain the interpolation of b is, largest over the points
    int compared = 0;  // numbers compared; 0 means nothing was
};

struct Reading {
    std::vector<Deviation> channels;  // one per channel
    std::string not_compared;         // why there is none, empty when there is
    int outside = 0;                  // points of a that b does not reach (equal travel)
};

// Points with the same load factor. Values that are not finite make the deviation NaN, never zero.
Reading at_equal_load(const Curve& a, const Curve& b);

// b interpolated at the travels of a, where it reaches them; both travels must be strictly monotone.
Reading at_equal_travel(const Curve& a, const Curve& b);

// Local polynomial interpolation of y over strictly monotone x through the `nodes` samples around `at`.
double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at, int nodes);

}  // namespace elastocheck::compare
