#include "reference/equilibrium/linear_algebra/linearisation.hpp"
#include "models/eigen/dense.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// QR threshold on the equilibrated matrix: a column this close to the span of those before is
// dependent. Healthy models stay above 1e-6.
constexpr double null_threshold = 1e-11;

// Exception: constraints that are redundant up to an angle σ are independent, with a singular value
// of J of σ² over a stiffness. Their vector v has an image |A v| larger than `zero_tolerance`, and
// consists of reactions except for a part of about σ on bodies, between `min_angle` and
// `largest_angle`.
constexpr double zero_tolerance = 1e-13, min_angle = 1e-9, largest_angle = 1e-3;

// Below this condition number the null space is empty and is not computed.
constexpr double surely_regular = 1e8;

// Equilibration sweeps; each halves the logarithm of the ratio of sizes.
constexpr int equilibration_sweeps = 10;

// Largest stiffness of a tracked mode, relative to the largest entry of J, that still
// counts as idle.
constexpr double idle_stiffness = 1e-10;

// Relative to the length of a mode: smaller entries are round-off and dropped.
constexpr double min_entry = 1e-14;

// Orthonormal basis of the columns with their orientation: Gram-Schmidt applied twice, which is as
// accurate as Householder and keeps the sparsity of columns without a common row.
Sparse orthonormal(const Sparse& columns) {
    Sparse Q(columns.rows(), columns.cols());
    std::vector<Eigen::SparseVector<double>> earlier_columns;
    for (Index k = 0; k < columns.cols(); ++k) {
        Eigen::SparseVector<double> q = columns.col(k);
        for (int pass = 0; pass < 2; ++pass)
            for (const auto& earlier : earlier_columns)
                if (const double overlap = earlier.dot(q); overlap != 0) q -= overlap * earlier;
        q /= q.norm();
        q.prune(1., min_entry);
        Q.startVec(k);
        for (Eigen::SparseVector<double>::InnerIterator entry(q); entry; ++entry)
            Q.insertBack(entry.index(), k) = entry.value();
        earlier_columns.push_back(std::move(q));
    }
    Q.finalize();
    return Q;
}

// D_r A D_c, the largest entry of each row and column being one in size (Ruiz 2001).
struct Equilibrated {
    Sparse A;
    VectorXd D_r, D_c;
};
Equilibrated equilibrated(const Sparse& J) {
    Equilibrated result{J, VectorXd::Ones(J.rows()), VectorXd::Ones(J.cols())};
    const auto scale = [](double size) { return size > 0 ? 1 / std::sqrt(size) : 1; };
    for (int sweep = 0; sweep < equilibration_sweeps; ++sweep) {
        VectorXd r = VectorXd::Zero(J.rows()), c = VectorXd::Zero(J.cols());
        for (Index k = 0; k < J.cols(); ++k)
            for (Sparse::InnerIterator entry(result.A, k); entry; ++entry) {
                const double size = std::abs(entry.value());
                r[entry.row()] = std::max(r[entry.row()], size);
                c[k] = std::max(c[k], size);
            }
        r = r.unaryExpr(scale);
        c = c.unaryExpr(scale);
        for (Index k = 0; k < J.cols(); ++k)
            for (Sparse::InnerIterator entry(result.A, k); entry; ++entry)
                entry.valueRef() *= r[entry.row()] * c[k];
        result.D_r.array() *= r.array();
        result.D_c.array() *= c.array();
    }
    return result;
}

// Number n of body unknowns: A_ij = 0 for all i, j ≥ n, the block of the reactions.
Index body_unknowns(const Sparse& A) {
    Index n = 0;
    for (Index j = 0; j < A.cols(); ++j)
        for (Sparse::InnerIterator entry(A, j); entry; ++entry)
            n = std::max(n, std::min<Index>(entry.row(), j) + 1);
    return n;
}

