#include "reference/equilibrium/continuation/stability.hpp"
#include "models/eigen/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Round-off of an eigenvalue, relative to the largest entry of ∂(balance)/∂q.
constexpr double eigenvalue_round_off = 1e-13;

// The parabola may not dip below the larger of these shares of the least and of the range of its
// three values; otherwise the step is halved.
constexpr double min_dip = 0.5, min_dip_of_range = 0.02;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The blocks ∂(balance)/∂q and Φ_q of J.
Sparse balance_rows(const System& system, const Sparse& J) {
    return J.topLeftCorner(6 * system.bodies, 6 * system.bodies);
}
Sparse constraint_rows(const System& system, const Sparse& J) {
    return J.bottomLeftCorner(system.constraint_rows, 6 * system.bodies);
}

// Extremes of the eigenvalues μ of M, for Stiffness.
struct Spectrum {
    double lowest = std::numeric_limits<double>::infinity(), modulus = lowest;
    int negative = 0;
    double log_product = 0;
    void add(const std::complex<double>& mu) {
        log_product += std::log2(std::abs(mu));
        const bool real = mu.imag() == 0;
        lowest = std::min(lowest, real ? mu.real() : std::abs(mu));
        modulus = std::min(modulus, std::abs(mu));
        negative += real && mu.real() < 0;
    }
    Stiffness stiffness(const System& system, double round_off) const {
        if (system.conservative) return {lowest, round_off};
        return {negative % 2 == 0 ? modulus : -modulus, round_off, negative};
    }
};

// ---- Models of few bodies: M itself

