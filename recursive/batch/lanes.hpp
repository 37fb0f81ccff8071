// Four numbers of four variants of a model as one scalar: arithmetic lane by lane.
//
// Templates of the formula, the linear algebra and the power series that do not branch on a value
// take it in place of double. Each lane is computed by the same operations in the same order as a
// double, so that a variant's result does not depend on its neighbours, nor on the instructions
// that the processor has (AVX: four lanes in one; SSE2: two by two; no fused multiply-add).
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace elastocheck::recursive::batch {

struct Lanes {
    static constexpr int count = 4;
    // Aligned as Eigen and the allocators align, which is less than a register of AVX.
    typedef double Register __attribute__((vector_size(32), aligned(16)));

    Register v;

    Lanes() = default;
    Lanes(double all) : v{all, all, all, all} {}  // NOLINT: implicit, as of an int to a double
    explicit Lanes(const Register& of) : v(of) {}
    // User-provided, so that it is passed by reference whatever the target of a function is:
    // callers with and without AVX would pass a register in different ways.
    Lanes(const Lanes& other) : v(other.v) {}
    Lanes& operator=(const Lanes& other) {
        v = other.v;
        return *this;
    }

    double operator[](int lane) const { return v[lane]; }

    Lanes& operator+=(const Lanes& b) {
        v += b.v;
        return *this;
    }
    Lanes& operator-=(const Lanes& b) {
        v -= b.v;
        return *this;
    }
    Lanes& operator*=(const Lanes& b) {
        v *= b.v;
        return *this;
    }
    Lanes& operator/=(const Lanes& b) {
        v /= b.v;
        return *this;
    }
    friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.v + b.v); }
    friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.v - b.v); }
    friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.v * b.v); }
    friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.v / b.v); }
    friend Lanes operator-(const Lanes& a) { return Lanes(-a.v); }
};

// As for a double in series/taylor.hpp.
inline double lane(const Lanes& all, int number) { return all.v[number]; }
inline void set_lane(Lanes& all, int number, double value) { all.v[number] = value; }
inline bool is_zero(const Lanes& all) {
    return all.v[0] == 0 && all.v[1] == 0 && all.v[2] == 0 && all.v[3] == 0;
}

// Lane by lane.
template <class Function>
Lanes each_lane(Function f) {
    Lanes result;
    for (int k = 0; k < Lanes::count; ++k) result.v[k] = f(k);
    return result;
}
inline Lanes sqrt(const Lanes& a) {
    return each_lane([&](int k) { return std::sqrt(a[k]); });
}
inline Lanes sin(const Lanes& a) {
    return each_lane([&](int k) { return std::sin(a[k]); });
}
inline Lanes cos(const Lanes& a) {
    return each_lane([&](int k) { return std::cos(a[k]); });
}
inline Lanes atan2(const Lanes& y, const Lanes& x) {
    return each_lane([&](int k) { return std::atan2(y[k], x[k]); });
}

// The larger and the smaller of two numbers; the second where one is NaN.
inline Lanes larger(const Lanes& a, const Lanes& b) { return Lanes(a.v > b.v ? a.v : b.v); }
inline Lanes smaller(const Lanes& a, const Lanes& b) { return Lanes(a.v < b.v ? a.v : b.v); }
inline Lanes abs(const Lanes& a) { return Lanes(a.v < 0 ? -a.v : a.v); }
// b where a is not zero, else 0.
inline Lanes only_where(const Lanes& a, const Lanes& b) {
    return Lanes(a.v != 0 ? b.v : Lanes(0).v);
}
// b, negated where a is negative.
inline Lanes with_sign_of(const Lanes& a, const Lanes& b) { return Lanes(a.v < 0 ? -b.v : b.v); }

}  // namespace elastocheck::recursive::batch

template <>
struct Eigen::NumTraits<elastocheck::recursive::batch::Lanes>
    : Eigen::GenericNumTraits<elastocheck::recursive::batch::Lanes> {
    using Real = elastocheck::recursive::batch::Lanes;
    using NonInteger = Real;
    using Nested = Real;
    using Literal = Real;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 0,
        ReadCost = 1,
        AddCost = 1,
        MulCost = 1
    };
    static Real epsilon() { return Eigen::NumTraits<double>::epsilon(); }
    static Real dummy_precision() { return Eigen::NumTraits<double>::dummy_precision(); }
};
