#include "reference/equilibrium/continuation/from_start.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

#include "models/eigen/dense.hpp"
#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/continuation/stability.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Longest Newton step [L or rad], since no branch limits it.
constexpr double longest_correction = 0.3;

// Below this step size Newton's method converges without a step limit [L or rad].
constexpr double convergence_radius = 1e-3;

// Two states closer than this are the same [L or rad]: the uncertainty of a soft spring beside
// stiff ones.
constexpr double same_state_distance = 1e-6;

// Motions with less stiffness than this, relative to the largest, are idle.
constexpr double idle_eigenvalue = 1e-10;

// A state to be excluded. Its idle motions do not count in the distance.
struct KnownState {
    VectorXd x;
    MatrixXd idle;  // orthonormal [6 nb × k]

    // (to - x) of the bodies [6 nb], without its part along the idle motions.
    VectorXd difference(const System& system, const VectorXd& to) const {
        VectorXd d = step_between(system, x, to).head(6 * system.bodies);
        if (idle.cols() > 0) d -= idle * (idle.transpose() * d).eval();
        return d;
    }
};

KnownState known_state(const System& system, double a, const Equilibrium& state) {
    KnownState known{unknowns_at(system, state.poses), MatrixXd(6 * system.bodies, 0)};
    Counts counts;
    const Sparse J = derivatives(system, {a}, known.x, counts).J;
    if (!is_finite(J)) return known;
    const MatrixXd V = MatrixXd(null_spaces(J).right).topRows(6 * system.bodies);
    if (V.cols() == 0) return known;
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(V);
    known.idle = matrix_Q(qr).leftCols(qr.rank());
    return known;
}

// Deflation (Brown & Gearhart 1971; Farrell, Birkisson & Funke 2015): the equations times
//
//   m(x) = Π (1 / |x - x_k|² + 1)        over the known states x_k
//
// have the same solutions except these. The Newton step of m E is that of E, scaled or reversed:
//
//   δ / (1 - η),     η = ∇m · δ / m = -Σ 2 (x - x_k)·δ / (s (1 + s)),     s = |x - x_k|²
double deflation_factor(const System& system, const std::vector<KnownState>& known,
                        const VectorXd& x, const VectorXd& dx) {
    double eta = 0;
    for (const auto& state : known) {
        const VectorXd d = state.difference(system, x);
        const double s = d.squaredNorm();
        eta -= 2 * d.dot(dx.head(d.size())) / (s * (1 + s));
    }
    return 1 / (1 - eta);
}

}  // namespace

FromStart solve_from(const Model& model, const Branch& branch, double a,
                     const std::vector<Pose>& start, std::span<const Equilibrium> known,
                     const Options& options) {
    const System system = make_system(model, branch, {&a, 1});
    std::vector<KnownState> others;
    for (const auto& state : known) others.push_back(known_state(system, a, state));
    const Loading loading{a};
    VectorXd x = unknowns_at(system, start);
    Counts counts;
    Derivatives slopes = derivatives(system, loading, x, counts);
    if (!slopes.E.allFinite() || !is_finite(slopes.J)) return {Outcome::not_finite};
    const Index n = 6 * system.bodies, m = system.constraint_rows;
    // E is linear in the reactions: start with those of least imbalance.
    if (n > 0 && m > 0) {
        x.tail(m) -= least_squares(slopes.J.topRightCorner(n, m), slopes.E.head(n));
        slopes = derivatives(system, loading, x, counts);
    }
    Linearisation linearisation = linearise(slopes.J, nullptr, counts);
    for (int iteration = 0;; ++iteration) {
        if (iteration == options.iteration_limit) return {Outcome::iteration_limit};
        VectorXd dx = solve_bordered(linearisation.bordered, slopes.E).dx;
        if (!dx.allFinite()) return {Outcome::singular};
        dx *= deflation_factor(system, others, x, dx);
        const double size = pose_size(system, dx);
        if (!std::isfinite(size)) return {Outcome::singular};
        if (size > longest_correction) dx *= longest_correction / size;
        x = moved(system, x, dx);
        slopes = derivatives(system, loading, x, counts);
        if (!slopes.E.allFinite() || !is_finite(slopes.J)) return {Outcome::not_finite};
        linearisation = linearise(slopes.J, &linearisation, counts);
        if (size <= convergence_radius) break;
    }
    const Attempt attempt =
        newton(system, loading, x, linearise(slopes.J, nullptr, counts), options, counts);
    if (!(attempt.residual <= options.tolerance))
        return {std::isfinite(attempt.residual) ? Outcome::iteration_limit : Outcome::not_finite};
    for (const auto& other : others)
        if (pose_size(system, other.difference(system, attempt.x)) <= same_state_distance)
            return {Outcome::branch_lost};
    const Stiffness softest = stiffness(
        system, linearise(derivatives(system, loading, attempt.x, counts).J, nullptr, counts));
    return {Outcome::converged, state_of(system, loading, attempt.x), softest.least,
            softest.least > softest.round_off};
}

std::vector<std::vector<Pose>> beside(const Model& model, const Branch& branch,
                                      const Equilibrium& state, int motions,
                                      std::span<const double> lengths) {
    constexpr int max_bodies = 100;
    const System system = make_system(model, branch, {&state.load, 1});
    if (system.bodies == 0 || system.bodies > max_bodies) return {};
    const Index n = 6 * system.bodies, m = system.constraint_rows;
    const VectorXd x = unknowns_at(system, state.poses);
    // The curvature of the constraints depends on their reactions.
    VectorXd with_reactions = x;
    Counts counts;
    Derivatives slopes = derivatives(system, {state.load}, x, counts);
    if (!slopes.E.allFinite() || !is_finite(slopes.J)) return {};
    if (m > 0) {
        with_reactions.tail(m) -= least_squares(slopes.J.topRightCorner(n, m), slopes.E.head(n));
        slopes = derivatives(system, {state.load}, with_reactions, counts);
    }
    // M = -Zᵀ ∂(balance)/∂q Z in the null space of the constraints
    MatrixXd Z = MatrixXd::Identity(n, n);
    if (m > 0) {
        Eigen::ColPivHouseholderQR<MatrixXd> qr(
            MatrixXd(slopes.J.bottomLeftCorner(m, n)).transpose());
        Z = matrix_Q(qr).rightCols(n - qr.rank());
    }
    if (Z.cols() == 0) return {};
    const MatrixXd K = -MatrixXd(slopes.J.topLeftCorner(n, n)),
                   M = congruence((K + K.transpose()) / 2, Z);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(M);
    const double idle = idle_eigenvalue * modes.eigenvalues().cwiseAbs().maxCoeff();
    std::vector<std::vector<Pose>> list;
    int count = 0;
    for (Index k = 0; k < Z.cols() && count < motions; ++k) {
        if (std::abs(modes.eigenvalues()[k]) <= idle) continue;
        ++count;
        VectorXd dx = VectorXd::Zero(system.equations());
        dx.head(n) = Z * modes.eigenvectors().col(k);
        dx /= pose_size(system, dx);
        for (const double length : lengths)
            for (const double side : {+1., -1.})
                list.push_back(
                    state_of(system, {state.load}, moved(system, x, VectorXd(side * length * dx)))
                        .poses);
    }
    return list;
}

double distance(const Model& model, const Branch& branch, const Equilibrium& a,
                const Equilibrium& b) {
    const System system = make_system(model, branch, {&a.load, 1});
    return pose_size(
        system, known_state(system, a.load, a).difference(system, unknowns_at(system, b.poses)));
}

}  // namespace elastocheck::reference::equilibrium
