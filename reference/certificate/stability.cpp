// Verified positive definiteness of the reduced Hessian. With T the map δz = T (δr, L δπ), and
// A = T applied to the Jacobian,
//
//   H = -½ (A_qq + A_qqᵀ),    H + ρ (Φ_qᵀ Φ_q + g gᵀ) positive definite for some ρ
//     ⟹  xᵀ H x > 0 where Φ_q x = 0 and g x = 0
//
// A separated law is not in A_qq: its force f does the work k w δx on the deformation wᵀ δx, so it
// adds k w wᵀ, which is at least that of the smallest slope k ≥ 0 in the box. Only for systems with
// an energy.
//
// Test (Rump 2006): scaled by powers of two to a diagonal of about one, which allows stiff and soft
// directions together, M ± R is M̂ ± R̂. With the row sums C = diag(R̂ 1), C - R̂ has no negative
// eigenvalue. If Cholesky's method in doubles ends for M̂ - C - c I, with at most p entries in a row
// of L, then L Lᵀ = M̂ - C - c I + Δ with |Δ_ij| ≤ γ (m_ii m_jj)^½, γ = γ_{p+2}, so
//
//   xᵀ (M̂ ± R̂) x ≥ xᵀ (M̂ - C) x ≥ (c - γ tr M̂) xᵀ x > 0     for a larger c
#include "reference/certificate/stability.hpp"

#include <Eigen/SparseCholesky>

#include "reference/certificate/krawczyk.hpp"

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Scaling by it is exact.
double power_of_two(double x) { return std::exp2(std::nearbyint(std::log2(x))); }

using Sparse = std::vector<std::pair<Index, Interval>>;  // one row: its nonzero entries
using Entries = std::vector<Slope<Interval>>;

// A row of the Jacobian with respect to (δr, L δπ) of each body, from that by r and the quaternion
// p: δp = ½ (0, δπ) p.
Sparse turned_row(const System& system, const std::vector<Interval>& z,
                  std::span<const Slope<Interval>> J, double length) {
    std::vector<std::pair<BodyId, std::array<Interval, 7>>> by_body;
    for (const auto& [_, column, value] : J) {
        if (column >= 7 * system.bodies) continue;
        const BodyId body = column / 7;
        auto at = std::ranges::find(by_body, body, [](const auto& entry) { return entry.first; });
        if (at == by_body.end()) at = by_body.insert(at, {body, {}});
        at->second[static_cast<std::size_t>(column % 7)] = value;
    }
    Sparse row;
    for (const auto& [body, slopes] : by_body) {
        const auto k = static_cast<std::size_t>(system.pose(body));
        const Index to = 6 * body;
        for (std::size_t i = 0; i < 3; ++i)
            if (!is_zero(slopes[i])) row.emplace_back(to + static_cast<Index>(i), slopes[i]);
        const Interval *p = &z[k + 3], *d = &slopes[3];
        const Interval half = Interval(0.5) / Interval(length);
        const std::array<Interval, 3> turn{d[1] * p[0] - d[0] * p[1] + d[3] * p[2] - d[2] * p[3],
                                           d[2] * p[0] - d[0] * p[2] + d[1] * p[3] - d[3] * p[1],
                                           d[3] * p[0] - d[0] * p[3] + d[2] * p[1] - d[1] * p[2]};
        for (std::size_t i = 0; i < 3; ++i)
            if (!is_zero(turn[i])) row.emplace_back(to + 3 + static_cast<Index>(i), turn[i] * half);
    }
    return row;
}

}  // namespace

