// Predicted cost of the energy leg in floating-point operations. SLSQP and its coordinate
// transformation are dense: the cost grows with the cube of the number of coordinates. That of a
// large model (quadratic.hpp) grows with the bodies and the fill of a sparse factor (cost.cpp).
//
// Leading powers, with n = 6nb coordinates, m rows of Φ and k = n - m motions:
//
// An evaluation is one iteration of SLSQP. Its subproblem |E y - f| → min under C y = d, E [n × n],
// C [m × n], both dense, takes m Householder transformations that make C triangular and are applied
// to E, and k for the other columns:
//
//   Σ_{i<m} 4 (n - i)(n + m - i) + 2 k² (n - k/3)
//     = 4/3 (n³ - k³) + 2 m (n² - k²) + 2 k² (n - k/3)
//
// and the acceptance measure takes another QR of Φ_qᵀ, 2 m² (n - m/3).
//
// A state, a pose with its Hessian and modes: that QR, its Q with 4 (n² m - n m² + m³/3), the
// Hessian along the motions 2 n k (n + k) (nothing where m = 0), its eigenvectors 9 k³, and the
// directions across 4 n² m.
//
// Counts: the continuation takes a step for each requested value, and some more because it starts
// with 1/64 of the span and doubles. A step takes two or three states (its start, and the end of
// each chart) and about six evaluations. On the built-in scenes and on chains of any length the
// predicted counts are within a factor of four; stops that close take most. Not predicted: scenes
// that settle under a load before the continuation, and halved steps.
#pragma once

#include <cstddef>

#include "elastocheck/model.hpp"

namespace elastocheck::reference::energy {

struct Cost {
    double evaluations = 0, states = 0;        // how many
    double per_evaluation = 0, per_state = 0;  // operations

    double operations() const { return evaluations * per_evaluation + states * per_state; }
};

// For a branch with this number of values.
Cost cost_of(const Model& model, std::size_t values);
// The same if it were solved densely, as responses of states are.
Cost dense_cost(const Model& model, std::size_t values);

}  // namespace elastocheck::reference::energy
