#include "recursive/formula/recentre.hpp"

#include <algorithm>

#include "models/kinds.hpp"

namespace elastocheck::recursive {
namespace {

// Calls visit(point) for every point of a joint or element that is fixed to the ground, in ground
// axes [m].
template <class Any, class Visit>
void for_each_ground_point(Any& model, Visit&& visit) {
    const auto point = [&](auto& at) {
        if (at.body == ground) visit(at.s_local);
    };
    for (auto& constraint : model.constraints) each_point(constraint.kind, point);
    for (auto& element : model.elastics) each_point(element.kind, point);
    for (auto& joint : model.joints) point(joint.at);
}

}  // namespace

std::optional<Eigen::Vector3d> far_centre(const Model& model) {
    constexpr double two_digits = 100;  // distance of the origin over the size of the model
    Eigen::Vector3d c = Eigen::Vector3d::Zero();
    for (const auto& body : model.bodies)
        c += body.design.r / static_cast<double>(model.bodies.size());
    double size = 0;
    for (const auto& body : model.bodies) size = std::max(size, (body.design.r - c).norm());
    for_each_ground_point(model,
                          [&](const Eigen::Vector3d& s) { size = std::max(size, (s - c).norm()); });
    if (!(size > 0) || !(c.norm() > two_digits * size) || !c.allFinite()) return std::nullopt;
    return c;
}

Model centred(const Model& model, const Eigen::Vector3d& c) {
    Model here = model;
    for (auto& body : here.bodies) body.design.r -= c;
    for_each_ground_point(here, [&](Eigen::Vector3d& s) { s -= c; });
    return here;
}

}  // namespace elastocheck::recursive
