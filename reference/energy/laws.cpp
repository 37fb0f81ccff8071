#include "reference/energy/laws.hpp"

#include "reference/energy/overloaded.hpp"

namespace elastocheck::reference::energy {
namespace {

// u = ½ xᵀ K x:  u - u_c = δᵀ (K x_c + ½ K δ)
template <int N>
LawValues<N> quadratic(const Eigen::Matrix<double, N, N>& K, const Eigen::Matrix<double, N, 1>& x_c,
                       const Eigen::Matrix<double, N, 1>& delta) {
    const Eigen::Matrix<double, N, 1> K_delta = K * delta, stress_c = K * x_c;
    return {delta.dot(stress_c + 0.5 * K_delta), stress_c, stress_c + K_delta, K};
}

}  // namespace

LawValues<1> values(const ScalarLaw& law, const Vector1& x_c, const Vector1& delta) {
    return std::visit(overloaded{[&](const LinearRate& u) { return quadratic<1>(Vector1(u.k), x_c, delta); }},
                      law);
}

LawValues<6> values(const SpatialLaw& law, const Vector6& x_c, const Vector6& delta) {
    return std::visit(overloaded{[&](const LinearStiffness& u) { return quadratic<6>(u.K, x_c, delta); }},
                      law);
}

bool resists_rotation(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) { return !u.K.bottomRows<3>().isZero(0); }},
                      law);
}

}  // namespace elastocheck::reference::energy
