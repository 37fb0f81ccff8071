// Truncated power series arithmetic (Taylor recursion), one order at a time.
//
// At order k all coefficients below k are known, of the unknowns x and of all intermediates. The
// same straight-line program then runs twice:
//
//   known    with x_k = 0: the contribution of lower orders to coefficient k, Σ_{0≤i≤k} a_i b_{k-i}
//   change   after the solve: the contribution of x_k, linear in it, with coefficients 0 as factors
//
// so an operation costs O(k) and then O(1), and no lower coefficient is evaluated again.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <memory_resource>
#include <span>

#include "recursive/formula/state.hpp"

namespace elastocheck::recursive::series {

enum class Pass { known, change };
struct Order {
    int k = 0;
    Pass pass = Pass::known;
};

// Memory of all series of one set of equations, freed as a whole.
struct Arena {
    int order = 0;  // p
    std::unique_ptr<std::pmr::monotonic_buffer_resource> memory;

    explicit Arena(int p)
        : order(p),
          memory(std::make_unique<std::pmr::monotonic_buffer_resource>(std::size_t{1} << 15)) {}

    template <class T>
    T* take(int count, const T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        const auto n = static_cast<std::size_t>(count);
        T* const first = static_cast<T*>(memory->allocate(n * sizeof(T), alignof(T)));
        std::uninitialized_fill_n(first, n, value);
        return first;
    }
};

template <class T>
struct Series {
    T* c = nullptr;  // c[0 ... p], in the memory of its equations
    T change;        // contribution of x_k to c[k]
    int last = 0;    // coefficients beyond it are zero: 0 for a constant

    Series() : change(zero()) {}
    static T zero() {
        if constexpr (std::is_arithmetic_v<T>)
            return T(0);
        else
            return T::Zero();
    }
};
using Scalar = Series<double>;
using Vector2Series = Series<Eigen::Vector2d>;
using Vector3Series = Series<Vector3<double>>;
using Vector6Series = Series<Vector6<double>>;
using Matrix3Series = Series<Matrix3<double>>;

template <class T>
void reserve(Arena& room, Series<T>& s, bool constant = false) {
    s.c = room.take<T>(room.order + 1, s.zero());
    s.last = constant ? 0 : room.order;
}
template <class T>
T& at(Series<T>& s, int k) {
    return s.c[k];
}
template <class T>
const T& at(const Series<T>& s, int k) {
    return s.c[k];
}

// Σ a_i b_{k-i}, times(a_i, b_j) any product.
template <class A, class B, class Times>
auto convolution(int k, const Series<A>& a, const Series<B>& b, Times times) {
    using Product = std::decay_t<decltype(times(a.c[0], b.c[0]))>;
    Product sum = Series<Product>::zero();
    const int to = std::min(k, a.last);
    for (int i = std::max(0, k - b.last); i <= to; ++i) sum += times(at(a, i), at(b, k - i));
    return sum;
}

// Coefficient k of c = a b.
template <class A, class B, class C, class Times>
void product(Order o, const Series<A>& a, const Series<B>& b, Series<C>& c, Times times) {
    if (o.pass == Pass::known) {
        at(c, o.k) = convolution(o.k, a, b, times);
    } else {
        c.change = times(a.change, b.c[0]) + times(a.c[0], b.change);
        at(c, o.k) += c.change;
    }
}

inline constexpr auto scale = [](double a, const Vector3<double>& b) -> Vector3<double> {
    return a * b;
};
inline constexpr auto dot = [](const Vector3<double>& a, const Vector3<double>& b) {
    return a.dot(b);
};
inline constexpr auto cross = [](const Vector3<double>& a,
                                 const Vector3<double>& b) -> Vector3<double> {
    return a.cross(b);
};
inline constexpr auto outer = [](const Vector3<double>& a,
                                 const Vector3<double>& b) -> Matrix3<double> {
    return a * b.transpose();
};
inline constexpr auto apply = [](const Matrix3<double>& A,
                                 const Vector3<double>& b) -> Vector3<double> { return A * b; };
inline constexpr auto apply_transposed = [](const Matrix3<double>& A,
                                            const Vector3<double>& b) -> Vector3<double> {
    return A.transpose() * b;
};

// Coefficient k of a linear map of series: map(get), where get(s) reads coefficient k of s.
template <class C, class Map>
void linear(Order o, Series<C>& c, Map map) {
    if (o.pass == Pass::known) {
        at(c, o.k) = map([&](const auto& s) { return at(s, o.k); });
    } else {
        c.change = map([](const auto& s) { return s.change; });
        at(c, o.k) += c.change;
    }
}

// Adds a linear map to c.
template <class C, class Map>
void add_linear(Order o, Series<C>& c, Map map) {
    if (o.pass == Pass::known) {
        at(c, o.k) += map([&](const auto& s) { return at(s, o.k); });
    } else {
        const C more = map([](const auto& s) { return s.change; });
        c.change += more;
        at(c, o.k) += more;
    }
}

// c = 1 / a:  Σ a_i c_{k-i} = 0
inline void reciprocal(Order o, const Scalar& a, Scalar& c) {
    if (o.pass == Pass::change) {
        c.change = -a.change * c.c[0] * c.c[0];
        at(c, o.k) += c.change;
    } else if (o.k == 0) {
        c.c[0] = 1 / a.c[0];
    } else {
        double sum = 0;
        for (int i = 1; i <= o.k; ++i) sum += at(a, i) * at(c, o.k - i);
        at(c, o.k) = -sum * c.c[0];
    }
}

// c = √a:  Σ c_i c_{k-i} = a_k
inline void square_root(Order o, const Scalar& a, Scalar& c) {
    if (o.pass == Pass::change) {
        c.change = a.change / (2 * c.c[0]);
        at(c, o.k) += c.change;
    } else if (o.k == 0) {
        c.c[0] = std::sqrt(a.c[0]);
    } else {
        double sum = at(a, o.k);
        for (int i = 1; i < o.k; ++i) sum -= at(c, i) * at(c, o.k - i);
        at(c, o.k) = sum / (2 * c.c[0]);
    }
}

// c = cos α, s = sin α:  c' = -s α',  s' = c α'
inline void cosine_sine(Order o, const Scalar& alpha, Scalar& c, Scalar& s) {
    if (o.pass == Pass::change) {
        c.change = -s.c[0] * alpha.change;
        s.change = c.c[0] * alpha.change;
        at(c, o.k) += c.change;
        at(s, o.k) += s.change;
    } else if (o.k == 0) {
        c.c[0] = std::cos(alpha.c[0]);
        s.c[0] = std::sin(alpha.c[0]);
    } else {
        double of_c = 0, of_s = 0;
        for (int i = 1; i <= std::min(o.k, alpha.last); ++i) {
            of_c -= i * at(alpha, i) * at(s, o.k - i);
            of_s += i * at(alpha, i) * at(c, o.k - i);
        }
        at(c, o.k) = of_c / o.k;
        at(s, o.k) = of_s / o.k;
    }
}

// α of u = (cos α, sin α):  α' = u × u'
inline void arc(Order o, const Vector2Series& u, Scalar& alpha) {
    const auto across = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return a.x() * b.y() - a.y() * b.x();
    };
    if (o.pass == Pass::change) {
        alpha.change = across(u.c[0], u.change);
        at(alpha, o.k) += alpha.change;
    } else if (o.k == 0) {
        alpha.c[0] = std::atan2(u.c[0].y(), u.c[0].x());
    } else {
        double sum = 0;
        for (int i = 1; i <= o.k; ++i) sum += i * across(at(u, o.k - i), at(u, i));
        at(alpha, o.k) = sum / o.k;
    }
}

