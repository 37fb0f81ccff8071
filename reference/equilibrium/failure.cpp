// Saying why a branch ended.
#include <fmt/format.h>

#include <Eigen/QR>

#include "reference/equilibrium/walk.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string body_with_largest(const System& system, const VectorXd& n) {
    double largest_part = -1;
    std::string name;
    for (int body = 0; body < system.bodies; ++body) {
        const double part = n.segment<6>(6 * body).norm();
        if (part > largest_part * 1.000001) {
            largest_part = part;
            name = system.model->bodies[static_cast<std::size_t>(body)].name;
        }
    }
    return name;
}

std::string joints_in(const System& system, const VectorXd& n) {
    std::string names;
    int row = 6 * system.bodies, last = -1;
    for (const auto& constraint : system.model->constraints) {
        const double part = n.segment(row, rows(constraint.kind)).norm();
        row += rows(constraint.kind);
        if (!(part > 1e-6 * n.norm()) || constraint.joint == last) continue;
        last = constraint.joint;
        names +=
            (names.empty() ? "'" : ", '") + system.model->joints[static_cast<std::size_t>(last)].name + "'";
    }
    return names;
}

// Whether the constraints alone can be met near x: Gauss-Newton with minimum-norm steps, Φ_q dq = -Φ.
bool constraints_can_be_met(Walk& walk, VectorXd x) {
    const System& system = walk.system;
    const int m = system.constraint_rows;
    const auto Phi = [&] { return VectorXd(residual(system, {0, 0}, x).tail(m)); };
    for (int iteration = 0; iteration < 30; ++iteration) {
        const MatrixXd Phi_q = jacobian(system, 0, x, walk.counts).bottomLeftCorner(m, 6 * system.bodies);
        VectorXd dx = VectorXd::Zero(system.equations());
        Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
        decomposition.setThreshold(1e-10);
        dx.head(6 * system.bodies) = -decomposition.compute(Phi_q).solve(Phi());
        if (!dx.allFinite()) return false;
        x = moved(system, x, dx);
        ++walk.counts.factorisations;
    }
    const double error = largest(Phi());
    return std::isfinite(error) && error <= 1e-9;
}

}  // namespace

Failure unanswerable(const System& system, const VectorXd& left) {
    if (left.tail(system.constraint_rows).norm() > left.head(6 * system.bodies).norm())
        return {Outcome::inconsistent_constraints,
                fmt::format("the joints {} contradict each other", joints_in(system, left))};
    return {Outcome::loaded_idle_mode, fmt::format("body '{}' is pushed along a motion that nothing resists",
                                                   body_with_largest(system, left))};
}

Failure failure(Walk& walk, double t, const Trial& trial) {
    const System& system = walk.system;
    const Attempt& attempt = trial.attempt;
    const std::string where =
        walk.stage == Stage::settling
            ? fmt::format("while settling at load factor 0, {:.0f} % of the way", 100 * walk.here.t)
            : fmt::format("between load factors {:.10g} and {:.10g}", walk.here.t, t);

    if (trial.verdict == Verdict::turned_over)
        return {Outcome::singular,
                "the system is singular and the branch may divide or lose its stability " + where};
    if (walk.stage == Stage::settling && !constraints_can_be_met(walk, walk.here.x))
        return {Outcome::inconsistent_constraints, "no pose near the design pose satisfies all joints"};
    if (const std::string bushing = bushing_at_half_turn(system, walk.here.x); !bushing.empty())
        return {Outcome::branch_lost,
                fmt::format("bushing '{}' is turned by half a turn, where its rotation has no value, {}",
                            bushing, where)};
    if (trial.verdict == Verdict::out_of_reach)
        return {Outcome::branch_lost, "the branch becomes too steep to be followed " + where};
    if (trial.verdict == Verdict::unsettled)
        return {Outcome::iteration_limit, "the solution does not settle within arithmetic " + where};
    if (trial.verdict == Verdict::unsolved) {
        if (!std::isfinite(attempt.residual))
            return {Outcome::not_finite, "the equations gave a number that is not finite " + where};
        const VectorXd left_over = residual(system, loading_at(walk.stage, t), attempt.x);
        const MatrixXd& U = walk.here.linearised.modes.left;
        if (U.cols() > 0 && (U.transpose() * left_over).norm() > 0.9 * left_over.norm())
            return unanswerable(system, U * (U.transpose() * left_over));
        // At a limit point a good part of the load step finds no answer; far below, arithmetic is at its end.
        const double step = std::abs(t - walk.here.t) * largest(walk.here.E_rate);
        if (attempt.out_of_time || attempt.residual <= std::max(1e-6 * step, 1e-13))
            return {Outcome::iteration_limit,
                    fmt::format("the scaled residual is {:.1e} after the last iteration {}", attempt.residual,
                                where)};
    }
    return {Outcome::branch_lost, "no equilibrium continues the branch " + where};
}

}  // namespace elastocheck::reference::equilibrium
