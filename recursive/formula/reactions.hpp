// Joint reaction wrenches from Lagrange multipliers, eq. (22).
#pragma once

#include "elastocheck/equilibrium_path.hpp"
#include "recursive/formula/constraints.hpp"

namespace elastocheck::recursive {

// f_ext = f_elast + Φ_qᵀ λ, so the joint exerts -(Φ_qᵀ λ)_i on its body i, a force with a moment
// about the body's origin. The wrench is moved to the joint's point, p = r + s:  M_p = M_r - s × F.
// Ground is a body like the others. Returns |Φ|², computed from the same rows.
template <class Real>
Real joint_wrenches(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                    const Vector<Real>& lambda, std::vector<Wrench>& wrenches) {
    for (auto& wrench : wrenches) wrench = {};
    int k = 0, last_joint = -1;
    Real sum = 0;
    Vector3<Real> s;  // lever of the joint's point; a joint's constraints follow one another
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const Constraint& constraint = model.constraints[c];
        const ModelJoint& joint = model.joints[static_cast<std::size_t>(constraint.joint)];
        if (constraint.joint != last_joint) s = q[joint.i].lever(joint.at.s_local);
        last_joint = constraint.joint;
        Wrench& wrench = wrenches[static_cast<std::size_t>(constraint.joint)];
        rows<Real>(constraint.kind, inputs.offset[c], q, [&](const Row<Real>& row) {
            // A constraint may list the joint's bodies in either order.
            const bool on_i = row.i == joint.i;
            const Real pull = on_i ? -lambda[k] : lambda[k];
            ++k;
            sum += row.Phi * row.Phi;
            const Vector3<Real> F = pull * row.n;
            wrench.force += F.template cast<double>();
            wrench.moment +=
                (((on_i ? row.s_i : row.s_j) - s).cross(F) + pull * row.u).template cast<double>();
        });
    }
    return sum;
}

// Instantiated in linear_algebra/in_double.cpp.
extern template double joint_wrenches<double>(const Model&, const Inputs<double>&,
                                              const State<double>&, const Vector<double>&,
                                              std::vector<Wrench>&);

}  // namespace elastocheck::recursive
