#include "reference/energy/state_tangent.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "models/branch.hpp"
#include "models/eigen/dense.hpp"
#include "reference/energy/minimise/cost.hpp"
#include "reference/energy/potential/conservative.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rest_on_idle = 1e-8;  // of the disturbance: largest load on an idle mode
constexpr double unanswered = 1e-3;    // of the disturbance: remainder before the last correction
constexpr double open = 1e-9;          // of Φ_rate: largest part that redundant joints may leave

}  // namespace

StateTangent tangent_at(const Model& model, const Branch& branch, const Equilibrium& state) {
    if (!fits_branch(model, branch))
        throw std::invalid_argument("the model has parts that are inactive on branch '" +
                                    branch.name + "', or the branch has two sides");
    if (state.poses.size() != model.bodies.size())
        throw std::invalid_argument("the state belongs to another model");
    StateTangent t;
    if (const auto what = why_not_conservative(model, branch)) {
        t.failure = {Outcome::not_conservative, *what};
        return t;
    }
    if (const double operations = dense_cost(model, 1).operations();
        operations > Options{}.operation_limit) {
        t.failure = {
            Outcome::too_large,
            fmt::format(
                "about {:.1g} operations for {} coordinates, the limit of the energy leg is {:.1g}",
                operations, coordinates(model), Options{}.operation_limit)};
        return t;
    }
    const Options options;
    t.course = course_of(model, branch);
    const std::array ends{state.load, branch.to};
    t.scales = scales_of(model, t.course, ends);
    Counts unused;
    const Path path{
        model, options, t.scales, t.course, turning_bushings(model, t.course), std::abs(state.load),
        unused};
    t.state = dense_state_at(path, state.load, state.poses);
    if (!t.state.balance.projected_gradient.allFinite() || !t.state.balance.Phi.allFinite() ||
        !t.state.H.allFinite()) {
        t.failure = {Outcome::not_finite, "the state has no finite potential"};
        return t;
    }
    if (!within_laws(model, path.turning, state.poses)) {
        t.failure = {Outcome::branch_lost, law_ended};
        return t;
    }
    const int n = coordinates(model);
    t.prescribed = at(t.course, state.load);
    t.S = t.scales.coordinates(n);
    t.D = t.scales.rows(model);
    t.lambda = t.scales.energy() * t.D.cwiseProduct(t.state.balance.lambda);
    t.K = t.state.H + load_stiffness(t.prescribed, t.scales, state.poses);
    t.Z = t.state.modes.Z(Eigen::all, t.state.modes.resisting());
    t.idle = t.state.modes.idle_motions();
    if (t.Z.cols() > 0) t.W.compute(congruence(t.K, t.Z));
    return t;
}

TangentSolution solve_tangent(const StateTangent& tangent, const VectorXd& b_SI,
                              const VectorXd& Phi_rate, double rounding) {
    VectorXd t = VectorXd::Zero(b_SI.size());
    if (Phi_rate.size() > 0) {
        const VectorXd driven_rate = -tangent.D.cwiseProduct(Phi_rate);
        t = shortest(tangent.state.balance, driven_rate);
        if (std::isfinite(rounding) &&
            !((tangent.state.balance.J_t.transpose() * t - driven_rate).norm() <=
              open * driven_rate.norm()))
            return {
                Outcome::inconsistent_constraints, "redundant joints prevent this motion", {}, {}};
    }
    const double energy = tangent.scales.energy();
    const VectorXd b = tangent.S.cwiseProduct(b_SI) / energy;

    VectorXd rest = Phi_rate.size() > 0 ? VectorXd(b + tangent.K * t) : b;
    const double size = largest(b) + largest(rest - b);
    const auto correct = [&] {
        if (tangent.Z.cols() == 0) return;
        const VectorXd along = tangent.Z.transpose() * rest;
        t -= tangent.Z * VectorXd(tangent.W.solve(along));
        rest = b + tangent.K * t;
    };
    correct();
    const double remainder = tangent.Z.cols() > 0 ? largest(tangent.Z.transpose() * rest) : 0;
    correct();
    if (!t.allFinite()) return {Outcome::not_finite, "the response is not finite", {}, {}};
    // Where the stiffness in W is only rounding, the corrections do not converge to a solution.
    if (!(remainder <= unanswered * size))
        return {Outcome::singular, "the stiffness of a motion vanishes", {}, {}};
    if (!(largest(tangent.idle.transpose() * rest) <= rest_on_idle * size + rounding))
        return {Outcome::loaded_idle_mode, "a motion that nothing resists is loaded", {}, {}};
    return {Outcome::converged, "", tangent.S.cwiseProduct(t), std::move(rest)};
}

VectorXd multiplier_rates(const StateTangent& tangent, const TangentSolution& solution) {
    if (tangent.lambda.size() == 0 || solution.rest.size() == 0)
        return VectorXd::Zero(tangent.lambda.size());
    const VectorXd minus_rest = -solution.rest,
                   dlambda = tangent.state.balance.qr.solve(minus_rest);
    return tangent.scales.energy() * tangent.D.cwiseProduct(dlambda);
}

}  // namespace elastocheck::reference::energy
