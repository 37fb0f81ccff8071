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

// D_r A D_c, the largest entry of each row and column being one in size (Ruiz 2001).
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

// Null space of A: orthonormal columns x with A x = 0 up to `zero_tolerance`, for rows of
// Euclidean norm one.
MatrixXd null_space(const MatrixXd& A, double zero_tolerance) {
    const Index n = A.cols();
    if (A.size() == 0) return MatrixXd::Identity(n, n);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(A.transpose());
    qr.setThreshold(zero_tolerance / std::max(zero_tolerance, A.rowwise().norm().maxCoeff()));
    return matrix_Q(qr).rightCols(n - qr.rank());
}
// Scales the rows to Euclidean norm one and returns the factors.
VectorXd normalise(MatrixXd& A) {
    const VectorXd factors =
        A.rowwise().norm().unaryExpr([](double size) { return size > 0 ? 1 / size : 1; });
    A = factors.asDiagonal() * A;
    return factors;
}

// Removes rounding from the columns and scales them to Euclidean norm one.
void clean(MatrixXd& columns) {
    for (Index k = 0; k < columns.cols(); ++k) {
        columns.col(k) /= columns.col(k).norm();
        const double least = no_part * columns.col(k).cwiseAbs().maxCoeff();
        columns.col(k) =
            columns.col(k).unaryExpr([&](double x) { return std::abs(x) < least ? 0 : x; });
    }
}

// Columns: δ(r, p) of all bodies for each component of (δr / L, δπ), δp = ½ (0, δπ) p
// [7 nb × 6 nb].
MatrixXd tangent(const System& system, const VectorXd& z) {
    MatrixXd T = MatrixXd::Zero(7 * system.bodies, 6 * system.bodies);
    for (int b = 0; b < system.bodies; ++b) {
        const int row = system.pose(b), col = 6 * b;
        T.block<3, 3>(row, col) = system.length * Eigen::Matrix3d::Identity();
        const Eigen::Vector4d half_p = z.segment<4>(row + 3) / 2;
        const double p_w = half_p[0], p_x = half_p[1], p_y = half_p[2], p_z = half_p[3];
        T.block<4, 3>(row + 3, col + 3) << -p_x, -p_y, -p_z,  //
            p_w, p_z, -p_y,                                   //
            -p_z, p_w, p_x,                                   //
            p_y, -p_x, p_w;
    }
    return T;
}

