// Sparse LU against a dense factorisation, and its sparsity.
#include "recursive/linear_algebra/sparse_lu.hpp"
#include "recursive/diagnosis/analysis.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace elastocheck::recursive {
namespace {

// A random sparse saddle-point matrix [K Aᵀ; A 0].
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

// The three calls for a dense matrix, with its non-zeros as pattern.
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
void analyse_dense(SparseLU<double>& lu, const Matrix<double>& A) {
    const Pattern pattern = pattern_of(A);
    recursive::analyse(lu, pattern, values_of(pattern, A).data());
}
double factorise_dense(SparseLU<double>& lu, const Matrix<double>& A) {
    return recursive::factorise(lu, values_of(lu.order->pattern, A).data());
}

// Residual, and sign and size of the determinant, for other values in the same places.
void expect_as_dense(Matrix<double> M, int times) {
    SparseLU<double> lu;
    analyse_dense(lu, M);
    const Eigen::Index n = M.rows();
    for (int again = 0; again < times; ++again) {
        M = (M.array() * (1 + 0.1 * Matrix<double>::Random(n, n).array())).matrix();
        ASSERT_GT(factorise_dense(lu, M), 0);
        const Vector<double> b = Vector<double>::Random(n);
        Vector<double> x(n);
        solve(lu, b.data(), x.data());
        EXPECT_LE((M * x - b).norm(), 1e-14 * M.norm() * x.norm()) << n;
        const Eigen::PartialPivLU<Matrix<double>> dense(M);
        EXPECT_LE((x - dense.solve(b)).norm(), 1e-10 * x.norm()) << n;
        EXPECT_EQ(lu.orientation, dense.determinant() < 0 ? -1 : 1) << n;
        EXPECT_NEAR(log_determinant(lu), dense.matrixLU().diagonal().array().abs().log2().sum(),
                    1e-9 * static_cast<double>(n))
            << n;
    }
    EXPECT_LE(lu.LU.size(), static_cast<std::size_t>(40 * n));
}

// A saddle-point matrix with the sparsity of a large model: n coordinates, each coupled to the next
// and to a few others, m constraint rows on three neighbours each.
Matrix<double> sparse_saddle_point(std::mt19937& random, int n, int m) {
    std::uniform_real_distribution<double> value(-1, 1);
    Matrix<double> M = Matrix<double>::Zero(n + m, n + m);
    const auto tie = [&](int i, int j, double k) {
        M(i, i) += k;
        M(j, j) += k;
        M(i, j) -= k;
        M(j, i) -= k;
    };
    for (int i = 0; i < n; ++i) M(i, i) = 1;
    for (int i = 1; i < n; ++i) tie(i, i - 1, 1 + value(random));
    for (int k = 0; k < n / 10; ++k) {
        const int i = static_cast<int>(random() % static_cast<unsigned>(n)), j = (i + 2) % n;
        tie(i, j, 1 + value(random));
    }
    for (int k = 0; k < m; ++k)
        for (int c = 0; c < 3; ++c) {
            const int j = (k * n / m + c) % n;
            M(n + k, j) = M(j, n + k) = value(random) + (c == 0 ? 2 : 0);
        }
    return M;
}

std::size_t fill_in(const SparseLU<double>& lu) {
    return lu.order->nonzeros - lu.order->pattern.entries();
}

TEST(SparseLU, ChainAndArrowMatricesHaveNoFillAtAnySize) {
    for (const int n : {3, 10, 59, 60, 61, 200, 1000}) {
        Matrix<double> chain = Matrix<double>::Zero(n, n), arrow = Matrix<double>::Zero(n, n);
        for (int i = 0; i < n; ++i) {
            chain(i, i) = arrow(i, i) = 4;
            if (i > 0) chain(i, i - 1) = chain(i - 1, i) = arrow(0, i) = arrow(i, 0) = -1;
        }
        arrow(0, 0) = n;
        for (const auto& A : {chain, arrow}) {
            SparseLU<double> lu;
            analyse_dense(lu, A);
            EXPECT_EQ(fill_in(lu), 0u) << n;
            EXPECT_EQ(lu.order->nonzeros, static_cast<std::size_t>(3 * n - 2)) << n;
            ASSERT_GT(factorise_dense(lu, A), 0);
            const Vector<double> x = Vector<double>::Random(n), b = A * x;
            Vector<double> y(n);
            solve(lu, b.data(), y.data());
            EXPECT_LE((y - x).norm(), 1e-13 * x.norm()) << n;
        }
    }
}

TEST(SparseLU, PivotSearchInFewColumnsHasTheFillOfAFullSearch) {
    std::mt19937 random(11);
    for (const auto& [n, m] : {std::pair{40, 12}, {100, 30}, {200, 60}}) {
        const Matrix<double> M = sparse_saddle_point(random, n, m);
        const Pattern pattern = pattern_of(M);
        const std::vector<double> values = values_of(pattern, M);
        const auto entries = [&](auto search) {
            PivotSearch<double> found;
            search(found, pattern, values.data());
            return static_cast<double>(found.below.size() + found.right.size());
        };
        const double all = entries(detail::search_all<double>),
                     few = entries(detail::search_few<double>);
        EXPECT_LE(few, 1.25 * all) << n;
        EXPECT_GE(few, 0.8 * all) << n;
    }
}

TEST(SparseLU, SolutionEqualsThatOfDenseFactors) {
    std::mt19937 random(12);
    for (int n = 1; n <= 20; ++n)
        for (int m = 0; m <= n / 2; ++m) expect_as_dense(random_saddle_point(random, n, m), 5);
    for (const auto& [n, m] : {std::pair{50, 20}, {200, 60}, {400, 150}})
        expect_as_dense(sparse_saddle_point(random, n, m), 3);
}

TEST(SparseLU, PartialSolutionEqualsTheFullSolution) {
    std::mt19937 random(13);
    for (const auto& [n, m] : {std::pair{8, 3}, {200, 60}}) {
        const Matrix<double> M = sparse_saddle_point(random, n, m);
        SparseLU<double> lu;
        analyse_dense(lu, M);
        ASSERT_GT(factorise_dense(lu, M), 0);
        Vector<double> e(n + m), x(n + m);
        for (int j = 0; j < n + m; j += 3) {
            e.setZero();
            e[j] = 1;
            solve(lu, e.data(), x.data());
            const std::vector<int> wanted{0, j, n / 2, n + m - 1};
            double some[4];
            solve_unit(lu, j, wanted.data(), 4, some);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_NEAR(some[k], x[wanted[k]], 1e-12 * x.cwiseAbs().maxCoeff())
                    << n << " " << j;
        }
    }
}

TEST(SparseLU, PartialSolutionVisitsOnlyReachableRows) {
    // A thousand 2×2 blocks coupled only by negligible entries.
    const int n = 2000;
    Matrix<double> A = Matrix<double>::Zero(n, n);
    for (int i = 0; i < n; ++i) A(i, i) = 2;
    for (int i = 0; i + 1 < n; i += 2) A(i, i + 1) = A(i + 1, i) = 1;
    for (int i = 1; i + 1 < n; i += 2) A(i, i + 1) = A(i + 1, i) = 1e-300;  // in the pattern
    SparseLU<double> lu;
    analyse_dense(lu, A);
    ASSERT_GT(factorise_dense(lu, A), 0);
    const int wanted[] = {1000, 1001};
    double x[2];
    solve_unit(lu, 1000, wanted, 2, x);
    EXPECT_NEAR(x[0], 2.0 / 3, 1e-15);
    EXPECT_NEAR(x[1], -1.0 / 3, 1e-15);
    EXPECT_LE(lu.reached.size(), 10u);
}

TEST(SparseLU, LargeMatrixIsReorderedWhenAPivotShrinks) {
    std::mt19937 random(14);
    const int n = 300, m = 90;
    const Matrix<double> M = sparse_saddle_point(random, n, m);
    SparseLU<double> lu;
    analyse_dense(lu, M);
    const Vector<double> b = Vector<double>::Random(n + m);
    Vector<double> x(n + m);
    for (int k = 0; k < n; k += 7) {
        Matrix<double> other = M;
        other(lu.order->row[static_cast<std::size_t>(k)],
              lu.order->col[static_cast<std::size_t>(k)]) *= 1e-14;
        ASSERT_GT(factorise_dense(lu, other), 0);
        solve(lu, b.data(), x.data());
        EXPECT_LE((other * x - b).norm(), 1e-12 * other.norm() * x.norm()) << k;
    }
    EXPECT_GT(lu.orders, 10);
}

TEST(SparseLU, FactorsAfterASingularMatrixAreCorrect) {
    for (const int n : {3, 100}) {
        Matrix<double> A = 4 * Matrix<double>::Identity(
                                   // arrow matrix: its first row fills in everything
                                   // if eliminated first
                                   n, n);
        A.row(0).tail(n - 1).setOnes();
        A.col(0).tail(n - 1).setOnes();
        A(0, 0) = n + 1;
        const Pattern pattern = pattern_of(A);
        SparseLU<double> lu;
        recursive::analyse(lu, pattern, std::vector<double>(pattern.entries(), 0.0).data());
        EXPECT_EQ(recursive::factorise(lu, std::vector<double>(pattern.entries(), 0.0).data()), 0);
        for (int again = 0; again < 2; ++again) {
            ASSERT_GT(factorise_dense(lu, A), 0);
            const Vector<double> b = Vector<double>::Ones(n);
            Vector<double> x(n);
            solve(lu, b.data(), x.data());
            EXPECT_LE((A * x - b).norm(), 1e-15 * n);
        }
    }
}

TEST(SparseLU, SolutionIsAccurateForADiagonalEntryOfAnyMagnitude) {
    Matrix<double> A(3, 3);
    A << 4, 1, 0, -1, 3, 1, 0, -1, 2;  // regular for any non-negative diagonal with one zero
    SparseLU<double> lu;
    analyse_dense(lu, A);
    for (double pivot = 1; pivot > 1e-17; pivot /= 10) {
        for (int k = 0; k < 3; ++k) {  // for each position in the order
            Matrix<double> B = A;
            B(k, k) *= pivot;
            ASSERT_GT(factorise_dense(lu, B), 0);
            const Vector<double> b = Vector<double>::Ones(3);
            Vector<double> x(3);
            solve(lu, b.data(), x.data());
            EXPECT_LE((x - B.fullPivLu().solve(b)).norm(), 1e-14 * x.norm()) << pivot << " " << k;
        }
    }
    EXPECT_GT(lu.orders, 1);
}

TEST(SparseLU, PivotOrderIsKeptWhileMultipliersAreBounded) {
    std::mt19937 random(2);
    const Matrix<double> M = random_saddle_point(random, 12, 5);
    SparseLU<double> lu;
    analyse_dense(lu, M);
    for (int k = 0; k < 100; ++k) factorise_dense(lu, (1 + 0.01 * k) * M);
    EXPECT_EQ(lu.orders, 1);
}

TEST(SparseLU, SingularAndNonFiniteMatricesAreReported) {
    Matrix<double> A(3, 3);
    A << 1, 2, 0, 2, 4, 0, 0, 0, 1;
    SparseLU<double> lu;
    analyse_dense(lu, A);
    EXPECT_EQ(factorise_dense(lu, A), 0);
    A(1, 1) = 5;
    EXPECT_GT(factorise_dense(lu, A), 0.01);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        A(2, 2) = bad;
        EXPECT_TRUE(std::isnan(factorise_dense(lu, A)));
    }
    A(2, 2) = 1;
    EXPECT_GT(factorise_dense(lu, A), 0.01);
}

TEST(SparseLU, PivotOrderFoundInDoubleServesLongDouble) {
    std::mt19937 random(5);
    const Matrix<double> M = random_saddle_point(random, 14, 6);
    SparseLU<double> lu;
    analyse_dense(lu, M);
    SparseLU<long double> other;
    recursive::analyse(other, lu);
    const std::vector<double> values = values_of(lu.order->pattern, M);
    const std::vector<long double> same(values.begin(), values.end());
    ASSERT_GT(recursive::factorise(other, same.data()), 0);
    EXPECT_EQ(other.orders, 0);  // chosen once
    const Vector<long double> b = Vector<long double>::Ones(20);
    Vector<long double> x(20);
    solve(other, b.data(), x.data());
    EXPECT_LE(static_cast<double>((M.cast<long double>() * x - b).norm()), 1e-16);
}

}  // namespace
}  // namespace elastocheck::recursive
