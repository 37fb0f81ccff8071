#include "reference/energy/constraints/quadratic.hpp"
#include "models/eigen/dense.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double above = 100;      // ρ over the largest stiffness
constexpr int refinements = 40;    // largest number of corrections of a minimum x
constexpr double refined = 1e-10;  // |last correction| / |x|
constexpr int known_modes = 6;     // and as many again that only speed up the iteration
constexpr int subspaces = 60;      // largest number of subspace iterations
constexpr int closings = 3;        // number of projections onto the constraints
constexpr double settled = 1e-3;   // |last change of a stiffness| / stiffness

// Unit vectors with entries of any sign, the same at every call.
VectorXd any_direction(Eigen::Index n, Eigen::Index which) {
    VectorXd v(n);
    for (Eigen::Index i = 0; i < n; ++i)
        v[i] = std::sin(1.0 + static_cast<double>((i + 1) * (which + 2)) * 1.618 +
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
    rho_ = above * std::max(1.0, largest(H_.diagonal()));
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
    for (int i = 0; i < refinements; ++i) {
        remove_idle(r);
        VectorXd dx = factor_.solve(VectorXd(r + rho_ * (J_.transpose() * c)));
        remove_idle(dx);
        const double size = largest(dx);
        if (!(size < last)) break;  // rounding, or a motion that nothing resists
        result.x += dx;
        result.lambda += rho_ * (J_ * dx - c);
        if (size <= refined * largest(result.x)) break;
        last = size;
        r = -b - gradient(result.x) - J_.transpose() * result.lambda;
        c = gap - J_ * result.x;
    }
    return result;
}

// The eigenvectors X of S violate the constraints slightly, which falsifies the stiffness of soft
// modes: X ← X - S⁻¹ ρ JᵀJ X moves them onto the constraints at the least cost of energy.
MatrixXd Quadratic::onto_constraints(MatrixXd X) const {
    for (int i = 0; i < closings; ++i)
        X -= factor_.solve(MatrixXd(rho_ * (J_.transpose() * (J_ * X))));
    return orthonormal(X);
}

Modes Quadratic::softest(const Modes& near) const {
    const Eigen::Index n = H_.rows();
    Modes modes{.Z = {}, .stiffness = {}, .idle_limit = mu_};
    const auto falling = (factor_.vectorD().array() < 0).count();
    for (Eigen::Index known = std::min<Eigen::Index>(n, std::max(known_modes, near.count()));;
         known = std::min(n, 2 * known)) {
        const Eigen::Index iterated = std::min(n, 2 * known);
        MatrixXd X(n, iterated);
        for (Eigen::Index i = 0; i < iterated; ++i)
            X.col(i) = i < near.Z.cols() ? VectorXd(near.Z.col(i)) : any_direction(n, i);
        VectorXd w = VectorXd::Constant(known, std::numeric_limits<double>::infinity()), before;
        for (int i = 0; i < subspaces; ++i) {
            before = w;
            const MatrixXd Q = orthonormal(factor_.solve(X)), J_Q = J_ * Q;
            MatrixXd reduced = transposed_product(Q, H_ * Q);
            reduced += rho_ * transposed_product(J_Q, J_Q);
            const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(reduced);
            X = matrix_product(Q, eigen.eigenvectors());
            w = eigen.eigenvalues().head(known);
            if (((w - before).array().abs() <= settled * w.array().abs() + mu_).all()) break;
        }
        const MatrixXd Q = onto_constraints(X.leftCols(known));
        const MatrixXd reduced = transposed_product(Q, H_ * Q);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(reduced);
        modes.Z = matrix_product(Q, eigen.eigenvectors());
        modes.stiffness = eigen.eigenvalues();
        modes.other_falling_modes = static_cast<int>(falling - (w.array() < 0).count());
        if (known == n || !modes.idle(static_cast<int>(known) - 1)) return modes;
    }
}

}  // namespace elastocheck::reference::energy