// Removes the vectors of nearly redundant constraints (above) from the columns. If one column is
// not quite null, all combinations are searched, which takes a dense matrix.
Sparse without_nearly_redundant(const Sparse& A, const Sparse& columns) {
    const Sparse images = A * columns;
    bool all_null = true;
    for (Index k = 0; k < columns.cols() && all_null; ++k)
        all_null = images.col(k).norm() <= zero_tolerance * columns.col(k).norm();
    if (all_null) return columns;
    MatrixXd V = times_matrix(Eigen::HouseholderQR<MatrixXd>(MatrixXd(columns)).householderQ(),
                              MatrixXd::Identity(columns.rows(), columns.cols()));
    const Svd svd = svd_of(V.topRows(body_unknowns(A)), Eigen::ComputeThinV);
    V = matrix_product(V, svd.V);
    std::vector<Index> kept;
    for (Index k = 0; k < V.cols(); ++k) {
        const double part = k < svd.values.size() ? svd.values[k] : 0;
        if (!(part > min_angle && part < largest_angle && (A * V.col(k)).norm() > zero_tolerance))
            kept.push_back(k);
    }
    return MatrixXd(V(Eigen::all, kept)).sparseView();
}

Sparse bordered_matrix(const Sparse& J, const NullSpaces& modes) {
    const Index n = J.rows(), k = modes.count();
    if (k == 0) return J;
    // column j: the entries of the modes in unknown j
    const Sparse V_rows = modes.right.transpose();
    Sparse B(n + k, n + k);
    B.reserve(J.nonZeros() + modes.left.nonZeros() + modes.right.nonZeros());
    for (Index j = 0; j < n; ++j) {
        B.startVec(j);
        for (Sparse::InnerIterator entry(J, j); entry; ++entry)
            B.insertBack(entry.row(), j) = entry.value();
        for (Sparse::InnerIterator entry(V_rows, j); entry; ++entry)
            B.insertBack(n + entry.row(), j) = entry.value();
    }
    for (Index j = 0; j < k; ++j) {
        B.startVec(n + j);
        for (Sparse::InnerIterator entry(modes.left, j); entry; ++entry)
            B.insertBack(entry.row(), n + j) = entry.value();
    }
    B.finalize();
    return B;
}

// Tracks the idle modes: with the old modes as border, J v + U μ = 0, Vᵀv = 1 gives the modes here
// with the least rotation, valid as long as their stiffness μ is round-off.
bool track(Linearisation& linearisation) {
    const Index n = linearisation.J.rows(), k = linearisation.modes.count();
    MatrixXd ones = MatrixXd::Zero(n + k, k);
    ones.bottomRows(k).setIdentity();
    const MatrixXd right = linearisation.bordered.solve(ones),
                   left = linearisation.bordered.solve_transposed(ones);
    const double stiffness = right.bottomRows(k).cwiseAbs().maxCoeff();
    if (!right.allFinite() || !left.allFinite() ||
        !(stiffness <= idle_stiffness * largest_entry(linearisation.J)))
        return false;
    linearisation.modes = {orthonormal(right.topRows(n).sparseView(1., min_entry)),
                           orthonormal(left.topRows(n).sparseView(1., min_entry))};
    return true;
}

}  // namespace

// Rank is judged on the equilibrated matrix D_r J D_c, because a large ratio of stiffnesses is not
// a singularity. Its null vectors v, u are mapped back: V ~ D_c v, U ~ D_r u.
NullSpaces null_spaces(const Sparse& J) {
    const auto [A, D_r, D_c] = equilibrated(J);
    if (Factors(A).condition(A) < surely_regular) return {Sparse(J.rows(), 0), Sparse(J.rows(), 0)};
    const auto [near_right, near_left] = null_bases(A, null_threshold);
    const Sparse A_t = A.transpose();
    Sparse right = without_nearly_redundant(A, near_right),
           left = without_nearly_redundant(A_t, near_left);
    if (right.cols() != left.cols()) {
        right = near_right;
        left = near_left;
    }
    return {orthonormal(D_c.asDiagonal() * right), orthonormal(D_r.asDiagonal() * left)};
}

Factors bordered_like(const Linearisation& like, const Sparse& J) {
    return Factors(bordered_matrix(J, like.modes), &like.bordered);
}

