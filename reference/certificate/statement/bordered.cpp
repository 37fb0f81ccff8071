#include "reference/certificate/statement/bordered.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SparseLU>
#include <algorithm>
#include <memory>

#include "models/eigen/dense.hpp"

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A reciprocal condition number above the threshold by this factor needs no null space.
constexpr double surely_regular = 1e3;
constexpr int equilibration_sweeps = 8;
// Null spaces take dense matrices.
constexpr int max_unknowns_of_borders = 2000;
// Up to here dense factors take less time.
constexpr int max_unknowns_of_dense = 80;
// Relative to the largest entry of a null vector: smaller entries are rounding.
constexpr double no_part = 1e-12;

// D_r A D_c with rows and columns of size one (Ruiz 2001).
struct Equilibrated {
    SparseMatrix A;
    VectorXd D_r, D_c;
};
Equilibrated equilibrated(const SparseMatrix& A) {
    Equilibrated result{A, VectorXd::Ones(A.rows()), VectorXd::Ones(A.cols())};
    const auto scale = [](double size) { return size > 0 ? 1 / std::sqrt(size) : 1; };
    VectorXd r(A.rows()), c(A.cols());
    for (int sweep = 0; sweep < equilibration_sweeps; ++sweep) {
        r.setZero(), c.setZero();
        for (Index j = 0; j < A.cols(); ++j)
            for (SparseMatrix::InnerIterator entry(result.A, j); entry; ++entry) {
                const double size = std::abs(entry.value());
                r[entry.row()] = std::max(r[entry.row()], size);
                c[j] = std::max(c[j], size);
            }
        r = r.unaryExpr(scale);
        c = c.unaryExpr(scale);
        for (Index j = 0; j < A.cols(); ++j)
            for (SparseMatrix::InnerIterator entry(result.A, j); entry; ++entry)
                entry.valueRef() = r[entry.row()] * entry.value() * c[j];
        result.D_r.array() *= r.array();
        result.D_c.array() *= c.array();
    }
    return result;
}

// Null space of A: orthonormal columns x with A x = 0 up to `zero_tolerance`, for rows of size one.
MatrixXd null_space(const MatrixXd& A, double zero_tolerance) {
    const Index n = A.cols();
    if (A.size() == 0) return MatrixXd::Identity(n, n);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(A.transpose());
    qr.setThreshold(zero_tolerance / std::max(zero_tolerance, A.rowwise().norm().maxCoeff()));
    return matrix_Q(qr).rightCols(n - qr.rank());
}
// Scales the rows to size one and returns the factors.
VectorXd normalise(MatrixXd& A) {
    const VectorXd factors =
        A.rowwise().norm().unaryExpr([](double size) { return size > 0 ? 1 / size : 1; });
    A = factors.asDiagonal() * A;
    return factors;
}

// Removes rounding from the columns and scales them to size one.
void clean(MatrixXd& columns) {
    for (Index k = 0; k < columns.cols(); ++k) {
        columns.col(k) /= columns.col(k).norm();
        const double least = no_part * columns.col(k).cwiseAbs().maxCoeff();
        columns.col(k) =
            columns.col(k).unaryExpr([&](double x) { return std::abs(x) < least ? 0 : x; });
    }
}

// δz of (δr, δπ), r over L: δp = ½ (0, δπ) p.
MatrixXd tangent(const System& system, const VectorXd& z) {
    MatrixXd T = MatrixXd::Zero(7 * system.bodies, 6 * system.bodies);
    for (int b = 0; b < system.bodies; ++b) {
        const int row = system.pose(b), col = 6 * b;
        T.block<3, 3>(row, col) = system.length * Eigen::Matrix3d::Identity();
        const double w = z[row + 3] / 2, x = z[row + 4] / 2, y = z[row + 5] / 2, u = z[row + 6] / 2;
        T.block<4, 3>(row + 3, col + 3) << -x, -y, -u, w, u, -y, -u, w, x, y, -x, w;
    }
    return T;
}

