#include "reference/energy/constraints/reactions.hpp"

namespace elastocheck::reference::energy {

using Eigen::Vector3d;
using Eigen::VectorXd;

// V + λᵀΦ is stationary, so in a small motion of one body its constraints do the work -λᵀ Φ_q δx.
// At the centre of the chart δφ = δπ, so the entries of -Φ_qᵀ λ for a body are the force on it and
// the moment about its origin. About another point p the moment is less by (p - r) × F. If body i
// is ground, the wrench is the opposite of that on body j.
std::vector<Wrench> reactions(const Model& model, const Chart& centre,
                              const ConstraintValues& values, const VectorXd& lambda) {
    std::vector<Wrench> wrenches(model.joints.size());
    int row = 0;
    auto slope = values.Phi_q.slopes.begin();
    for (const auto& constraint : model.constraints) {
        const ModelJoint& joint = model.joints[static_cast<std::size_t>(constraint.joint)];
        Wrench& wrench = wrenches[static_cast<std::size_t>(constraint.joint)];
        const int count = rows(constraint.kind);
        const BodyId body = joint.i != ground ? joint.i : joint.j;
        if (body != ground) {
            const double sign = joint.i != ground ? -1 : 1;
            Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
            for (; slope != values.Phi_q.slopes.end() && slope->row < row + count; ++slope)
                if (slope->body == body) {
                    force += sign * slope->dr * lambda[slope->row];
                    moment += sign * slope->dpi * lambda[slope->row];
                }
            const Vector3d p = motion(centre[joint.at.body], joint.at.s_local).p;
            wrench.force += force;
            wrench.moment += moment - (p - centre[body].centre.r).cross(force);
        }
        row += count;
    }
    return wrenches;
}

}  // namespace elastocheck::reference::energy
