// The factorisation against a dense one, and the zeros it counts on.
#include "recursive/sparse_lu.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace elastocheck::recursive {
namespace {

// A saddle-point matrix with zeros all over the place: [K Aᵀ; A 0] of random sizes.
Matrix<double> random_saddle_point(std::mt19937& random, int n, int m) {
    std::uniform_real_distribution<double> value(-1, 1);
    std::bernoulli_distribution zero(0.6);
    Matrix<double> M = Matrix<double>::Zero(n + m, n + m);
    for (int i = 0; i < n + m; ++i)
        for (int j = 0; j <= i; ++j)
            if (j < n && (i == j || i == n + j || !zero(random)))
                M(i, j) = M(j, i) = value(random) + (i == j || i == n + j ? 2 : 0);
    return M;
}

// The three calls for a dense matrix: its entries other than zero are the pattern.
Pattern pattern_of(const Matrix<double>& A) {
    Pattern pattern{static_cast<int>(A.rows()), {}, {}};
    for (int j = 0; j < pattern.size; ++j) {
        pattern.first.push_back(static_cast<int>(pattern.row.size()));
        for (int i = 0; i < pattern.size; ++i)
            if (A(i, j) != 0) pattern.row.push_back(i);
    }
    pattern.first.push_back(static_cast<int>(pattern.row.size()));
    return pattern;
}
std::vector<double> values_of(const Pattern& pattern, const Matrix<double>& A) {
    std::vector<double> values;
    for (int j = 0; j < pattern.size; ++j)
        for (int e = pattern.first[static_cast<std::size_t>(j)];
             e < pattern.first[static_cast<std::size_t>(j) + 1]; ++e)
            values.push_back(A(pattern.row[static_cast<std::size_t>(e)], j));
    return values;
}
void analyse(SparseLU<double>& lu, const Matrix<double>& A) {
    const Pattern pattern = pattern_of(A);
    recursive::analyse(lu, pattern, values_of(pattern, A).data());
}
double factorise(SparseLU<double>& lu, const Matrix<double>& A) {
    return recursive::factorise(lu, values_of(lu.order.pattern, A).data());
}

TEST(SparseLU, SolvesWhatDenseFactorsSolve) {
    std::mt19937 random(1);
    double worst = 0;
    for (int n = 1; n <= 20; ++n)
        for (int m = 0; m <= n / 2; ++m) {
            Matrix<double> M = random_saddle_point(random, n, m);
            SparseLU<double> lu;
            analyse(lu, M);
            for (int again = 0; again < 5; ++again) {  // other values in the same places
                M = (M.array() * (1 + 0.3 * Matrix<double>::Random(n + m, n + m).array())).matrix();
                ASSERT_GT(factorise(lu, M), 0);
                const Vector<double> b = Vector<double>::Random(n + m);
                Vector<double> x(n + m);
                solve(lu, b.data(), x.data());
                worst = std::max(worst, (M * x - b).norm() / (M.norm() * x.norm()));
            }
        }
    EXPECT_LE(worst, 1e-14);
}

TEST(SparseLU, ASingularMatrixSpoilsNoneThatFollows) {
    Matrix<double> A(3, 3);
    A << 4, 1, 1, 1, 4, 0, 1, 0, 4;  // an arrow, whose point fills in what is left when it goes first
    const Pattern pattern = pattern_of(A);
    SparseLU<double> lu;
    recursive::analyse(lu, pattern, std::vector<double>(pattern.entries(), 0.0).data());
    EXPECT_EQ(recursive::factorise(lu, std::vector<double>(pattern.entries(), 0.0).data()), 0);
    for (int again = 0; again < 2; ++again) {
        ASSERT_GT(factorise(lu, A), 0);
        const Vector<double> b = Vector<double>::Ones(3);
        Vector<double> x(3);
        solve(lu, b.data(), x.data());
        EXPECT_LE((A * x - b).norm(), 1e-15);
    }
}

TEST(SparseLU, ChoosesAnewWhenAPivotShrinks) {
    Matrix<double> A(3, 3);
    A << 4, 1, 0, -1, 3, 1, 0, -1, 2;  // regular for any diagonal that is not negative, and one zero
    SparseLU<double> lu;
    analyse(lu, A);
    for (double pivot = 1; pivot > 1e-17; pivot /= 10) {
        for (int k = 0; k < 3; ++k) {  // whichever comes first in the order
            Matrix<double> B = A;
            B(k, k) *= pivot;
            ASSERT_GT(factorise(lu, B), 0);
            const Vector<double> b = Vector<double>::Ones(3);
            Vector<double> x(3);
            solve(lu, b.data(), x.data());
            EXPECT_LE((x - B.fullPivLu().solve(b)).norm(), 1e-14 * x.norm()) << pivot << " " << k;
        }
    }
    EXPECT_GT(lu.orders, 1);
}

TEST(SparseLU, KeepsItsOrderWhileItServes) {
    std::mt19937 random(2);
    const Matrix<double> M = random_saddle_point(random, 12, 5);
    SparseLU<double> lu;
    analyse(lu, M);
    for (int k = 0; k < 100; ++k) factorise(lu, (1 + 0.01 * k) * M);
    EXPECT_EQ(lu.orders, 1);
}

TEST(SparseLU, SaysSingularAndNotFinite) {
    Matrix<double> A(3, 3);
    A << 1, 2, 0, 2, 4, 0, 0, 0, 1;
    SparseLU<double> lu;
    analyse(lu, A);
    EXPECT_EQ(factorise(lu, A), 0);
    A(1, 1) = 5;
    EXPECT_GT(factorise(lu, A), 0.01);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        A(2, 2) = bad;
        EXPECT_TRUE(std::isnan(factorise(lu, A)));
    }
    A(2, 2) = 1;
    EXPECT_GT(factorise(lu, A), 0.01);
}

TEST(SparseLU, AnOrderServesOtherArithmetics) {
    std::mt19937 random(5);
    const Matrix<double> M = random_saddle_point(random, 14, 6);
    SparseLU<double> lu;
    analyse(lu, M);
    SparseLU<long double> other;
    recursive::analyse(other, lu.order);
    const std::vector<double> values = values_of(lu.order.pattern, M);
    const std::vector<long double> same(values.begin(), values.end());
    ASSERT_GT(recursive::factorise(other, same.data()), 0);
    EXPECT_EQ(other.orders, 0);  // chosen once
    const Vector<long double> b = Vector<long double>::Ones(20);
    Vector<long double> x(20);
    solve(other, b.data(), x.data());
    EXPECT_LE(static_cast<double>((M.cast<long double>() * x - b).norm()), 1e-16);
}

TEST(SparseLU, KnowsTheSignAndSizeOfTheDeterminant) {
    std::mt19937 random(6);
    for (int trial = 0; trial < 20; ++trial) {
        const Matrix<double> M = random_saddle_point(random, 8, 3);
        SparseLU<double> lu;
        analyse(lu, M);
        factorise(lu, M);
        const double det = M.fullPivLu().determinant();
        EXPECT_EQ(lu.orientation, det < 0 ? -1 : 1);
        EXPECT_NEAR(log_determinant(lu), std::log2(std::abs(det)), 1e-9);
    }
}

}  // namespace
}  // namespace elastocheck::recursive
