// Enclosures of the power series of angles, and of sine and cosine: interval coefficients, with a
// truncation bound for each derivative.
#pragma once

#include "reference/certificate/interval/numbers.hpp"

namespace elastocheck::reference::certificate {

// With x = sin² φ
//
//   turn   φ / (sin φ cos φ)       = Σ κ_n xⁿ            κ_0 = 1,  κ_n = κ_n-1 · 2n / (2n + 1)
//   bend   (1 - φ cot φ) / sin² φ  = Σ κ_n / (2n + 3) xⁿ
//
// The first is y = asin √x / √(x (1-x)), with 2x (1-x) y' + (1 - 2x) y = 1; the second is
// (1 - (1-x) y) / x, and κ_n - κ_n+1 = κ_n / (2n + 3). All coefficients are positive and
// decreasing, so the remainder of the j-th derivative over j!, from the term N on, is
//
//   Σ κ_n C(n, j) xⁿ⁻ʲ  ≤  κ_N C(N, j) |x|ᴺ⁻ʲ / (1 - ρ),     ρ = |x| (N+1) / (N+1-j) < 1
enum class Series { turn, bend };

// f⁽ʲ⁾(x)/j!, j = 0 ... count - 1
void expand(Series series, const Interval& x, int count, Interval* f);
void expand(Series series, double x, int count, double* f);

template <class T>
T sum(Series series, const T& x) {
    Expansion<T> f;
    if constexpr (std::is_same_v<Base<T>, double>)
        expand(series, mid(range(x)), static_cast<int>(f.size()), f.data());
    else
        expand(series, range(x), static_cast<int>(f.size()), f.data());
    return composed(f, x);
}

// cos and sin of an angle [rad].
struct CosSin {
    Interval cos, sin;
};
CosSin cos_sin(const Interval& x);

template <class T>
struct Turned {
    T cos, sin;
};
// The derivatives are periodic: c, -s, -c, s.
template <class T>
Turned<T> cos_sin_of(const T& x) {
    using B = Base<T>;
    std::array<B, 2> at;
    if constexpr (std::is_same_v<B, double>) {
        at = {std::cos(mid(range(x))), std::sin(mid(range(x)))};
    } else {
        const CosSin of = cos_sin(range(x));
        at = {of.cos, of.sin};
    }
    const std::array<B, 4> round{at[0], -at[1], -at[0], at[1]};
    Expansion<T> c, s;
    B factorial = 1;
    for (std::size_t j = 0; j < c.size(); ++j) {
        if (j > 0) factorial = factorial * B(static_cast<double>(j));
        c[j] = round[j % 4] / factorial;
        s[j] = round[(j + 3) % 4] / factorial;
    }
    return {composed(c, x), composed(s, x)};
}

}  // namespace elastocheck::reference::certificate
