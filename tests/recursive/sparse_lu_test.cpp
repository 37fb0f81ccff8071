// The factorisation against a dense one, and the zeros it counts on.
#include "recursive/sparse_lu.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "models/compile.hpp"
#include "recursive/assembly.hpp"
#include "recursive/solve.hpp"
#include "tests/support/scenes.hpp"

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

TEST(SparseLU, SolvesWhatDenseFactorsSolve) {
    std::mt19937 random(1);
    double worst = 0;
    for (int n = 1; n <= 20; ++n)
        for (int m = 0; m <= n / 2; ++m) {
            Matrix<double> M = random_saddle_point(random, n, m);
            SparseLU<double> lu;
            reserve(lu, M);
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

TEST(SparseLU, ChoosesAnewWhenAPivotShrinks) {
    Matrix<double> A(3, 3);
    A << 4, 1, 0, -1, 3, 1, 0, -1, 2;  // regular for any diagonal that is not negative, and one zero
    SparseLU<double> lu;
    reserve(lu, A);
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
    reserve(lu, M);
    for (int k = 0; k < 100; ++k) factorise<double>(lu, (1 + 0.01 * k) * M);
    EXPECT_EQ(lu.orders, 1);
}

TEST(SparseLU, SaysSingularAndNotFinite) {
    Matrix<double> A(3, 3);
    A << 1, 2, 0, 2, 4, 0, 0, 0, 1;
    SparseLU<double> lu;
    reserve(lu, A);
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

TEST(SparseLU, WhatIsZeroInTheGenericMatrixStaysZeroAlongEveryBranch) {
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        const Eigen::Index N = coordinates(model) + constraint_rows(model);
        Vector<double> Phi(constraint_rows(model));
        for (const auto& branch : model.branches) {
            const Matrix<double> generic = generic_matrix<double>(model, branch, Matrix<double>::Zero(N, N));
            const auto path = solve(model, branch, {.method = *find_method("chord"), .steps = 60});
            for (const auto& point : path.points) {
                Matrix<double> M = Matrix<double>::Zero(N, N);
                assemble_consistent<double>(model, branch, inputs_at<double>(model, branch, point.load), state_of<double>(point.poses),
                                            1e3 * Vector<double>::Random(constraint_rows(model)), M, Phi);
                for (Eigen::Index i = 0; i < N; ++i)
                    for (Eigen::Index j = 0; j < N; ++j) {
                        if (generic(i, j) != 0) continue;
                        EXPECT_LE(std::abs(M(i, j)), 1e-14 * M.row(i).cwiseAbs().maxCoeff())
                            << name << " " << i << " " << j;
                    }
            }
        }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
