// Number types of the equations: doubles and intervals, and of either
//
//   Dual<S, N>   v + Σ d_k ε_k: a value with its N derivatives
//   Jet<n>       Σ c_k sᵏ, k = 0 ... n, of intervals: Taylor coefficients in s along a curve
//
// and jets with derivatives, Dual<Jet<n>, N>. `composed` applies a function of one variable to any
// of them from its Taylor coefficients over an interval, f⁽ʲ⁾(X)/j!.
#pragma once

#include <array>
#include <bit>
#include <type_traits>

#include "reference/certificate/interval/interval.hpp"

namespace elastocheck::reference::certificate {

template <class S, int N>
struct Dual {
    S v{};
    std::array<S, static_cast<std::size_t>(N)> d{};
    unsigned has = 0;  // bit k: d_k may be other than zero
    void set(std::size_t k, const S& slope) {
        d.at(k) = slope;
        has |= 1U << k;
    }
    // f(k) for the derivatives that may be other than zero
    template <class F>
    void each(const F& f) const {
        for (unsigned rest = has; rest != 0; rest &= rest - 1)
            f(static_cast<std::size_t>(std::countr_zero(rest)));
    }
};

template <int n>
struct Jet {
    std::array<Interval, static_cast<std::size_t>(n) + 1> c{};
};

// Type of constants, and number of derivatives of a function that are needed.
template <class T>
struct Kind {
    using Base = T;  // double, Interval
    static constexpr int order = 0;
};
template <int n>
struct Kind<Jet<n>> {
    using Base = Interval;
    static constexpr int order = n;
};
template <class S, int N>
struct Kind<Dual<S, N>> {
    using Base = typename Kind<S>::Base;
    static constexpr int order = Kind<S>::order + 1;
};
template <class T>
using Base = typename Kind<T>::Base;
template <class T>
inline constexpr int order = Kind<T>::order;
// f⁽ʲ⁾/j!, j = 0 ... order
template <class T>
using Expansion = std::array<Base<T>, static_cast<std::size_t>(order<T>) + 1>;

// ---- Common functions: value, constant, square, root

inline Interval range(double x) { return x; }
inline const Interval& range(const Interval& x) { return x; }
template <int n>
const Interval& range(const Jet<n>& x) {
    return x.c[0];
}
template <class S, int N>
Interval range(const Dual<S, N>& x) {
    return range(x.v);
}

template <class T>
T constant(const Interval& x) {
    if constexpr (std::is_same_v<T, double>)
        return mid(x);
    else if constexpr (std::is_same_v<T, Interval>)
        return x;
    else if constexpr (std::is_same_v<T, Jet<order<T>>>) {
        T jet;
        jet.c[0] = x;
        return jet;
    } else {
        T dual;
        dual.v = constant<decltype(dual.v)>(x);
        return dual;
    }
}
// Value of a function outside its domain: NaN, or the whole line.
template <class T>
T undefined() {
    if constexpr (std::is_same_v<T, double>)
        return std::numeric_limits<double>::quiet_NaN();
    else
        return constant<T>(everything);
}

inline double sqr(double x) { return x * x; }
inline bool is_zero(double x) { return x == 0; }

// ---- Jets

template <int n>
bool is_zero(const Jet<n>& a) {
    return std::ranges::all_of(a.c, [](const Interval& c) { return is_zero(c); });
}
template <int n>
Jet<n> operator-(const Jet<n>& a) {
    Jet<n> r;
    for (std::size_t k = 0; k < a.c.size(); ++k) r.c[k] = -a.c[k];
    return r;
}
template <int n>
Jet<n> operator+(const Jet<n>& a, const Jet<n>& b) {
    Jet<n> r;
    for (std::size_t k = 0; k < a.c.size(); ++k) r.c[k] = a.c[k] + b.c[k];
    return r;
}
template <int n>
Jet<n> operator-(const Jet<n>& a, const Jet<n>& b) {
    return a + -b;
}
template <int n>
Jet<n> operator*(const Jet<n>& a, const Jet<n>& b) {
    Jet<n> r;
    for (std::size_t k = 0; k < r.c.size(); ++k)
        for (std::size_t i = 0; i <= k; ++i) r.c[k] += a.c[i] * b.c[k - i];
    return r;
}
// q b = a
template <int n>
Jet<n> operator/(const Jet<n>& a, const Jet<n>& b) {
    Jet<n> q;
    for (std::size_t k = 0; k < q.c.size(); ++k) {
        Interval rest = a.c[k];
        for (std::size_t i = 1; i <= k; ++i) rest -= b.c[i] * q.c[k - i];
        q.c[k] = rest / b.c[0];
    }
    return q;
}
template <int n>
Jet<n> sqr(const Jet<n>& a) {
    Jet<n> r = a * a;
    r.c[0] = sqr(a.c[0]);
    return r;
}
// r r = a
template <int n>
Jet<n> sqrt(const Jet<n>& a) {
    Jet<n> r;
    r.c[0] = sqrt(a.c[0]);
    for (std::size_t k = 1; k < r.c.size(); ++k) {
        Interval rest = a.c[k];
        for (std::size_t i = 1; i < k; ++i) rest -= r.c[i] * r.c[k - i];
        r.c[k] = rest / (Interval(2) * r.c[0]);
    }
    return r;
}
template <int n>
Jet<n> operator+(Jet<n> a, const Interval& b) {
    a.c[0] += b;
    return a;
}
template <int n>
Jet<n> operator-(const Jet<n>& a, const Interval& b) {
    return a + -b;
}
template <int n>
Jet<n> operator*(Jet<n> a, const Interval& b) {
    for (Interval& c : a.c) c *= b;
    return a;
}

// along_curve: the range of x(s) for |s| ≤ 1. take_radius: replaces the coefficients of x by their
// middles and returns the sum of their radii. Neither includes the last coefficient of a jet.
inline Interval along_curve(const Interval& x) { return x; }
inline double take_radius(Interval& x) {
    const double radius = rad(x);
    x = mid(x);
    return radius;
}
template <int n>
Interval along_curve(const Jet<n>& x) {
    Interval sum = x.c[0];
    for (std::size_t k = 1; k + 1 < x.c.size(); ++k) sum += x.c[k] * Interval(-1, 1);
    return sum;
}
template <int n>
double take_radius(Jet<n>& x) {
    Interval sum;
    for (std::size_t k = 0; k + 1 < x.c.size(); ++k) sum += take_radius(x.c[k]);
    return sum.hi;
}

// ---- Duals. Zero derivatives are skipped: an element has two bodies and a point one.

template <class S, int N>
Dual<S, N> operator-(const Dual<S, N>& a) {
    Dual<S, N> r;
    r.v = -a.v, r.has = a.has;
    a.each([&](std::size_t k) { r.d[k] = -a.d[k]; });
    return r;
}
template <class S, int N>
Dual<S, N> operator+(const Dual<S, N>& a, const Dual<S, N>& b) {
    Dual<S, N> r = a;
    r.v = a.v + b.v, r.has |= b.has;
    b.each([&](std::size_t k) { r.d[k] = a.d[k] + b.d[k]; });
    return r;
}
template <class S, int N>
Dual<S, N> operator-(const Dual<S, N>& a, const Dual<S, N>& b) {
    Dual<S, N> r = a;
    r.v = a.v - b.v, r.has |= b.has;
    b.each([&](std::size_t k) { r.d[k] = a.d[k] - b.d[k]; });
    return r;
}
template <class S, int N>
Dual<S, N> operator*(const Dual<S, N>& a, const Dual<S, N>& b) {
    Dual<S, N> r;
    r.v = a.v * b.v, r.has = a.has | b.has;
    a.each([&](std::size_t k) { r.d[k] = a.d[k] * b.v; });
    b.each([&](std::size_t k) { r.d[k] = r.d[k] + a.v * b.d[k]; });
    return r;
}
template <class S, int N>
Dual<S, N> operator/(const Dual<S, N>& a, const Dual<S, N>& b) {
    Dual<S, N> r = a;
    r.v = a.v / b.v, r.has |= b.has;
    r.each([&](std::size_t k) { r.d[k] = (a.d[k] - r.v * b.d[k]) / b.v; });
    return r;
}
// A value with its slope by x.
template <class S, int N>
Dual<S, N> chained(const S& v, const S& slope, const Dual<S, N>& x) {
    Dual<S, N> r;
    r.v = v, r.has = x.has;
    x.each([&](std::size_t k) { r.d[k] = slope * x.d[k]; });
    return r;
}
template <class S, int N>
Dual<S, N> sqr(const Dual<S, N>& a) {
    return chained(sqr(a.v), a.v + a.v, a);
}
template <class S, int N>
Dual<S, N> sqrt(const Dual<S, N>& a) {
    using std::sqrt;
    Dual<S, N> r;
    r.v = sqrt(a.v), r.has = a.has;
    const S twice = r.v + r.v;
    a.each([&](std::size_t k) { r.d[k] = a.d[k] / twice; });
    return r;
}
// With a constant, of the type of the value or another.
template <class S, int N, class B>
requires(std::is_same_v<B, S> || std::is_same_v<B, Base<S>>) Dual<S, N>
operator+(Dual<S, N> a, const B& b) {
    a.v = a.v + b;
    return a;
}
template <class S, int N, class B>
requires(std::is_same_v<B, S> || std::is_same_v<B, Base<S>>) Dual<S, N>
operator-(Dual<S, N> a, const B& b) {
    a.v = a.v - b;
    return a;
}
template <class S, int N, class B>
requires(std::is_same_v<B, S> || std::is_same_v<B, Base<S>>) Dual<S, N>
operator*(Dual<S, N> a, const B& b) {
    a.v = a.v * b;
    a.each([&](std::size_t k) { a.d[k] = a.d[k] * b; });
    return a;
}

template <class T>
T& operator+=(T& a, const T& b) requires(!std::is_same_v<T, Base<T>>) {
    return a = a + b;
}

// ---- f(x) from f⁽ʲ⁾(X)/j!, j = 0 ... order<T>, where X contains the values of x

inline double composed(const double* f, const double&) { return f[0]; }
inline Interval composed(const Interval* f, const Interval&) { return f[0]; }
template <int n>
Jet<n> composed(const Interval* f, const Jet<n>& x) {
    Jet<n> step = x;
    step.c[0] = {};
    Jet<n> r = constant<Jet<n>>(f[n]);
    for (int j = n - 1; j >= 0; --j) r = r * step + f[j];
    return r;
}
template <class S, int N>
Dual<S, N> composed(const Base<S>* f, const Dual<S, N>& x) {
    std::array<Base<S>, static_cast<std::size_t>(order<S>) + 1> slope;
    for (std::size_t j = 0; j < slope.size(); ++j)
        slope[j] = f[j + 1] * Base<S>(static_cast<double>(j + 1));
    return chained(composed(f, x.v), composed(slope.data(), x.v), x);
}
template <class T>
T composed(const Expansion<T>& f, const T& x) {
    return composed(f.data(), x);
}

}  // namespace elastocheck::reference::certificate
