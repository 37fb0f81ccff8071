#include "reference/certificate/bordered.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A reciprocal condition number this much above what is nothing needs no search.
constexpr double surely_regular = 1e3;
constexpr int equilibration_sweeps = 8;
// Of a null vector's largest entry: what is below is rounding.
constexpr double no_part = 1e-12;

// D_r A D_c with rows and columns of size one (Ruiz).
struct Equilibrated {
    MatrixXd A;
    VectorXd D_r, D_c;
};
Equilibrated equilibrated(const MatrixXd& A) {
    Equilibrated of{A, VectorXd::Ones(A.rows()), VectorXd::Ones(A.cols())};
    const auto scale = [](double size) { return size > 0 ? 1 / std::sqrt(size) : 1; };
    for (int sweep = 0; sweep < equilibration_sweeps; ++sweep) {
        const VectorXd r = of.A.cwiseAbs().rowwise().maxCoeff().unaryExpr(scale),
                       c = of.A.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(scale);
        of.A = r.asDiagonal() * of.A * c.asDiagonal();
        of.D_r.array() *= r.array();
        of.D_c.array() *= c.array();
    }
    return of;
}

// x with A x = 0, and y with yᵀ A = 0, by columns.
struct NullSpaces {
    MatrixXd right, left;
};
NullSpaces null_spaces(const MatrixXd& A, double nothing) {
    const auto [E, D_r, D_c] = equilibrated(A);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(E);
    qr.setThreshold(nothing);
    const Index rank = qr.rank(), free = E.cols() - rank;
    MatrixXd x = MatrixXd::Zero(E.cols(), free);
    x.bottomRows(free).setIdentity();
    x.topRows(rank) = -qr.matrixQR()
                           .topLeftCorner(rank, rank)
                           .template triangularView<Eigen::Upper>()
                           .solve(qr.matrixQR().topRightCorner(rank, free).eval());
    const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(E.rows(), E.rows());
    return {D_c.asDiagonal() * (qr.colsPermutation() * x), D_r.asDiagonal() * Q.rightCols(E.rows() - rank)};
}

// Columns of size one, without what is rounding.
void clean(MatrixXd& columns) {
    for (Index k = 0; k < columns.cols(); ++k) {
        columns.col(k) /= columns.col(k).norm();
        const double least = no_part * columns.col(k).cwiseAbs().maxCoeff();
        columns.col(k) = columns.col(k).unaryExpr([&](double x) { return std::abs(x) < least ? 0 : x; });
    }
}

// δz of δr, δπ and δR: a quaternion turns by ½ (0, δπ) p.
MatrixXd tangent(const System& system, const VectorXd& z) {
    const int others = system.rows + system.corners();
    MatrixXd T = MatrixXd::Zero(system.n(), 6 * system.bodies + others);
    for (int b = 0; b < system.bodies; ++b) {
        const int row = system.pose(b), col = 6 * b;
        T.block<3, 3>(row, col).setIdentity();
        const double w = z[row + 3] / 2, x = z[row + 4] / 2, y = z[row + 5] / 2, u = z[row + 6] / 2;
        T.block<4, 3>(row + 3, col + 3) << -x, -y, -u, w, u, -y, -u, w, x, y, -x, w;
    }
    T.bottomRightCorner(others, others).setIdentity();
    return T;
}

}  // namespace

MatrixXd square(const std::vector<double>& J, Index n) { return Eigen::Map<const RowMajor>(J.data(), n, n); }

MatrixXd middle(const std::vector<Interval>& J, Index n) {
    MatrixXd of(n, n);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) of(i, j) = mid(J[static_cast<std::size_t>(i * n + j)]);
    return of;
}

std::vector<double> doubles(const VectorXd& x) { return {x.data(), x.data() + x.size()}; }
std::vector<Interval> thin(const VectorXd& x) { return {x.data(), x.data() + x.size()}; }
std::vector<Interval> box(const VectorXd& middle, const VectorXd& radius) {
    std::vector<Interval> y;
    for (Index k = 0; k < middle.size(); ++k) y.push_back(around(middle[k], radius[k]));
    return y;
}

