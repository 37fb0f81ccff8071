// Interval arithmetic in doubles with guaranteed enclosure.
//
// A bound is computed with rounding to nearest and then moved outwards by one unit in the last
// place: the rounding error is at most half a unit, so the bound lies beyond the exact value. No
// rounding mode is set, so the result does not depend on the compiler's code motion, and threads do
// not interfere.
// `arithmetic_is_as_proved()` checks the two assumptions of this argument.
//
// An unbounded interval carries no information, and neither does any result of it. It stands for
// "not defined here" (a quotient by zero, a root of a negative number) and for "too large". NaN
// counts as unbounded.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastocheck::reference::certificate {

// A double above x: the next one, near the least normal number the one after it (Rump, Zimmermann,
// Boldo, Melquiond 2009). ∞ is returned unchanged, -∞ and NaN as NaN.
inline double next_up(double x) {
    constexpr double more_than_half = 0x1.0000000000001p-53;
    return x + (more_than_half * std::abs(x) + std::numeric_limits<double>::denorm_min());
}
inline double next_down(double x) { return -next_up(-x); }

struct Interval {
    double lo = 0, hi = 0;

    constexpr Interval() = default;
    constexpr Interval(double x)
        : lo(x), hi(x) {}  // NOLINT(google-explicit-constructor): a double is one
    constexpr Interval(double from, double to) : lo(from), hi(to) {}
};

inline constexpr Interval everything{-std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::infinity()};

inline bool is_bounded(const Interval& a) {
    return a.lo > -std::numeric_limits<double>::infinity() &&
           a.hi < std::numeric_limits<double>::infinity();
}
inline bool is_zero(const Interval& a) { return a.lo == 0 && a.hi == 0; }
inline bool contains(const Interval& a, double x) { return a.lo <= x && x <= a.hi; }
inline bool is_inside(const Interval& a, const Interval& b) { return b.lo <= a.lo && a.hi <= b.hi; }
inline bool are_disjoint(const Interval& a, const Interval& b) {
    return a.hi < b.lo || b.hi < a.lo;
}

// Largest and least absolute value; infinite and 0 for an unbounded interval.
inline double mag(const Interval& a) {
    return is_bounded(a) ? std::max(std::abs(a.lo), std::abs(a.hi))
                         : std::numeric_limits<double>::infinity();
}
inline double mig(const Interval& a) {
    if (!is_bounded(a) || contains(a, 0)) return 0;
    return std::min(std::abs(a.lo), std::abs(a.hi));
}
// A double inside the interval, and the largest distance of its ends from it.
inline double mid(const Interval& a) { return a.lo == a.hi ? a.lo : a.lo / 2 + a.hi / 2; }
inline double rad(const Interval& a) {
    if (a.lo == a.hi) return 0;
    const double m = mid(a);
    return next_up(std::max(m - a.lo, a.hi - m));
}

inline Interval hull(const Interval& a, const Interval& b) {
    if (!is_bounded(a) || !is_bounded(b)) return everything;
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
// Intersection of two enclosures of the same number; unbounded if they are disjoint.
inline Interval intersection(const Interval& a, const Interval& b) {
    if (!is_bounded(a)) return b;
    if (!is_bounded(b)) return a;
    const Interval both{std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
    return both.lo <= both.hi ? both : everything;
}
inline Interval around(double middle, double radius) {
    return {next_down(middle - radius), next_up(middle + radius)};
}

// Interval of two rounded bounds; NaN, from ∞ - ∞ or 0 · ∞, makes it unbounded.
inline Interval outward(double lo, double hi) {
    const Interval a{next_down(lo), next_up(hi)};
    return a.lo <= a.hi ? a : everything;
}

inline Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }

// A sum of doubles that is computed as zero is exactly zero.
inline Interval operator+(const Interval& a, const Interval& b) {
    if (is_zero(a)) return b;
    if (is_zero(b)) return a;
    const double lo = a.lo + b.lo, hi = a.hi + b.hi;
    const Interval sum{lo == 0 ? 0 : next_down(lo), hi == 0 ? 0 : next_up(hi)};
    return sum.lo <= sum.hi ? sum : everything;
}
inline Interval operator-(const Interval& a, const Interval& b) { return a + -b; }

inline Interval operator*(const Interval& a, const Interval& b) {
    if (is_zero(a)) return is_bounded(b) ? Interval{} : everything;
    if (is_zero(b)) return is_bounded(a) ? Interval{} : everything;
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    const double sum = (p + q) + (r + s);  // detects 0 · ∞, which a minimum would skip
    if (!(sum - sum == 0)) return everything;
    return outward(std::min(std::min(p, q), std::min(r, s)),
                   std::max(std::max(p, q), std::max(r, s)));
}

inline Interval operator/(const Interval& a, const Interval& b) {
    if (!is_bounded(a) || !is_bounded(b) || contains(b, 0)) return everything;
    if (is_zero(a)) return {};
    const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    return outward(std::min(std::min(p, q), std::min(r, s)),
                   std::max(std::max(p, q), std::max(r, s)));
}

inline Interval& operator+=(Interval& a, const Interval& b) { return a = a + b; }
inline Interval& operator-=(Interval& a, const Interval& b) { return a = a - b; }
inline Interval& operator*=(Interval& a, const Interval& b) { return a = a * b; }

// A square is not negative, for any rounding.
inline Interval sqr(const Interval& a) {
    if (!is_bounded(a)) return everything;
    const double least = mig(a), most = mag(a);
    return {std::max(0.0, next_down(least * least)), most == 0 ? 0 : next_up(most * most)};
}

inline Interval sqrt(const Interval& a) {
    if (!is_bounded(a) || !(a.lo >= 0)) return everything;
    return {std::max(0.0, next_down(std::sqrt(a.lo))), a.hi == 0 ? 0 : next_up(std::sqrt(a.hi))};
}

// Whether doubles are rounded to nearest and denormals kept, as the argument above assumes. Linked
// libraries or the calling program may have changed either.
inline bool arithmetic_is_as_proved() {
    const volatile double one = 1, half_unit = std::numeric_limits<double>::epsilon() / 2,
                          least = std::numeric_limits<double>::denorm_min(),
                          normal = std::numeric_limits<double>::min();
    const volatile double tie = one + half_unit, above = one + 1.5 * half_unit,
                          below = -one - 1.5 * half_unit, small = normal / 2, kept = least * one;
    return tie == 1 && above == 1 + 2 * half_unit && below == -(1 + 2 * half_unit) && small > 0 &&
           kept > 0;
}

}  // namespace elastocheck::reference::certificate
