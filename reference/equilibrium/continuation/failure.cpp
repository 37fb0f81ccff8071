// Diagnosis of the end of a branch.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "models/eigen/dense.hpp"
#include "reference/equilibrium/continuation/continuation.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::VectorXd;

// Name of the body whose six entries of the vector [n] are largest.
std::string body_with_largest(const System& system, const VectorXd& vector) {
    double largest_part = -1;
    std::string name;
    for (int body = 0; body < system.bodies; ++body) {
        const double part = vector.segment<6>(6 * body).norm();
        if (part > largest_part * 1.000001) {
            largest_part = part;
            name = system.model->bodies[static_cast<std::size_t>(body)].name;
        }
    }
    return name;
}

// Names of the joints with entries in a vector of the constraint rows [m], such as a dependency.
std::string joints_in(const System& system, const VectorXd& vector) {
    constexpr double min_part = 1e-6;  // below round-off
    std::string names;
    int row = 0, last = -1;
    for (const auto& constraint : system.model->constraints) {
        const double part = vector.segment(row, rows(constraint.kind)).norm();
        row += rows(constraint.kind);
        if (!(part > min_part * vector.norm()) || constraint.joint == last) continue;
        last = constraint.joint;
        names += (names.empty() ? "'" : ", '") +
                 system.model->joints[static_cast<std::size_t>(last)].name + "'";
    }
    return names;
}

// Remaining gap of the constraints near x at a: Gauss-Newton with minimum-norm steps, Φ_q dq = -Φ.
// Where the constraints are inconsistent the iteration ends at Φ_qᵀ Φ = 0, so that Φ names the
// conflicting ones.
VectorXd gap(Continuation& continuation, double a, VectorXd x) {
    // quadratic convergence for consistent constraints; no accuracy needed otherwise
    constexpr int iterations = 30;
    const System& system = continuation.system;
    const int m = system.constraint_rows;
    const auto Phi = [&] { return VectorXd(residual(system, {a}, x).tail(m)); };
    for (int iteration = 0; iteration < iterations; ++iteration) {
        const Sparse J = derivatives(system, {a}, x, continuation.counts).J;
        if (!is_finite(J)) break;
        VectorXd dx = VectorXd::Zero(system.equations());
        dx.head(6 * system.bodies) =
            -least_squares(J.bottomLeftCorner(m, 6 * system.bodies), Phi());
        if (!dx.allFinite()) break;
        x = moved(system, x, dx);
        ++continuation.counts.factorisations;
    }
    return Phi();
}

// Tolerance of the scaled Φ: smaller gaps count as closed.
constexpr double gap_tolerance = 1e-9;

// Whether a limit point lies just ahead, in contrast to a bifurcation. With u the left null vector
// of J at the singular point, M u = 0, the tangent near it is x' = -(u · dE/dt) / μ v + ..., μ the
// least stiffness. It grows as μ falls unless u · dE/dt = 0, that is, unless dE/dt is in the range
// of J and another curve crosses this one. So at a limit point μ |x'| keeps its value, at a
// bifurcation it goes to zero with μ.
bool turns_back(const Continuation& continuation) {
    constexpr double max_stiffness = 0.15, min_product = 0.02;  // relative to their values at a = 0
    const double stiffness = continuation.current.stiffness.least / continuation.first_stiffness;
    return continuation.stage == Stage::branch && std::abs(stiffness) <= max_stiffness &&
           std::abs(stiffness) * pose_size(continuation.system, continuation.current.tangent) >=
               min_product * continuation.first_tangent;
}

// Whether a bifurcation was passed: beyond the singular point the same curve continues
// with a negative eigenvalue of M, so another curve crosses it. M does not show a
// bifurcation of the constraints.
bool has_bifurcated(const Continuation& continuation, const Trial& trial) {
    const Stiffness& past = trial.station.stiffness;
    return trial.verdict == Verdict::past_singular_point && past.least < -past.round_off &&
           constraints_keep_their_side(continuation.system, continuation.current.linearised,
                                       trial.station.linearised);
}

}  // namespace

