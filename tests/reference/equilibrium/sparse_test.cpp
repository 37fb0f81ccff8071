// Sparse linear algebra against dense on every built-in scene; and cost proportional to the size of
// large scenes.
#include <fmt/format.h>

#include <Eigen/Dense>

#include "models/branch.hpp"
#include "models/eigen/dense.hpp"
#include "reference/equilibrium/continuation/continuation.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The settled state and a third of every branch side of every built-in scene.
template <class See>
void at_stations(const See& see) {
    const auto files = scene_names();
    ASSERT_GE(files.size(), 20u);
    for (const auto& file : files) {
        const Model whole = compile(scene(file));
        for (const auto& branch : whole.branches)
            for (const auto& way : branch_sides(branch)) {
                const Model model = on_branch(whole, way);
                const std::vector<double> points = {way.to / 3};
                const System system = make_system(model, model.branches[0], points);
                const Options options;
                Continuation continuation = start(system, options);
                const std::string name = file + ", " + way.name;
                if (advance(continuation, 1) || begin_branch(continuation, std::abs(points[0])))
                    continue;
                see(continuation, name + ", settled");
                if (!advance(continuation, points[0])) see(continuation, name);
            }
    }
}

// ---- Null spaces

Index dense_nullity(MatrixXd A) {
    for (int sweep = 0; sweep < 10; ++sweep) {
        const auto scale = [](double size) { return size > 0 ? 1 / std::sqrt(size) : 1; };
        const VectorXd r = A.cwiseAbs().rowwise().maxCoeff().unaryExpr(scale);
        const VectorXd c = A.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(scale);
        A = r.asDiagonal() * A * c.asDiagonal();
    }
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    qr.setThreshold(1e-11);
    return A.rows() - qr.compute(A).rank();
}

void expect_null_spaces_of(const MatrixXd& J, const NullSpaces& modes, const std::string& what) {
    const MatrixXd V = modes.right, U = modes.left;
    ASSERT_EQ(V.cols(), dense_nullity(J)) << what;
    ASSERT_EQ(U.cols(), V.cols()) << what;
    if (V.cols() == 0) return;
    const auto one = MatrixXd::Identity(V.cols(), V.cols());
    const double size = J.cwiseAbs().maxCoeff();
    EXPECT_LT((J * V).cwiseAbs().maxCoeff(), 1e-10 * size) << what;
    EXPECT_LT((U.transpose() * J).cwiseAbs().maxCoeff(), 1e-10 * size) << what;
    EXPECT_LT((V.transpose() * V - one).cwiseAbs().maxCoeff(), 1e-12) << what;
    EXPECT_LT((U.transpose() * U - one).cwiseAbs().maxCoeff(), 1e-12) << what;
}

TEST(EquilibriumSparse, ComputedAndTrackedNullSpacesEqualTheDenseOnes) {
    int with_modes = 0;
    at_stations([&](const Continuation& continuation, const std::string& what) {
        const auto& at = continuation.current.linearised;
        expect_null_spaces_of(at.J, at.modes, what + ", tracked");
        expect_null_spaces_of(at.J, null_spaces(at.J), what + ", found");
        with_modes += at.modes.count() > 0;
    });
    EXPECT_GT(with_modes, 0);
}

// ---- Sparsity pattern

TEST(EquilibriumSparse, ReusedPatternCoversTheEntriesOfANewOne) {
    at_stations([&](const Continuation& continuation, const std::string& what) {
        System fresh = continuation.system;
        fresh.pattern = nullptr;
        Counts counts;
        const Loading loading = loading_at(continuation, continuation.current.t);
        const Sparse kept =
                         derivatives(continuation.system, loading, continuation.current.x, counts)
                             .J,
                     J = derivatives(fresh, loading, continuation.current.x, counts).J;
        EXPECT_EQ((MatrixXd(kept) - MatrixXd(J)).cwiseAbs().maxCoeff(), 0) << what;
    });
}

