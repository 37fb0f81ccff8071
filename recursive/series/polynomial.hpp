// Polynomials in τ: value, slope, first change of sign.
#pragma once

#include <optional>

#include "recursive/formula/state.hpp"

namespace elastocheck::recursive::series {

inline double polynomial(const Eigen::VectorXd& c, double tau) {
    double value = 0;
    for (Eigen::Index k = c.size(); k-- > 0;) value = value * tau + c[k];
    return value;
}

inline double slope(const Eigen::VectorXd& c, double tau) {
    double value = 0;
    for (Eigen::Index k = c.size(); k-- > 1;) value = value * tau + static_cast<double>(k) * c[k];
    return value;
}

// Bisection: τ in [from, to] where f changes sign, to the last bit. Pre: f(from) and f(to) differ
// in sign.
template <class Function>
double bisect(Function f, double from, double to) {
    const bool below = f(from) < 0;
    for (int k = 0; k < 200 && from != to; ++k) {
        const double middle = from + (to - from) / 2;
        if (middle == from || middle == to) break;
        ((f(middle) < 0) == below ? from : to) = middle;
    }
    return to;
}

// First τ in (0, reach] at which f changes its sign, sampled at `pieces` intervals.
template <class Function>
std::optional<double> first_zero(Function f, double reach) {
    constexpr int pieces = 64;
    double from = 0, at = f(0);
    for (int k = 1; k <= pieces; ++k) {
        const double to = reach * k / pieces, value = f(to);
        if (value == 0) return to;
        if (at != 0 && (value < 0) != (at < 0)) return bisect(f, from, to);
        from = to;
        at = value;
    }
    return std::nullopt;
}

// x'(τ) of the polynomial with the columns c.
inline Vector<double> derivative(const Eigen::Ref<const Eigen::MatrixXd>& c, double tau) {
    Vector<double> d = Vector<double>::Zero(c.rows());
    for (Eigen::Index k = c.cols() - 1; k >= 1; --k) {
        d *= tau;
        d += static_cast<double>(k) * c.col(k);
    }
    return d;
}

}  // namespace elastocheck::recursive::series