// With Z from a QR factorisation of Φ_qᵀ, all eigenvalues of M are cheaper than a sparse
// factorisation. Those of the `idle` modes are zero, the others have enough digits beside the
// rounding of M; otherwise, and for more coordinates than `max_coordinates`, the result is empty.
std::optional<Spectrum> spectrum_of_few(const System& system, const Sparse& J, Index idle,
                                        Index redundant) {
    constexpr Index max_coordinates = 72;
    // of the largest entry: the largest idle eigenvalue, and the smallest other one; of that one:
    // the largest asymmetry of a symmetric M
    constexpr double max_idle = 1e-11, min_resisting = 1e-6, max_asymmetry = 1e-3;
    const Index n = 6 * system.bodies, m = system.constraint_rows, d = n - m + redundant;
    if (n > max_coordinates || d <= idle) return std::nullopt;
    const MatrixXd dense = J;
    MatrixXd Z = MatrixXd::Identity(n, n).rightCols(d);
    if (m > 0) {
        const MatrixXd Phi_q_t = dense.bottomLeftCorner(m, n).transpose();
        Z = times_matrix(Eigen::ColPivHouseholderQR<MatrixXd>(Phi_q_t).householderQ(), Z);
    }
    const MatrixXd M = -congruence(dense.topLeftCorner(n, n), Z), S = (M + M.transpose()) / 2;
    const double size = dense.topLeftCorner(n, n).cwiseAbs().maxCoeff();
    if (!M.allFinite()) return std::nullopt;
    Eigen::VectorXcd mu;
    const auto sort_eigenvalues = [&](const auto& solver) {
        if (solver.info() != Eigen::Success) return false;
        mu = solver.eigenvalues();
        std::sort(mu.data(), mu.data() + d,
                  [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
        return true;
    };
    const bool symmetric =
        system.conservative &&
        sort_eigenvalues(Eigen::SelfAdjointEigenSolver<MatrixXd>(S, Eigen::EigenvaluesOnly)) &&
        (M - S).norm() <= max_asymmetry * std::abs(mu[idle]);
    if (!symmetric && !sort_eigenvalues(Eigen::EigenSolver<MatrixXd>(M, false)))
        return std::nullopt;
    if (idle > 0 && !(std::abs(mu[idle - 1]) <= max_idle * size)) return std::nullopt;
    if (!(std::abs(mu[idle]) > min_resisting * size)) return std::nullopt;
    Spectrum spectrum;
    for (Index k = idle; k < d; ++k) spectrum.add(mu[k]);
    return spectrum;
}

// ---- Definiteness without forming M

// Idle modes are fixed by adding a stiffness to one unknown per mode in which the mode is large. By
// inertia, k added terms create at most k positive eigenvalues, so a matrix with k null vectors
// that becomes positive definite had no negative eigenvalue.
std::vector<Index> fixed_unknowns(const Sparse& modes, Index n) {
    std::vector<Index> unknowns;
    for (Index k = 0; k < modes.cols(); ++k) {
        Index largest = -1;
        double size = 0;
        for (Sparse::InnerIterator entry(modes, k); entry; ++entry)
            if (entry.row() < n && std::abs(entry.value()) > size &&
                std::ranges::find(unknowns, entry.row()) == unknowns.end()) {
                largest = entry.row();
                size = std::abs(entry.value());
            }
        if (largest >= 0) unknowns.push_back(largest);
    }
    return unknowns;
}

// Whether no eigenvalue of the symmetric part of M is below -round_off. `false` is inconclusive: ρ
// may be too small for the negative part of K, or so large that round-off dominates.
bool surely_stable(const Sparse& K, const Sparse& Phi_q, const NullSpaces& idle, double size,
                   double round_off) {
    constexpr double penalties[] = {1e4, 1e7, 1e10};  // ρ over the largest entry of K
    const Index n = K.rows();
    Sparse added(n, n), K_T = K.transpose(), Phi_T = Phi_q.transpose();
    std::vector<Eigen::Triplet<double>> diagonal;
    for (int k = 0; k < n; ++k) diagonal.emplace_back(k, k, round_off);
    for (const Index k : fixed_unknowns(idle.right, n))
        diagonal.emplace_back(static_cast<int>(k), static_cast<int>(k), size);
    added.setFromTriplets(diagonal.begin(), diagonal.end());
    const Sparse S = (K + K_T) / 2 + added, constraints = Phi_T * Phi_q;
    for (const double rho : penalties) {
        const Eigen::SimplicialLDLT<Sparse> factors(Sparse(S + rho * size * constraints));
        if (factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all()) return true;
        if (Phi_q.rows() == 0) break;
    }
    return false;
}

// x = Z M⁻¹ Zᵀ b, with the idle modes projected out of b and x: P = 1 - V (VᵀV)⁻¹ Vᵀ, V the body
// part of the modes. Some columns of V may be zero; the small number regularises these.
struct Inverse {
    const Linearisation& source;
    Index n;
    Sparse V;
    Eigen::SimplicialLDLT<Sparse> gram;
    Inverse(const Linearisation& linearised, Index size) : source(linearised), n(size) {
        if (source.modes.count() == 0) return;
        constexpr double zero_tolerance = 1e-14;
        V = source.modes.right.topRows(n);
        Sparse identity(V.cols(), V.cols());
        identity.setIdentity();
        gram.compute(Sparse(Sparse(V.transpose()) * V + zero_tolerance * identity));
    }
    VectorXd without_idle(const VectorXd& b) const {
        if (source.modes.count() == 0) return b;
        return b - V * gram.solve(VectorXd(V.transpose() * b));
    }
    VectorXd operator()(const VectorXd& b) const {
        VectorXd right = VectorXd::Zero(source.J.rows());
        right.head(n) = without_idle(b);
        return without_idle(solve_bordered(source.bordered, right).dx.head(n));
    }
};

// Ritz values of an Arnoldi matrix H, and the size of the last entry of each eigenvector.
// Where an energy makes M symmetric, H is nearly symmetric: each eigenvalue of S + N, S
// symmetric, is within |N| of one of S (Bauer & Fike 1960). The eigenvalues of S are cheaper,
// and real where two coincide.
struct Ritz {
    Eigen::VectorXcd theta;
    VectorXd last;
};
std::optional<Ritz> ritz(const MatrixXd& H, bool conservative) {
    constexpr double max_asymmetry = 1e-3;
    if (const MatrixXd S = (H + H.transpose()) / 2; conservative) {
        const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(S);
        if (solver.info() != Eigen::Success) return std::nullopt;
        if ((H - S).norm() <= max_asymmetry * solver.eigenvalues().cwiseAbs().maxCoeff())
            return Ritz{solver.eigenvalues(),
                        solver.eigenvectors().bottomRows(1).transpose().cwiseAbs()};
    }
    const Eigen::EigenSolver<MatrixXd> solver(H);
    if (solver.info() != Eigen::Success) return std::nullopt;
    return Ritz{solver.eigenvalues(), solver.eigenvectors().bottomRows(1).transpose().cwiseAbs()};
}

// Eigenvalues of M near zero by Arnoldi's method on M⁻¹, whose largest they are: the first ones,
// to a relative error of 1e-8, as soon as the very first has converged; or `all`, which is the
// complete spectrum without multiplicity if at most `max_values` motions are free.
std::optional<Spectrum> eigenvalues_near_zero(const Inverse& inverse, Index n, Index free,
                                              bool conservative, bool all) {
    constexpr Index max_values = 200, steps_between_checks = 4;
    constexpr double tolerance = 1e-8, round_off = 1e-14;
    const Index size = std::min(max_values, free);
    MatrixXd Q(n, size), H = MatrixXd::Zero(size, size);
    VectorXd next(n);  // generic start vector: fractions of multiples of the golden ratio
    for (Index k = 0; k < n; ++k)
        next[k] = std::fmod(0.6180339887498949 * static_cast<double>(k + 1), 1.) - 0.5;
    next = inverse(next);
    double remainder = next.norm();
    if (!(std::isfinite(remainder) && remainder > 0)) return std::nullopt;
    for (Index k = 0; k < size; ++k) {
        if (k > 0) H(k, k - 1) = remainder;
        Q.col(k) = next / remainder;
        next = inverse(Q.col(k));
        for (int pass = 0; pass < 2; ++pass) {
            const VectorXd overlap = Q.leftCols(k + 1).transpose() * next;
            next -= Q.leftCols(k + 1) * overlap;
            H.col(k).head(k + 1) += overlap;
        }
        remainder = next.norm();
        if (!std::isfinite(remainder)) return std::nullopt;
        const MatrixXd H_k = H.topLeftCorner(k + 1, k + 1);
        const bool is_last = k + 1 == size || remainder <= round_off * H_k.norm();
        if (!is_last && (all || (k + 1) % steps_between_checks != 0)) continue;
        const auto values = ritz(H_k, conservative);
        if (!values) return std::nullopt;
        std::vector<Index> order(static_cast<std::size_t>(k + 1));
        std::iota(order.begin(), order.end(), 0);
        std::ranges::sort(order, std::greater{},
                          [&](Index j) { return std::abs(values->theta[j]); });
        const double largest = std::abs(values->theta[order.front()]);
        const bool complete = is_last && (size == free || remainder <= round_off * largest);
        Spectrum spectrum;
        Index count = 0;
        for (const Index j : order) {
            const double theta = std::abs(values->theta[j]);
            if (theta <= round_off * largest ||
                (!complete && remainder * values->last[j] > tolerance * theta))
                break;
            spectrum.add(1. / values->theta[j]);
            ++count;
        }
        if (count > 0) return spectrum;
        if (is_last) return std::nullopt;
    }
    return std::nullopt;
}

// Self-stresses in the left null space: combinations of its vectors whose body part is zero.
MatrixXd self_stresses(const System& system, const NullSpaces& modes) {
    constexpr double zero_tolerance = 1e-14;
    const Index n = 6 * system.bodies, m = system.constraint_rows;
    const Sparse of_bodies = modes.left.topRows(n);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
        MatrixXd(Sparse(of_bodies.transpose()) * of_bodies));
    const Index count = (solver.eigenvalues().array() <= zero_tolerance).count();
    return modes.left.bottomRows(m) * solver.eigenvectors().leftCols(count);
}

}  // namespace

