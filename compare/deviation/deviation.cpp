#include "compare/deviation/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/deviation/tolerance.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

// Accumulates the deviation of one channel. After a difference that is not finite max and rms stay NaN.
struct Running {
    Deviation deviation;
    double squares = 0;

    void add(double difference, double at) {
        ++deviation.compared;
        deviation.end = difference;
        squares += difference * difference;
        if (!std::isfinite(difference)) {
            deviation.max = deviation.signed_max = nan;
            deviation.at = at;
        } else if (std::abs(difference) > deviation.max) {  // false once max is NaN
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

Reading finish(std::vector<Running>& sums, const Curve& a) {
    Reading reading;
    for (std::size_t c = 0; c < sums.size(); ++c) {
        reading.channels.push_back(sums[c].result());
        reading.channels.back().range = range(a, c);
    }
    return reading;
}

Reading no_reading(std::string why) {
    Reading reading;
    reading.not_compared = std::move(why);
    return reading;
}

// Whether two parameters are equal up to rounding of a division.
bool same(double a, double b, const Curve& curve) {
    return std::abs(a - b) <= 1e-12 * std::max(std::abs(curve.a.front()), std::abs(curve.a.back()));
}

// Takes a difference of a channel into the worst of its unit, of a force or moment with an extent into
// the worst share.
void include(const std::vector<Channel>& channels, std::size_t c, double difference,
             Accuracy& worst, const std::vector<double>& extents = {}) {
    if (!channels[c].main) {
        if (!extents.empty() && !is_motion(channels[c]) && std::isfinite(extents[c]))
            worst.share = worse(worst.share, std::abs(difference) / extents[c]);
        return;
    }
    double& side = channels[c].unit == Unit::deg ? worst.deg : worst.mm;
    side = worse(side, std::abs(difference));
}

}  // namespace

double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }
Accuracy worse(const Accuracy& a, const Accuracy& b) {
    return {worse(a.mm, b.mm), worse(a.deg, b.deg), worse(a.share, b.share)};
}

Deviation deviation_of(const std::vector<double>& a, const std::vector<double>& b,
                       const std::vector<double>& places) {
    Running running;
    for (std::size_t k = 0; k < a.size(); ++k) running.add(b[k] - a[k], places[k]);
    return running.result();
}

Reading at_equal_parameter(const Curve& a, const Curve& b) {
    if (a.values.empty() || b.values.empty()) return no_reading("a curve is empty");
    std::vector<Running> sums(a.values.front().size());
    // Two-sided curves that ended early begin at different points; their common range lies around
    // their start.
    const std::size_t before = std::min(a.start, b.start);
    const std::size_t after = std::min(a.a.size() - a.start, b.a.size() - b.start);
    for (std::size_t k = 0; k < before + after; ++k) {
        const std::size_t i = a.start - before + k, j = b.start - before + k;
        if (!same(a.a[i], b.a[j], a))
            return no_reading("the curves are not at the same parameters");
        for (std::size_t c = 0; c < sums.size(); ++c)
            sums[c].add(b.values[j][c] - a.values[i][c], a.a[i]);
    }
    return finish(sums, a);
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double place,
                   int nodes) {
    const auto n = static_cast<std::ptrdiff_t>(x.size());
    const bool up = x.back() > x.front();
    const auto above = std::lower_bound(x.begin(), x.end(), place,
                                        [&](double u, double v) { return up ? u < v : u > v; });
    const std::ptrdiff_t count = std::min<std::ptrdiff_t>(nodes, n);
    const std::ptrdiff_t first =
        std::clamp<std::ptrdiff_t>(above - x.begin() - count / 2, 0, n - count);
    double sum = 0;  // Lagrange's formula, over `count` samples around `place`
    for (std::ptrdiff_t k = first; k < first + count; ++k) {
        double basis = 1;
        for (std::ptrdiff_t l = first; l < first + count; ++l)
            if (l != k)
                basis *= (place - x[static_cast<std::size_t>(l)]) /
                         (x[static_cast<std::size_t>(k)] - x[static_cast<std::size_t>(l)]);
        sum += basis * y[static_cast<std::size_t>(k)];
    }
    return sum;
}

namespace {

// Calls sink(point of a, channel, b - a, its uncertainty) where b reaches the abscissa of a;
// returns the number of points out of reach.
template <class Sink>
int read_over(const Curve& a, const Curve& b, std::size_t abscissa, Sink&& sink) {
    const auto x_of_a = a.channel(abscissa), x = b.channel(abscissa);
    // A driven end has the same travel in both up to rounding.
    const double rounding = 1e-9 * std::abs(x.back() - x.front());
    const double low = std::min(x.front(), x.back()) - rounding,
                 high = std::max(x.front(), x.back()) + rounding;
    int outside = 0;
    for (const double t : x_of_a) outside += t < low || t > high;
    for (std::size_t c = 0; c < a.values.front().size(); ++c) {
        const auto y = b.channel(c);
        for (std::size_t k = 0; k < x_of_a.size(); ++k) {
            if (x_of_a[k] < low || x_of_a[k] > high) continue;
            const double value = interpolate(x, y, x_of_a[k], 6);
            sink(k, c, value - a.values[k][c], std::abs(value - interpolate(x, y, x_of_a[k], 4)));
        }
    }
    return outside;
}

}  // namespace

Reading at_equal_abscissa(const Curve& a, const Curve& b, const Abscissa& abscissa) {
    if (!abscissa.why_not.empty()) return no_reading(abscissa.why_not);
    const auto channel = static_cast<std::size_t>(abscissa.channel);
    std::vector<Running> sums(a.values.front().size());
    const int outside = read_over(
        a, b, channel, [&](std::size_t k, std::size_t c, double difference, double uncertain) {
            sums[c].add(difference, a.values[k][channel]);
            sums[c].deviation.interpolation = worse(sums[c].deviation.interpolation, uncertain);
        });
    Reading reading = finish(sums, a);
    reading.outside = outside;
    return reading;
}

Profile profile_at_equal_parameter(const std::vector<Channel>& channels, const Curve& a,
                                   const Curve& b, const std::vector<double>& extents) {
    Profile profile{a.unit, {}, {}};
    if (a.a.empty() || b.a.empty()) return profile;
    const std::size_t before = std::min(a.start, b.start);
    const std::size_t after = std::min(a.a.size() - a.start, b.a.size() - b.start);
    for (std::size_t k = 0; k < before + after; ++k) {
        const std::size_t i = a.start - before + k, j = b.start - before + k;
        Accuracy deviation{};
        for (std::size_t c = 0; c < channels.size(); ++c)
            include(channels, c, same(a.a[i], b.a[j], a) ? b.values[j][c] - a.values[i][c] : nan,
                    deviation, extents);
        profile.a.push_back(a.a[i]);
        profile.deviation.push_back(deviation);
    }
    return profile;
}

Profile profile_at_equal_abscissa(const std::vector<Channel>& channels, const Curve& a,
                                  const Curve& b, const Abscissa& abscissa) {
    Profile profile{a.unit, {}, {}};
    if (!abscissa.why_not.empty()) return profile;
    std::vector<bool> reached(a.a.size(), false);
    profile.a = a.a;
    profile.deviation.resize(a.a.size());
    read_over(a, b, static_cast<std::size_t>(abscissa.channel),
              [&](std::size_t k, std::size_t c, double difference, double) {
                  reached[k] = true;
                  include(channels, c, difference, profile.deviation[k]);
              });
    for (std::size_t k = 0; k < reached.size(); ++k)
        if (!reached[k]) profile.deviation[k] = {nan, nan};
    return profile;
}

Accuracy distance(const std::vector<Channel>& channels, const Curve& a, const Curve& b,
                  const std::vector<double>& extents) {
    if (a.a.empty() || a.a.size() != b.a.size() || a.start != b.start)
        return {nan, nan, extents.empty() ? 0 : nan};
    Accuracy worst{};
    for (const auto& deviation : profile_at_equal_parameter(channels, a, b, extents).deviation)
        worst = worse(worst, deviation);
    return worst;
}

Accuracy rounding_of(const std::vector<Channel>& channels, const Curve& curve,
                     const std::vector<double>& extents) {
    Accuracy largest{};
    for (const auto& values : curve.values)
        for (std::size_t c = 0; c < channels.size(); ++c)
            include(channels, c, 16 * std::numeric_limits<double>::epsilon() * values[c], largest,
                    extents);
    return largest;
}

}  // namespace elastocheck::compare