// ---- Stability

MatrixXd null_space(const MatrixXd& A) {
    if (A.rows() == 0) return MatrixXd::Identity(A.cols(), A.cols());
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    qr.setThreshold(1e-10);
    qr.compute(A.transpose());
    const MatrixXd Q = matrix_Q(qr);
    return Q.rightCols(Q.cols() - qr.rank());
}

// By M itself, with its idle modes fixed.
double dense_smallest(const System& system, const Linearisation& at) {
    const Index n = 6 * system.bodies;
    const MatrixXd J = at.J, A = J.topLeftCorner(n, n);
    const MatrixXd Z = null_space(J.bottomLeftCorner(system.constraint_rows, n));
    if (Z.cols() == 0) return 1;
    const MatrixXd held = Z.transpose() * MatrixXd(at.modes.right).topRows(n);
    const MatrixXd M =
        -Z.transpose() * A * Z + std::max(A.cwiseAbs().maxCoeff(), 1.) * held * held.transpose();
    const Eigen::EigenSolver<MatrixXd> solver(M, false);
    double least = std::numeric_limits<double>::infinity(), modulus = least;
    int negative = 0;
    for (const auto& mu : solver.eigenvalues()) {
        const bool real = std::abs(mu.imag()) <= 1e-9 * std::abs(mu);
        least = std::min(least, real ? mu.real() : std::abs(mu));
        modulus = std::min(modulus, std::abs(mu));
        negative += real && mu.real() < 0;
    }
    return system.conservative ? least : negative % 2 == 0 ? modulus : -modulus;
}

TEST(EquilibriumSparse, LeastStiffnessEqualsTheDenseEigenvalue) {
    Worst worst;
    at_stations([&](const Continuation& continuation, const std::string& what) {
        const double least = dense_smallest(continuation.system, continuation.current.linearised);
        worst.add(std::abs(continuation.current.stiffness.least / least - 1), what);
    });
    EXPECT_TRUE(within(worst, 1e-6));
}

// Forty bodies, each a thousand times as stiff as its neighbour at first, beside a column far
// beyond its buckling load: its negative eigenvalue is the farthest from zero.
TEST(EquilibriumSparse, NegativeEigenvalueFarFromZeroIsFound) {
    for (const bool stable : {true, false}) {
        Scene s = hinged_bar({0, 0, 0.5}, {0, 1, 0}, 1000);
        s.branches = {pull({0, {0, 0, 0.5}}, {0, 0, stable ? 1. : -1.})};
        for (int k = 0; k < 12; ++k) {
            const Vector3d at(0.1 * k, 1, 0);
            s.bodies.push_back({fmt::format("block {}", k), {at, Quaterniond::Identity()}});
            Bushing mount;
            mount.i = {ground, at};
            mount.j = {k + 1, {0, 0, 0}};
            stiffness_of(mount).diagonal().setConstant(std::pow(10., std::max(0, 3 - k)));
            s.elastics.push_back({"mount", mount});
            s.probes.push_back({fmt::format("block {}", k), {k + 1, {0, 0, 0}}});
        }
        const Model model = compile(s);
        const std::vector<double> points = {1e6};
        const System system = make_system(model, model.branches[0], points);
        Counts counts;
        const VectorXd x = design_unknowns(system);
        const auto at = linearise(derivatives(system, {1e6}, x, counts).J, nullptr, counts);
        const double least = stiffness(system, at).least;
        EXPECT_EQ(least > 0, stable) << least;
        EXPECT_NEAR(least / dense_smallest(system, at), 1, 1e-6);
    }
}

// ---- Bifurcation of the constraints

