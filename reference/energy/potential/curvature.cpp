#include "reference/energy/potential/curvature.hpp"

#include <algorithm>
#include <array>

#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

void add_block(BodyId a, int rows, BodyId b, int columns, const Matrix3d& M, Blocks& H) {
    if (a != ground && b != ground) H.blocks.push_back({6 * a + rows, 6 * b + columns, M});
}

}  // namespace

bool Blocks::finite() const {
    return std::ranges::all_of(blocks, [](const auto& block) { return block.M.allFinite(); });
}

MatrixXd Blocks::dense() const {
    MatrixXd sum = MatrixXd::Zero(size, size);
    for (const auto& block : blocks) sum.block<3, 3>(block.row, block.column) += block.M;
    return sum;
}

Eigen::SparseMatrix<double> Blocks::sparse() const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(9 * blocks.size());
    for (const auto& block : blocks)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
                entries.emplace_back(block.row + i, block.column + j, block.M(i, j));
    Eigen::SparseMatrix<double> sum(size, size);
    sum.setFromTriplets(entries.begin(), entries.end());
    return sum;
}

Matrix3d turn_curvature(const Vector3d& f, const Vector3d& u) {
    const Matrix3d product = f * u.transpose();
    return 0.5 * (product + product.transpose()) - f.dot(u) * Matrix3d::Identity();
}

void add_pair(BodyId a, int rows, BodyId b, int columns, const Matrix3d& M, Blocks& H) {
    add_block(a, rows, b, columns, M, H);
    add_block(b, columns, a, rows, M.transpose(), H);
}

void add_curvature_along(const Vector3d& f, const Carried& point, Blocks& H) {
    add_block(point.body, 3, point.body, 3, turn_curvature(f, point.u), H);
}

// δD = P x - P' x':  δDᵀ M δD, and f·δ²D.
void add_curvature_of_difference(const Vector3d& f, const Matrix3d& M, const Carried& point,
                                 const Carried& other_point, Blocks& H) {
    add_curvature_along(f, point, H);
    add_curvature_along(-f, other_point, H);
    const std::array ends{&point, &other_point};
    for (const auto* a : ends)
        for (const auto* b : ends) {
            const Matrix3d sign_M = a == b ? M : Matrix3d(-M);
            const Matrix3d u_a = skew(a->u), M_u = -sign_M * skew(b->u);
            add_block(a->body, 0, b->body, 0, sign_M, H);
            add_block(a->body, 0, b->body, 3, M_u, H);
            add_block(a->body, 3, b->body, 0, u_a * sign_M, H);
            add_block(a->body, 3, b->body, 3, u_a * M_u, H);
        }
}

// n·δ²D + D·δ²n + 2 δn·δD, δn = -ñ φ, so δn·δD = φᵀ ñ (P x - P' x').
void add_curvature_of_offset(const Carried& n, const Vector3d& D, const Carried& point,
                             const Carried& other_point, Blocks& H) {
    add_curvature_along(n.u, point, H);
    add_curvature_along(-n.u, other_point, H);
    add_curvature_along(D, n, H);
    const Matrix3d n_skew = skew(n.u);
    add_pair(n.body, 3, point.body, 0, n_skew, H);
    add_pair(n.body, 3, point.body, 3, -n_skew * skew(point.u), H);
    add_pair(n.body, 3, other_point.body, 0, -n_skew, H);
    add_pair(n.body, 3, other_point.body, 3, n_skew * skew(other_point.u), H);
}

// v·δ²u + u·δ²v + 2 δu·δv, δu·δv = φᵀ ũ (-ṽ) φ'
void add_curvature_of_cosine(double lambda, const Carried& u, const Carried& v, Blocks& H) {
    add_curvature_along(lambda * v.u, u, H);
    add_curvature_along(lambda * u.u, v, H);
    add_pair(u.body, 3, v.body, 3, -lambda * skew(u.u) * skew(v.u), H);
}

}  // namespace elastocheck::reference::energy