// Combinations of (d / L, θ) that have stiffness in the law, one per row.
MatrixXd resisted(const ElasticKind& kind, double length) {
    MatrixXd rows = MatrixXd::Identity(6, 6);
    const auto keep = [&](const std::array<bool, 6>& resists) {
        Index count = 0;
        for (Index k = 0; k < 6; ++k)
            if (resists[static_cast<std::size_t>(k)]) rows.row(count++) = rows.row(k).eval();
        rows.conservativeResize(count, 6);
    };
    // K = D Q diag(κ) Qᵀ D, D² its diagonal: independent of the ratio of stiff to soft axes.
    const auto keep_of_matrix = [&](const Matrix6& K) {
        const Vector6 D = K.diagonal().cwiseMax(0).cwiseSqrt(),
                      by = D.unaryExpr([](double d) { return d > 0 ? 1 / d : 0; });
        const Matrix6 C = by.asDiagonal() * K * by.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Matrix6> modes(C);
        std::array<bool, 6> resists{};
        for (Index k = 0; k < 6; ++k)
            resists[static_cast<std::size_t>(k)] = modes.eigenvalues()[k] > no_part;
        rows = modes.eigenvectors().transpose() * D.asDiagonal();
        keep(resists);
    };
    each_member(kind, overloaded{[&](const ScalarLaw& law) { keep({!is_zero(law)}); },
                                 [&](const SpatialLaw& spatial) {
                                     if (const PerAxis* law = axes_of(spatial)) {
                                         std::array<bool, 6> resists{};
                                         for (std::size_t k = 0; k < 6; ++k)
                                             resists[k] = !is_zero(law->axis[k]);
                                         return keep(resists);
                                     }
                                     keep_of_matrix(*matrix_of(spatial));
                                 }});
    for (Index k = 0; k < 3; ++k) rows.col(k) *= length;
    return rows;
}

// Reference size of each row of Φ [m rows]: L for a length, 1 for a direction.
VectorXd constraint_sizes(const System& system) {
    VectorXd size(system.rows);
    for (std::size_t c = 0; c < system.values.size(); ++c) {
        const ConstraintKind& kind = system.model->constraints[c].kind;
        size.segment(system.first_row[c], rows(kind))
            .setConstant(is_direction(kind) ? 1 : system.length);
    }
    return size;
}

}  // namespace

template <class S>
SparseMatrix middle(const SparseRows<S>& J) {
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& [row, column, value] : J.entries)
        entries.emplace_back(row, column, mid(range(value)));
    const auto n = static_cast<Index>(J.start.size()) - 1;
    SparseMatrix of(n, n);
    of.setFromTriplets(entries.begin(), entries.end());
    return of;
}
template SparseMatrix middle(const SparseRows<double>&);
template SparseMatrix middle(const SparseRows<Interval>&);

std::vector<double> doubles(const VectorXd& x) { return {x.data(), x.data() + x.size()}; }
std::vector<Interval> thin(const VectorXd& x) { return {x.data(), x.data() + x.size()}; }
std::vector<Interval> box(const VectorXd& middle, const VectorXd& radius) {
    std::vector<Interval> y;
    for (Index k = 0; k < middle.size(); ++k) y.push_back(around(middle[k], radius[k]));
    return y;
}

double zero_tolerance_of_rounding(const System& system) {
    constexpr double unit = std::numeric_limits<double>::epsilon(), operations = 1024;
    return operations * unit * system.farthest / system.length;
}

VectorXd rounding_of_equations(const System& system, const VectorXd& z, double a) {
    VectorXd size = VectorXd::Zero(system.n());
    const Geometry fixed = geometry(system, doubles(z), a);
    for (int b = 0; b < system.bodies; ++b) {
        const double acts = fixed.acts[static_cast<std::size_t>(b)];
        size.segment<3>(system.balance(b)).setConstant(acts);
        size.segment<3>(system.balance(b) + 3).setConstant(acts * system.length);
    }
    size.segment(6 * system.bodies, system.rows) = constraint_sizes(system);
    return zero_tolerance_of_rounding(system) * size;
}

