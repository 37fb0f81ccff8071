// Builds output curves from states, and selects the channels that can serve as abscissa.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// A parameter [SI] in its display unit, rounded to 15 digits: -60 deg in a scene stays -60 after its
// conversion to radians and back, in place of -59.99999999999999.
double parameter_in(Unit unit, double load);

// Appends one point; `load` in SI, `values` in the units of the channels.
void append(Curve& curve, double load, std::vector<double> values);

Curve curve(const Model& model, std::span<const Channel> channels, const Branch& branch,
            const std::vector<Equilibrium>& points);

// Curve with every `stride`-th point, counted from the start of the branch.
Curve thinned(const Curve& curve, std::size_t stride);

// Direction of a sequence. Only a rising or falling sequence can be inverted.
enum class Course {
    rising,      // x_k+1 > x_k for all k
    falling,     // x_k+1 < x_k for all k
    still,       // max x - min x ≤ 1e-9 of the unit (mm, deg, N, N·m)
    turning,     // (x_k+1 - x_k) (x_1 - x_0) ≤ 0 for some k
    not_finite,  // !isfinite(x_k) for some k
    too_short    // fewer than two values
};
struct Trend {
    Course course = Course::too_short;
    std::size_t at = 0;  // index at which the sequence first reverses, or is not finite
    bool monotonic() const { return course == Course::rising || course == Course::falling; }
};
Trend trend(std::span<const double> x);

// Abscissa of a comparison other than the parameter: a channel that is monotonic on both curves.
struct Abscissa {
    int channel = -1;  // -1: there is none
    // reason why not, "travel turns back at 1230 N (at 35.2 mm)", "travel does not move";
    // empty if usable
    std::string why_not;
};
// Default abscissa: the first wheel's travel; without a wheel the main position channel with the
// largest range; -1 without a position.
int default_abscissa(std::span<const Channel> channels, const Curve& curve);
// Whether both curves are monotonic in this channel.
Abscissa abscissa(std::span<const Channel> channels, int channel, const Curve& a, const Curve& b);

}  // namespace elastocheck::compare