Failure unsolvable_load(const System& system, const VectorXd& left) {
    // Truly redundant joints balance each other, and leave only round-off on the bodies.
    constexpr double round_off = 1e-11;
    const double joint_part = left.tail(system.constraint_rows).norm(),
                 body_part = left.head(6 * system.bodies).norm();
    if (joint_part > body_part && body_part > round_off * joint_part)
        return {Outcome::iteration_limit,
                fmt::format("the joints {} are nearly redundant, and the motions that they leave "
                            "free cannot be computed in double precision",
                            joints_in(system, left.tail(system.constraint_rows)))};
    if (joint_part > body_part)
        return {Outcome::inconsistent_constraints,
                fmt::format("the joints {} are inconsistent",
                            joints_in(system, left.tail(system.constraint_rows)))};
    return {Outcome::loaded_idle_mode,
            fmt::format("body '{}' is loaded along a motion that nothing resists",
                        body_with_largest(system, left))};
}

// M = ZᵀKZ, formed here with Z from a singular value decomposition of Φ_q. Its least eigenvalue is
// that of stability.hpp, or that of an idle mode with a negative stiffness.
std::string softest_motion(const System& system, const Linearisation& linearised) {
    constexpr int largest_dense = 600;  // coordinates
    const int n = 6 * system.bodies, m = system.constraint_rows;
    if (n > largest_dense) return "the model is too large to say which bodies move";
    const Eigen::MatrixXd J = linearised.J;
    Eigen::MatrixXd Z = Eigen::MatrixXd::Identity(n, n);
    if (m > 0) {
        constexpr double dependent = 1e-9;  // of the largest singular value
        const Svd svd = svd_of(J.bottomLeftCorner(m, n), Eigen::ComputeFullV);
        Z = svd.V.rightCols(n - (svd.values.array() > dependent * svd.values[0]).count());
    }
    const Eigen::MatrixXd K = -J.topLeftCorner(n, n);
    const Eigen::MatrixXd M = congruence((K + K.transpose()) / 2, Z);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(M);
    const VectorXd motion = Z * solver.eigenvectors().col(0);
    VectorXd rotations = motion, displacements = motion;
    for (int body = 0; body < system.bodies; ++body) {
        rotations.segment<3>(6 * body).setZero();
        displacements.segment<3>(6 * body + 3).setZero();
    }
    const double largest_displacement = largest(displacements);
    std::string text;
    for (int body = 0; body < system.bodies; ++body)
        if (largest(displacements.segment<6>(6 * body)) > std::max(largest_displacement / 2, 1e-6))
            text += (text.empty() ? "bodies that are displaced: '" : ", '") +
                    system.model->bodies[static_cast<std::size_t>(body)].name + "'";
    if (largest(rotations) > 1e-6)
        text += (text.empty() ? "body that turns most: '" : "; body that turns most: '") +
                body_with_largest(system, rotations) + "'";
    return text;
}

Failure too_soft(const System& system, const VectorXd& left) {
    return {Outcome::iteration_limit,
            fmt::format("body '{}' is loaded along a motion so much softer than others that its "
                        "stiffness cannot be computed in double precision",
                        body_with_largest(system, left))};
}

