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
// Test: with G ≈ L⁻¹ of M = L Lᵀ, in doubles, G (M ± R) Gᵀ is close to the identity. If its row
// sums deviate by less than one, all its eigenvalues are positive, and so are those of M ± R. The
// test is row by row, which allows stiff and soft directions together:
//
//   |I - G (M ± R) Gᵀ| 1 ≤ |I - fl(fl(G M) Gᵀ)| 1 + |G| (R + 2γ |M|) |Gᵀ| 1
#include "reference/certificate/stability.hpp"

#include <Eigen/Cholesky>

#include "reference/certificate/krawczyk.hpp"

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Scaling by it is exact.
double power_of_two(double x) { return std::exp2(std::nearbyint(std::log2(x))); }

using Sparse = std::vector<std::pair<Index, Interval>>;  // one row: its nonzero entries

// A row of the Jacobian with respect to (δr, L δπ) of each body.
Sparse turned_row(const System& system, const std::vector<Interval>& z, const Interval* J,
                  double length) {
    Sparse row;
    for (BodyId body = 0; body < system.bodies; ++body) {
        const auto k = static_cast<std::size_t>(system.pose(body));
        const Index to = 6 * body;
        for (std::size_t i = 0; i < 3; ++i)
            if (!is_zero(J[k + i])) row.emplace_back(to + static_cast<Index>(i), J[k + i]);
        const Interval *p = &z[k + 3], *d = J + k + 3;
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

bool positive_definite(const MatrixXd& M, const MatrixXd& R) {
    const Index n = M.rows();
    if (n == 0) return true;
    if (!M.allFinite() || !R.allFinite()) return false;
    const Eigen::LLT<MatrixXd> cholesky(M);
    if (cholesky.info() != Eigen::Success) return false;
    const MatrixXd G = cholesky.matrixL().solve(MatrixXd::Identity(n, n)), size = G.cwiseAbs();
    if (!G.allFinite()) return false;
    const MatrixXd rest = (MatrixXd::Identity(n, n) - G * M * G.transpose()).cwiseAbs();
    const double unit = std::numeric_limits<double>::epsilon(),
                 gamma = 2 * static_cast<double>(n + 4) * unit;
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(n), across = above(size.transpose(), one);
    const Eigen::VectorXd off =
        above(rest, one) + above(size, above(R, across) + gamma * above(M.cwiseAbs(), across));
    return (off.array() < 0.99).all();
}

bool stable(const Problem& problem, const std::vector<Interval>& z,
            const std::vector<Interval>& J) {
    const System& system = problem.system;
    const Index n = 6 * system.bodies;
    const auto size = static_cast<std::size_t>(problem.size());
    const double length = power_of_two(system.length);
    const auto row_of = [&](std::size_t row) {
        return turned_row(system, z, &J[row * size], length);
    };

    const auto N = static_cast<std::size_t>(n);
    std::vector<Interval> H(N * N);
    const Interval half = 0.5;
    for (Index i = 0; i < n; ++i) {
        const double by = i % 6 < 3 ? 1 : 1 / length;
        for (const auto& [j, entry] : row_of(static_cast<std::size_t>(i))) {
            const Interval part = -(entry * Interval(by) * half);
            const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
            H[a * N + b] += part;
            H[b * N + a] += part;
        }
    }
    for (std::size_t c = 0; c < system.separated.size(); ++c) {
        const auto at = static_cast<std::size_t>(system.corner(c));
        // from the law itself: the smallest slope of a stop is zero, and outward rounding would
        // make it negative
        std::array<Interval, 2> f;
        expand(std::get<Curve>(law_of(system, system.separated[c])),
               z[static_cast<std::size_t>(system.deformation(c))], 2, f.data());
        const double k = f[1].lo;
        if (!system.conservative || !(k >= 0)) return false;
        const Sparse w = row_of(at);
        for (const auto& [i, a] : w)
            for (const auto& [j, b] : w)
                H[static_cast<std::size_t>(i) * N + static_cast<std::size_t>(j)] +=
                    Interval(k) * (i == j ? sqr(a) : a * b);
    }
    double most = 0;
    for (const Interval& entry : H) most = std::max(most, mag(entry));
    if (!std::isfinite(most) || !(most > 0)) return n == 0;

    // Constraint rows and gauges of idle motions, scaled to size one.
    std::vector<Sparse> held;
    const auto hold = [&](Sparse row) {
        double largest = 0;
        for (const auto& [k, entry] : row) largest = std::max(largest, mag(entry));
        if (!(largest > 0) || !std::isfinite(largest)) return;
        const Interval by = power_of_two(1 / largest);
        for (auto& [k, entry] : row) entry *= by;
        held.push_back(std::move(row));
    };
    for (int row = 0; row < system.rows; ++row) hold(row_of(static_cast<std::size_t>(n + row)));
    for (int k = problem.border.redundant; k < problem.border.count(); ++k)
        hold(row_of(static_cast<std::size_t>(system.n() + k)));

    for (const double rho : {1., 1e3, 1e6}) {
        std::vector<Interval> all = H;
        const Interval weight = power_of_two(rho * most);
        for (const Sparse& row : held)
            for (const auto& [i, a] : row)
                for (const auto& [j, b] : row)
                    all[static_cast<std::size_t>(i) * N + static_cast<std::size_t>(j)] +=
                        weight * (i == j ? sqr(a) : a * b);
        MatrixXd M(n, n), R(n, n);
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j) {
                const Interval& entry = all[static_cast<std::size_t>(std::max(i, j)) * N +
                                            static_cast<std::size_t>(std::min(i, j))];
                M(i, j) = mid(entry);
                R(i, j) = rad(entry);
            }
        if (positive_definite(M, R)) return true;
        if (held.empty()) return false;
    }
    return false;
}

}  // namespace elastocheck::reference::certificate
