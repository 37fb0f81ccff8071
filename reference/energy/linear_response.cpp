#include "reference/energy/linear_response.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <stdexcept>

#include "models/branch.hpp"
#include "models/overloaded.hpp"
#include "reference/energy/minimise/branch.hpp"
#include "reference/energy/minimise/cost.hpp"
#include "reference/energy/potential/conservative.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rest_on_idle = 1e-8;  // of the disturbance: smallest load on an idle mode
constexpr double unanswered = 1e-3;    // of the disturbance: remainder before the last correction
constexpr double open = 1e-9;  // of an offset's rate: largest part that redundant joints may leave

void check(const Model& model, const Equilibrium& state,
           std::span<const Disturbance> disturbances) {
    const auto require = [](bool met, const char* what) {
        if (!met) throw std::invalid_argument(what);
    };
    require(state.poses.size() == model.bodies.size(), "the state belongs to another model");
    for (const auto& disturbance : disturbances)
        std::visit(
            overloaded{[&](const UnitWrench& wrench) {
                           require(static_cast<std::size_t>(wrench.at.body) < model.bodies.size(),
                                   "a disturbance acts on no body of the model");
                       },
                       [&](const Motion& motion) {
                           const auto joint = static_cast<std::size_t>(motion.joint);
                           require(joint < model.joints.size() && model.joints[joint].driven >= 0,
                                   "a disturbance drives a joint without offset");
                       }},
            disturbance);
}

// The prescribed quantities grow with s as along a branch that drives only this disturbance.
Prescribed rate_of(const Model& model, const Disturbance& disturbance) {
    Branch branch;
    const auto drive = [&](const Driven& what) { branch.drivers.push_back({what, 0, 1}); };
    std::visit(overloaded{[&](const UnitWrench& wrench) {
                              drive(Load{"", DeadForce{wrench.at, wrench.force}});
                              drive(Load{"", DeadMoment{wrench.at.body, wrench.moment}});
                          },
                          [&](const Motion& motion) { drive(motion); }},
               disturbance);
    return course_of(model, branch).rate;
}

std::string name_of(const Model& model, const Disturbance& disturbance) {
    return std::visit(
        overloaded{
            [&](const UnitWrench& wrench) {
                return fmt::format("a wrench on '{}'",
                                   model.bodies[static_cast<std::size_t>(wrench.at.body)].name);
            },
            [&](const Motion& motion) {
                return fmt::format("moving '{}'",
                                   model.joints[static_cast<std::size_t>(motion.joint)].name);
            }},
        disturbance);
}

// Linearised state, in ξ and units of F·L; A is that of dead moments.
struct Tangent {
    const Model& model;
    const State& state;
    Prescribed prescribed;
    double energy;                    // F·L
    VectorXd S, D, lambda;            // lambda of Φ, SI
    MatrixXd K;                       // H + A
    MatrixXd Z, idle;                 // resisting motions, and idle ones
    Eigen::PartialPivLU<MatrixXd> W;  // ZᵀKZ
};

Tangent tangent_of(const Path& path, const State& state) {
    const int n = coordinates(path.model);
    Tangent t{.model = path.model,
              .state = state,
              .prescribed = at(path.course, state.a),
              .energy = path.scales.energy(),
              .S = path.scales.coordinates(n),
              .D = path.scales.rows(path.model),
              .lambda = {},
              .K = {},
              .Z = state.modes.Z(Eigen::all, state.modes.resisting()),
              .idle = state.modes.idle_motions(),
              .W = {}};
    t.lambda = t.energy * t.D.cwiseProduct(state.at.lambda);
    t.K = state.H + moment_stiffness(t.prescribed, path.scales, n);
    if (t.Z.cols() > 0) t.W.compute(t.Z.transpose() * t.K * t.Z);
    return t;
}

struct Answer {
    Outcome outcome = Outcome::converged;
    std::string what;
    VectorXd t;
};

