#include "recursive/stepping/inertia.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace elastocheck::recursive {

bool has_energy(const Model& model, const Branch& branch) {
    return std::ranges::none_of(model.static_loads,
                                [&](const Load& load) { return is_follower(load.kind); }) &&
           std::ranges::none_of(branch.drivers,
                                [&](const Driver& driver) {
                                    const Load* load = driven_load(driver.what);
                                    return load != nullptr && is_follower(load->kind);
                                }) &&
           std::ranges::all_of(model.elastics, [](const auto& element) {
               const auto* formulation = member<Formulation>(element.kind);
               return formulation == nullptr || elastocheck::has_energy(*formulation);
           });
}

bool is_unstable(const Eigen::SparseMatrix<double>& saddle, const Eigen::VectorXd& weight,
                 const std::vector<int>& held) {
    using Sparse = Eigen::SparseMatrix<double>;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    // bound on |K - Kᵀ| / |K|: the residual asymmetry after Newton's method
    constexpr double symmetric = 1e-6;
    // ρ over the largest stiffness: too small leaves motions that the joints forbid negative, too
    // large hides K in round-off.
    constexpr double strengths[] = {1, 1e3, 1e6};
    const Eigen::Index n = weight.size(), m = saddle.rows() - n;
    const auto scale = weight.cwiseInverse().asDiagonal();
    const Sparse K = scale * Sparse(saddle.topLeftCorner(n, n)) * scale, K_T = K.transpose();
    const double stiffest = K.nonZeros() > 0 ? K.coeffs().abs().maxCoeff() : 0;
    if (!(stiffest > 0) || !K.coeffs().allFinite() || Sparse(K - K_T).norm() > symmetric * K.norm())
        return false;
    Sparse Phi = Sparse(saddle.bottomLeftCorner(m, n)) * scale, Phi_T = Phi.transpose();
    for (Eigen::Index row = 0; row < m; ++row)
        if (const double size = Phi_T.col(row).norm(); size > 0) Phi_T.col(row) /= size;
    const Sparse forbidden = Phi_T * Sparse(Phi_T.transpose());
    std::vector<Eigen::Triplet<double>> diagonal;
    for (const int k : held) diagonal.emplace_back(k, k, stiffest);
    Sparse held_too(n, n);
    held_too.setFromTriplets(diagonal.begin(), diagonal.end());
    Sparse one(n, n);
    one.setIdentity();
    const Sparse S = (K + K_T) / 2 + held_too;
    return std::ranges::all_of(strengths, [&](double rho) {
        const double rounding = 16 * epsilon * static_cast<double>(n) * rho;
        const Eigen::SimplicialLDLT<Sparse> factors(
            Sparse(S + rho * stiffest * forbidden + rounding * stiffest * one));
        return factors.info() == Eigen::Success && (factors.vectorD().array() < 0).any();
    });
}

}  // namespace elastocheck::recursive
