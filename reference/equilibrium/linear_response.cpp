#include "reference/equilibrium/linear_response.hpp"

#include <fmt/format.h>

#include "reference/equilibrium/state_tangent.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

// Drives the system, which has no driver, by the disturbance alone, of rate 1 and value 0 at a.
void disturb(System& system, const Disturbance& disturbance, double a) {
    const Model& model = *system.model;
    std::visit(overloaded{[&](const UnitWrench& wrench) {
                              const Affine growing{-a, 1};
                              system.loads = {{DeadForce{wrench.at, wrench.force}, growing},
                                              {DeadMoment{wrench.at.body, wrench.moment}, growing}};
                          },
                          [&](const Motion& motion) {
                              const int driven =
                                  model.joints[static_cast<std::size_t>(motion.joint)].driven;
                              Affine& value = system.values[static_cast<std::size_t>(driven)];
                              value = {value.start - a, 1};
                          }},
               disturbance);
}

std::vector<Increment> increments_of(const System& system, const Eigen::VectorXd& dx) {
    std::vector<Increment> increments;
    for (int body = 0; body < system.bodies; ++body)
        increments.push_back(
            {system.length * dx.segment<3>(6 * body), dx.segment<3>(6 * body + 3)});
    return increments;
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances,
                         std::shared_ptr<const Orders>* orders) {
    check(model, disturbances);
    const double a = state.load;
    const auto fail = [&](Outcome outcome, const std::string& what) {
        return Response{outcome,
                        fmt::format("branch '{}', {}: {}", branch.name, parameter(branch, a), what),
                        {}};
    };
    Orders known;
    if (orders != nullptr && *orders) known = **orders;
    const StateTangent tangent = tangent_at(model, branch, state, known);
    if (orders != nullptr) *orders = std::make_shared<const Orders>(std::move(known));
    if (tangent.outcome != Outcome::converged) return fail(tangent.outcome, tangent.what);
    System driven = tangent.system;
    Response response;
    for (const Disturbance& disturbance : disturbances) {
        driven.values = tangent.system.values;
        driven.loads.clear();  // static here
        disturb(driven, disturbance, a);
        const Solved solved = solve_at_state(tangent, rate_of(driven, tangent.loading, tangent.x));
        if (solved.outcome != Outcome::converged)
            return fail(solved.outcome, name_of(model, disturbance) + ": " + solved.what);
        response.increments.push_back(increments_of(tangent.system, solved.dx));
    }
    return response;
}

}  // namespace elastocheck::reference::equilibrium
