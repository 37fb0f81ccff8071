// The external force vector f_ext of eq. (3): dead forces and moments on the bodies' origins.
#pragma once

#include "recursive/state.hpp"

namespace elastocheck::recursive {

// Adds factor · (sum of loads) to f_ext [6nb]. A force at
// a body point has a lever s = A s' that moves with the body.
template <class Real>
void add_loads(const std::vector<Load>& loads, Real factor, const State<Real>& q, Vector<Real>& f_ext) {
    for (const auto& load : loads) {
        if (const auto* force = std::get_if<DeadForce>(&load.kind)) {
            const BodyId b = force->at.body;
            const Vector3<Real> f = factor * force->f.cast<Real>();
            f_ext.template segment<3>(6 * b) += f;
            f_ext.template segment<3>(6 * b + 3) += q[b].lever(force->at.s_local).cross(f);
        } else {
            const auto& moment = std::get<DeadMoment>(load.kind);
            f_ext.template segment<3>(6 * moment.body + 3) += factor * moment.m.cast<Real>();
        }
    }
}

// f_ext(q, a) = static loads + a · branch loads.
template <class Real>
void external_force(const Model& model, const Branch& branch, Real a, const State<Real>& q,
                    Vector<Real>& f_ext) {
    f_ext.setZero(coordinates(model));
    add_loads<Real>(model.static_loads, Real(1), q, f_ext);
    add_loads<Real>(branch.loads, a, q, f_ext);
}

}  // namespace elastocheck::recursive
