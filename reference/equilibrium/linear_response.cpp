#include "reference/equilibrium/linear_response.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <stdexcept>

#include "reference/equilibrium/continuation/continuation.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::VectorXd;

// Relative part of a disturbance outside the range of ∂E/∂x that counts as round-off.
constexpr double residual_round_off = 1e-9;

// Largest displacement under F, over L: beyond it the stiffness is round-off.
constexpr double farthest = 1e10;

// Freezes the branch's drivers at a.
void stop(Affine& path, double a) { path = {path.at(a), 0}; }
System stopped(System system, double a) {
    for (Affine& value : system.values) stop(value, a);
    for (LoadPath& load : system.loads) stop(load.factor, a);
    for (ElementPath& element : system.elements) {
        stop(element.free_length, a);
        for (Affine& preload : element.preload) stop(preload, a);
    }
    return system;
}

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

// Reactions of least imbalance: E is linear in them.
void balance(const System& system, const Loading& loading, VectorXd& x, Derivatives& by,
             Counts& counts) {
    const Eigen::Index n = 6 * system.bodies, m = system.constraint_rows;
    if (n == 0 || m == 0 || !is_finite(by.J) || !by.E.allFinite()) return;
    const VectorXd R = -least_squares(by.J.topRightCorner(n, m), by.E.head(n));
    x.tail(m) += R;
    add_reactions(system, loading, x, R, by, counts);
}

// dx with minimum-norm motion in the idle modes. The border would minimise motion and reactions of
// the null vectors together, which is not wanted. The small number regularises modes that consist
// of reactions alone.
VectorXd with_shortest_motion(const System& system, const Linearisation& at, const VectorXd& dx) {
    constexpr double nothing = 1e-14;
    if (at.modes.count() == 0) return dx;
    const Eigen::Index n = 6 * system.bodies;
    const Sparse V = at.modes.right.topRows(n), V_T = V.transpose();
    Sparse one(V.cols(), V.cols());
    one.setIdentity();
    const Eigen::SimplicialLDLT<Sparse> gram(Sparse(V_T * V + nothing * one));
    return dx - at.modes.right * gram.solve(VectorXd(V_T * dx.head(n)));
}

// Whether the disturbance has a part outside the range of ∂E/∂x.
bool is_pushed(const Rate& rate, const VectorXd& E_rate) {
    return rate.mu.norm() > residual_round_off * E_rate.norm();
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances) {
    const double a = state.load;
    const System moving = make_system(model, branch, {&a, 1});
    if (state.poses.size() != model.bodies.size())
        throw std::invalid_argument("the state belongs to another model");
    const System system = stopped(moving, a);
    const auto fail = [&](Outcome outcome, const std::string& what) {
        return Response{outcome,
                        fmt::format("branch '{}', {}: {}", branch.name, parameter(branch, a), what),
                        {}};
    };

    Counts unused;
    const Loading loading{.a = a, .a_rate = 1};
    VectorXd x = unknowns_at(system, state.poses);
    Derivatives by = derivatives(system, loading, x, unused);
    balance(system, loading, x, by, unused);
    if (!x.allFinite() || !is_finite(by.J))
        return fail(Outcome::not_finite, "the equations give a number that is not finite");
    const Linearisation at = linearise(std::move(by.J), nullptr, unused);
    const VectorXd ahead = rate_of(moving, loading, x);
    if (system.equations() > 0 &&
        (at.bordered.sign() == 0 || is_pushed(refined_answer(at, ahead), ahead)))
        return fail(Outcome::singular, "the system is singular, the branch turns back here");

    Response response;
    for (const Disturbance& disturbance : disturbances) {
        const VectorXd E_rate = rate_of(disturbed(system, disturbance, a), loading, x);
        const Rate rate = refined_answer(at, E_rate);
        if (!rate.dx.allFinite())
            return fail(Outcome::not_finite,
                        name_of(model, disturbance) + " has a response that is not finite");
        if (rate.dx.norm() > farthest * E_rate.norm())
            return fail(Outcome::singular,
                        name_of(model, disturbance) + " acts on a motion with almost no stiffness");
        if (is_pushed(rate, E_rate)) {
            const Failure why = unsolvable_load(system, at.modes.left * rate.mu);
            return fail(why.outcome, name_of(model, disturbance) + ": " + why.what);
        }
        const VectorXd dx = with_shortest_motion(system, at, rate.dx);
        auto& increments = response.increments.emplace_back();
        for (int body = 0; body < system.bodies; ++body)
            increments.push_back(
                {system.length * dx.segment<3>(6 * body), dx.segment<3>(6 * body + 3)});
    }
    return response;
}

}  // namespace elastocheck::reference::equilibrium
