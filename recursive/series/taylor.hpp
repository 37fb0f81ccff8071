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
#include <vector>

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

// The arithmetic of the coefficients: double, or several variants at once, one to a lane
// (recursive/batch/lanes.hpp). For a lane's number, and what holds of all of them:
inline void set_lane(double& all, int, double value) { all = value; }
inline double lane(double all, int) { return all; }
inline bool is_zero(double all) { return all == 0; }

template <class T>
struct Series {
    T* c = nullptr;  // c[0 ... p], in the memory of its equations
    T change;        // contribution of x_k to c[k]
    int last = 0;    // coefficients beyond it are zero: 0 for a constant

    Series() : change(zero()) {}
    static T zero() {
        if constexpr (std::is_base_of_v<Eigen::MatrixBase<T>, T>)
            return T::Zero();
        else
            return T(0);
    }
};
template <class Real>
using Vector2 = Eigen::Matrix<Real, 2, 1>;
template <class Real>
using Vector4 = Eigen::Matrix<Real, 4, 1>;
template <class Real>
using Vector2Series = Series<Vector2<Real>>;
template <class Real>
using Vector3Series = Series<Vector3<Real>>;
template <class Real>
using Vector6Series = Series<Vector6<Real>>;
template <class Real>
using Matrix3Series = Series<Matrix3<Real>>;

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

inline constexpr auto scale =
    []<class Real>(const Real& a, const Vector3<Real>& b) -> Vector3<Real> { return a * b; };
