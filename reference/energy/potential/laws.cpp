#include "reference/energy/potential/laws.hpp"

#include <algorithm>
#include <cmath>

#include "models/overloaded.hpp"

namespace elastocheck::reference::energy {
namespace {

// u = ½ xᵀ K x:  u - u_c = δᵀ (K x_c + ½ K δ)
template <int N>
LawValues<N> quadratic(const Eigen::Matrix<double, N, N>& K, const Eigen::Matrix<double, N, 1>& x_c,
                       const Eigen::Matrix<double, N, 1>& delta) {
    const Eigen::Matrix<double, N, 1> K_delta = K * delta, stress_c = K * x_c;
    return {delta.dot(stress_c + 0.5 * K_delta), stress_c, stress_c + K_delta, K};
}

// One piece of a curve,  f = c_0 + c_1 t + c_2 t² + c_3 t³,  t = x - its own knot.
struct Piece {
    const std::array<double, 4>& c;
    double knot;
    double end;  // t of the next knot; for the piece before the first knot, t of that knot: 0

    double force(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    double slope(double t) const { return c[1] + t * (2 * c[2] + t * 3 * c[3]); }
    // ∫ f from t to t + h, by the Taylor coefficients of f at t: each term is a power of
    // h, without cancellation.
    double work(double t, double h) const {
        return h *
               (force(t) + h * (slope(t) / 2 + h * ((c[2] + 3 * c[3] * t) / 3 + h * (c[3] / 4))));
    }
};

// k = 0 before the first knot, else after knot k - 1.
Piece piece(const Curve& curve, std::size_t k) {
    const auto& x = curve.knots;
    if (k == 0) return {curve.pieces[0], x[0], 0};
    return {curve.pieces[k], x[k - 1], k < x.size() ? x[k] - x[k - 1] : INFINITY};
}

// Integrates from x_c to x_c + δ piece by piece: the exact energy change across any knots, without
// a difference of two energies. A NaN ends the loop.
LawValues<1> integrated(const Curve& curve, double x_c, double delta) {
    const auto& x = curve.knots;
    std::size_t k = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), x_c) - x.begin());
    double t = x_c - piece(curve, k).knot, rest = delta;
    LawValues<1> u;
    u.stress_c << piece(curve, k).force(t);
    for (;;) {
        const Piece p = piece(curve, k);
        const bool beyond = rest > 0 && k < x.size() && t + rest >= p.end;
        const bool before = rest < 0 && k > 0 && t + rest < 0;
        if (!beyond && !before) {
            u.change += p.work(t, rest);
            u.stress << p.force(t + rest);
            u.stiffness << p.slope(t + rest);
            return u;
        }
        const double h = (beyond ? p.end : 0) - t;
        u.change += p.work(t, h);
        rest -= h;
        k = beyond ? k + 1 : k - 1;
        t = beyond ? 0 : piece(curve, k).end;
    }
}

bool resists(const ScalarLaw& law) {
    return std::visit(overloaded{[](const LinearRate& u) { return u.k != 0; },
                                 [](const Curve& u) {
                                     return std::ranges::any_of(u.pieces, [](const auto& c) {
                                         return std::ranges::any_of(
                                             c, [](double x) { return x != 0; });
                                     });
                                 }},
                      law);
}

}  // namespace

LawValues<1> values(const ScalarLaw& law, const Vector1& x_c, const Vector1& delta) {
    return std::visit(
        overloaded{[&](const LinearRate& u) { return quadratic<1>(Vector1(u.k), x_c, delta); },
                   [&](const Curve& u) { return integrated(u, x_c[0], delta[0]); }},
        law);
}

LawValues<6> values(const SpatialLaw& law, const Vector6& x_c, const Vector6& delta) {
    return std::visit(
        overloaded{[&](const LinearStiffness& u) { return quadratic<6>(u.K, x_c, delta); },
                   [&](const PerAxis& u) {
                       LawValues<6> all;
                       all.stiffness.setZero();
                       for (int k = 0; k < 6; ++k) {
                           const LawValues<1> axis = values(u.axis[static_cast<std::size_t>(k)],
                                                            Vector1(x_c[k]), Vector1(delta[k]));
                           all.change += axis.change;
                           all.stress_c[k] = axis.stress_c[0];
                           all.stress[k] = axis.stress[0];
                           all.stiffness(k, k) = axis.stiffness(0, 0);
                       }
                       return all;
                   }},
        law);
}

bool resists(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) { return !u.K.isZero(0); },
                                 [](const PerAxis& u) {
                                     return std::ranges::any_of(u.axis, [](const ScalarLaw& axis) {
                                         return resists(axis);
                                     });
                                 }},
                      law);
}

bool resists_rotation(const SpatialLaw& law) {
    return std::visit(
        overloaded{[](const LinearStiffness& u) { return !u.K.bottomRows<3>().isZero(0); },
                   [](const PerAxis& u) {
                       return std::any_of(u.axis.begin() + 3, u.axis.end(),
                                          [](const ScalarLaw& axis) { return resists(axis); });
                   }},
        law);
}

}  // namespace elastocheck::reference::energy
