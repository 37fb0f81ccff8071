// The real numbers of a scene or of a compiled model, to add and to scale those of the same shape:
// models that are rates (models/state_rate.hpp).
#pragma once

#include <stdexcept>
#include <type_traits>
#include <vector>

#include "elastocheck/model.hpp"
#include "models/kinds.hpp"

namespace elastocheck {

// Calls f(double&) for every real number that a leg or an output reads, always in the same order.
// S is a Scene or a Model.
template <class S, class F>
void each_real_number(S& model, F&& f) {
    const auto vector = [&](auto& v) {
        for (auto& x : v.reshaped()) f(x);
    };
    const auto quaternion = [&](Eigen::Quaterniond& p) { vector(p.coeffs()); };
    const auto scalar_law = [&](ScalarLaw& law) {
        std::visit(overloaded{[&](LinearRate& u) { f(u.k); },
                              [&](Curve& u) {
                                  for (double& x : u.knots) f(x);
                                  for (auto& piece : u.pieces)
                                      for (double& c : piece) f(c);
                              }},
                   law);
    };
    const auto members =
        overloaded{[&](Point& p) { vector(p.s_local); },
                   [&](Direction& u) { vector(u.u_local); },
                   [&](Marker& m) { vector(m.s_local), quaternion(m.A_local); },
                   [&](Length<double> l) { f(l.value); },
                   [&](PlaneAngle<double> a) { f(a.value); },
                   [&](ForceAndMoment<Vector6> w) { vector(w.value); },
                   [&](Deformation<Vector6> e) { vector(e.value); },
                   [&](LoadVector<Eigen::Vector3d> l) { vector(l.value); },
                   [&](ScalarLaw& law) { scalar_law(law); },
                   [&](SpatialLaw& law) {
                       std::visit(overloaded{[&](LinearStiffness& u) { vector(u.K); },
                                             [&](PerAxis& u) {
                                                 for (auto& axis : u.axis) scalar_law(axis);
                                             }},
                                  law);
                   }};
    for (auto& body : model.bodies) vector(body.design.r), quaternion(body.design.p);
    if constexpr (std::is_same_v<S, Model>) {
        for (auto& joint : model.joints) vector(joint.at.s_local);
        for (auto& constraint : model.constraints) each_member(constraint.kind, members);
    } else {
        for (auto& joint : model.joints) each_member(joint.kind, members);
        for (auto& point : model.hardpoints) vector(point.position);
    }
    for (auto& elastic : model.elastics) each_member(elastic.kind, members);
    for (auto& load : model.static_loads) each_member(load.kind, members);
    for (auto& branch : model.branches)
        for (auto& driver : branch.drivers) {
            f(driver.start), f(driver.rate);
            each_member(driver.what,
                        overloaded{[&](Load& load) { each_member(load.kind, members); },
                                   [&](ForceAndMoment<Vector6> w) { vector(w.value); }});
        }
    for (auto& wheel : model.wheels) {
        vector(wheel.centre_local), vector(wheel.contact_local), vector(wheel.spin_axis_local);
        f(wheel.tyre_rate);
        if (wheel.steering_axis)
            vector(wheel.steering_axis->lower.s_local), vector(wheel.steering_axis->upper.s_local);
    }
    for (auto& probe : model.probes) vector(probe.at.s_local);
    for (auto& damper : model.dampers) vector(damper.i.s_local), vector(damper.j.s_local);
    if (model.vehicle) {
        Vehicle& v = *model.vehicle;
        f(v.wheelbase), f(v.cg_height), f(v.brake_share), f(v.drive_share);
    }
    if constexpr (std::is_same_v<S, Scene>)
        if (model.trim) {
            for (auto& adjustment : model.trim->adjust) {
                f(adjustment.per_unit);
                each_member(adjustment.what, [&](ForceAndMoment<Vector6> w) { vector(w.value); });
            }
            for (auto& condition : model.trim->until)
                if (condition.value) f(*condition.value);
        }
}

template <class S>
std::vector<double> numbers_of(S model) {
    std::vector<double> all;
    each_real_number(model, [&](double& x) { all.push_back(x); });
    return all;
}
// `model` with these numbers. Throws std::invalid_argument unless there are as many.
template <class S>
S with_numbers(S model, const std::vector<double>& numbers) {
    std::size_t k = 0;
    const auto next = [&]() {
        if (k == numbers.size()) throw std::invalid_argument("models of different shapes");
        return numbers[k++];
    };
    each_real_number(model, [&](double& x) { x = next(); });
    if (k != numbers.size()) throw std::invalid_argument("models of different shapes");
    return model;
}
template <class S>
S without_numbers(S model) {  // all zero
    each_real_number(model, [](double& x) { x = 0; });
    return model;
}

}  // namespace elastocheck
