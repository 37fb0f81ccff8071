// Numbers with a mixed second derivative: along one direction p and N directions s.
//
//   x + p ε + s·η + ps·η ε,   ε² = 0, η_k η_l = 0
//
// For the derivative by a number (p) of the response to disturbances (s).
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace elastocheck::reference::equilibrium {

template <int N>
struct Mixed {
    using Along = Eigen::Array<double, N, 1>;
    double x = 0, p = 0;
    Along s = Along::Zero(), ps = Along::Zero();

    Mixed() = default;
    Mixed(double value) : x(value) {}  // NOLINT: a number

    friend Mixed operator-(const Mixed& a) { return {-a.x, -a.p, -a.s, -a.ps}; }
    friend Mixed operator+(const Mixed& a, const Mixed& b) {
        return {a.x + b.x, a.p + b.p, a.s + b.s, a.ps + b.ps};
    }
    friend Mixed operator-(const Mixed& a, const Mixed& b) {
        return {a.x - b.x, a.p - b.p, a.s - b.s, a.ps - b.ps};
    }
    friend Mixed operator*(const Mixed& a, const Mixed& b) {
        return {a.x * b.x, a.x * b.p + a.p * b.x, a.x * b.s + b.x * a.s,
                a.x * b.ps + b.x * a.ps + a.p * b.s + b.p * a.s};
    }
    friend Mixed operator*(double a, const Mixed& b) {
        return {a * b.x, a * b.p, a * b.s, a * b.ps};
    }
    friend Mixed operator*(const Mixed& a, double b) { return b * a; }
    friend Mixed operator/(const Mixed& a, const Mixed& b) {
        const double one = 1 / b.x;
        return a * b.with(one, -one * one, 2 * one * one * one);
    }
    Mixed& operator+=(const Mixed& b) { return *this = *this + b; }
    Mixed& operator-=(const Mixed& b) { return *this = *this - b; }
    Mixed& operator*=(const Mixed& b) { return *this = *this * b; }
    Mixed& operator/=(const Mixed& b) { return *this = *this / b; }
    friend auto operator<=>(const Mixed& a, const Mixed& b) { return a.x <=> b.x; }
    friend bool operator==(const Mixed& a, const Mixed& b) { return a.x == b.x; }

    // A function of this number, from its value f, slope df and curvature ddf.
    Mixed with(double f, double df, double ddf) const {
        return {f, df * p, df * s, df * ps + (ddf * p) * s};
    }

    Mixed(double value, double by_p, const Along& by_s, const Along& by_ps)
        : x(value), p(by_p), s(by_s), ps(by_ps) {}
};

template <int N>
Mixed<N> sqrt(const Mixed<N>& a) {
    const double root = std::sqrt(a.x);
    return a.with(root, 0.5 / root, -0.25 / (root * a.x));
}
template <int N>
Mixed<N> sin(const Mixed<N>& a) {
    const double s = std::sin(a.x);
    return a.with(s, std::cos(a.x), -s);
}
template <int N>
Mixed<N> cos(const Mixed<N>& a) {
    const double c = std::cos(a.x);
    return a.with(c, -std::sin(a.x), -c);
}
// The angle is that of y/x or of -x/y: whichever quotient is the smaller.
template <int N>
Mixed<N> atan2(const Mixed<N>& y, const Mixed<N>& x) {
    const bool flat = std::abs(y.x) <= std::abs(x.x);
    const Mixed<N> t = flat ? y / x : -(x / y);
    const double r = 1 / (1 + t.x * t.x);
    return t.with(std::atan2(y.x, x.x), r, -2 * t.x * r * r);
}

}  // namespace elastocheck::reference::equilibrium

template <int N>
struct Eigen::NumTraits<elastocheck::reference::equilibrium::Mixed<N>>
    : Eigen::GenericNumTraits<double> {
    using Real = elastocheck::reference::equilibrium::Mixed<N>;
    using NonInteger = Real;
    using Nested = Real;
    using Literal = Real;
    enum { RequireInitialization = 1 };
};
