// Sparsity pattern of eq. (24), with the consistent tangent in place of K.
// It holds the entries of every element and constraint, by halves of bodies (Δr or Δπ) and
// rows of Φ. A point in the origin of its body has no lever, and a part fixed in the ground
// has structural zeros.
#pragma once

#include "elastocheck/model.hpp"
#include "recursive/linear_algebra/saddle_matrix.hpp"
#include "recursive/linear_algebra/sparse_lu.hpp"

namespace elastocheck::recursive {

// The entries of [(6nb + m) × (6nb + m)], on any branch.
Pattern pattern(const Model& model);

// The zero matrix with the blocks of the model.
SaddleMatrix<double> saddle_matrix(const Model& model);

}  // namespace elastocheck::recursive
