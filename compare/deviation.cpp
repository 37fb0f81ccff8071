#include "compare/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// One channel's deviation, number by number. A difference that is not finite poisons max and rms for good.
struct Tally {
    Deviation deviation;
    double squares = 0;

    void add(double difference, double at) {
        ++deviation.compared;
        deviation.end = difference;
        squares += difference * difference;
        if (!std::isfinite(difference)) {
            deviation.max = deviation.signed_max = nan;
            deviation.at = at;
        } else if (std::abs(difference) > deviation.max) {  // false for good once max is NaN
            deviation.max = std::abs(difference);
            deviation.signed_max = difference;
            deviation.at = at;
        }
    }
    Deviation result() {
        deviation.rms = deviation.compared > 0 ? std::sqrt(squares / deviation.compared) : nan;
        if (deviation.compared == 0) deviation.max = deviation.signed_max = deviation.end = nan;
        return deviation;
    }
};

double range(const Curve& curve, std::size_t channel) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& point : curve.values) {
        if (!std::isfinite(point[channel])) return nan;
        low = std::min(low, point[channel]);
        high = std::max(high, point[channel]);
    }
    return curve.values.empty() ? nan : high - low;
}

bool strictly_monotone(const std::vector<double>& x) {
    if (x.size() < 2) return false;
    const bool up = x[1] > x[0];
    for (std::size_t k = 1; k < x.size(); ++k)
        if (!(up ? x[k] > x[k - 1] : x[k] < x[k - 1])) return false;
    return true;
}

Reading finish(std::vector<Tally>& tallies, const Curve& a) {
    Reading reading;
    for (std::size_t c = 0; c < tallies.size(); ++c) {
        reading.channels.push_back(tallies[c].result());
        reading.channels.back().range = range(a, c);
    }
    return reading;
}

Reading nothing(std::string why) {
    Reading reading;
    reading.not_compared = std::move(why);
    return reading;
}

}  // namespace

Reading at_equal_load(const Curve& a, const Curve& b) {
    if (a.values.empty() || b.values.empty()) return nothing("a curve is empty");
    std::vector<Tally> tallies(a.values.front().size());
    for (std::size_t k = 0; k < std::min(a.load.size(), b.load.size()); ++k) {
        if (a.load[k] != b.load[k]) return nothing("the curves are not at the same loads");
        for (std::size_t c = 0; c < tallies.size(); ++c)
            tallies[c].add(b.values[k][c] - a.values[k][c], a.load[k]);
    }
    return finish(tallies, a);
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at, int nodes) {
    const auto n = static_cast<std::ptrdiff_t>(x.size());
    const bool up = x.back() > x.front();
    const auto above =
        std::lower_bound(x.begin(), x.end(), at, [&](double u, double v) { return up ? u < v : u > v; });
    const std::ptrdiff_t count = std::min<std::ptrdiff_t>(nodes, n);
    const std::ptrdiff_t first = std::clamp<std::ptrdiff_t>(above - x.begin() - count / 2, 0, n - count);
    double sum = 0;  // Lagrange
    for (std::ptrdiff_t k = first; k < first + count; ++k) {
        double basis = 1;
        for (std::ptrdiff_t l = first; l < first + count; ++l)
            if (l != k)
                basis *= (at - x[static_cast<std::size_t>(l)]) /
                         (x[static_cast<std::size_t>(k)] - x[static_cast<std::size_t>(l)]);
        sum += basis * y[static_cast<std::size_t>(k)];
    }
    return sum;
}

Reading at_equal_travel(const Curve& a, const Curve& b) {
    if (a.travel.empty() || b.travel.empty())
        return nothing("the branch has no travel: its loads have no resultant force");
    if (!strictly_monotone(a.travel) || !strictly_monotone(b.travel))
        return nothing("travel is not monotone in the load");
    const auto [low, high] = std::minmax(b.travel.front(), b.travel.back());
    std::vector<Tally> tallies(a.values.front().size());
    int outside = 0;
    for (const double travel : a.travel) outside += travel < low || travel > high;
    for (std::size_t c = 0; c < tallies.size(); ++c) {
        std::vector<double> y;
        for (const auto& point : b.values) y.push_back(point[c]);
        double uncertain = 0;
        for (std::size_t k = 0; k < a.travel.size(); ++k) {
            const double travel = a.travel[k];
            if (travel < low || travel > high) continue;
            const double value = interpolate(b.travel, y, travel, 6);
            uncertain = std::max(uncertain, std::abs(value - interpolate(b.travel, y, travel, 4)));
            tallies[c].add(value - a.values[k][c], travel);
        }
        tallies[c].deviation.interpolation = uncertain;
    }
    Reading reading = finish(tallies, a);
    reading.outside = outside;
    return reading;
}

}  // namespace elastocheck::compare
