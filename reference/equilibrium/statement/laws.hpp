// Forces ∂u/∂x and ∂u/∂e of the elastic laws of mechanism.hpp, for double and for Ceres Jets; each
// law once, independent of the geometry.
#pragma once

#include <algorithm>
#include <array>

#include "elastocheck/mechanism.hpp"
#include "models/kinds.hpp"
#include "reference/equilibrium/statement/rotations.hpp"

namespace elastocheck::reference::equilibrium {

template <class T>
using Vec6 = Eigen::Matrix<T, 6, 1>;

// Piece of its curve for each deformation of an element (a spring has only the first), or
// `by_itself`: the piece that contains x. A given piece is extrapolated past its knots by its
// tangent: as a polynomial, a short steep piece would fall again just outside the knot at
// which it rises.
inline constexpr int by_itself = -1;
using ElementPieces = std::array<int, 6>;
inline constexpr ElementPieces all_by_themselves = {by_itself, by_itself, by_itself,
                                                    by_itself, by_itself, by_itself};

// Piece 0 before the first knot, piece k from knot k - 1 on.
template <class T>
int piece_at(const Curve& curve, const T& x) {
    const auto behind = std::ranges::find_if(curve.knots, [&](double knot) { return x < knot; });
    return static_cast<int>(behind - curve.knots.begin());
}

// du/dx [N] at the deformation x [m]
template <class T>
T gradient(const ScalarLaw& law, const T& x, int piece = by_itself) {
    return std::visit(
        overloaded{[&](const LinearRate& u) { return T(u.k * x); },
                   [&](const Curve& u) {
                       const int k = piece == by_itself ? piece_at(u, x) : piece;
                       const auto& c = u.pieces[static_cast<std::size_t>(k)];
                       const auto knot = [&](int n) {
                           return u.knots[static_cast<std::size_t>(n)];
                       };
                       const bool before = k > 0 && x < knot(k - 1),
                                  past = k < static_cast<int>(u.knots.size()) && x > knot(k);
                       const T on = before ? T(knot(k - 1)) : past ? T(knot(k)) : x;
                       const T h = on - knot(std::max(k - 1, 0));
                       const T f = c[0] + h * (c[1] + h * (c[2] + h * c[3]));
                       if (!before && !past) return f;
                       return T(f + (c[1] + h * (2. * c[2] + h * (3. * c[3]))) * (x - on));
                   }},
        law);
}

// ∂u/∂e (force [N], moment [N·m]) at the deformation e = (d [m], θ [rad])
template <class T>
Vec6<T> gradient(const SpatialLaw& law, const Vec6<T>& e,
                 const ElementPieces& pieces = all_by_themselves) {
    return std::visit(overloaded{[&](const LinearStiffness& u) {
                                     Vec6<T> g = Vec6<T>::Constant(T(0.0));
                                     for (int row = 0; row < 6; ++row)
                                         for (int col = 0; col < 6; ++col)
                                             if (u.K(row, col) != 0)
                                                 g[row] += u.K(row, col) * e[col];
                                     return g;
                                 },
                                 [&](const PerAxis& u) {
                                     Vec6<T> g;
                                     for (std::size_t k = 0; k < 6; ++k)
                                         g[static_cast<int>(k)] =
                                             gradient(u.axis[k], e[static_cast<int>(k)], pieces[k]);
                                     return g;
                                 }},
                      law);
}

// The largest |d²u/dx²| anywhere: within a cubic piece f' is a parabola, largest at an end or at
// its vertex.
inline double steepest(const ScalarLaw& law) {
    const auto over = [](const std::array<double, 4>& c, double width) {
        const auto slope = [&](double h) { return std::abs(c[1] + h * (2 * c[2] + h * 3 * c[3])); };
        const double vertex = c[3] != 0 ? -c[2] / (3 * c[3]) : 0;
        return std::max({slope(0), slope(width), vertex > 0 && vertex < width ? slope(vertex) : 0});
    };
    return std::visit(
        overloaded{[](const LinearRate& u) { return u.k; },
                   [&](const Curve& u) {
                       double k = std::max(over(u.pieces.front(), 0), over(u.pieces.back(), 0));
                       for (std::size_t n = 1; n < u.knots.size(); ++n)
                           k = std::max(k, over(u.pieces[n], u.knots[n] - u.knots[n - 1]));
                       return k;
                   }},
        law);
}

// Whether u depends on x.
inline bool resists(const ScalarLaw& law) {
    const auto vanishes = [](const std::array<double, 4>& c) {
        return std::ranges::all_of(c, [](double c_n) { return c_n == 0; });
    };
    return std::visit(
        overloaded{[](const LinearRate& u) { return u.k != 0; },
                   [&](const Curve& u) { return !std::ranges::all_of(u.pieces, vanishes); }},
        law);
}

// Whether u depends on θ.
inline bool resists_rotation(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) {
                                     return !(u.K.bottomRows<3>().isZero(0) &&
                                              u.K.topRightCorner<3, 3>().isZero(0));
                                 },
                                 [](const PerAxis& u) {
                                     return std::any_of(u.axis.begin() + 3, u.axis.end(), resists);
                                 }},
                      law);
}

// ∂u/∂x of the law of an element: of a spring in the first entry.
template <class T>
Vec6<T> forces(const ElasticKind& element, const Vec6<T>& x,
               const ElementPieces& pieces = all_by_themselves) {
    Vec6<T> f = Vec6<T>::Constant(T(0.0));
    each_member(element,
                overloaded{[&](const ScalarLaw& law) { f[0] = gradient(law, x[0], pieces[0]); },
                           [&](const SpatialLaw& law) { f = gradient(law, x, pieces); }});
    return f;
}

}  // namespace elastocheck::reference::equilibrium
