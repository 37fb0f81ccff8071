#include "recursive/batch/kernels.hpp"

#include "recursive/series/terms.hpp"

namespace elastocheck::recursive::batch {
namespace {

void eliminate_all(Factors& lu) {
    const std::size_t n = lu.size();
    const Elimination& order = *lu.order;
    Lanes* const LU = lu.LU.data();
    Lanes min_pivot = std::numeric_limits<double>::infinity(), max_pivot = 0, multiplier = 0,
          sign = order.parity, finite = 0;
    std::fill(lu.LU.begin(), lu.LU.end(), Lanes(0));
    for (std::size_t e = 0; e < lu.values.size(); ++e) {
        LU[order.to[e]] = lu.values[e];
        finite += lu.values[e] * 0;
    }
    const int* target = order.target.data();
    for (std::size_t k = 0; k < n; ++k) {
        const Lanes pivot = LU[order.pivot[k]], size = abs(pivot), inverse = 1 / pivot;
        lu.inverse[k] = inverse;
        min_pivot = smaller(size, min_pivot);
        max_pivot = larger(size, max_pivot);
        finite += pivot * 0;
        sign = with_sign_of(pivot, sign);
        const auto* const last = order.right.data() + order.first_right[k + 1];
        for (int e = order.first_below[k]; e < order.first_below[k + 1]; ++e) {
            const int at = order.below[static_cast<std::size_t>(e)].at;
            const Lanes l = LU[at] * inverse;
            LU[at] = l;
            multiplier = larger(abs(l), multiplier);
            for (const auto* run = order.right.data() + order.first_right[k]; run != last; ++run) {
                Lanes* const a = LU + *target++;
                const Lanes* const u = LU + run->at;
                for (int c = 0; c < run->length; ++c) a[c] -= l * u[c];
            }
        }
    }
    lu.min_pivot = min_pivot;
    lu.largest_pivot = max_pivot;
    lu.largest_multiplier = multiplier;
    lu.sign = sign;
    lu.finite = finite;
}

void solve_all(Factors& lu, const Lanes* b, Lanes* x) {
    const std::size_t n = lu.size();
    const Elimination& order = *lu.order;
    Lanes* const y = lu.y.data();
    const Lanes* const LU = lu.LU.data();
    const int* const column = order.column.data();
    for (std::size_t i = 0; i < n; ++i) {
        Lanes sum = b[order.row[i]];
        for (int at = order.first[i]; at < order.pivot[i]; ++at) sum -= LU[at] * y[column[at]];
        y[i] = sum;
    }
    for (std::size_t k = n; k-- > 0;) {
        Lanes sum = y[k];
        for (int at = order.pivot[k] + 1; at < order.first[k + 1]; ++at)
            sum -= LU[at] * y[column[at]];
        x[order.col[k]] = y[k] = sum * lu.inverse[k];
    }
}

Lanes min_pivot_of(Matrix<Lanes>& A) {
    Lanes least = std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < A.rows(); ++k) {
        const Lanes pivot = A(k, k);
        least = smaller(pivot, least);
        for (Eigen::Index j = k + 1; j < A.rows(); ++j) {
            const Lanes l = A(j, k) / pivot;
            for (Eigen::Index i = j; i < A.rows(); ++i) A(i, j) -= l * A(i, k);
        }
    }
    return least;
}

// `flatten` compiles all that a function calls with the function's own target.
#if defined(__x86_64__) && defined(__GNUC__)
#define ELASTOCHECK_WITH_AVX2 [[gnu::flatten, gnu::target("avx2")]]
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
#else
#define ELASTOCHECK_WITH_AVX2
bool has_avx2() { return false; }
#endif
bool with_avx2 = has_avx2();

ELASTOCHECK_WITH_AVX2 void evaluate_avx2(series::Equations<Lanes>& e, series::Order o) {
    series::evaluate<Lanes>(e, o);
}
ELASTOCHECK_WITH_AVX2 void eliminate_avx2(Factors& lu) { eliminate_all(lu); }
ELASTOCHECK_WITH_AVX2 void solve_avx2(Factors& lu, const Lanes* b, Lanes* x) {
    solve_all(lu, b, x);
}
ELASTOCHECK_WITH_AVX2 void min_pivot_avx2(Matrix<Lanes>& A, Lanes& least) {
    least = min_pivot_of(A);
}

}  // namespace

bool use_avx2(bool wanted) {
    with_avx2 = wanted && has_avx2();
    return with_avx2;
}

void evaluate(series::Equations<Lanes>& e, series::Order o) {
    with_avx2 ? evaluate_avx2(e, o) : series::evaluate<Lanes>(e, o);
}
void eliminate(Factors& lu) { with_avx2 ? eliminate_avx2(lu) : eliminate_all(lu); }
void solve(Factors& lu, const Lanes* b, Lanes* x) {
    with_avx2 ? solve_avx2(lu, b, x) : solve_all(lu, b, x);
}
Lanes min_pivot(Matrix<Lanes>& A) {
    Lanes least = 0;
    if (with_avx2)
        min_pivot_avx2(A, least);
    else
        least = min_pivot_of(A);
    return least;
}

Factors reserve_factors(const Elimination& order) {
    Factors lu;
    lu.order = &order;
    const auto n = static_cast<std::size_t>(order.pattern.size);
    lu.values.assign(order.pattern.entries(), 0);
    lu.LU.assign(order.column.size(), 0);
    for (auto* list : {&lu.inverse, &lu.y}) list->assign(n, 0);
    return lu;
}

double log_determinant(const Factors& lu, int lane) {
    double sum = 0;
    for (const Lanes& inverse : lu.inverse) sum -= std::log2(std::abs(inverse[lane]));
    return sum;
}

}  // namespace elastocheck::recursive::batch

// Explicit instantiations of the series for Lanes.
namespace elastocheck::recursive::series {
template struct Equations<batch::Lanes>;
template Equations<batch::Lanes> equations<batch::Lanes>(const Model&, const Branch&, int, Drive);
template void take<batch::Lanes>(Equations<batch::Lanes>&, const Model&, const Branch&, int);
template void settle_on_constants<batch::Lanes>(Equations<batch::Lanes>&);
template CubicSeries<batch::Lanes>& cubic_of<batch::Lanes>(Equations<batch::Lanes>&, std::size_t,
                                                           int);
template const batch::Lanes& deformation<batch::Lanes>(const Equations<batch::Lanes>&, std::size_t,
                                                       int, int);
template void begin<batch::Lanes>(Equations<batch::Lanes>&, const State<double>&,
                                  const Vector<double>&, double, int);
template void assign<batch::Lanes>(Equations<batch::Lanes>&, int, const Vector<batch::Lanes>&,
                                   const batch::Lanes&);
}  // namespace elastocheck::recursive::series
