// Forces f = ∂u/∂x of the elastic laws of mechanism.hpp.
#pragma once

#include "elastocheck/mechanism.hpp"
#include "reference/certificate/interval/numbers.hpp"

namespace elastocheck::reference::certificate {

// Taylor coefficients f⁽ʲ⁾(x)/j! of a curve. Where x contains a knot: the hull of the pieces'
// values and of their slopes, which contains every difference quotient of two points of x; second
// derivatives do not exist. Unbounded where x is outside a table without extrapolation.
void expand(const Curve& curve, const Interval& x, int count, Interval* f);
void expand(const Curve& curve, double x, int count, double* f);

// Whether x contains a knot.
bool spans_knot(const Curve& curve, const Interval& x);

template <class T>
T force(const ScalarLaw& law, const T& x) {
    if (const auto* rate = std::get_if<LinearRate>(&law)) return x * Base<T>(rate->k);
    const auto& curve = std::get<Curve>(law);
    Expansion<T> f;
    if constexpr (std::is_same_v<Base<T>, double>)
        expand(curve, mid(range(x)), static_cast<int>(f.size()), f.data());
    else
        expand(curve, range(x), static_cast<int>(f.size()), f.data());
    return composed(f, x);
}

// A zero law does not use its deformation, which may be undefined.
inline bool is_zero(const ScalarLaw& law) {
    const auto* rate = std::get_if<LinearRate>(&law);
    return rate != nullptr && rate->k == 0;
}

// ∂u/∂e of e = (d, θ), without the separated axes
template <class T>
std::array<T, 6> force(const SpatialLaw& law, const std::array<T, 6>& e,
                       const std::array<bool, 6>& separated) {
    std::array<T, 6> f;
    f.fill(constant<T>(0.));
    if (const auto* linear = std::get_if<LinearStiffness>(&law)) {
        for (int row = 0; row < 6; ++row)
            for (int col = 0; col < 6; ++col)
                if (linear->K(row, col) != 0)
                    f[static_cast<std::size_t>(row)] =
                        f[static_cast<std::size_t>(row)] +
                        e[static_cast<std::size_t>(col)] * Base<T>(linear->K(row, col));
        return f;
    }
    const auto& axis = std::get<PerAxis>(law).axis;
    for (std::size_t k = 0; k < 6; ++k)
        if (!is_zero(axis[k]) && !separated[k]) f[k] = force(axis[k], e[k]);
    return f;
}

}  // namespace elastocheck::reference::certificate