Border border_at(const System& system, const VectorXd& z, double a, double zero_tolerance,
                 Values<double>* values_at) {
    const Index nb = 6 * system.bodies, poses = 7 * system.bodies, m = system.rows, n = system.n();
    Border border{MatrixXd(n, 0), MatrixXd(n, 0)};
    const auto values = evaluate(system, doubles(z), a, Slopes::yes);
    if (values_at != nullptr) *values_at = values;
    const SparseMatrix slopes = middle(values.J);
    if (!slopes.coeffs().allFinite() || nb == 0 ||
        factors(slopes).rcond() > surely_regular * zero_tolerance)
        return border;
    border.too_large = n > max_unknowns_of_borders;
    if (border.too_large) return border;
    const MatrixXd J = slopes;

    // Redundant rows, yᵀ Φ_q = 0: the reactions y are self-equilibrated.
    const MatrixXd T = tangent(system, z);
    MatrixXd G = J.block(nb, 0, m, poses) * T;
    const VectorXd scale = normalise(G);
    MatrixXd y = scale.asDiagonal() * null_space(G.transpose(), zero_tolerance);
    clean(y);

    // Z: motions without deformation. v = Z N: those of them that keep all forces in balance.
    for (std::size_t e = 0; e < system.elements.size(); ++e) {
        MatrixXd rows = resisted(system.model->elastics[e].kind, 1 / system.length) *
                        deformation_slopes(system, e, doubles(z), a) * T;
        if (!rows.allFinite()) return border;
        normalise(rows);
        G.conservativeResize(G.rows() + rows.rows(), nb);
        G.bottomRows(rows.rows()) = rows;
    }
    const MatrixXd Z = null_space(G, zero_tolerance);
    const Geometry fixed = geometry(system, doubles(z), a);
    const double largest = *std::ranges::max_element(fixed.acts);
    VectorXd acts(nb), in_forces(nb);  // moments over L
    for (Index k = 0; k < nb; ++k) {
        const double on_body = fixed.acts[static_cast<std::size_t>(k / 6)];
        acts[k] = on_body > 0 ? on_body : largest > 0 ? largest : 1;
        in_forces[k] = k % 6 < 3 ? 1 : 1 / system.length;
    }
    const VectorXd weight = in_forces.cwiseQuotient(acts);
    MatrixXd turned =
        weight.asDiagonal() * MatrixXd(middle(fixed.J)).topLeftCorner(nb, poses) * T * Z;
    MatrixXd C = (weight.asDiagonal() * J.block(0, poses, nb, m)).transpose();
    normalise(C);
    // part outside the range of reactions
    turned = null_space(C, zero_tolerance).transpose() * turned;
    const MatrixXd v = Z * null_space(turned, zero_tolerance);

    const Index k = y.cols(), i = v.cols();
    border.redundant = static_cast<int>(k);
    border.U = border.g = MatrixXd::Zero(n, k + i);
    border.U.block(nb, 0, m, k) = y;
    border.g.block(poses, 0, m, k) = y;
    MatrixXd U = v, g = T * v;  // U: wrenches conjugate to v, moments about each body's origin
    for (Index row = 0; row < nb; ++row)
        if (row % 6 < 3) U.row(row) *= system.length;
    clean(U);
    clean(g);
    border.U.topRightCorner(nb, i) = U;
    border.g.topRightCorner(poses, i) = g;

    const Eigen::Map<const VectorXd> E(values.E.data(), n);
    const VectorXd work = v.transpose() * (in_forces.asDiagonal() * E.head(nb)),
                   work_of_acting_forces = v.cwiseAbs().transpose() * acts;
    border.pushed = (work.array().abs() > zero_tolerance * work_of_acting_forces.array()).any();
    const VectorXd gap = y.transpose() * E.segment(nb, m);
    const VectorXd size = constraint_sizes(system);
    border.open =
        (gap.array().abs() > zero_tolerance * (y.cwiseAbs().transpose() * size).array()).any();
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
        if (shares[k] > 0.1 * most)
            named += fmt::format("{}'{}'", named.empty() ? "" : ", ", name(k));
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
                double& share =
                    shares[static_cast<std::size_t>(system.model->constraints[c].joint)];
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

// Adds U μ and the gauges.
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
SparseRows<S> bordered_slopes(const Problem& problem, Values<S> values) {
    const int n = problem.n(), k = problem.border.count(), size = problem.size();
    std::vector<Slope<S>> entries = std::move(values.J.entries);
    const auto add = [&](int row, int column, const S& value) {
        if (!is_zero(value)) entries.push_back({row, column, value});
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < k; ++j) {
            add(i, n + j, constant<S>(problem.border.U(i, j)));
            add(n + j, i, constant<S>(problem.border.g(i, j)));
        }
        if (problem.a_is_unknown) add(i, size - 1, values.E_a[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; problem.a_is_unknown && i < size; ++i)
        add(size - 1, i, constant<S>(problem.t[i]));
    return by_rows(entries, size);
}

// The equations of the system with their border.
template <class S>
Values<S> bordered(const Problem& problem, const std::vector<S>& y, Values<S> values) {
    add_border(problem, y, values.E);
    if (problem.size() > problem.n()) values.J = bordered_slopes(problem, values);
    return values;
}

}  // namespace

template <class S>
Values<S> evaluate_without_slopes(const Problem& problem, const std::vector<S>& y, const S& a) {
    Values<S> values = evaluate_without_slopes(problem.system, poses_and_reactions(problem, y),
                                               parameter(problem, y, a));
    add_border(problem, y, values.E);
    return values;
}
template <class S>
Values<S> evaluate(const Problem& problem, const std::vector<S>& y, const S& a, Slopes slopes) {
    if (slopes == Slopes::no) return evaluate_without_slopes(problem, y, a);
    return bordered(problem, y,
                    evaluate(problem.system, poses_and_reactions(problem, y),
                             parameter(problem, y, a), slopes));
}
template <class S>
Values<S> residual(const Problem& problem, const std::vector<S>& y, const S& a) {
    Values<S> values =
        residual(problem.system, poses_and_reactions(problem, y), parameter(problem, y, a));
    add_border(problem, y, values.E);
    return values;
}
template Values<Interval> residual(const Problem&, const std::vector<Interval>&, const Interval&);
template Values<Along> residual(const Problem&, const std::vector<Along>&, const Along&);
template Values<Jet<1>> residual(const Problem&, const std::vector<Jet<1>>&, const Jet<1>&);
template Values<double> evaluate(const Problem&, const std::vector<double>&, const double&, Slopes);
template Values<Interval> evaluate(const Problem&, const std::vector<Interval>&, const Interval&,
                                   Slopes);
template Values<SlopesAlong> evaluate(const Problem&, const std::vector<SlopesAlong>&,
                                      const SlopesAlong&, Slopes);
template Values<Along> evaluate_without_slopes(const Problem&, const std::vector<Along>&,
                                               const Along&);
template Values<Jet<1>> evaluate_without_slopes(const Problem&, const std::vector<Jet<1>>&,
                                                const Jet<1>&);

VectorXd Factors::solve(const VectorXd& b) const {
    if (!of) return VectorXd::Constant(size(), std::numeric_limits<double>::quiet_NaN());
    return D_c.cwiseProduct(of(D_r.cwiseProduct(b), false));
}

MatrixXd Factors::rows_of_inverse(Index from, Index count) const {
    if (!of) return MatrixXd::Constant(count, size(), std::numeric_limits<double>::quiet_NaN());
    MatrixXd right = MatrixXd::Zero(size(), count);
    for (Index k = 0; k < count; ++k) right(from + k, k) = D_c[from + k];
    return (D_r.asDiagonal() * of(right, true)).transpose();
}

// ‖A⁻¹‖₁ by Hager's method (Hager 1984, Higham 1988).
double Factors::rcond() const {
    constexpr int iterations = 5;
    const Index n = size();
    if (!of) return 0;
    VectorXd x = VectorXd::Constant(n, 1 / static_cast<double>(n));
    double inverse_norm = 0;
    for (int k = 0; k < iterations; ++k) {
        const VectorXd y = of(x, false);
        if (!y.allFinite()) return 0;
        const double size = y.lpNorm<1>();
        if (k > 0 && !(size > inverse_norm)) break;
        inverse_norm = std::max(inverse_norm, size);
        const VectorXd sign = y.unaryExpr([](double v) { return v < 0 ? -1. : 1.; }),
                       z = of(sign, true);
        Index largest = 0;
        const double slope = z.cwiseAbs().maxCoeff(&largest);
        if (!z.allFinite()) return 0;
        if (k > 0 && slope <= z.dot(x)) break;
        x = VectorXd::Unit(n, largest);
    }
    for (Index k = 0; k < n; ++k)
        x[k] = (k % 2 == 0 ? 1 : -1) * (1 + static_cast<double>(k) / static_cast<double>(n));
    const VectorXd y = of(x, false);
    if (!y.allFinite()) return 0;
    inverse_norm = std::max(inverse_norm, 2 * y.lpNorm<1>() / (3 * static_cast<double>(n)));
    return 1 / (norm * inverse_norm);
}

Factors factors(const SparseMatrix& J) {
    const Index n = J.rows();
    Factors result{VectorXd::Ones(n), VectorXd::Ones(n), {}};
    if (n == 0 || !J.coeffs().allFinite()) return result;
    const auto [A, D_r, D_c] = equilibrated(J);
    result.D_r = D_r, result.D_c = D_c;
    for (Index j = 0; j < n; ++j) result.norm = std::max(result.norm, A.col(j).cwiseAbs().sum());
    // of Aᵀ, which most right-hand sides are for
    const auto solving = [](const auto& lu) {
        return [lu](const MatrixXd& b, bool transposed) -> MatrixXd {
            if (transposed) return lu->solve(b);
            return lu->transpose().solve(b);
        };
    };
    if (n <= max_unknowns_of_dense) {
        const MatrixXd dense = A.transpose();
        result.of = solving(std::make_shared<Eigen::PartialPivLU<MatrixXd>>(dense));
        return result;
    }
    const auto lu = std::make_shared<Eigen::SparseLU<SparseMatrix>>(SparseMatrix(A.transpose()));
    if (lu->info() == Eigen::Success) result.of = solving(lu);
    return result;
}

MatrixXd inverse(const Factors& factors) { return factors.rows_of_inverse(0, factors.size()); }

namespace {

// Of a change of the poses: the largest of a body, relative to the model's size.
double size_of(const Problem& problem, const VectorXd& step) {
    double size = 0;
    for (int b = 0; b < problem.system.bodies; ++b) {
        const int k = problem.system.pose(b);
        size = std::max({size, step.segment<3>(k).norm() / problem.system.length,
                         step.segment<4>(k + 3).norm()});
    }
    return size;
}

}  // namespace

// Newton's method until its steps are rounding. The end must be near the start: iterations that
// diverge along an idle motion also end in small steps, at coordinates of 1e7 and more. The last
// two steps share their factors, unless they do not decrease: then a knot may lie in between, with
// the factors from its other side (near a limit point it is only rounding).
Approximate newton(const Problem& problem, const VectorXd& from, double a,
                   const Values<double>* values_at) {
    constexpr int max_steps = 12, max_shared = 2, max_anew = 3;
    constexpr double close = 1e-7, near = 1;  // relative to the model's size
    const double rounding = problem.system.separated.empty() ? 1e-13 : 1e-15;
    Approximate approximate{from, {}};
    double last_size = std::numeric_limits<double>::infinity();
    bool share = false;
    for (int step = 0, shared = 0, anew = 0;
         shared < max_shared && (approximate.settled || step < max_steps); ++step) {
        const std::vector<double> y = doubles(approximate.y);
        const Values<double> values =
            step == 0 && values_at != nullptr
                ? bordered(problem, y, *values_at)
                : evaluate(problem, y, a, share ? Slopes::no : Slopes::yes);
        if (!share) {
            approximate.J = factors(middle(values.J));
            approximate.since = 0;
        }
        const VectorXd dy =
            -approximate.J.solve(Eigen::Map<const VectorXd>(values.E.data(), problem.size()));
        if (!dy.allFinite()) return {approximate.y, approximate.J, false};
        approximate.y += dy;
        const double size = size_of(problem, dy);
        approximate.since += size;
        approximate.settled = approximate.settled || size < close;
        shared += share ? 1 : 0;
        const bool other_side =
            share && !(size < last_size / 4 || size < rounding) && anew < max_anew;
        share = approximate.settled && !other_side;
        if (other_side) {
            shared = 0;
            ++anew;
        }
        last_size = size;
    }
    approximate.settled = approximate.settled && size_of(problem, approximate.y - from) <= near;
    return approximate;
}

BorderCheck check_border(const Problem& problem, const VectorXd& y, double a) {
    const System& system = problem.system;
    const Border there =
        border_at(system, y.head(system.n()), a, zero_tolerance_of_rounding(system));
    const bool alike =
        there.redundant == problem.border.redundant && there.count() == problem.border.count();
    return {alike && !there.pushed && !there.open && !there.too_large, alike && there.pushed,
            alike && there.open};
}

NearEquilibrium equilibrium_near(const System& system, const VectorXd& z, double a) {
    const double rounding = zero_tolerance_of_rounding(system);
    const auto from = [&](const VectorXd& start, double zero_tolerance) {
        Values<double> values;
        Problem problem{system, border_at(system, start, a, zero_tolerance, &values), z, false, {},
                        {}};
        VectorXd y = VectorXd::Zero(problem.size());
        y.head(system.n()) = start;
        Approximate found = newton(problem, y, a, &values);
        // Without a border the factors show that J is regular, also after the steps since.
        BorderCheck there;
        if (found.settled && found.y.allFinite()) {
            const Border& border = problem.border;
            // A state that is loaded or open by its own rounding is checked again at the
            // equilibrium.
            const bool is_there = zero_tolerance == rounding && !border.too_large &&
                                  !border.pushed && !border.open &&
                                  size_of(problem, found.y - y) <= rounding;
            const bool is_regular =
                border.count() == 0 &&
                found.J.rcond() > surely_regular * std::max(rounding, found.since);
            there = is_there || is_regular ? BorderCheck{true} : check_border(problem, found.y, a);
        }
        return NearEquilibrium{std::move(problem), std::move(found), there};
    };
    // Whether the border at the end is that of the start.
    const auto arrives = [](const BorderCheck& there) {
        return there.sound || there.pushed || there.open;
    };
    NearEquilibrium first = from(z, rounding);
    if (arrives(first.there)) return first;
    // Away from an equilibrium an idle motion has some stiffness, and Newton's method would diverge
    // along it. So these motions are held first, by the looser threshold.
    NearEquilibrium held = from(z, loose_zero_tolerance);
    if (!held.found.settled) return first;
    NearEquilibrium again = from(held.found.y.head(system.n()), rounding);
    return arrives(again.there) ? again : held;
}

}  // namespace elastocheck::reference::certificate