Border border_at(const System& system, const VectorXd& z, double a, double nothing) {
    const Index nb = 6 * system.bodies, m = system.rows, all = nb + m + system.corners(), n = system.n();
    Border border{MatrixXd(n, 0), MatrixXd(n, 0)};
    const MatrixXd T = tangent(system, z);
    const MatrixXd J = square(evaluate(system, doubles(z), a, Slopes::yes).J, n).topRows(all) * T;
    if (!J.allFinite() || J.size() == 0) return border;
    // Of a matrix with a pivot that is nothing the estimate of its condition is nothing, too.
    const Eigen::PartialPivLU<MatrixXd> lu(equilibrated(J).A);
    if (lu.matrixLU().diagonal().cwiseAbs().minCoeff() > nothing && lu.rcond() > surely_regular * nothing)
        return border;

    // yᵀ Φ = 0: the rows y say the same, and reactions y are in balance.
    MatrixXd y = m > 0 && nb > 0 ? null_spaces(J.block(nb, 0, m, nb), nothing).left : MatrixXd(m, 0);
    clean(y);
    const Index k = y.cols();
    MatrixXd bordered = MatrixXd::Zero(all + k, all + k);
    bordered.topLeftCorner(all, all) = J;
    bordered.block(nb, all, m, k) = y;
    bordered.block(all, nb, k, m) = y.transpose();

    // Motions that meet no stiffness, and what must not push them. Only their own part: how the poses go, what acts on bodies.
    NullSpaces idle = null_spaces(bordered, nothing);
    const Index i = std::min(idle.right.cols(), idle.left.cols());
    MatrixXd v = T.topLeftCorner(7 * system.bodies, nb) * idle.right.topLeftCorner(nb, i),
             u = idle.left.topLeftCorner(nb, i);
    clean(v);
    clean(u);
    border.redundant = static_cast<int>(k);
    border.U = MatrixXd::Zero(n, k + i);
    border.g = MatrixXd::Zero(n, k + i);
    border.U.block(nb, 0, m, k) = y;
    border.g.block(7 * system.bodies, 0, m, k) = y;
    border.U.topRightCorner(nb, i) = u;
    border.g.topRightCorner(7 * system.bodies, i) = v;
    return border;
}

namespace {

// Names with at least a tenth of the largest share.
std::string largest_named(const std::vector<double>& shares,
                          const std::function<std::string(std::size_t)>& name) {
    double most = 0;
    for (const double share : shares) most = std::max(most, share);
    std::string named;
    for (std::size_t k = 0; k < shares.size(); ++k)
        if (shares[k] > 0.1 * most) named += fmt::format("{}'{}'", named.empty() ? "" : ", ", name(k));
    return named;
}

}  // namespace

std::string idle_bodies(const System& system, const Border& border) {
    std::vector<double> shares(static_cast<std::size_t>(system.bodies));
    for (int b = 0; b < system.bodies; ++b)
        for (int k = border.redundant; k < border.count(); ++k)
            shares[static_cast<std::size_t>(b)] =
                std::max({shares[static_cast<std::size_t>(b)],
                          border.g.block<3, 1>(system.pose(b), k).norm() / system.length,
                          border.g.block<4, 1>(system.pose(b) + 3, k).norm()});
    return largest_named(shares, [&](std::size_t b) { return system.model->bodies[b].name; });
}

std::string redundant_joints(const System& system, const Border& border) {
    std::vector<double> shares(system.model->joints.size());
    for (std::size_t c = 0; c < system.values.size(); ++c)
        for (int n = 0; n < rows(system.model->constraints[c].kind); ++n)
            for (int k = 0; k < border.redundant; ++k) {
                double& share = shares[static_cast<std::size_t>(system.model->constraints[c].joint)];
                share = std::max(share, std::abs(border.U(system.closure(c) + n, k)));
            }
    return largest_named(shares, [&](std::size_t j) { return system.model->joints[j].name; });
}

