// What it takes to ask this leg, in floating point operations, foreseen before the first of them. SLSQP is dense by
// nature, and so is what makes its coordinates round: all grows with the cube of the number of coordinates.
//
// Leading powers, with n = 6nb coordinates, m rows of Φ and k = n - m motions:
//
// An evaluation is an iteration of SLSQP. Its subproblem |E y - f| → min under C y = d, E [n × n], C [m × n], both
// dense, takes m Householder transformations that bring C to a triangle and E along, and those of the k columns left:
//
//   Σ_{i<m} 4 (n - i)(n + m - i) + 2 k² (n - k/3)  =  4/3 (n³ - k³) + 2 m (n² - k²) + 2 k² (n - k/3)
//
// and the measure of the point another QR of Φ_qᵀ, 2 m² (n - m/3).
//
// A state, a pose with its Hessian and modes: that QR, its Q with 4 (n² m - n m² + m³/3), the Hessian along the
// motions 2 n k (n + k) (nothing where m = 0), its eigenvectors 9 k³, and the directions across 4 n² m.
//
// How many: the walk takes a step for each value asked for, and some more because it begins with 1/64 of the
// span and doubles. A step is two or three states, where it starts, where each chart ends, and some six evaluations.
// On the built-in scenes and on chains of any length the counts come out within a factor of four; stops that close
// take most. Not foreseen: scenes that settle under a load before they walk, and steps that had to be halved.
#pragma once

#include <cstddef>

#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Cost {
    double evaluations = 0, states = 0;        // how many
    double per_evaluation = 0, per_state = 0;  // operations

    double operations() const { return evaluations * per_evaluation + states * per_state; }
};

// Of a branch with so many values.
Cost cost_of(const Model& model, std::size_t values);

// More operations than this are not worth it: of the order of a minute of a desk computer.
inline constexpr double most_operations = 1e11;

}  // namespace elastocheck::reference::energy
