#include "reference/energy/linear_response.hpp"

#include <fmt/format.h>

#include "models/overloaded.hpp"
#include "reference/energy/state_tangent.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

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

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances) {
    check(model, disturbances);
    const auto fail = [&](Outcome outcome, const std::string& what) {
        return Response{outcome, fmt::format("branch '{}': {}", branch.name, what), {}};
    };
    const StateTangent tangent = tangent_at(model, branch, state);
    if (tangent.failure) return fail(tangent.failure->outcome, tangent.failure->what);
    const Chart chart = chart_about(tangent.state.poses);
    const auto solution_for = [&](const Prescribed& rate) {
        VectorXd b = gradient_rate(model, tangent.prescribed, rate, chart);
        if (rate.offset.isZero(0)) return solve_tangent(tangent, b, {});
        const ConstraintRates rates = constraint_rates(model, tangent.prescribed, rate, chart);
        b += transposed_times(rates.Phi_qa, tangent.lambda);
        return solve_tangent(tangent, b, rates.Phi_a);
    };
    if (solution_for(tangent.course.rate).outcome == Outcome::loaded_idle_mode)
        return fail(Outcome::singular,
                    "the stiffness of a motion vanishes, the branch turns back here");
    Response response;
    for (const auto& disturbance : disturbances) {
        const TangentSolution solution = solution_for(rate_of(model, disturbance));
        if (solution.outcome != Outcome::converged)
            return fail(solution.outcome, name_of(model, disturbance) + ": " + solution.what);
        auto& increments = response.increments.emplace_back(model.bodies.size());
        for (std::size_t b = 0; b < increments.size(); ++b) {
            const auto row = static_cast<Eigen::Index>(6 * b);
            increments[b] = {solution.x.segment<3>(row), solution.x.segment<3>(row + 3)};
        }
    }
    return response;
}

}  // namespace elastocheck::reference::energy
