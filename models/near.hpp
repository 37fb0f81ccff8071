// Comparison of numbers of a scene within a tolerance.
#pragma once

#include <cmath>

#include "elastocheck/mechanism.hpp"

namespace elastocheck {

// |a - b| ≤ tolerance
inline bool are_near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }
inline bool are_near(const Vector3& a, const Vector3& b, double tolerance) {
    return (a - b).norm() <= tolerance;
}

}  // namespace elastocheck
