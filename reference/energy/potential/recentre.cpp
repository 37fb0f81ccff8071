#include "reference/energy/potential/recentre.hpp"

#include "models/kinds.hpp"

namespace elastocheck::reference::energy {

using Eigen::Vector3d;

Vector3d centre_of(const Model& model) {
    Vector3d c = Vector3d::Zero();
    for (const Body& body : model.bodies)
        c += body.design.r / static_cast<double>(model.bodies.size());
    return c.allFinite() ? c : Vector3d::Zero();
}

Model about(const Model& model, const Vector3d& c) {
    Model here = model;
    for (Body& body : here.bodies) body.design.r -= c;
    const auto move = [&](auto& at) {
        if (at.body == ground) at.s_local -= c;
    };
    for (Constraint& constraint : here.constraints) each_point(constraint.kind, move);
    for (Elastic& elastic : here.elastics) each_point(elastic.kind, move);
    for (ModelJoint& joint : here.joints) move(joint.at);
    return here;
}

std::vector<Pose> moved_by(std::vector<Pose> poses, const Vector3d& r) {
    for (Pose& pose : poses) pose.r += r;
    return poses;
}

}  // namespace elastocheck::reference::energy
