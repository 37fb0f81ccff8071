#include "reference/equilibrium/linearisation.hpp"

#include <Eigen/QR>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of the equilibrated matrix: what its QR with column pivoting has below this on its diagonal, over the largest,
// is null. Healthy models stay above 1e-6.
constexpr double null_threshold = 1e-11;

// Sweeps of the equilibration; each halves the logarithm of what the sizes are apart.
constexpr int equilibration_sweeps = 10;

// What a tracked mode may have as stiffness, over the largest entry of J, and still be called idle.
constexpr double idle_stiffness = 1e-10;

// An orthonormal basis of the columns, oriented as they are (R with a positive diagonal).
MatrixXd orthonormal(const MatrixXd& columns) {
    if (columns.cols() == 0) return columns;
    const Eigen::HouseholderQR<MatrixXd> qr(columns);
    MatrixXd Q = qr.householderQ() * MatrixXd::Identity(columns.rows(), columns.cols());
    for (Index k = 0; k < Q.cols(); ++k)
        if (qr.matrixQR()(k, k) < 0) Q.col(k) = -Q.col(k);
    return Q;
}

// Rank is judged on the equilibrated matrix D_r J D_c (Ruiz: rows and columns of size one),
// because stiff and soft elements side by side are no sign of singularity.
// Its null vectors v, u are mapped back: V ~ D_c v, U ~ D_r u.
NullSpaces null_spaces(const MatrixXd& J) {
    VectorXd D_r = VectorXd::Ones(J.rows()), D_c = VectorXd::Ones(J.cols());
    MatrixXd A = J;
    for (int sweep = 0; sweep < equilibration_sweeps; ++sweep) {
        const auto scale = [](double size) { return size > 0 ? 1 / std::sqrt(size) : 1; };
        const VectorXd r = A.cwiseAbs().rowwise().maxCoeff().unaryExpr(scale);
        const VectorXd c = A.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(scale);
        A = r.asDiagonal() * A * c.asDiagonal();
        D_r.array() *= r.array();
        D_c.array() *= c.array();
    }
    // A P = Q R with |r_00| ≥ |r_11| ≥ ..., R = [R_1 R_2; 0 ~0]: then A P [-R_1⁻¹ R_2; 1] = 0, and Q's last columns are
    // what A never reaches. The factors of ten that r_kk may be off a singular value do not matter beside the gap
    // between healthy and null.
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
    const Index n = A.rows();
    const auto diagonal = qr.matrixQR().diagonal().cwiseAbs();
    Index rank = 0;
    while (rank < n && diagonal[rank] > null_threshold * diagonal[0]) ++rank;
    const Index k = n - rank;
    if (k == 0) return {MatrixXd(n, 0), MatrixXd(n, 0)};
    MatrixXd V = MatrixXd::Zero(n, k), last = MatrixXd::Zero(n, k);
    V.topRows(rank) = -qr.matrixQR()
                           .topLeftCorner(rank, rank)
                           .triangularView<Eigen::Upper>()
                           .solve(MatrixXd(qr.matrixQR().topRightCorner(rank, k)));
    V.bottomRows(k).setIdentity();
    last.bottomRows(k).setIdentity();
    const MatrixXd right = qr.colsPermutation() * V, left = qr.householderQ() * last;
    return {orthonormal(D_c.asDiagonal() * right), orthonormal(D_r.asDiagonal() * left)};
}

void border(Linearisation& at) {
    const Index n = at.J.rows(), k = at.modes.count();
    MatrixXd B = MatrixXd::Zero(n + k, n + k);
    B.topLeftCorner(n, n) = at.J;
    B.topRightCorner(n, k) = at.modes.left;
    B.bottomLeftCorner(k, n) = at.modes.right.transpose();
    at.bordered.compute(B);
    const auto diagonal = at.bordered.matrixLU().diagonal();
    at.orientation = static_cast<int>(at.bordered.permutationP().determinant());
    for (Index i = 0; i < n + k; ++i) at.orientation *= diagonal[i] > 0 ? 1 : diagonal[i] < 0 ? -1 : 0;
}

// With the old modes as border, J v + U μ = 0, Vᵀv = 1 gives the modes here, turned as little as possible, as
// long as μ, the stiffness they have got, is nothing but round-off.
bool track(Linearisation& at) {
    const Index n = at.J.rows(), k = at.modes.count();
    MatrixXd ones = MatrixXd::Zero(n + k, k);
    ones.bottomRows(k).setIdentity();
    const MatrixXd right = at.bordered.solve(ones), left = at.bordered.transpose().solve(ones);
    const double stiffness = right.bottomRows(k).cwiseAbs().maxCoeff();
    if (!right.allFinite() || !left.allFinite() ||
        !(stiffness <= idle_stiffness * at.J.cwiseAbs().maxCoeff()))
        return false;
    at.modes = {orthonormal(right.topRows(n)), orthonormal(left.topRows(n))};
    return true;
}

}  // namespace

Linearisation linearise(MatrixXd J, const Linearisation* before, Counts& counts) {
    Linearisation at;
    at.J = std::move(J);
    if (at.J.rows() == 0 || !at.J.allFinite()) return at;
    if (before != nullptr) {
        at.modes = before->modes;
        border(at);
        ++counts.factorisations;
        at.modes_are_new = at.modes.count() > 0 && !track(at);
        if (!at.modes_are_new) return at;
    }
    at.modes = null_spaces(at.J);
    border(at);
    counts.factorisations += 2;
    return at;
}

Rate answer(const Linearisation& at, const VectorXd& E_rate) {
    const Index n = at.J.rows(), k = at.modes.count();
    if (n == 0) return {};
    if (at.orientation == 0)
        return {VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN()), VectorXd::Zero(k)};
    VectorXd right = VectorXd::Zero(n + k);
    right.head(n) = -E_rate;
    const VectorXd solution = at.bordered.solve(right);
    return {solution.head(n), solution.tail(k)};
}

}  // namespace elastocheck::reference::equilibrium