Linearisation linearise(Sparse J, const Linearisation* previous, Counts& counts, Factors* order) {
    Linearisation result;
    result.J = std::move(J);
    if (result.J.rows() == 0 || !is_finite(result.J)) return result;
    if (previous != nullptr) {
        result.modes = previous->modes;
        result.bordered = bordered_like(*previous, result.J);
        ++counts.factorisations;
        result.modes_are_new = result.modes.count() > 0 && !track(result);
        result.modes_are_soft = previous->modes_are_soft;
        if (!result.modes_are_new) return result;
        result.modes_are_soft = false;
    }
    // Most matrices are regular by their own factors, without equilibration. The estimate of their
    // condition counts as a factorisation.
    result.bordered = Factors(result.J, order);
    if (order != nullptr) *order = result.bordered;
    counts.factorisations += 2;
    if (result.bordered.condition(result.J) < surely_regular) {
        result.modes = {Sparse(result.J.rows(), 0), Sparse(result.J.rows(), 0)};
        return result;
    }
    result.modes = null_spaces(result.J);
    if (result.modes.count() > 0)
        result.bordered = Factors(bordered_matrix(result.J, result.modes));
    return result;
}

Rate solve_bordered(const Factors& bordered, const VectorXd& E_rate) {
    const Index n = E_rate.size(), k = bordered.size() - n;
    if (n == 0) return {};
    if (bordered.sign() == 0)
        return {VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN()),
                VectorXd::Zero(std::max<Index>(k, 0))};
    VectorXd right = VectorXd::Zero(n + k);
    right.head(n) = -E_rate;
    const VectorXd solution = bordered.solve(right);
    return {solution.head(n), solution.tail(k)};
}

Rate solve_bordered_refined(const Linearisation& linearisation, const VectorXd& E_rate) {
    Rate rate = solve_bordered(linearisation.bordered, E_rate);
    if (!rate.dx.allFinite()) return rate;
    const Rate correction =
        solve_bordered(linearisation.bordered,
                       E_rate + linearisation.J * rate.dx + linearisation.modes.left * rate.mu);
    rate.dx += correction.dx;
    rate.mu += correction.mu;
    return rate;
}

// Augmented system with the longer side of A first, so that its null space, which becomes the
// border, contains only the dependencies of A:
//
//   ⎡ 1   A ⎤ ⎧ r ⎫   ⎧ b ⎫              ⎡ 1   Aᵀ ⎤ ⎧  x ⎫   ⎧ 0 ⎫
//   ⎣ Aᵀ  0 ⎦ ⎩ x ⎭ = ⎩ 0 ⎭      or      ⎣ A   0  ⎦ ⎩ -y ⎭ = ⎩ b ⎭
//
// On the left: r is orthogonal to the columns of A, and x has no part in the null space. On the
// right: x is in the row space of A, and the border takes the part of b outside the range of A.
VectorXd least_squares(const Sparse& A, const VectorXd& b, Factors* order) {
    const bool tall = A.rows() >= A.cols();
    const Index long_side = std::max(A.rows(), A.cols()), size = A.rows() + A.cols();
    std::vector<Eigen::Triplet<double>> entries;
    for (Index k = 0; k < long_side; ++k)
        entries.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.);
    for (Index k = 0; k < A.cols(); ++k)
        for (Sparse::InnerIterator entry(A, k); entry; ++entry) {
            const Index i = tall ? entry.row() : entry.col(),
                        j = long_side + (tall ? entry.col() : entry.row());
            entries.emplace_back(static_cast<int>(i), static_cast<int>(j), entry.value());
            entries.emplace_back(static_cast<int>(j), static_cast<int>(i), entry.value());
        }
    Sparse G(size, size);
    G.setFromTriplets(entries.begin(), entries.end());
    VectorXd right = VectorXd::Zero(size);
    right.segment(tall ? 0 : long_side, b.size()) = -b;
    Counts counts;
    const VectorXd solution =
        solve_bordered_refined(linearise(std::move(G), nullptr, counts, order), right).dx;
    return solution.segment(tall ? long_side : 0, A.cols());
}

}  // namespace elastocheck::reference::equilibrium