// The functions of the logarithm of a rotation, regular at zero angle:
//
//   F_m(s) = Σ (-1)ⁿ sⁿ / (2n + m),   m F_m + 2 s F_m' = 1 / (1 + s)
//
// F_1(t²) = atan(t) / t and F_3(t²) = (1 - F_1) / t². Their Taylor coefficients about s_0 ≥ 0,
// b_n = c_n / (1 + s_0)ⁿ, follow from the differential equation,
//
//   (2n + m) c_n + 2 (n + 1) s_0 / (1 + s_0) c_{n+1} = (-1)ⁿ / (1 + s_0) ,
//
// in descending order, in which an error shrinks by s_0 / (1 + s_0) per step. The start far beyond
// p makes the initial error negligible.
inline void taylor_of_F(int m, double s_0, std::span<double> b) {
    const double inverse = 1 / (1 + s_0), shrinks = s_0 * inverse;
    const int p = static_cast<int>(b.size()) - 1;
    const int beyond = shrinks > 0 ? static_cast<int>(std::min(-40 / std::log(shrinks), 1e6)) : 0;
    double next = 0;
    for (int n = p + beyond; n >= 0; --n) {
        next = ((n % 2 == 0 ? inverse : -inverse) - 2 * (n + 1) * shrinks * next) / (2 * n + m);
        if (n <= p) b[static_cast<std::size_t>(n)] = next;
    }
    double power = 1;
    for (int n = 0; n <= p; ++n, power *= inverse) b[static_cast<std::size_t>(n)] *= power;
}

// f(s(τ)) from the Taylor coefficients b_n of f about s_0:  Σ b_n σⁿ, σ = s - s_0.
struct Composition {
    std::span<double> b;  // [p + 1]
    double* power;        // coefficient k of σⁿ at n (p + 1) + k, n = 2 ... p
    bool fills = true;    // whether it computes the powers; else another function of s has done so
    Scalar f;
};
inline void reserve(Arena& room, Composition& c, const Composition* before = nullptr) {
    const int n = room.order + 1;
    c.b = {room.take<double>(n, 0), static_cast<std::size_t>(n)};
    c.fills = before == nullptr;
    c.power = c.fills ? room.take<double>(n * n, 0) : before->power;
    reserve(room, c.f);
}
inline void compose(Order o, const Scalar& s, Composition& c) {
    if (o.pass == Pass::change) {
        c.f.change = c.b[1] * s.change;
        at(c.f, o.k) += c.f.change;
        return;
    }
    if (o.k == 0) {
        c.f.c[0] = c.b[0];
        return;
    }
    const int k = o.k, columns = static_cast<int>(c.b.size());
    double sum = c.b[1] * at(s, k);
    for (int n = 2; n <= k; ++n) {
        double& power = c.power[n * columns + k];
        if (c.fills) {
            const double* const lower =
                n == 2 ? s.c : c.power + (n - 1) * columns;  // σⁿ⁻¹ begins at order n - 1
            power = 0;
            for (int i = 1; i + (n - 1) <= k; ++i) power += at(s, i) * lower[k - i];
        }
        sum += c.b[static_cast<std::size_t>(n)] * power;
    }
    at(c.f, k) = sum;
}

}  // namespace elastocheck::recursive::series
