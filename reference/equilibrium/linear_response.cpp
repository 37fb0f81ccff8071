#include "reference/equilibrium/linear_response.hpp"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "reference/equilibrium/linear_algebra/number_rates.hpp"
#include "reference/equilibrium/state_tangent.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

// The disturbance as the only driver, of rate one and value zero at a.
System disturbed(System system, const Disturbance& disturbance, double a) {
    const Model& model = *system.model;
    std::visit(
        overloaded{
            [&](const UnitWrench& wrench) {
                if (static_cast<std::size_t>(wrench.at.body) >= model.bodies.size())
                    throw std::invalid_argument("a disturbance acts on no body of the model");
                const Affine growing{-a, 1};
                system.loads = {{DeadForce{wrench.at, wrench.force}, growing},
                                {DeadMoment{wrench.at.body, wrench.moment}, growing}};
            },
            [&](const Motion& motion) {
                const auto joint = static_cast<std::size_t>(motion.joint);
                if (joint >= model.joints.size() || model.joints[joint].driven < 0)
                    throw std::invalid_argument("a disturbance drives a joint without offset");
                Affine& value = system.values[static_cast<std::size_t>(model.joints[joint].driven)];
                value = {value.start - a, 1};
            }},
        disturbance);
    return system;
}

std::string name_of(const Model& model, const Disturbance& disturbance) {
    return std::visit(
        overloaded{[&](const UnitWrench& wrench) {
                       return "a wrench on '" +
                              model.bodies[static_cast<std::size_t>(wrench.at.body)].name + "'";
                   },
                   [&](const Motion& motion) {
                       return "moving '" +
                              model.joints[static_cast<std::size_t>(motion.joint)].name + "'";
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

struct Responses {
    Response response;
    Eigen::MatrixXd X;  // steps dx, one column per disturbance
};
Responses responses(const StateTangent& tangent, const Branch& branch, double a,
                    std::span<const Disturbance> disturbances) {
    Responses all;
    const auto fail = [&](Outcome outcome, const std::string& what) {
        all.response = {outcome,
                        fmt::format("branch '{}', {}: {}", branch.name, parameter(branch, a), what),
                        {}};
        return all;
    };
    if (tangent.outcome != Outcome::converged) return fail(tangent.outcome, tangent.what);
    const System& system = tangent.system;
    all.X.resize(system.equations(), static_cast<Eigen::Index>(disturbances.size()));
    for (const Disturbance& disturbance : disturbances) {
        const Answered answered = answer_to(
            tangent, rate_of(disturbed(system, disturbance, a), tangent.loading, tangent.x));
        if (answered.outcome != Outcome::converged)
            return fail(answered.outcome,
                        name_of(*system.model, disturbance) + ": " + answered.what);
        all.X.col(static_cast<Eigen::Index>(all.response.increments.size())) = answered.dx;
        all.response.increments.push_back(increments_of(system, answered.dx));
    }
    return all;
}

// The driven offsets of the disturbances [constraints × disturbances].
Eigen::MatrixXd offsets(const Model& model, std::span<const Disturbance> disturbances) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(std::ssize(model.constraints),
                                                static_cast<Eigen::Index>(disturbances.size()));
    for (std::size_t t = 0; t < disturbances.size(); ++t)
        std::visit(overloaded{[](const UnitWrench&) {},
                              [&](const Motion& motion) {
                                  const auto joint = static_cast<std::size_t>(motion.joint);
                                  all(model.joints[joint].driven, static_cast<Eigen::Index>(t)) = 1;
                              }},
                   disturbances[t]);
    return all;
}

// A wrench keeps its point of the body, whose lever turns by dx: moment (δπ × s) × f.
void add_turning_wrenches(const System& system, const Eigen::VectorXd& x, const Eigen::VectorXd& dx,
                          std::span<const Disturbance> disturbances, Eigen::MatrixXd& E_rate) {
    for (std::size_t t = 0; t < disturbances.size(); ++t)
        std::visit(overloaded{[&](const UnitWrench& wrench) {
                                  const BodyId b = wrench.at.body;
                                  const Eigen::Vector3d lever =
                                      turned(frame_of(system, x, b).p, wrench.at.s_local);
                                  E_rate.col(static_cast<Eigen::Index>(t)).segment<3>(6 * b + 3) +=
                                      dx.segment<3>(6 * b + 3).cross(lever).cross(wrench.force) /
                                      (system.force * system.length);
                              },
                              [](const Motion&) {}},
                   disturbances[t]);
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances) {
    return responses(tangent_at(model, branch, state), branch, state.load, disturbances).response;
}

ResponseRates response_rates(const Model& model, const Branch& branch, const Equilibrium& state,
                             std::span<const Disturbance> disturbances,
                             std::span<const Model> rates) {
    constexpr double rounding_of_terms = 64 * std::numeric_limits<double>::epsilon();
    const StateTangent tangent = tangent_at(model, branch, state);
    const System& system = tangent.system;
    Responses base = responses(tangent, branch, state.load, disturbances);
    ResponseRates all{std::move(base.response), {}};
    if (all.at.outcome != Outcome::converged) return all;
    const Responding to{std::move(base.X), offsets(model, disturbances)};
    const auto D = curvatures(system, tangent.x, to);
    for (const Model& rate : rates) {
        ResponseRate& by = all.by.emplace_back();
        const NumberRate number = number_rate(system, rate, state.load, tangent.x);
        const double rounding = rounding_of_terms * largest_entry(tangent.at.J) * number.motion;
        const auto answered = [&](const Eigen::VectorXd& E_rate, double rounding_of) {
            const Answered one = answer_to(tangent, E_rate, rounding_of);
            if (one.outcome != Outcome::converged) by = {one.outcome, one.what, {}};
            return one.dx;
        };
        const Eigen::VectorXd dx = answered(rate_of(number, tangent.x), rounding);
        if (by.outcome != Outcome::converged) continue;
        Eigen::MatrixXd E_rate = rates_of(number, tangent.x, to);
        for (Eigen::Index t = 0; t < to.X.cols(); ++t)
            E_rate.col(t) += D[static_cast<std::size_t>(t)] * dx;
        add_turning_wrenches(system, tangent.x, dx, disturbances, E_rate);
        for (Eigen::Index t = 0; t < to.X.cols() && by.outcome == Outcome::converged; ++t) {
            // The parts of a change that cancel may be as large as D dx.
            const double size = rounding_of_terms *
                                D[static_cast<std::size_t>(t)].cwiseAbs().maxCoeff() *
                                (dx.norm() + number.motion);
            const Eigen::VectorXd step = answered(E_rate.col(t), rounding + size);
            if (by.outcome == Outcome::converged)
                by.increments.push_back(increments_of(system, step));
        }
    }
    return all;
}

}  // namespace elastocheck::reference::equilibrium