TEST(EquilibriumSparse, SignOfTheConstraintDeterminantEqualsTheDenseOne) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> in(-1, 1);
    int kept = 0, changed = 0;
    at_stations([&](const Continuation& continuation, const std::string& what) {
        const System& system = continuation.system;
        const Index n = 6 * system.bodies, m = system.constraint_rows;
        const Linearisation& from = continuation.current.linearised;
        if (m == 0) return;
        Counts counts;
        for (const double away : {0.1, 1., 2.}) {
            const VectorXd dx =
                away * VectorXd::NullaryExpr(system.equations(), [&] { return in(random); });
            Linearisation to;
            to.J = derivatives(system, loading_at(continuation, continuation.current.t),
                               moved(system, continuation.current.x, dx), counts)
                       .J;
            const MatrixXd begin = MatrixXd(from.J).bottomLeftCorner(m, n),
                           end = MatrixXd(to.J).bottomLeftCorner(m, n);
            const MatrixXd Z = null_space(begin), U = null_space(begin.transpose());
            ASSERT_EQ(m + Z.cols(), n + U.cols()) << what;
            const auto determinant = [&](const MatrixXd& Phi_q) {
                MatrixXd B = MatrixXd::Zero(m + Z.cols(), n + U.cols());
                B.topLeftCorner(m, n) = Phi_q;
                B.topRightCorner(m, U.cols()) = U;
                B.bottomLeftCorner(Z.cols(), n) = Z.transpose();
                return B.determinant();
            };
            const bool keep = determinant(begin) * determinant(end) > 0;
            EXPECT_EQ(constraints_keep_their_side(system, from, to), keep) << what << ", " << away;
            ++(keep ? kept : changed);
        }
    });
    EXPECT_GT(kept, 20);
    EXPECT_GT(changed, 20);
}

// ---- Least squares

TEST(EquilibriumSparse, LeastSquaresSolutionHasMinimumNorm) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> in(-1, 1);
    const auto any = [&](Index rows, Index cols) {
        return MatrixXd(MatrixXd::NullaryExpr(rows, cols, [&] { return in(random); }));
    };
    for (const auto& [rows, cols, rank] : {std::tuple<Index, Index, Index>{9, 5, 5},
                                           {9, 5, 3},
                                           {5, 9, 5},
                                           {5, 9, 2},
                                           {6, 6, 6},
                                           {6, 6, 4}}) {
        const MatrixXd A = any(rows, rank) * any(rank, cols);
        const VectorXd b = any(rows, 1), x = least_squares(A.sparseView(), b);
        const VectorXd pseudo = A.completeOrthogonalDecomposition().solve(b);
        EXPECT_LT((x - pseudo).norm(), 1e-10 * pseudo.norm())
            << rows << " x " << cols << ", rank " << rank;
    }
}

// ---- Large scenes

