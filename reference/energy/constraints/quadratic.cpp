#include "reference/energy/constraints/quadratic.hpp"
#include "models/eigen/dense.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double penalty = 100;  // ρ over the largest stiffness
// corrections of a minimum x: their largest number, and |last correction| / |x|
constexpr int max_refinements = 40;
constexpr double correction_tolerance = 1e-10;
// modes that are iterated at first; as many again only speed up the iteration
constexpr int first_modes = 6;
// subspace iterations: their largest number, and |last change of a stiffness| / stiffness
constexpr int max_subspaces = 60;
constexpr double stiffness_tolerance = 1e-3;
constexpr int constraint_projections = 3;

// Generic start vector `index` of the subspace iteration: entries of any sign, the same at every
// call, of norm one.
VectorXd start_vector(Eigen::Index n, Eigen::Index index) {
    VectorXd v(n);
    for (Eigen::Index i = 0; i < n; ++i)
        v[i] = std::sin(1.0 + static_cast<double>((i + 1) * (index + 2)) * 1.618 +
                        static_cast<double>(i * i % 97));
    return v.normalized();
}

MatrixXd orthonormal(const MatrixXd& X) {
    const Eigen::HouseholderQR<MatrixXd> qr(X);
    return times_matrix(qr.householderQ(), MatrixXd::Identity(X.rows(), X.cols()));
}

}  // namespace

bool is_large(const Model& model) { return coordinates(model) > dense_coordinates; }

Quadratic::Quadratic(const Blocks& H, const Blocks& A, const Jacobian& J)
    : H_(H.sparse()), A_(A.sparse()), J_(sparse_transposed(J).transpose()) {
    stiffness_ = H_.cwiseAbs() * VectorXd::Ones(H_.cols());
    rho_ = penalty * std::max(1.0, largest(H_.diagonal()));
    mu_ = idle_limit(rho_);
    const Sparse J_t = J_.transpose();
    factor_.setShift(mu_);
    factor_.compute(H_ + rho_ * Sparse(J_t * J_));
}

Quadratic::Minimum Quadratic::minimum(const VectorXd& b, const VectorXd& Phi,
                                      const MatrixXd& idle) const {
    // One inverse iteration turns the idle motions of a nearby pose into those of this pose.
    const MatrixXd Z = idle.cols() > 0 ? orthonormal(factor_.solve(idle)) : idle;
    const auto remove_idle = [&](VectorXd& x) { x -= Z * (Z.transpose() * x).eval(); };
    const VectorXd gap = Phi.size() > 0 ? VectorXd(-Phi) : VectorXd::Zero(J_.rows());
    Minimum result{.x = VectorXd::Zero(H_.rows()), .lambda = VectorXd::Zero(J_.rows())};
    VectorXd r = -b, c = gap;
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < max_refinements; ++i) {
        remove_idle(r);
        VectorXd dx = factor_.solve(VectorXd(r + rho_ * (J_.transpose() * c)));
        remove_idle(dx);
        const double size = largest(dx);
        if (!(size < last)) break;  // rounding, or a motion that nothing resists
        result.x += dx;
        result.lambda += rho_ * (J_ * dx - c);
        if (size <= correction_tolerance * largest(result.x)) break;
        last = size;
        r = -b - gradient(result.x) - J_.transpose() * result.lambda;
        c = gap - J_ * result.x;
    }
    return result;
}

// The eigenvectors X of S violate the constraints slightly, which falsifies the stiffness of soft
// modes: X ← X - S⁻¹ ρ JᵀJ X moves them onto the constraints at the least cost of energy.
MatrixXd Quadratic::onto_constraints(MatrixXd X) const {
    for (int i = 0; i < constraint_projections; ++i)
        X -= factor_.solve(MatrixXd(rho_ * (J_.transpose() * (J_ * X))));
    return orthonormal(X);
}

Modes Quadratic::softest(const Modes& near) const {
    const Eigen::Index n = H_.rows();
    Modes modes{.Z = {}, .stiffness = {}, .idle_limit = mu_};
    const auto negative_pivots = (factor_.vectorD().array() < 0).count();
    for (Eigen::Index wanted = std::min<Eigen::Index>(n, std::max(first_modes, near.count()));;
         wanted = std::min(n, 2 * wanted)) {
        const Eigen::Index iterated = std::min(n, 2 * wanted);
        MatrixXd X(n, iterated);
        for (Eigen::Index i = 0; i < iterated; ++i)
            X.col(i) = i < near.Z.cols() ? VectorXd(near.Z.col(i)) : start_vector(n, i);
        // Subspace iteration with S⁻¹: Ritz vectors X and Ritz values w of H + ρ JᵀJ.
        VectorXd w = VectorXd::Constant(wanted, std::numeric_limits<double>::infinity()), last_w;
        for (int i = 0; i < max_subspaces; ++i) {
            last_w = w;
            const MatrixXd Q = orthonormal(factor_.solve(X)), J_Q = J_ * Q;
            MatrixXd reduced = transposed_product(Q, H_ * Q);
            reduced += rho_ * transposed_product(J_Q, J_Q);
            const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(reduced);
            X = matrix_product(Q, eigen.eigenvectors());
            w = eigen.eigenvalues().head(wanted);
            if (((w - last_w).array().abs() <= stiffness_tolerance * w.array().abs() + mu_).all())
                break;
        }
        const MatrixXd Q = onto_constraints(X.leftCols(wanted));
        const MatrixXd reduced = transposed_product(Q, H_ * Q);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(reduced);
        modes.Z = matrix_product(Q, eigen.eigenvectors());
        modes.stiffness = eigen.eigenvalues();
        modes.other_falling_modes = static_cast<int>(negative_pivots - (w.array() < 0).count());
        if (wanted == n || !modes.idle(static_cast<int>(wanted) - 1)) return modes;
    }
}

}  // namespace elastocheck::reference::energy
