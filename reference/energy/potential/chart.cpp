#include "reference/energy/potential/chart.hpp"

#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

const Placement& Chart::operator[](BodyId body) const {
    static const Placement fixed;
    return body == ground ? fixed : placements[static_cast<std::size_t>(body)];
}

std::vector<Pose> design_poses(const Model& model) {
    std::vector<Pose> result;
    for (const auto& body : model.bodies) result.push_back(body.design);
    return result;
}

Chart chart_about(const std::vector<Pose>& centre) {
    Chart chart;
    chart.placements.resize(centre.size());
    for (std::size_t b = 0; b < centre.size(); ++b) {
        Placement& body = chart.placements[b];
        body.centre = {centre[b].r, centre[b].p.normalized()};
        body.A_c = body.centre.p.toRotationMatrix();
    }
    return chart;
}

void move_to(Placement& body, const Vector6& x) {
    body.dr = x.head<3>();
    body.phi = x.tail<3>();
    body.rotation_minus_one = rotation_minus_one(body.phi);
    body.quaternion_minus_one = quaternion_minus_one(body.phi);
    body.J = turn_jacobian(body.phi);
}

void move_to(Chart& chart, const VectorXd& x) {
    for (std::size_t b = 0; b < chart.placements.size(); ++b)
        move_to(chart.placements[b], x.segment<6>(6 * static_cast<int>(b)));
}

std::vector<Pose> poses(const Chart& chart) {
    std::vector<Pose> result;
    for (const auto& body : chart.placements) {
        Quaterniond rotation = body.quaternion_minus_one;
        rotation.w() += 1;
        result.push_back({body.centre.r + body.dr, (rotation * body.centre.p).normalized()});
    }
    return result;
}

VectorXd increment(const std::vector<Pose>& from, const std::vector<Pose>& to) {
    VectorXd x(6 * static_cast<int>(from.size()));
    for (std::size_t b = 0; b < from.size(); ++b) {
        x.segment<3>(6 * static_cast<int>(b)) = to[b].r - from[b].r;
        x.segment<3>(6 * static_cast<int>(b) + 3) =
            rotation_vector(to[b].p * from[b].p.conjugate());
    }
    return x;
}

PointMotion motion(const Placement& body, const Vector3d& s_local) {
    const Vector3d lever_c = body.A_c * s_local;
    const Vector3d dlever = body.rotation_minus_one * lever_c;
    return {body.centre.r + lever_c + (body.dr + dlever), body.dr + dlever, lever_c + dlever};
}

DirectionMotion turned(const Placement& body, const Vector3d& u_local) {
    const Vector3d u_c = body.A_c * u_local;
    const Vector3d du = body.rotation_minus_one * u_c;
    return {u_c + du, du};
}

}  // namespace elastocheck::reference::energy
