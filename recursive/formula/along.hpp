// Numbers with their first derivatives along N directions, x + d·η, η_k η_l = 0: Real of the
// formulas, to differentiate the tangent and number_rates.hpp along responses.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace elastocheck::recursive {

template <int N>
struct Along {
    using Derivatives = Eigen::Array<double, N, 1>;
    double x = 0;
    Derivatives d = Derivatives::Zero();

    Along() = default;
    Along(double value) : x(value) {}  // NOLINT: a number
    Along(double value, const Derivatives& derivatives) : x(value), d(derivatives) {}

    friend Along operator-(const Along& a) { return {-a.x, -a.d}; }
    friend Along operator+(const Along& a, const Along& b) { return {a.x + b.x, a.d + b.d}; }
    friend Along operator-(const Along& a, const Along& b) { return {a.x - b.x, a.d - b.d}; }
    friend Along operator*(const Along& a, const Along& b) {
        return {a.x * b.x, a.x * b.d + b.x * a.d};
    }
    friend Along operator/(const Along& a, const Along& b) {
        const double q = a.x / b.x;
        return {q, (a.d - q * b.d) / b.x};
    }
    Along& operator+=(const Along& b) { return *this = *this + b; }
    Along& operator-=(const Along& b) { return *this = *this - b; }
    Along& operator*=(const Along& b) { return *this = *this * b; }
    Along& operator/=(const Along& b) { return *this = *this / b; }
    friend auto operator<=>(const Along& a, const Along& b) { return a.x <=> b.x; }
    friend bool operator==(const Along& a, const Along& b) { return a.x == b.x; }
};

template <int N>
Along<N> sqrt(const Along<N>& a) {
    const double root = std::sqrt(a.x);
    return {root, a.d / (2 * root)};
}
template <int N>
Along<N> sin(const Along<N>& a) {
    return {std::sin(a.x), std::cos(a.x) * a.d};
}
template <int N>
Along<N> cos(const Along<N>& a) {
    return {std::cos(a.x), -std::sin(a.x) * a.d};
}
template <int N>
Along<N> tan(const Along<N>& a) {
    const double t = std::tan(a.x);
    return {t, (1 + t * t) * a.d};
}
template <int N>
Along<N> atan2(const Along<N>& y, const Along<N>& x) {
    return {std::atan2(y.x, x.x), (x.x * y.d - y.x * x.d) / (x.x * x.x + y.x * y.x)};
}
template <int N>
Along<N> hypot(const Along<N>& a, const Along<N>& b) {
    const double h = std::hypot(a.x, b.x);
    return {h, (a.x * a.d + b.x * b.d) / h};
}

}  // namespace elastocheck::recursive

template <int N>
struct Eigen::NumTraits<elastocheck::recursive::Along<N>> : Eigen::GenericNumTraits<double> {
    using Real = elastocheck::recursive::Along<N>;
    using NonInteger = Real;
    using Nested = Real;
    using Literal = Real;
    enum { RequireInitialization = 1 };
};
