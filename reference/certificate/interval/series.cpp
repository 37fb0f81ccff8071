#include "reference/certificate/interval/series.hpp"

namespace elastocheck::reference::certificate {
namespace {

constexpr int max_terms = 64;

template <class B>
struct Coefficients {
    std::array<B, max_terms + 1> turn, bend;
    Coefficients() {
        turn[0] = B(1.);
        for (std::size_t n = 0; n < turn.size(); ++n) {
            const auto k = static_cast<double>(n);
            if (n > 0) turn[n] = turn[n - 1] * B(2 * k) / B(2 * k + 1);
            bend[n] = turn[n] / B(2 * k + 3);
        }
    }
    const auto& of(Series series) const { return series == Series::turn ? turn : bend; }
};
template <class B>
const Coefficients<B>& coefficients() {
    static const Coefficients<B> all;
    return all;
}

double choose(int n, int j) {
    double c = 1;
    // an integer after each division, and far below 2⁵³
    for (int k = 1; k <= j; ++k) c = c * (n - j + k) / k;
    return c;
}

// Number of terms that makes the remainder less than rounding.
int terms(double x, int count) {
    int n = count + 2;
    for (double power = x * x; power > 1e-19 && n < max_terms; power *= x) ++n;
    return n;
}

// Σ κ_n C(n, j) xⁿ⁻ʲ, n = j ... N - 1
template <class B>
B partial(const std::array<B, max_terms + 1>& kappa, const B& x, int N, int j) {
    B sum = B(0.);
    for (int n = N - 1; n >= j; --n)
        sum = sum * x + kappa[static_cast<std::size_t>(n)] * B(choose(n, j));
    return sum;
}

Interval power(const Interval& x, int n) {
    Interval p = 1;
    for (int k = 0; k < n; ++k) p *= x;
    return p;
}

}  // namespace

void expand(Series series, double x, int count, double* f) {
    const auto& kappa = coefficients<double>().of(series);
    const int N = terms(std::abs(x), count);
    for (int j = 0; j < count; ++j) f[j] = partial(kappa, x, N, j);
}

void expand(Series series, const Interval& x, int count, Interval* f) {
    const auto& kappa = coefficients<Interval>().of(series);
    const double size = mag(x);
    const int N = size < 1 ? terms(size, count) : 0;
    for (int j = 0; j < count; ++j) {
        const Interval rho = Interval(size) * Interval(N + 1) / Interval(std::max(1, N + 1 - j));
        if (!(size < 1) || !(rho.hi < 1)) {
            f[j] = everything;
            continue;
        }
        const Interval omitted = kappa[static_cast<std::size_t>(N)] * Interval(choose(N, j)) *
                                 power(size, N - j) / (Interval(1) - rho);
        f[j] = partial(kappa, x, N, j) + Interval(-omitted.hi, omitted.hi);
    }
}

// x = k π/2 + y, then the series of both about 0: alternating with decreasing terms, so each
// remainder is less than the first omitted term.
CosSin cos_sin(const Interval& x) {
    // π/2 = 1.5707963267948966192313216916...
    const Interval half_pi{1.5707963267948965580, 1.5707963267948967800};
    if (!(mag(x) < 1e6)) return {everything, everything};
    const double k = std::nearbyint(mid(x) / half_pi.lo);
    const Interval y = x - Interval(k) * half_pi;
    if (!(mag(y) < 2)) return {{-1, 1}, {-1, 1}};
    constexpr int last = 28;  // 2²⁸ / 28! is below 1e-21
    const Interval y2 = sqr(y);
    Interval cosine = 1, sine = 1;
    for (int n = last - 2; n >= 2; n -= 2) {
        cosine = Interval(1) - y2 * cosine / Interval(n * (n - 1));
        sine = Interval(1) - y2 * sine / Interval(n * (n + 1));
    }
    // 28! = 3.0488...e29
    const Interval omitted = power(Interval(mag(y)), last) / Interval(3.0e29);
    const Interval error{-omitted.hi, omitted.hi};
    const Interval unit{-1, 1};
    cosine = intersection(cosine + error, unit);
    sine = intersection(y * sine + error, unit);
    switch (static_cast<long>(k) & 3) {
        case 0: return {cosine, sine};
        case 1: return {-sine, cosine};
        case 2: return {-cosine, -sine};
        default: return {sine, -cosine};
    }
}

}  // namespace elastocheck::reference::certificate
