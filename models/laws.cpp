#include "models/laws.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/kinds.hpp"

namespace elastocheck {
namespace {

using std::pow;

using Cubic = std::array<double, 4>;  // c_0 + c_1 x + c_2 x² + c_3 x³

// The cubic c about a, re-expanded about a + h.
Cubic shifted(const Cubic& c, double h) {
    return {c[0] + h * (c[1] + h * (c[2] + h * c[3])), c[1] + h * (2 * c[2] + h * 3 * c[3]),
            c[2] + 3 * h * c[3], c[3]};
}
// -f(-x) of a cubic in x.
Cubic reversed(const Cubic& c) { return {-c[0], c[1], -c[2], c[3]}; }

}  // namespace

double force(const ScalarLaw& law, double x) {
    const auto value = [&](const Curve& curve) {
        const auto piece = std::ranges::upper_bound(curve.knots, x) - curve.knots.begin();
        const Cubic& c = curve.pieces[static_cast<std::size_t>(piece)];
        const double t =
            x - curve.knots[static_cast<std::size_t>(std::max<std::ptrdiff_t>(piece - 1, 0))];
        return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    };
    return std::visit(overloaded{[&](const LinearRate& u) { return u.k * x; }, value}, law);
}

Curve reversed(const Curve& curve) {
    const std::size_t n = curve.knots.size();
    Curve result = curve;
    std::ranges::transform(curve.knots, result.knots.rbegin(), [](double x) { return -x; });
    result.pieces.front() = reversed(curve.pieces.back());
    result.pieces.back() = reversed(curve.pieces.front());
    // A piece between two knots is a polynomial about its left knot; the left one after the reversal
    // is the right one before.
    for (std::size_t k = 1; k < n; ++k)
        result.pieces[n - k] =
            reversed(shifted(curve.pieces[k], curve.knots[k] - curve.knots[k - 1]));
    return result;
}

ScalarLaw reversed(const ScalarLaw& law) {
    return std::visit(overloaded{[](const LinearRate& u) -> ScalarLaw { return u; },
                                 [](const Curve& u) -> ScalarLaw { return reversed(u); }},
                      law);
}

bool is_zero(const ScalarLaw& law) {
    const auto vanishes = [](const Cubic& c) {
        return std::ranges::all_of(c, [](double c_n) { return c_n == 0; });
    };
    return std::visit(
        overloaded{[](const LinearRate& u) { return u.k == 0; },
                   [&](const Curve& u) { return std::ranges::all_of(u.pieces, vanishes); }},
        law);
}
bool is_zero(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) { return u.K.isZero(0); },
                                 [](const PerAxis& u) {
                                     return std::ranges::all_of(
                                         u.axis, [](const ScalarLaw& l) { return is_zero(l); });
                                 }},
                      law);
}

SpatialLaw with_signs(const SpatialLaw& law, const Vector6& signs) {
    return std::visit(overloaded{[&](LinearStiffness u) -> SpatialLaw {
                                     for (int i = 0; i < 6; ++i)
                                         for (int j = 0; j < 6; ++j)
                                             if (signs[i] * signs[j] < 0)
                                                 u.K(i, j) = 0 - u.K(i, j);  // 0, not -0, for 0
                                     return u;
                                 },
                                 [&](PerAxis u) -> SpatialLaw {
                                     for (int k = 0; k < 6; ++k) {
                                         ScalarLaw& axis = u.axis[static_cast<std::size_t>(k)];
                                         if (signs[k] < 0) axis = reversed(axis);
                                     }
                                     return u;
                                 }},
                      law);
}

ScalarLaw scaled(const ScalarLaw& law, double stretch, double force) {
    return std::visit(overloaded{[&](LinearRate rate) -> ScalarLaw {
                                     rate.k *= force / stretch;
                                     return rate;
                                 },
                                 [&](Curve curve) -> ScalarLaw {
                                     for (double& knot : curve.knots) knot *= stretch;
                                     for (auto& piece : curve.pieces)
                                         for (int n = 0; n < 4; ++n)
                                             piece[static_cast<std::size_t>(n)] *=
                                                 force / pow(stretch, n);
                                     return curve;
                                 }},
                      law);
}

SpatialLaw scaled(const SpatialLaw& law, const Vector6& stretch, const Vector6& force) {
    return std::visit(overloaded{[&](LinearStiffness linear) -> SpatialLaw {
                                     const Vector6 root = force.cwiseQuotient(stretch).cwiseSqrt();
                                     linear.K = root.asDiagonal() * linear.K * root.asDiagonal();
                                     return linear;
                                 },
                                 [&](PerAxis axes) -> SpatialLaw {
                                     for (int k = 0; k < 6; ++k) {
                                         auto& u = axes.axis[static_cast<std::size_t>(k)];
                                         u = scaled(u, stretch[k], force[k]);
                                     }
                                     return axes;
                                 }},
                      law);
}

Bushing markers_swapped(const Bushing& bushing) {
    Bushing result = bushing;
    std::swap(result.i, result.j);
    result.law = with_signs(bushing.law, -Vector6::Ones());
    result.preload = -bushing.preload;
    result.undeformed = -bushing.undeformed;
    using Frame = Formulation::Frame;
    if (bushing.formulation.frame == Frame::on_i) result.formulation.frame = Frame::on_j;
    if (bushing.formulation.frame == Frame::on_j) result.formulation.frame = Frame::on_i;
    return result;
}

}  // namespace elastocheck
