// Dual numbers x + dx ε, ε² = 0: a value with its first derivative, also as entries of Eigen's
// vectors.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace elastocheck::compare {

struct Dual {
    double x = 0, dx = 0;
    Dual() = default;
    Dual(double value, double derivative = 0) : x(value), dx(derivative) {}  // NOLINT: a number

    friend Dual operator-(const Dual& a) { return {-a.x, -a.dx}; }
    friend Dual operator+(const Dual& a, const Dual& b) { return {a.x + b.x, a.dx + b.dx}; }
    friend Dual operator-(const Dual& a, const Dual& b) { return {a.x - b.x, a.dx - b.dx}; }
    friend Dual operator*(const Dual& a, const Dual& b) {
        return {a.x * b.x, a.dx * b.x + a.x * b.dx};
    }
    friend Dual operator/(const Dual& a, const Dual& b) {
        return {a.x / b.x, (a.dx - a.x / b.x * b.dx) / b.x};
    }
    Dual& operator+=(const Dual& b) { return *this = *this + b; }
    Dual& operator-=(const Dual& b) { return *this = *this - b; }
    Dual& operator*=(const Dual& b) { return *this = *this * b; }
    Dual& operator/=(const Dual& b) { return *this = *this / b; }
    friend auto operator<=>(const Dual& a, const Dual& b) { return a.x <=> b.x; }
    friend bool operator==(const Dual& a, const Dual& b) { return a.x == b.x; }
};

inline double value_of(double a) { return a; }
inline double value_of(const Dual& a) { return a.x; }

inline Dual abs(const Dual& a) { return a.x < 0 ? -a : a; }
inline Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.x);
    return {root, a.dx / (2 * root)};
}
inline Dual tan(const Dual& a) {
    const double t = std::tan(a.x);
    return {t, a.dx * (1 + t * t)};
}
inline Dual asin(const Dual& a) { return {std::asin(a.x), a.dx / std::sqrt(1 - a.x * a.x)}; }
inline Dual atan(const Dual& a) { return {std::atan(a.x), a.dx / (1 + a.x * a.x)}; }
inline Dual atan2(const Dual& y, const Dual& x) {
    return {std::atan2(y.x, x.x), (x.x * y.dx - y.x * x.dx) / (x.x * x.x + y.x * y.x)};
}

}  // namespace elastocheck::compare

template <>
struct Eigen::NumTraits<elastocheck::compare::Dual> : Eigen::GenericNumTraits<double> {
    using Real = elastocheck::compare::Dual;
    using NonInteger = elastocheck::compare::Dual;
    using Nested = elastocheck::compare::Dual;
    using Literal = elastocheck::compare::Dual;
    enum { RequireInitialization = 1 };
};
