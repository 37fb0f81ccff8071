// What the reader and compile() need to know of Real beyond arithmetic: here for double, in
// models/rates/dual.hpp for dual numbers.
//
// Code that is compiled with both calls abs, sqrt, pow, cos and sin without std::, after a using
// declaration of the function of std.
#pragma once

#include <cmath>

#include "elastocheck/scene.hpp"

#ifndef ELASTOCHECK_REAL
namespace elastocheck {

inline double value_of(double x) { return x; }
template <class M>
const M& values_of(const M& matrix) {
    return matrix;
}
// 0 with the derivative of x.
inline double rate_only(double) { return 0; }

// |a - b| ≤ tolerance. Dual numbers are near where they are so for all small changes: two parts
// that only happen to be in the same place are not.
inline bool are_near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }
inline bool are_near(const Vector3& a, const Vector3& b, double tolerance) {
    return (a - b).norm() <= tolerance;
}

// A number of the file. Dual numbers: with its derivative, if it is one to differentiate by.
inline double as_read(const Number& number) { return number.value; }
// A whole number of the file, which has no derivative.
inline void as_counted(const Number&) {}

// Dual numbers are compared by their values alone while an object of this type exists: in checks
// and warnings, on which no result depends.
struct ByValue {
    ByValue() = default;
};

}  // namespace elastocheck
#endif