// Blocks in a row, connected by springs of rate k: under P, the n-th moves by n P / k.
TEST(EquilibriumSparse, ThousandSpringsInSeriesCarryTheSameForce) {
    constexpr int n = 1000;
    constexpr double k = 1e5, P = 300, h = 1e-2;
    Scene s;
    s.name = "springs in series";
    for (int b = 0; b < n; ++b) {
        s.bodies.push_back(
            {fmt::format("block {}", b), {{(b + 1) * h, 0, 0}, Quaterniond::Identity()}});
        Bushing spring;
        spring.i = {b - 1, {h / 2, 0, 0}};
        spring.j = {b, {-h / 2, 0, 0}};
        stiffness_of(spring).diagonal() << k, k, k, 1e3, 1e3, 1e3;
        s.elastics.push_back({fmt::format("spring {}", b), spring});
    }
    s.branches = {pull({n - 1, {0, 0, 0}}, {1, 0, 0})};
    s.probes = {{"end", {n - 1, {0, 0, 0}}}};
    const Model model = compile(s);
    const std::vector<double> loads = {P};
    const auto path = solve(model, model.branches[0], loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    Worst worst;
    for (int b = 0; b < n; ++b) {
        const Vector3d exact((b + 1) * (h + P / k), 0, 0);
        worst.add(
            (path.points[0].poses[static_cast<std::size_t>(b)].r - exact).norm() / exact.norm(),
            fmt::format("block {}", b));
    }
    EXPECT_TRUE(within(worst, 1e-10));
}

// Hinges about z with torsion springs of n times the single rate: for any n, a moment at the end
// gives the same rotation in the same number of steps.
TEST(EquilibriumSparse, ThousandHingesNeedAsManyStepsAsTen) {
    constexpr double c = 100, M = 80, L = 1;
    std::vector<long> factorisations;
    for (const int n : {10, 1000}) {
        Scene s;
        s.name = fmt::format("{} hinges", n);
        const double h = L / n;
        for (int b = 0; b < n; ++b) {
            s.bodies.push_back(
                {fmt::format("bar {}", b), {{(b + 1) * h, 0, 0}, Quaterniond::Identity()}});
            const Vector3d end(0, 0, 0), begin(-h, 0, 0), z(0, 0, 1);
            s.joints.push_back({fmt::format("hinge {}", b),
                                Revolute{{b, begin}, {b - 1, end}, {b, z}, {b - 1, z}}});
            Bushing torsion;
            torsion.i = {b - 1, end};
            torsion.j = {b, begin};
            stiffness_of(torsion).diagonal() << 0, 0, 0, 0, 0, c * n;
            s.elastics.push_back({fmt::format("torsion {}", b), torsion});
        }
        s.branches = {twist(n - 1, {0, 0, 1})};
        s.probes = {{"end", {n - 1, {0, 0, 0}}}};
        const Model model = compile(s);
        const std::vector<double> loads = {M};
        const auto path = solve(model, model.branches[0], loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        factorisations.push_back(path.counts.factorisations);
        Worst worst;
        for (int b = 0; b < n; ++b) {
            const Quaterniond turn(Eigen::AngleAxisd(M / (c * n) * (b + 1), Vector3d::UnitZ()));
            worst.add(path.points[0].poses[static_cast<std::size_t>(b)].p.angularDistance(turn),
                      fmt::format("bar {} of {}", b, n));
        }
        EXPECT_TRUE(within(worst, 1e-10));
    }
    EXPECT_LE(factorisations[1], factorisations[0] + factorisations[0] / 2);
}

// Rods between two balls, each on ground: every one has its own idle spin and its own self-stress.
TEST(EquilibriumSparse, NullSpacesOfHundredsOfRodsHaveSparseColumns) {
    for (const int n : {3, 150}) {
        Scene s;
        s.name = fmt::format("{} rods", n);
        for (int b = 0; b < n; ++b) {
            const Vector3d at(0.01 * b, 0.3, 0.1), along(0, 0.5, 0.2);
            s.bodies.push_back({fmt::format("rod {}", b), {at, Quaterniond::Identity()}});
            for (const double end : {-1., 1.})
                s.joints.push_back({fmt::format("ball {} {}", b, end),
                                    Spherical{{b, end * along}, {ground, at + end * along}}});
            s.probes.push_back({fmt::format("rod {}", b), {b, {0.1, 0, 0}}});
        }
        s.branches = {pull({n - 1, {0, 0, 0}}, {1, 0, 0})};
        const Model model = compile(s);
        ASSERT_EQ(model.bodies.size(), static_cast<std::size_t>(n));
        const std::vector<double> points = {100};
        const System system = make_system(model, model.branches[0], points);
        const Options options;
        Continuation continuation = start(system, options);
        ASSERT_FALSE(advance(continuation, 1));
        ASSERT_FALSE(begin_branch(continuation, 100));
        const auto failed = advance(continuation, 100);
        ASSERT_FALSE(failed) << failed->what;
        const NullSpaces& modes = continuation.current.linearised.modes;
        EXPECT_EQ(modes.count(), 2 * n);
        EXPECT_LE(modes.right.nonZeros(), 12 * modes.count());
        EXPECT_LE(modes.left.nonZeros(), 12 * modes.count());
    }
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
