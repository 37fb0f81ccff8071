// Dual numbers as the type of the numbers of a scene: a value and its derivatives in several
// directions, each direction one number of the scene file.
//
// The sources of the reader and of compile() are compiled a second time with ELASTOCHECK_REAL
// naming this file and with the namespace elastocheck renamed to elastocheck_dual
// (models/rates/CMakeLists.txt), so that no symbol of the two has the same name. Real is Dual there.
//
// Comparisons. A program with comparisons is a piecewise function. Inside a piece its derivative is
// that of the operations executed. On a boundary the operands of a comparison are equal and their
// derivatives differ: a tie. Such a comparison is decided by values, as by the program with double,
// and the direction is noted. A second pass with `side` = 1 or -1 decides ties as they are decided
// for an infinitesimally larger or smaller number of the file: then the derivatives are those of
// the piece on that side.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "models/rates/bridge.hpp"

namespace elastocheck {

struct Number;

// What is differentiated by, and what was met on the way.
struct Pass {
    std::vector<Together> changes;  // of numbers of the file, one of each direction
    std::size_t count = 0;          // directions in use
    int side = 0;                   // 0, or ±1 for one direction: how ties are decided
    Flags tie{}, whole_number{};
    int by_value = 0;  // > 0: ties are neither noted nor decided by derivatives
};
inline thread_local Pass pass;

struct Dual {
    double x = 0;
    std::array<double, directions> dx{};

    Dual() = default;
    template <class N>
    requires std::is_arithmetic_v<N> Dual(N value)
        : x(static_cast<double>(value)) {}  // NOLINT: a number

    // y = f(a) with dy = slope · da
    static Dual of(double y, double slope, const Dual& a) {
        Dual result = y;
        for (std::size_t k = 0; k < directions; ++k)
            result.dx[k] = a.dx[k] == 0 ? 0 : slope * a.dx[k];
        return result;
    }

    Dual& operator+=(const Dual& b) {
        x += b.x;
        for (std::size_t k = 0; k < directions; ++k) dx[k] += b.dx[k];
        return *this;
    }
    Dual& operator-=(const Dual& b) {
        x -= b.x;
        for (std::size_t k = 0; k < directions; ++k) dx[k] -= b.dx[k];
        return *this;
    }
    Dual& operator*=(const Dual& b) {
        for (std::size_t k = 0; k < directions; ++k) dx[k] = dx[k] * b.x + x * b.dx[k];
        x *= b.x;
        return *this;
    }
    Dual& operator/=(const Dual& b) {
        x /= b.x;
        for (std::size_t k = 0; k < directions; ++k) dx[k] = (dx[k] - x * b.dx[k]) / b.x;
        return *this;
    }
    friend Dual operator-(Dual a) {
        a.x = -a.x;
        for (double& d : a.dx) d = -d;
        return a;
    }
    friend Dual operator+(Dual a, const Dual& b) { return a += b; }
    friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
    friend Dual operator*(Dual a, const Dual& b) { return a *= b; }
    friend Dual operator/(Dual a, const Dual& b) { return a /= b; }

    // The sign of a - b for a.x = b.x.
    static int sign_at_tie(const Dual& a, const Dual& b) {
        constexpr double round_off = 1e-12;
        if (pass.by_value > 0) return 0;
        int sign = 0;
        for (std::size_t k = 0; k < pass.count; ++k) {
            const double d = a.dx[k] - b.dx[k];
            if (d == 0 || std::abs(d) <= round_off * (std::abs(a.dx[k]) + std::abs(b.dx[k])))
                continue;
            pass.tie[k] = true;
            if (k == 0) sign = (d > 0 ? 1 : -1) * pass.side;
        }
        return sign;
    }
    friend bool operator<(const Dual& a, const Dual& b) {
        return a.x < b.x || (a.x == b.x && sign_at_tie(a, b) < 0);
    }
    friend bool operator==(const Dual& a, const Dual& b) {
        return a.x == b.x && sign_at_tie(a, b) == 0;
    }
    friend bool operator<=(const Dual& a, const Dual& b) {
        return a.x < b.x || (a.x == b.x && sign_at_tie(a, b) <= 0);
    }
    friend bool operator>(const Dual& a, const Dual& b) { return b < a; }
    friend bool operator>=(const Dual& a, const Dual& b) { return b <= a; }
    friend bool operator!=(const Dual& a, const Dual& b) { return !(a == b); }

    friend Dual abs(const Dual& a) { return of(std::abs(a.x), a < 0 ? -1 : 1, a); }
    friend Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.x);
        return of(root, 0.5 / root, a);
    }
    friend Dual sin(const Dual& a) { return of(std::sin(a.x), std::cos(a.x), a); }
    friend Dual cos(const Dual& a) { return of(std::cos(a.x), -std::sin(a.x), a); }
    friend Dual atan2(const Dual& y, const Dual& x) {
        const double square = x.x * x.x + y.x * y.x;
        Dual result = of(std::atan2(y.x, x.x), x.x / square, y);
        for (std::size_t k = 0; k < directions; ++k) result.dx[k] -= y.x / square * x.dx[k];
        return result;
    }
    friend Dual pow(const Dual& a, int n) {
        return of(std::pow(a.x, n), n == 0 ? 0 : n * std::pow(a.x, n - 1), a);
    }
};