Failure failure(Continuation& continuation, double t, const Trial& trial) {
    const System& system = continuation.system;
    const Attempt& attempt = trial.attempt;
    const auto parameter_at = [&](double a) { return parameter(*system.branch, a); };
    const bool settling = continuation.stage == Stage::settling;
    const std::string where =
        settling ? fmt::format("while settling at {}, at {:.0f} % of the homotopy", parameter_at(0),
                               100 * continuation.current.t)
        : parameter_at(continuation.current.t) == parameter_at(t)
            ? "at " + parameter_at(t)
            : fmt::format("between {} and {}", parameter_at(continuation.current.t),
                          parameter_at(t));

    if (!settling && has_bifurcated(continuation, trial))
        return {Outcome::bifurcation_point,
                "a bifurcation point: another curve of equilibria crosses the branch, which is "
                "unstable past this point, " +
                    where};
    if (trial.verdict == Verdict::past_singular_point)
        return {
            Outcome::singular,
            "the system is singular and the branch may bifurcate or lose its stability " + where};
    if (trial.verdict == Verdict::uncertain)
        return {
            Outcome::singular,
            "the system is too close to singular to decide whether the branch continues " + where};
    // A mechanism at the end of its range has almost no gap here: its gap is evaluated farther on.
    constexpr double probe_steps = 12, min_probe = 1.8e-4;  // trial steps; share of the whole stage
    const double target =
        settling ? 0
                 : continuation.current.t +
                       std::copysign(std::max(probe_steps * std::abs(t - continuation.current.t),
                                              min_probe * continuation.length),
                                     t - continuation.current.t);
    const VectorXd Phi =
        system.constraint_rows > 0 ? gap(continuation, target, continuation.current.x) : VectorXd();
    if (const double largest_gap = largest(Phi);
        !(std::isfinite(largest_gap) && largest_gap <= gap_tolerance))
        return {Outcome::inconsistent_constraints,
                settling
                    ? fmt::format("no pose near the design pose satisfies all joints at {}: {} "
                                  "cannot be closed",
                                  parameter_at(0), joints_in(system, Phi))
                    : fmt::format("no pose satisfies all joints beyond {}: {} cannot be closed",
                                  parameter_at(continuation.current.t), joints_in(system, Phi))};
    if (const std::string bushing = bushing_without_angles(system, continuation.current.x);
        !bushing.empty())
        return {Outcome::branch_lost, fmt::format("{}, {}", bushing, where)};
    if (turns_back(continuation))
        return {Outcome::limit_point,
                "a limit point, past which no equilibrium continues the branch, " + where};
    if (trial.verdict == Verdict::past_knot)
        return {Outcome::iteration_limit, "no step ends at the knot of a law " + where};
    if (trial.verdict == Verdict::out_of_reach)
        return {Outcome::branch_lost, "the branch is too steep for the continuation " + where};
    if (trial.verdict == Verdict::unsettled)
        return {Outcome::iteration_limit,
                "Newton's method does not converge to the accuracy of the arithmetic " + where};
    if (trial.verdict == Verdict::unsolved) {
        if (!std::isfinite(attempt.residual))
            return {Outcome::not_finite, "the equations give a number that is not finite " + where};
        const VectorXd remainder = residual(system, loading_at(continuation, t), attempt.x);
        const Sparse& U = continuation.current.linearised.modes.left;
        constexpr double dominant_part = 0.9;
        if (U.cols() > 0 && (U.transpose() * remainder).norm() > dominant_part * remainder.norm())
            return unsolvable_load(system, U * (U.transpose() * remainder));
        // At a limit point a large part of the step remains unsolved. A far smaller remainder is
        // the rounding limit, in proportion to the largest distance of a body from the centre, over
        // L.
        constexpr double max_unsolved_part = 1e-6, relative_rounding = 1e-13;
        double distance = 1;
        for (int body = 0; body < system.bodies; ++body)
            distance = std::max(distance, continuation.current.x.segment<3>(7 * body).norm());
        const double rounding_limit = distance * relative_rounding;
        const double step =
            std::abs(t - continuation.current.t) * largest(continuation.current.E_rate);
        if (attempt.out_of_time ||
            attempt.residual <= std::max(max_unsolved_part * step, rounding_limit))
            return {Outcome::iteration_limit,
                    fmt::format("the scaled residual is {:.1e} after the last iteration {}",
                                attempt.residual, where)};
    }
    return {Outcome::branch_lost, "no equilibrium continues the branch " + where};
}

}  // namespace elastocheck::reference::equilibrium