// Combinations of the deformations (d, θ) that have stiffness in the law, one per row.
// `per_length`: factor of d that makes it dimensionless [1/m].
MatrixXd resisted(const ElasticKind& kind, double per_length) {
    MatrixXd rows = MatrixXd::Identity(6, 6);
    const auto keep = [&](const std::array<bool, 6>& resists) {
        Index count = 0;
        for (Index k = 0; k < 6; ++k)
            if (resists[static_cast<std::size_t>(k)]) rows.row(count++) = rows.row(k).eval();
        rows.conservativeResize(count, 6);
    };
    // K = D Q diag(κ) Qᵀ D, D² its diagonal, so that κ is independent of the ratio of stiff to soft
    // axes. The rows are those of Qᵀ D with κ > 0.
    const auto keep_of_matrix = [&](const Matrix6& K) {
        const Vector6 D = K.diagonal().cwiseMax(0).cwiseSqrt(),
                      inverse_D = D.unaryExpr([](double d) { return d > 0 ? 1 / d : 0; });
        const Matrix6 C = inverse_D.asDiagonal() * K * inverse_D.asDiagonal();
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
    for (Index k = 0; k < 3; ++k) rows.col(k) *= per_length;
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
    SparseMatrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
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

// Coordinates are stored with an error of ε times their distance from the origin. `operations`
// allows for the roundings that add up in an equation.
double zero_tolerance_of_rounding(const System& system) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon(), operations = 1024;
    return operations * epsilon * system.farthest / system.length;
}

VectorXd rounding_of_equations(const System& system, const VectorXd& z, double a) {
    VectorXd size = VectorXd::Zero(system.n());
    const Geometry fixed = geometry(system, doubles(z), a);
    for (int b = 0; b < system.bodies; ++b) {
        const double acting = fixed.force_sizes[static_cast<std::size_t>(b)];
        size.segment<3>(system.balance(b)).setConstant(acting);
        size.segment<3>(system.balance(b) + 3).setConstant(acting * system.length);
    }
    size.segment(6 * system.bodies, system.rows) = constraint_sizes(system);
    return zero_tolerance_of_rounding(system) * size;
}

namespace {

// Structural null spaces at a state, dimensionless: motions are (δr / L, δπ) of every body.
struct NullSpaces {
    const System& system;
    const VectorXd& z;
    double a, zero_tolerance;
    MatrixXd J;  // ∂E/∂z [n × n]
    MatrixXd T;  // tangent() at z

    Index n_q() const { return 6 * system.bodies; }    // balance rows, and coordinates of a motion
    Index poses() const { return 7 * system.bodies; }  // first entries of z
    Index m() const { return system.rows; }            // constraint rows

    // Φ_q of a motion, rows scaled to size one by `scale` [m × n_q].
    MatrixXd constraint_slopes(VectorXd& scale) const {
        MatrixXd G = J.block(n_q(), 0, m(), poses()) * T;
        scale = normalise(G);
        return G;
    }
    // y: self-equilibrated reactions, yᵀ Φ_q = 0, one per column [m × k].
    MatrixXd redundant_rows(const MatrixXd& G, const VectorXd& scale) const {
        MatrixXd y = scale.asDiagonal() * null_space(G.transpose(), zero_tolerance);
        clean(y);
        return y;
    }
    // Z: motions without deformation, G Z = 0 with the deformations that have stiffness as further
    // rows of G. Empty where a deformation has no derivative.
    std::optional<MatrixXd> undeformed_motions(MatrixXd G) const {
        for (std::size_t e = 0; e < system.elements.size(); ++e) {
            MatrixXd rows = resisted(system.model->elastics[e].kind, 1 / system.length) *
                            deformation_slopes(system, e, doubles(z), a) * T;
            if (!rows.allFinite()) return {};
            normalise(rows);
            G.conservativeResize(G.rows() + rows.rows(), n_q());
            G.bottomRows(rows.rows()) = rows;
        }
        return null_space(G, zero_tolerance);
    }
    // v = Z N: the motions of Z that keep all forces in balance, B v + Cᵀ δR = 0 for some δR. With
    // C x = 0 for the columns x of X, which no reaction acts on, this is Xᵀ B Z N = 0.
    // `scale`: makes each balance row relative to the acting forces on its body.
    MatrixXd idle_motions(const MatrixXd& Z, const Geometry& fixed, const VectorXd& scale) const {
        const MatrixXd B =
            scale.asDiagonal() * MatrixXd(middle(fixed.J)).topLeftCorner(n_q(), poses()) * T * Z;
        MatrixXd C = (scale.asDiagonal() * J.block(0, poses(), n_q(), m())).transpose();
        normalise(C);
        const MatrixXd balance_change = null_space(C, zero_tolerance).transpose() * B;
        return Z * null_space(balance_change, zero_tolerance);
    }
};

// Size of the acting forces on the body of each balance row [N]; on a body without any, the largest
// of all bodies, so that the rows can be divided by it.
VectorXd acting_forces(const System& system, const Geometry& fixed) {
    const double largest = *std::ranges::max_element(fixed.force_sizes);
    VectorXd acting(6 * system.bodies);
    for (Index k = 0; k < acting.size(); ++k) {
        const double on_body = fixed.force_sizes[static_cast<std::size_t>(k / 6)];
        acting[k] = on_body > 0 ? on_body : largest > 0 ? largest : 1;
    }
    return acting;
}
// Factor that turns each balance row into a force: 1 for a force, 1 / L for a moment.
VectorXd force_scale(const System& system) {
    VectorXd scale(6 * system.bodies);
    for (Index k = 0; k < scale.size(); ++k) scale[k] = k % 6 < 3 ? 1 : 1 / system.length;
    return scale;
}

}  // namespace

Border border_at(const System& system, const VectorXd& z, double a, double zero_tolerance,
                 Values<double>* system_values) {
    const Index n_q = 6 * system.bodies, poses = 7 * system.bodies, m = system.rows, n = system.n();
    Border border{MatrixXd(n, 0), MatrixXd(n, 0)};

    // 1. Where ∂E/∂z is regular, there is no border.
    const auto values = evaluate(system, doubles(z), a, Slopes::yes);
    if (system_values != nullptr) *system_values = values;
    const SparseMatrix slopes = middle(values.J);
    if (!slopes.coeffs().allFinite() || n_q == 0 ||
        factors(slopes).rcond() > surely_regular * zero_tolerance)
        return border;
    border.too_large = n > max_unknowns_of_borders;
    if (border.too_large) return border;

    // 2. Redundant rows y and idle motions v.
    const NullSpaces spaces{system, z, a, zero_tolerance, slopes, tangent(system, z)};
    VectorXd scale;
    const MatrixXd G = spaces.constraint_slopes(scale), y = spaces.redundant_rows(G, scale);
    const std::optional<MatrixXd> Z = spaces.undeformed_motions(G);
    if (!Z) return border;
    const Geometry fixed = geometry(system, doubles(z), a);
    const VectorXd acting = acting_forces(system, fixed), in_forces = force_scale(system);
    const MatrixXd v = spaces.idle_motions(*Z, fixed, in_forces.cwiseQuotient(acting));

    // 3. Columns of U and g. For an idle motion U is (δr, δπ) itself, so that Uᵀ E is the work of
    // the imbalance on it (moments about each body's origin), and g its δz.
    const Index k = y.cols(), i = v.cols();
    border.redundant = static_cast<int>(k);
    border.U = border.g = MatrixXd::Zero(n, k + i);
    border.U.block(n_q, 0, m, k) = y;
    border.g.block(poses, 0, m, k) = y;
    MatrixXd U = v, g = spaces.T * v;
    for (Index row = 0; row < n_q; ++row)
        if (row % 6 < 3) U.row(row) *= system.length;
    clean(U);
    clean(g);
    border.U.topRightCorner(n_q, i) = U;
    border.g.topRightCorner(poses, i) = g;

    // 4. Load on the idle motions: work of the imbalance over L [N], relative to that of the acting
    // forces. Gap of the redundant rows, relative to the size of the rows.
    const Eigen::Map<const VectorXd> E(values.E.data(), n);
    const VectorXd work = v.transpose() * (in_forces.asDiagonal() * E.head(n_q)),
                   work_of_acting_forces = v.cwiseAbs().transpose() * acting;
    border.idle_motion_loaded =
        (work.array().abs() > zero_tolerance * work_of_acting_forces.array()).any();
    const VectorXd gap = y.transpose() * E.segment(n_q, m);
    const VectorXd size = constraint_sizes(system);
    border.redundant_row_gap =
        (gap.array().abs() > zero_tolerance * (y.cwiseAbs().transpose() * size).array()).any();
    return border;
}

namespace {

// Lists the names whose share is at least a tenth of the largest one.
std::string largest_named(const std::vector<double>& shares,
                          const std::function<std::string(std::size_t)>& name) {
    double largest = 0;
    for (const double share : shares) largest = std::max(largest, share);
    std::string names;
    for (std::size_t k = 0; k < shares.size(); ++k)
        if (shares[k] > 0.1 * largest)
            names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name(k));
    return names;
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

// Appends to the n equations E of the system the border's terms: U μ in the balances and rows, the
// gauges gᵀ (z - z_g), and tᵀ (y - y_t) where a is an unknown.
template <class S>
void add_border(const Problem& problem, const std::vector<S>& y, std::vector<S>& E) {
    using B = Base<S>;
    const Index n = problem.n(), k = problem.border.count();
    const auto entry = [](auto& vector, Index i) -> auto& {
        return vector[static_cast<std::size_t>(i)];
    };
    E.resize(static_cast<std::size_t>(problem.size()), constant<S>(0.));
    for (Index j = 0; j < k; ++j)
        for (Index i = 0; i < n; ++i) {
            const double U = problem.border.U(i, j), g = problem.border.g(i, j);
            if (U != 0) entry(E, i) = entry(E, i) + entry(y, n + j) * B(U);
            if (g != 0)
                entry(E, n + j) = entry(E, n + j) + (entry(y, i) - B(problem.z_g[i])) * B(g);
        }
    if (!problem.a_is_unknown) return;
    for (Index i = 0; i < problem.size(); ++i)
        E.back() = E.back() + (entry(y, i) - B(problem.y_t[i])) * B(problem.t[i]);
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
    if (!solve_A) return VectorXd::Constant(size(), std::numeric_limits<double>::quiet_NaN());
    return D_c.cwiseProduct(solve_A(D_r.cwiseProduct(b), false));
}

MatrixXd Factors::rows_of_inverse(Index from, Index count) const {
    if (!solve_A)
        return MatrixXd::Constant(count, size(), std::numeric_limits<double>::quiet_NaN());
    MatrixXd right = MatrixXd::Zero(size(), count);
    for (Index k = 0; k < count; ++k) right(from + k, k) = D_c[from + k];
    return (D_r.asDiagonal() * solve_A(right, true)).transpose();
}

// 1 / (‖A‖₁ ‖A⁻¹‖₁). ‖A⁻¹‖₁ = max ‖A⁻¹ x‖₁ over ‖x‖₁ = 1 is convex in x: Hager's method climbs from
// vertex to vertex along its gradient z = A⁻ᵀ sign(A⁻¹ x) (Hager 1984, Higham 1988).
double Factors::rcond() const {
    constexpr int iterations = 5;
    const Index n = size();
    if (!solve_A) return 0;
    VectorXd x = VectorXd::Constant(n, 1 / static_cast<double>(n));
    double inverse_norm = 0;
    for (int k = 0; k < iterations; ++k) {
        const VectorXd y = solve_A(x, false);
        if (!y.allFinite()) return 0;
        const double size = y.lpNorm<1>();
        if (k > 0 && !(size > inverse_norm)) break;
        inverse_norm = std::max(inverse_norm, size);
        const VectorXd sign = y.unaryExpr([](double v) { return v < 0 ? -1. : 1.; }),
                       z = solve_A(sign, true);
        Index largest = 0;
        const double slope = z.cwiseAbs().maxCoeff(&largest);
        if (!z.allFinite()) return 0;
        if (k > 0 && slope <= z.dot(x)) break;
        x = VectorXd::Unit(n, largest);
    }
    // Higham's vector of alternating signs, for matrices on which the iteration stops too early.
    for (Index k = 0; k < n; ++k)
        x[k] = (k % 2 == 0 ? 1 : -1) * (1 + static_cast<double>(k) / static_cast<double>(n));
    const VectorXd y = solve_A(x, false);
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
    // The factors are those of Aᵀ, since most right-hand sides are for it.
    const auto solver_of = [](const auto& lu) {
        return [lu](const MatrixXd& b, bool transposed) -> MatrixXd {
            if (transposed) return lu->solve(b);
            return lu->transpose().solve(b);
        };
    };
    if (n <= max_unknowns_of_dense) {
        const MatrixXd dense = A.transpose();
        result.solve_A = solver_of(std::make_shared<Eigen::PartialPivLU<MatrixXd>>(dense));
        return result;
    }
    const auto lu = std::make_shared<Eigen::SparseLU<SparseMatrix>>(SparseMatrix(A.transpose()));
    if (lu->info() == Eigen::Success) result.solve_A = solver_of(lu);
    return result;
}

MatrixXd inverse(const Factors& factors) { return factors.rows_of_inverse(0, factors.size()); }

namespace {

// Largest change of a body's pose, relative to the model's size.
double size_of(const Problem& problem, const VectorXd& step) {
    double size = 0;
    for (int b = 0; b < problem.system.bodies; ++b) {
        const int k = problem.system.pose(b);
        size = std::max({size, step.segment<3>(k).norm() / problem.system.length,
                         step.segment<4>(k + 3).norm()});
    }
    return size;
}

// Newton's method at a fixed a, or with a among the unknowns.
struct NewtonSteps {
    const Problem& problem;
    double a;
    Approximate& approximate;
    double size = std::numeric_limits<double>::infinity();  // of the last step, as size_of()

    // Full step, with factors at y; false if it is not finite, and then not taken. `system_values`:
    // as of newton().
    bool full_step(const Values<double>* system_values = nullptr) {
        const std::vector<double> y = doubles(approximate.y);
        const Values<double> values = system_values != nullptr
                                          ? bordered(problem, y, *system_values)
                                          : evaluate(problem, y, a, Slopes::yes);
        approximate.J = factors(middle(values.J));
        approximate.since = 0;
        return take_step(values.E);
    }
    // Chord step, with the factors of the last full step.
    bool chord_step() {
        return take_step(evaluate(problem, doubles(approximate.y), a, Slopes::no).E);
    }
    bool take_step(const std::vector<double>& E) {
        const VectorXd dy =
            -approximate.J.solve(Eigen::Map<const VectorXd>(E.data(), problem.size()));
        if (!dy.allFinite()) return false;
        approximate.y += dy;
        size = size_of(problem, dy);
        approximate.since += size;
        return true;
    }
};

}  // namespace

Approximate newton(const Problem& problem, const VectorXd& from, double a,
                   const Values<double>* system_values) {
    constexpr int max_full_steps = 12, chord_steps = 2, max_renewals = 3;
    constexpr double close = 1e-7, near = 1;  // relative to the model's size
    const double rounding = problem.system.separated.empty() ? 1e-13 : 1e-15;
    Approximate approximate{from, {}};
    NewtonSteps steps{problem, a, approximate};
    const auto unsettled = [&] { return Approximate{approximate.y, approximate.J, false}; };

    // 1. Full steps, until one is small.
    for (int step = 0; !approximate.settled && step < max_full_steps; ++step) {
        if (!steps.full_step(step == 0 ? system_values : nullptr)) return unsettled();
        approximate.settled = steps.size < close;
    }
    if (!approximate.settled) return approximate;

    // 2. Chord steps, down to rounding. One that does not decrease may have crossed a knot, whose
    // other side the factors belong to: they are renewed by a full step. Near a limit point it is
    // only rounding, so the number of renewals is limited.
    for (int chords = 0, renewals = 0; chords < chord_steps;) {
        const double last_size = steps.size;
        if (!steps.chord_step()) return unsettled();
        ++chords;
        const bool decreases = steps.size < last_size / 4 || steps.size < rounding;
        if (decreases || renewals == max_renewals) continue;
        if (!steps.full_step()) return unsettled();
        chords = 0;
        ++renewals;
    }

    // 3. The end must be near the start: iterations that diverge along an idle motion also end in
    // small steps, at coordinates of 1e7 and more.
    approximate.settled = size_of(problem, approximate.y - from) <= near;
    return approximate;
}

BorderCheck check_border(const Problem& problem, const VectorXd& y, double a) {
    const System& system = problem.system;
    const Border border =
        border_at(system, y.head(system.n()), a, zero_tolerance_of_rounding(system));
    const bool same_counts =
        border.redundant == problem.border.redundant && border.count() == problem.border.count();
    return {
        same_counts && !border.idle_motion_loaded && !border.redundant_row_gap && !border.too_large,
        same_counts && border.idle_motion_loaded, same_counts && border.redundant_row_gap};
}

namespace {

// Newton's method from z, with the border at z and the gauge at z_g; then checks the border.
NearEquilibrium equilibrium_from(const System& system, const VectorXd& z, const VectorXd& z_g,
                                 double a, double zero_tolerance) {
    const double rounding = zero_tolerance_of_rounding(system);
    Values<double> values;
    Problem problem{system, border_at(system, z, a, zero_tolerance, &values), z_g, false, {}, {}};
    VectorXd y = VectorXd::Zero(problem.size());
    y.head(system.n()) = z;
    Approximate equilibrium = newton(problem, y, a, &values);
    BorderCheck check;
    if (equilibrium.settled && equilibrium.y.allFinite()) {
        const Border& border = problem.border;
        // z is the equilibrium, so its border is that of the equilibrium. If the rounding of the
        // stored coordinates loads an idle motion or opens a gap, the border is evaluated again at
        // the corrected state.
        const bool is_at_start = zero_tolerance == rounding && !border.too_large &&
                                 !border.idle_motion_loaded && !border.redundant_row_gap &&
                                 size_of(problem, equilibrium.y - y) <= rounding;
        // Without a border the factors show that J is regular where they were computed, and their
        // margin covers the movement since then.
        const bool is_regular =
            border.count() == 0 &&
            equilibrium.J.rcond() > surely_regular * std::max(rounding, equilibrium.since);
        check =
            is_at_start || is_regular ? BorderCheck{true} : check_border(problem, equilibrium.y, a);
    }
    return {std::move(problem), std::move(equilibrium), check};
}

// Whether the border at the equilibrium has as many columns as that at the start.
bool has_border_of_start(const NearEquilibrium& near) {
    return near.border_check.sound || near.border_check.idle_motion_loaded ||
           near.border_check.redundant_row_gap;
}

}  // namespace

NearEquilibrium equilibrium_near(const System& system, const VectorXd& z, double a) {
    const double rounding = zero_tolerance_of_rounding(system);
    NearEquilibrium direct = equilibrium_from(system, z, z, a, rounding);
    if (has_border_of_start(direct)) return direct;
    // Away from an equilibrium an idle motion has some stiffness, and Newton's method would diverge
    // along it. So these motions are first taken into the border, by the looser threshold.
    NearEquilibrium loose = equilibrium_from(system, z, z, a, loose_zero_tolerance);
    if (!loose.equilibrium.settled) return direct;
    NearEquilibrium repeated =
        equilibrium_from(system, loose.equilibrium.y.head(system.n()), z, a, rounding);
    return has_border_of_start(repeated) ? repeated : loose;
}

}  // namespace elastocheck::reference::certificate