bool is_positive_definite(const SparseMatrix& M, const SparseMatrix& R) {
    const Index n = M.rows();
    if (n == 0) return true;
    const VectorXd diagonal = M.diagonal();
    if (!M.coeffs().allFinite() || !R.coeffs().allFinite() || !(diagonal.minCoeff() > 0))
        return false;
    const VectorXd D = diagonal.unaryExpr([](double m) { return power_of_two(1 / std::sqrt(m)); });
    SparseMatrix scaled = D.asDiagonal() * M * D.asDiagonal();
    // of the lower triangle, which is the one that is factorised
    const SparseMatrix radius =
        SparseMatrix(D.asDiagonal() * R * D.asDiagonal()).selfadjointView<Eigen::Lower>();
    Eigen::SimplicialLLT<SparseMatrix> cholesky(scaled);
    if (cholesky.info() != Eigen::Success) return false;
    const SparseMatrix L = cholesky.matrixL();
    VectorXd entries = VectorXd::Zero(n);  // of each row
    for (Index j = 0; j < n; ++j)
        for (SparseMatrix::InnerIterator at(L, j); at; ++at) ++entries[at.row()];
    const double unit = std::numeric_limits<double>::epsilon(),
                 c = 1.01 * unit * (entries.maxCoeff() + 4) * (scaled.diagonal().sum() + 1);
    const VectorXd C = product_bound(radius, VectorXd::Ones(n));
    for (Index k = 0; k < n; ++k) scaled.coeffRef(k, k) -= 1.01 * (C[k] + c);
    cholesky.factorize(scaled);
    return cholesky.info() == Eigen::Success;
}

bool is_stable(const Problem& problem, const std::vector<Interval>& z,
               const SparseRows<Interval>& J) {
    const System& system = problem.system;
    const Index n = 6 * system.bodies;
    const double length = power_of_two(system.length);
    const auto row_of = [&](Index row) { return turned_row(system, z, J.row(row), length); };
    // Adds weight · row rowᵀ.
    const auto add_square = [](Entries& sum, const Interval& weight, const Sparse& row) {
        for (const auto& [i, a] : row)
            for (const auto& [j, b] : row)
                sum.push_back(
                    {static_cast<int>(i), static_cast<int>(j), weight * (i == j ? sqr(a) : a * b)});
    };

    Entries H;
    const Interval half = 0.5;
    for (Index i = 0; i < n; ++i) {
        const double scale = i % 6 < 3 ? 1 : 1 / length;
        for (const auto& [j, entry] : row_of(i)) {
            const Interval part = -(entry * Interval(scale) * half);
            H.push_back({static_cast<int>(i), static_cast<int>(j), part});
            H.push_back({static_cast<int>(j), static_cast<int>(i), part});
        }
    }
    for (std::size_t c = 0; c < system.separated.size(); ++c) {
        // from the law itself: the smallest slope of a stop is zero, and outward rounding would
        // make it negative
        std::array<Interval, 2> f;
        expand(std::get<Curve>(law_of(system, system.separated[c])),
               z[static_cast<std::size_t>(system.deformation(c))], 2, f.data());
        const double k = f[1].lo;
        if (!system.conservative || !(k >= 0)) return false;
        add_square(H, k, row_of(system.curve(c)));
    }
    H = by_rows(H, static_cast<int>(n)).entries;
    double largest_entry = 0;
    for (const auto& entry : H) largest_entry = std::max(largest_entry, mag(entry.value));
    if (!std::isfinite(largest_entry) || !(largest_entry > 0)) return n == 0;

    // Constraint rows and gauges of idle motions, scaled to size one.
    std::vector<Sparse> excluded;
    const auto exclude = [&](Sparse row) {
        double largest = 0;
        for (const auto& [k, entry] : row) largest = std::max(largest, mag(entry));
        if (!(largest > 0) || !std::isfinite(largest)) return;
        const Interval scale = power_of_two(1 / largest);
        for (auto& [k, entry] : row) entry *= scale;
        excluded.push_back(std::move(row));
    };
    for (int row = 0; row < system.rows; ++row) exclude(row_of(n + row));
    for (int k = problem.border.redundant; k < problem.border.count(); ++k)
        exclude(row_of(system.n() + k));

    for (const double rho : {1., 1e3, 1e6}) {
        Entries sum_of_squares = H;
        for (const Sparse& row : excluded)
            add_square(sum_of_squares, power_of_two(rho * largest_entry), row);
        const Split sum = split(by_rows(sum_of_squares, static_cast<int>(n)));
        if (sum.finite && is_positive_definite(sum.M, sum.R)) return true;
        if (excluded.empty()) return false;
    }
    return false;
}

}  // namespace elastocheck::reference::certificate