inline constexpr auto dot = []<class Real>(const Vector3<Real>& a, const Vector3<Real>& b) -> Real {
    return a.dot(b);
};
inline constexpr auto cross = []<class Real>(const Vector3<Real>& a,
                                             const Vector3<Real>& b) -> Vector3<Real> {
    return a.cross(b);
};
inline constexpr auto outer = []<class Real>(const Vector3<Real>& a,
                                             const Vector3<Real>& b) -> Matrix3<Real> {
    return a * b.transpose();
};
inline constexpr auto apply = []<class Real>(const Matrix3<Real>& A,
                                             const Vector3<Real>& b) -> Vector3<Real> {
    return A * b;
};
inline constexpr auto apply_transposed = []<class Real>(const Matrix3<Real>& A,
                                                        const Vector3<Real>& b) -> Vector3<Real> {
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
template <class Real>
void reciprocal(Order o, const Series<Real>& a, Series<Real>& c) {
    if (o.pass == Pass::change) {
        c.change = -a.change * c.c[0] * c.c[0];
        at(c, o.k) += c.change;
    } else if (o.k == 0) {
        c.c[0] = 1 / a.c[0];
    } else {
        Real sum = 0;
        for (int i = 1; i <= o.k; ++i) sum += at(a, i) * at(c, o.k - i);
        at(c, o.k) = -sum * c.c[0];
    }
}

// c = √a:  Σ c_i c_{k-i} = a_k
template <class Real>
void square_root(Order o, const Series<Real>& a, Series<Real>& c) {
    if (o.pass == Pass::change) {
        c.change = a.change / (2 * c.c[0]);
        at(c, o.k) += c.change;
    } else if (o.k == 0) {
        using std::sqrt;
        c.c[0] = sqrt(a.c[0]);
    } else {
        Real sum = at(a, o.k);
        for (int i = 1; i < o.k; ++i) sum -= at(c, i) * at(c, o.k - i);
        at(c, o.k) = sum / (2 * c.c[0]);
    }
}

// c = cos α, s = sin α:  c' = -s α',  s' = c α'
template <class Real>
void cosine_sine(Order o, const Series<Real>& alpha, Series<Real>& c, Series<Real>& s) {
    if (o.pass == Pass::change) {
        c.change = -s.c[0] * alpha.change;
        s.change = c.c[0] * alpha.change;
        at(c, o.k) += c.change;
        at(s, o.k) += s.change;
    } else if (o.k == 0) {
        using std::cos;
        using std::sin;
        c.c[0] = cos(alpha.c[0]);
        s.c[0] = sin(alpha.c[0]);
    } else {
        Real of_c = 0, of_s = 0;
        for (int i = 1; i <= std::min(o.k, alpha.last); ++i) {
            of_c -= i * at(alpha, i) * at(s, o.k - i);
            of_s += i * at(alpha, i) * at(c, o.k - i);
        }
        at(c, o.k) = of_c / o.k;
        at(s, o.k) = of_s / o.k;
    }
}

// α of u = (cos α, sin α):  α' = u × u'
template <class Real>
void arc(Order o, const Vector2Series<Real>& u, Series<Real>& alpha) {
    const auto across = [](const Vector2<Real>& a, const Vector2<Real>& b) -> Real {
        return a.x() * b.y() - a.y() * b.x();
    };
    if (o.pass == Pass::change) {
        alpha.change = across(u.c[0], u.change);
        at(alpha, o.k) += alpha.change;
    } else if (o.k == 0) {
        using std::atan2;
        alpha.c[0] = atan2(u.c[0].y(), u.c[0].x());
    } else {
        Real sum = 0;
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
    const int beyond =
        shrinks > 0 ? static_cast<int>(std::clamp(-40 / std::log(shrinks), 0., 1e6)) : 0;
    double next = 0;
    for (int n = p + beyond; n >= 0; --n) {
        next = ((n % 2 == 0 ? inverse : -inverse) - 2 * (n + 1) * shrinks * next) / (2 * n + m);
        if (n <= p) b[static_cast<std::size_t>(n)] = next;
    }
    double power = 1;
    for (int n = 0; n <= p; ++n, power *= inverse) b[static_cast<std::size_t>(n)] *= power;
}
// The same in every lane.
template <class Real>
void taylor_of_F(int m, const Real& s_0, std::span<Real> b) {
    std::vector<double> one(b.size());
    for (int at = 0; at < Real::count; ++at) {
        taylor_of_F(m, lane(s_0, at), std::span<double>(one));
        for (std::size_t n = 0; n < b.size(); ++n) set_lane(b[n], at, one[n]);
    }
}

// f(s(τ)) from the Taylor coefficients b_n of f about s_0:  Σ b_n σⁿ, σ = s - s_0.
template <class Real>
struct Composition {
    std::span<Real> b;  // [p + 1]
    Real* power;        // coefficient k of σⁿ at n (p + 1) + k, n = 2 ... p
    bool fills = true;  // whether it computes the powers; else another function of s has done so
    Series<Real> f;
};
template <class Real>
void reserve(Arena& room, Composition<Real>& c, const Composition<Real>* before = nullptr) {
    const int n = room.order + 1;
    c.b = {room.take<Real>(n, 0), static_cast<std::size_t>(n)};
    c.fills = before == nullptr;
    c.power = c.fills ? room.take<Real>(n * n, 0) : before->power;
    reserve(room, c.f);
}
template <class Real>
void compose(Order o, const Series<Real>& s, Composition<Real>& c) {
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
    // σ begins at this order, σⁿ at n times as high a one: a square without constant at 2
    const int first = k > 1 && is_zero(s.c[1]) ? 2 : 1;
    Real sum = c.b[1] * at(s, k);
    for (int n = 2; n * first <= k; ++n) {
        if (c.fills) {
            const Real* const lower = n == 2 ? s.c : c.power + (n - 1) * columns;
            Real power = 0;
            for (int i = first; i + (n - 1) * first <= k; ++i) power += at(s, i) * lower[k - i];
            c.power[n * columns + k] = power;
        }
        sum += c.b[static_cast<std::size_t>(n)] * c.power[n * columns + k];
    }
    at(c.f, k) = sum;
}

}  // namespace elastocheck::recursive::series