namespace {

template <class S>
S parameter(const Problem& problem, const std::vector<S>& y, const S& a) {
    return problem.a_is_unknown ? y.back() : a;
}
template <class S>
std::vector<S> poses_and_reactions(const Problem& problem, const std::vector<S>& y) {
    return {y.begin(), y.begin() + problem.n()};
}

// U μ and the gauges.
template <class S>
void add_border(const Problem& problem, const std::vector<S>& y, std::vector<S>& E) {
    using B = Base<S>;
    const Index n = problem.n(), k = problem.border.count();
    const auto at = [](auto& all, Index i) -> auto& { return all[static_cast<std::size_t>(i)]; };
    E.resize(static_cast<std::size_t>(problem.size()), constant<S>(0.));
    for (Index j = 0; j < k; ++j)
        for (Index i = 0; i < n; ++i) {
            const double U = problem.border.U(i, j), g = problem.border.g(i, j);
            if (U != 0) at(E, i) = at(E, i) + at(y, n + j) * B(U);
            if (g != 0) at(E, n + j) = at(E, n + j) + (at(y, i) - B(problem.z_g[i])) * B(g);
        }
    if (!problem.a_is_unknown) return;
    for (Index i = 0; i < problem.size(); ++i)
        E.back() = E.back() + (at(y, i) - B(problem.y_t[i])) * B(problem.t[i]);
}

template <class S>
std::vector<S> bordered_slopes(const Problem& problem, const Values<S>& of) {
    const Index n = problem.n(), k = problem.border.count(), size = problem.size();
    std::vector<S> J(static_cast<std::size_t>(size * size), constant<S>(0.));
    const auto at = [&](Index i, Index j) -> S& { return J[static_cast<std::size_t>(i * size + j)]; };
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) at(i, j) = of.J[static_cast<std::size_t>(i * n + j)];
        for (Index j = 0; j < k; ++j) {
            at(i, n + j) = constant<S>(problem.border.U(i, j));
            at(n + j, i) = constant<S>(problem.border.g(i, j));
        }
        if (problem.a_is_unknown) at(i, size - 1) = of.E_a[static_cast<std::size_t>(i)];
    }
    for (Index i = 0; problem.a_is_unknown && i < size; ++i) at(size - 1, i) = constant<S>(problem.t[i]);
    return J;
}

}  // namespace

template <class S>
Values<S> evaluate_without_slopes(const Problem& problem, const std::vector<S>& y, const S& a) {
    Values<S> of =
        evaluate_without_slopes(problem.system, poses_and_reactions(problem, y), parameter(problem, y, a));
    add_border(problem, y, of.E);
    return of;
}
template <class S>
Values<S> evaluate(const Problem& problem, const std::vector<S>& y, const S& a, Slopes slopes) {
    if (slopes == Slopes::no) return evaluate_without_slopes(problem, y, a);
    Values<S> of =
        evaluate(problem.system, poses_and_reactions(problem, y), parameter(problem, y, a), slopes);
    add_border(problem, y, of.E);
    if (problem.size() > problem.n()) of.J = bordered_slopes(problem, of);
    return of;
}
template Values<double> evaluate(const Problem&, const std::vector<double>&, const double&, Slopes);
template Values<Interval> evaluate(const Problem&, const std::vector<Interval>&, const Interval&, Slopes);
template Values<SlopesAlong> evaluate(const Problem&, const std::vector<SlopesAlong>&, const SlopesAlong&,
                                      Slopes);
template Values<Along> evaluate_without_slopes(const Problem&, const std::vector<Along>&, const Along&);
template Values<Jet<1>> evaluate_without_slopes(const Problem&, const std::vector<Jet<1>>&, const Jet<1>&);

MatrixXd inverse(const MatrixXd& J) {
    const auto [A, D_r, D_c] = equilibrated(J);
    return D_c.asDiagonal() * Eigen::PartialPivLU<MatrixXd>(A).inverse() * D_r.asDiagonal();
}

// Newton's method until its steps are rounding. The last two steps share an inverse, unless they come out as large as the one
// before: then a knot may lie between, and the inverse be of its other side. Near a limit point that is rounding.
Approximate newton(const Problem& problem, const VectorXd& from, double a) {
    constexpr int most = 12, last = 2, most_anew = 3;
    constexpr double close = 1e-7;  // of the model's size
    const double rounding = problem.system.apart.empty() ? 1e-13 : 1e-15;
    Approximate at{from, {}};
    const auto size_of = [&](const VectorXd& step) {
        double size = 0;
        for (int b = 0; b < problem.system.bodies; ++b) {
            const int k = problem.system.pose(b);
            size = std::max(
                {size, step.segment<3>(k).norm() / problem.system.length, step.segment<4>(k + 3).norm()});
        }
        return size;
    };
    double before = std::numeric_limits<double>::infinity();
    bool share = false;
    for (int step = 0, shared = 0, anew = 0; shared < last && (at.settled || step < most); ++step) {
        const Values<double> of = evaluate(problem, doubles(at.y), a, share ? Slopes::no : Slopes::yes);
        if (!share) at.Y = inverse(square(of.J, problem.size()));
        const VectorXd dy = -at.Y * Eigen::Map<const VectorXd>(of.E.data(), problem.size());
        if (!dy.allFinite()) return {at.y, at.Y, false};
        at.y += dy;
        const double size = size_of(dy);
        at.settled = at.settled || size < close;
        shared += share ? 1 : 0;
        const bool other_side = share && !(size < before / 4 || size < rounding) && anew < most_anew;
        share = at.settled && !other_side;
        if (other_side) shared = 0, ++anew;
        before = size;
    }
    return at;
}

}  // namespace elastocheck::reference::certificate