using Real = Dual;

}  // namespace elastocheck

template <>
struct Eigen::NumTraits<elastocheck::Dual> : Eigen::NumTraits<double> {
    using Real = elastocheck::Dual;
    using NonInteger = elastocheck::Dual;
    using Nested = elastocheck::Dual;
    using Literal = double;
    // AddCost: above EIGEN_UNROLLING_LIMIT, for the order of sums below
    enum { RequireInitialization = 1, ReadCost = 10, AddCost = 200, MulCost = 200 };
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<elastocheck::Dual, double, Operation> {
    using ReturnType = elastocheck::Dual;
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<double, elastocheck::Dual, Operation> {
    using ReturnType = elastocheck::Dual;
};

namespace elastocheck {

inline double value_of(const Dual& a) { return a.x; }
inline Dual rate_only(Dual a) {
    a.x = 0;
    return a;
}
template <class M>
Eigen::Matrix<double, M::RowsAtCompileTime, M::ColsAtCompileTime> values_of(const M& matrix) {
    return matrix.unaryExpr([](const Dual& a) { return a.x; });
}

struct ByValue {
    ByValue() { ++pass.by_value; }
    ~ByValue() { --pass.by_value; }
    ByValue(const ByValue&) = delete;
    ByValue& operator=(const ByValue&) = delete;
};

// For near values: whether their derivatives are equal within round-off, for vectors relative to
// the largest. A difference is a tie, decided as "not near" on either side.
template <class Derived>
bool are_near_on_side(const Eigen::MatrixBase<Derived>& a, const Eigen::MatrixBase<Derived>& b) {
    constexpr double round_off = 1e-10;
    if (pass.by_value > 0) return true;
    bool near = true;
    for (std::size_t k = 0; k < pass.count; ++k) {
        double size = 0, difference = 0;
        for (Eigen::Index n = 0; n < a.size(); ++n) {
            size = std::max({size, std::abs(a[n].dx[k]), std::abs(b[n].dx[k])});
            difference = std::max(difference, std::abs(a[n].dx[k] - b[n].dx[k]));
        }
        if (difference <= round_off * size) continue;
        pass.tie[k] = true;
        near = near && pass.side == 0;
    }
    return near;
}
inline bool are_near(const Dual& a, const Dual& b, double tolerance) {
    using One = Eigen::Matrix<Dual, 1, 1>;
    return std::abs(a.x - b.x) <= tolerance && are_near_on_side(One(a), One(b));
}

}  // namespace elastocheck

// The order in which Eigen adds doubles, so that values are the same to the last bit: pairs, as in
// registers of two doubles, then pairs of pairs; a diagonal by halves.
namespace Eigen::internal {

template <class Evaluator>
struct redux_impl<scalar_sum_op<elastocheck::Dual, elastocheck::Dual>, Evaluator, DefaultTraversal,
                  NoUnrolling> {
    using Dual = elastocheck::Dual;
    template <class Xpr>
    static Dual run(const Evaluator& at, const scalar_sum_op<Dual, Dual>&, const Xpr& xpr) {
        const Index n = xpr.size();
        const auto entry = [&](Index k) {
            return at.coeffByOuterInner(k / xpr.innerSize(), k % xpr.innerSize());
        };
        const auto by_halves = [&](const auto& self, Index begin, Index size, Index step) -> Dual {
            if (size == 1) return entry(begin);
            const Index half = size / 2;
            return self(self, begin, half, step) +
                   self(self, begin + half * step, size - half, step);
        };
        if (is_diagonal<Xpr>::value) return by_halves(by_halves, 0, n, 1);
        if (n < 2) return entry(0);
        Dual sum = by_halves(by_halves, 0, n / 2, 2) + by_halves(by_halves, 1, n / 2, 2);
        if (n % 2 != 0) sum += entry(n - 1);
        return sum;
    }

  private:
    template <class Xpr>
    struct is_diagonal : std::false_type {};
    template <class M, int k>
    struct is_diagonal<Diagonal<M, k>> : std::true_type {};
};

}  // namespace Eigen::internal

namespace elastocheck {

inline bool are_near(const Eigen::Matrix<Dual, 3, 1>& a, const Eigen::Matrix<Dual, 3, 1>& b,
                     double tolerance) {
    const Eigen::Vector3d p = values_of(a), q = values_of(b);
    return (p - q).norm() <= tolerance && are_near_on_side(a, b);
}

// Defined in models/rates/dual.cpp.
Dual as_read(const Number& number);
void as_counted(const Number& number);

}  // namespace elastocheck

// In messages a dual number is its value.
template <>
struct fmt::formatter<elastocheck::Dual> : fmt::formatter<double> {
    template <class Context>
    auto format(const elastocheck::Dual& a, Context& context) const {
        return fmt::formatter<double>::format(a.x, context);
    }
};
