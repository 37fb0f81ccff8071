// One leg's outputs along one branch, and over what they can be read.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compare/channels.hpp"

namespace elastocheck::compare {

struct Curve {
    Unit unit = Unit::newton;                 // of the parameter
    std::vector<double> a;                    // [unit], in the order of the points
    std::size_t start = 0;                    // point at a = 0
    std::vector<std::vector<double>> values;  // [point][channel]

    std::vector<double> channel(std::size_t c) const;
};

// One point more, its parameter in SI.
void append(Curve& curve, double load, std::vector<double> values);

Curve curve(const Model& model, std::span<const Channel> channels, const Branch& branch,
            const std::vector<Equilibrium>& points);

// Which way a sequence goes. Only one that rises or falls throughout can be read the other way round.
enum class Course { rising, falling, still, turning, not_finite, too_short };
struct Trend {
    Course course = Course::too_short;
    std::size_t at = 0;  // where it first turns back, or is no number
    bool monotonic() const { return course == Course::rising || course == Course::falling; }
};
Trend trend(std::span<const double> x);

// Over what else than the parameter curves are compared: a channel that is monotonic on both.
struct Abscissa {
    int channel = -1;     // -1: there is none
    std::string why_not;  // "travel turns back at 1230 N (at 35.2 mm)", "travel does not move"; empty where
                          // it can be read
};
// The first wheel's travel; without a wheel the position among the main channels that moves farthest. -1
// where there is no position.
int default_abscissa(std::span<const Channel> channels, const Curve& curve);
// Whether both curves can be read over this channel.
Abscissa abscissa(std::span<const Channel> channels, int channel, const Curve& a, const Curve& b);

}  // namespace elastocheck::compare