std::optional<Stiffness> stiffness_of_few(const System& system, const Sparse& J, Index idle,
                                          Index redundant) {
    if (!is_finite(J)) return std::nullopt;
    const auto spectrum = spectrum_of_few(system, J, idle, redundant);
    if (!spectrum) return std::nullopt;
    Stiffness result =
        spectrum->stiffness(system, eigenvalue_round_off * largest_entry(balance_rows(system, J)));
    result.redundant = redundant;
    result.log_determinant = spectrum->log_product;
    return result;
}

Stiffness stiffness(const System& system, const Linearisation& linearisation) {
    if (!is_finite(linearisation.J)) return {nan, nan};
    if (system.bodies == 0) return {};
    const Index n = 6 * system.bodies, m = system.constraint_rows, k = linearisation.modes.count();
    const Index redundant = k == 0 ? 0 : self_stresses(system, linearisation.modes).cols();
    const Index free = n - (m - redundant) - (k - redundant);
    if (free == 0) return {};
    // Nearly redundant constraints: J and Φ_q disagree on the number of dependencies, so nothing
    // can be decided.
    if (free < 0) return {nan, nan};
    const Sparse K = -balance_rows(system, linearisation.J);
    const double size = largest_entry(K), round_off = eigenvalue_round_off * size;
    if (const auto direct = stiffness_of_few(system, linearisation.J, k - redundant, redundant))
        return *direct;
    const bool is_surely_stable =
        system.conservative && surely_stable(K, constraint_rows(system, linearisation.J),
                                             linearisation.modes, std::max(size, 1.0), round_off);
    const auto spectrum = eigenvalues_near_zero(Inverse(linearisation, n), n, free,
                                                system.conservative, !is_surely_stable);
    Stiffness result = spectrum ? spectrum->stiffness(system, round_off) : Stiffness{nan, nan};
    result.redundant = redundant;
    return result;
}

