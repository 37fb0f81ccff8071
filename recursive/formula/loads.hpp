// The external force vector f_ext of eq. (3): forces and moments on the bodies' origins.
// A follower keeps its components in body axes, F = A F', M = A M'.
#pragma once

#include "recursive/formula/inputs.hpp"

namespace elastocheck::recursive {

// Adds factor · load to f_ext [6nb]. A force at a body point has a lever s = A s', which rotates
// with the body.
template <class Real>
void add_load(const DeadForce& force, Real factor, const State<Real>& q, Vector<Real>& f_ext) {
    const BodyId b = force.at.body;
    const Vector3<Real> f = factor * force.f.cast<Real>();
    f_ext.template segment<3>(6 * b) += f;
    f_ext.template segment<3>(6 * b + 3) += q[b].lever(force.at.s_local).cross(f);
}
template <class Real>
void add_load(const DeadMoment& moment, Real factor, const State<Real>&, Vector<Real>& f_ext) {
    f_ext.template segment<3>(6 * moment.body + 3) += factor * moment.m.cast<Real>();
}
template <class Real>
void add_load(const FollowerForce& force, Real factor, const State<Real>& q, Vector<Real>& f_ext) {
    const BodyId b = force.at.body;
    const Vector3<Real> f = factor * q[b].lever(force.f_local);
    f_ext.template segment<3>(6 * b) += f;
    f_ext.template segment<3>(6 * b + 3) += q[b].lever(force.at.s_local).cross(f);
}
template <class Real>
void add_load(const FollowerMoment& moment, Real factor, const State<Real>& q,
              Vector<Real>& f_ext) {
    f_ext.template segment<3>(6 * moment.body + 3) += factor * q[moment.body].lever(moment.m_local);
}
// Lever from the origin of the carrier to the patch, ground axes.
template <class Real>
Vector3<Real> lever_of(const BrakeForce& brake, const State<Real>& q) {
    return q[brake.patch.body].r + q[brake.patch.body].lever(brake.patch.s_local) - q[brake.body].r;
}
template <class Real>
void add_load(const BrakeForce& brake, Real factor, const State<Real>& q, Vector<Real>& f_ext) {
    const Vector3<Real> f = factor * brake.f.cast<Real>();
    f_ext.template segment<3>(6 * brake.body) += f;
    f_ext.template segment<3>(6 * brake.body + 3) += lever_of<Real>(brake, q).cross(f);
}
template <class Real>
void add_load(const LoadKind& load, Real factor, const State<Real>& q, Vector<Real>& f_ext) {
    std::visit([&](const auto& kind) { add_load<Real>(kind, factor, q, f_ext); }, load);
}

// Calls sink(load, factor) for the static loads with factor 1, then for the loads that
// the branch drives.
template <class Real, class Sink>
void for_each_load(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                   Sink&& sink) {
    for (const auto& load : model.static_loads) sink(load.kind, Real(1));
    for (std::size_t k = 0; k < branch.drivers.size(); ++k)
        if (const Load* load = driven_load(branch.drivers[k].what))
            sink(load->kind, inputs.load_factor[k]);
}

// f_ext(q, inputs)
template <class Real>
void external_force(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                    const State<Real>& q, Vector<Real>& f_ext) {
    f_ext.setZero(coordinates(model));
    for_each_load<Real>(model, branch, inputs, [&](const LoadKind& load, Real factor) {
        add_load<Real>(load, factor, q, f_ext);
    });
}

// Instantiated in linear_algebra/in_double.cpp.
extern template void external_force<double>(const Model&, const Branch&, const Inputs<double>&,
                                            const State<double>&, Vector<double>&);

}  // namespace elastocheck::recursive