Answer answer(const Tangent& at, const Prescribed& rate) {
    const Model& model = at.model;
    const Chart chart = chart_about(at.state.poses);
    VectorXd b = gradient_rate(model, at.prescribed, rate, chart);
    VectorXd t = VectorXd::Zero(b.size());
    if (!rate.offset.isZero(0)) {
        const ConstraintRates rates = constraint_rates(model, at.prescribed, rate, chart);
        b += transposed_times(rates.Phi_qa, at.lambda);
        const VectorXd driven_rate = -at.D.cwiseProduct(rates.Phi_a);
        t = shortest(at.state.at, driven_rate);
        if (!((at.state.at.J_t.transpose() * t - driven_rate).norm() <= open * driven_rate.norm()))
            return {Outcome::inconsistent_constraints, "redundant joints prevent this motion", {}};
    }
    b = at.S.cwiseProduct(b) / at.energy;

    VectorXd left = b + at.K * t;
    const double size = largest(b) + largest(left - b);
    const auto correct = [&] {
        if (at.Z.cols() == 0) return;
        t -= at.Z * at.W.solve(at.Z.transpose() * left);
        left = b + at.K * t;
    };
    correct();
    const double remains = at.Z.cols() > 0 ? largest(at.Z.transpose() * left) : 0;
    correct();
    if (!t.allFinite()) return {Outcome::not_finite, "the response is not finite", {}};
    // Where the stiffness in W is only rounding, the corrections do not converge to a solution.
    if (!(remains <= unanswered * size))
        return {Outcome::singular, "the stiffness of a motion vanishes", {}};
    if (!(largest(at.idle.transpose() * left) <= rest_on_idle * size))
        return {Outcome::loaded_idle_mode, "a motion that nothing resists is loaded", {}};
    return {Outcome::converged, "", t};
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances) {
    if (!stands_on(model, branch))
        throw std::invalid_argument("the model has parts that are inactive on branch '" +
                                    branch.name + "', or the branch has two sides");
    check(model, state, disturbances);
    const auto fail = [&](Outcome outcome, const std::string& what) {
        return Response{outcome, fmt::format("branch '{}': {}", branch.name, what), {}};
    };
    if (const auto what = without_potential(model, branch))
        return fail(Outcome::not_conservative, *what);
    if (const double operations = cost_of(model, 1).operations(); operations > most_operations)
        return fail(
            Outcome::too_large,
            fmt::format(
                "about {:.1g} operations for {} coordinates, the limit of the energy leg is {:.1g}",
                operations, coordinates(model), most_operations));

    const Options options;
    const Course course = course_of(model, branch);
    const std::array ends{state.load, branch.to};
    Counts unused;
    const Path path{model,
                    options,
                    scales_of(model, course, ends),
                    course,
                    turning_bushings(model, course),
                    std::abs(state.load),
                    unused};
    const State here = state_at(path, state.load, state.poses);
    if (!here.at.left.allFinite() || !here.at.Phi.allFinite() || !here.H.allFinite())
        return fail(Outcome::not_finite, "the state has no finite potential");
    if (!within_laws(model, path.turning, state.poses))
        return fail(Outcome::branch_lost, law_ended);
    const Tangent tangent = tangent_of(path, here);
    if (answer(tangent, course.rate).outcome == Outcome::loaded_idle_mode)
        return fail(Outcome::singular,
                    "the stiffness of a motion vanishes, the branch turns back here");
    Response response;
    for (const auto& disturbance : disturbances) {
        const Answer answered = answer(tangent, rate_of(model, disturbance));
        if (answered.outcome != Outcome::converged)
            return fail(answered.outcome, name_of(model, disturbance) + ": " + answered.what);
        auto& increments = response.increments.emplace_back(model.bodies.size());
        const VectorXd x = tangent.S.cwiseProduct(answered.t);
        for (std::size_t b = 0; b < increments.size(); ++b) {
            const auto at = static_cast<Eigen::Index>(6 * b);
            increments[b] = {x.segment<3>(at), x.segment<3>(at + 3)};
        }
    }
    return response;
}

}  // namespace elastocheck::reference::energy