bool constraints_keep_their_side(const System& system, const Linearisation& from,
                                 const Linearisation& to) {
    if (system.constraint_rows == 0) return true;
    const Index m = system.constraint_rows;
    const Sparse begin = constraint_rows(system, from.J), end = constraint_rows(system, to.J);
    Sparse S = end * Sparse(begin.transpose());
    if (const MatrixXd U =
            from.modes.count() == 0 ? MatrixXd(m, 0) : self_stresses(system, from.modes);
        U.cols() > 0) {
        // ⎡ S   U ⎤
        // ⎣ -Uᵀ 1 ⎦ has the determinant of S + U Uᵀ
        std::vector<Eigen::Triplet<double>> entries;
        for (Index j = 0; j < m; ++j)
            for (Sparse::InnerIterator at(S, j); at; ++at)
                entries.emplace_back(static_cast<int>(at.row()), static_cast<int>(j), at.value());
        for (Index k = 0; k < U.cols(); ++k) {
            const int border = static_cast<int>(m + k);
            entries.emplace_back(border, border, 1.);
            for (int i = 0; i < m; ++i)
                if (U(i, k) != 0) {
                    entries.emplace_back(i, border, U(i, k));
                    entries.emplace_back(border, i, -U(i, k));
                }
        }
        S = Sparse(m + U.cols(), m + U.cols());
        S.setFromTriplets(entries.begin(), entries.end());
    }
    return Factors(S).sign() > 0;
}

namespace {

// With s from 0 to 1, λ(s) = λ₀ + b s + c s²,  b = -3 λ₀ + 4 λ_m - λ₁,  c = 2 (λ₀ - 2 λ_m + λ₁),
// has its least value λ₀ - b² / 4c at s = -b / 2c. A minimum predicted a little outside the step
// may lie within it, and the next step begins past it.
bool dips(double l_0, double l_m, double l_1, double round_off) {
    const double b = -3 * l_0 + 4 * l_m - l_1, c = 2 * (l_0 - 2 * l_m + l_1);
    const auto [smallest, largest] = std::minmax({l_0, l_m, l_1});
    constexpr double margin = 0.1;
    return c > 0 && b < 2 * margin * c && -b < 2 * (1 + margin) * c &&
           l_0 - b * b / (4 * c) <
               std::max(min_dip * smallest, min_dip_of_range * (largest - smallest)) - round_off;
}

}  // namespace

Stability over_step(const Stiffness& from, const Stiffness& middle, const Stiffness& to,
                    const std::array<double, 3>& logs) {
    const double l_0 = from.least, l_m = middle.least, l_1 = to.least;
    const double round_off = std::max({from.round_off, middle.round_off, to.round_off});
    const double least = std::min({l_0, l_m, l_1});
    if (!(std::isfinite(l_0) && std::isfinite(l_m) && std::isfinite(l_1)))
        return Stability::uncertain;
    if (least < -round_off) return Stability::lost;
    // Two eigenvalues became negative: through zero together, or around it as a complex pair.
    // In the second case the least modulus is not small, and hardly changes over a
    // sufficiently short step.
    constexpr double max_growth = 0.25;
    const bool pair = from.negative != to.negative || from.negative != middle.negative;
    if (pair && std::max({l_0, l_m, l_1}) > (1 + max_growth) * least) return Stability::uncertain;
    if (dips(l_0, l_m, l_1, round_off)) return Stability::uncertain;
    const double largest_log = std::max({logs[0], logs[1], logs[2]});
    const auto determinant = [&](std::size_t k) { return std::exp2(logs[k] - largest_log); };
    if (dips(determinant(0), determinant(1), determinant(2), 0)) return Stability::uncertain;
    return Stability::kept;
}

}  // namespace elastocheck::reference::equilibrium
