// Which entries of eq. (24), with the consistent tangent in place of K, can be other than zero: what every
// element and constraint touches, by halves of bodies (Δr or Δπ) and rows of Φ. A point in the origin of its
// body has no lever, and what is fixed in the ground keeps its zeros.
#pragma once

#include "models/model.hpp"
#include "recursive/saddle_matrix.hpp"
#include "recursive/sparse_lu.hpp"

namespace elastocheck::recursive {

// The entries of [(6nb + m) × (6nb + m)], on any branch.
Pattern pattern(const Model& model);

// The matrix itself, all zero: its blocks.
SaddleMatrix<double> saddle_matrix(const Model& model);

}  // namespace elastocheck::recursive
