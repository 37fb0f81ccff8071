// The arithmetic of four variants at once: coefficients of the series, elimination, substitution.
//
// Each function is compiled for processors with AVX2 and for all others of the baseline. The
// program chooses when it starts. Both give the same digits.
#pragma once

#include <vector>

#include "recursive/batch/lanes.hpp"
#include "recursive/linear_algebra/sparse_lu.hpp"
#include "recursive/series/equations.hpp"

namespace elastocheck::recursive::batch {

// Uses AVX2 if it is wanted and the processor has it; for tests, and for tools that do not know
// these instructions. Returns whether AVX2 is used. Not thread-safe.
bool use_avx2(bool wanted);

// As series::evaluate.
void evaluate(series::Equations<Lanes>& e, series::Order o);

// LU factors in the elimination order of the design: one for all variants.
struct Factors {
    const Elimination* order = nullptr;
    std::vector<Lanes> values;  // of the scaled and bordered matrices, in the order of the pattern
    std::vector<Lanes> LU, inverse, y;  // as in SparseLU
    // of the last elimination: pivots by size, largest multiplier of L, sign of the determinant
    Lanes min_pivot, largest_pivot, largest_multiplier, sign;
    Lanes finite;  // zero; NaN where an entry of a matrix is not finite

    std::size_t size() const { return static_cast<std::size_t>(order->pattern.size); }
};
Factors reserve_factors(const Elimination& order);

// Eliminates in the given order. A zero pivot leaves factors that are not finite.
void eliminate(Factors& lu);
// log₂ of |determinant|, one lane.
double log_determinant(const Factors& lu, int lane);
// Solves A x = b with the last factors.
void solve(Factors& lu, const Lanes* b, Lanes* x);

// Least pivot of the LDLᵀ of a symmetric matrix [n × n] without pivoting; destroys the matrix, of
// which the lower half is read.
Lanes min_pivot(Matrix<Lanes>& A);

}  // namespace elastocheck::recursive::batch
