// Second derivatives of positions and directions by the coordinates of a chart, at its centre.
//
// Body b has the coordinates δx = (δr, φ) in the rows 6b ... 6b + 5: a displacement [m] and a
// rotation vector [rad], ground axes. ũ is the matrix of the cross product, ũ a = u × a (`skew`).
// With p = r_c + δr + exp(φ) u, exp(φ) u = u + φ × u + ½ φ × (φ × u) + ...:
//
//   δp = δr + φ × u = P δx,   P = [1, -ũ],
//   f·δ²p = φᵀ T φ,           T(f, u) = ½ (f uᵀ + u fᵀ) - (f·u) 1
//
// δ²p is the second differential, twice the quadratic term.
//
// Each function adds the second derivatives of one expression to H [6nb × 6nb]; ground has no
// coordinates. H is kept as the sum of its blocks until it is known whether a dense or a sparse matrix is wanted.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck::reference::energy {

// A matrix as a sum of 3 × 3 blocks.
struct Blocks {
    struct Block {
        int row, column;
        Eigen::Matrix3d M;
    };
    int size;
    std::vector<Block> blocks = {};

    bool finite() const;
    Eigen::MatrixXd dense() const;
    Eigen::SparseMatrix<double> sparse() const;
};

// A vector u that turns with a body: a lever from its origin, or a direction (ground axes).
struct Carried {
    BodyId body;
    Eigen::Vector3d u;
};

Eigen::Matrix3d turn_curvature(const Eigen::Vector3d& f, const Eigen::Vector3d& u);  // T(f, u)

// xᵀ M y: adds M at the rows of x and the columns of y, and Mᵀ at the rows of y and the columns of
// x. x is δr (`rows` 0) or φ (`rows` 3) of body a; y likewise of body b, by `columns`.
void add_pair(BodyId a, int rows, BodyId b, int columns, const Eigen::Matrix3d& M, Blocks& H);

// f·p, f constant, p the point at lever `point`. The same for a direction instead of a lever, since
// its δ²u is the same.
void add_curvature_along(const Eigen::Vector3d& f, const Carried& point, Blocks& H);

// g(D), D = p - p', p and p' the points at the levers `point` and `other_point`; f [3] and M [3 × 3]
// are the first and second derivative of g.
void add_curvature_of_difference(const Eigen::Vector3d& f, const Eigen::Matrix3d& M,
                                 const Carried& point, const Carried& other_point, Blocks& H);

// n·D, n a direction carried by a body, D = p - p' of the points at the levers `point` and
// `other_point`.
void add_curvature_of_offset(const Carried& n, const Eigen::Vector3d& D, const Carried& point,
                             const Carried& other_point, Blocks& H);

// λ u·v, both directions carried by bodies.
void add_curvature_of_cosine(double lambda, const Carried& u, const Carried& v, Blocks& H);

}  // namespace elastocheck::reference::energy
