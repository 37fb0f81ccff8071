// Second derivatives of positions and directions by the coordinates of a chart, at its centre.
//
// With p = r_c + δr + exp(φ) u, exp(φ) u = u + φ × u + ½ φ × (φ × u) + ...:
//
//   δp = δr + φ × u = P δx,   P = [1, -ũ],
//   f·δ²p = φᵀ T φ,           T(f, u) = ½ (f uᵀ + u fᵀ) - (f·u) 1
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

// M by rows of δr (0) or φ (3) of one body and columns of another: xᵀ M y, so Mᵀ as well.
void add_pair(BodyId a, int rows, BodyId b, int columns, const Eigen::Matrix3d& M, Blocks& H);

// f·p, f constant, p at lever `at`; likewise f·u of a direction.
void add_curvature_along(const Eigen::Vector3d& f, const Carried& at, Blocks& H);

// g(D), D = p - p', f and M its first and second derivative.
void add_curvature_of_difference(const Eigen::Vector3d& f, const Eigen::Matrix3d& M,
                                 const Carried& at, const Carried& minus, Blocks& H);

// n·D, n a direction carried by a body, D = p - p'.
void add_curvature_of_offset(const Carried& n, const Eigen::Vector3d& D, const Carried& at,
                             const Carried& minus, Blocks& H);

// λ u·v, both directions carried by bodies.
void add_curvature_of_cosine(double lambda, const Carried& u, const Carried& v, Blocks& H);

}  // namespace elastocheck::reference::energy
