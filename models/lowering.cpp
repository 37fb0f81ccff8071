#include "models/lowering.hpp"

#include <utility>

#include "models/overloaded.hpp"

namespace elastocheck {
namespace {

Quaternion axes(const std::vector<Body>& bodies, BodyId body) {
    return body == ground ? Quaternion::Identity()
                          : bodies[static_cast<std::size_t>(body)].design.p;
}

// Two directions on the same body, perpendicular to `axis` and to each other.
std::pair<Direction, Direction> across(const Direction& axis) {
    const Vector3 a = axis.u_local.unitOrthogonal();
    return {{axis.body, a}, {axis.body, axis.u_local.cross(a).normalized()}};
}

// The direction `u` of one body, in the axes of another body at the design pose.
Direction carried(const Direction& u, BodyId to, const std::vector<Body>& bodies) {
    return {to, axes(bodies, to).conjugate() * (axes(bodies, u.body) * u.u_local)};
}

}  // namespace

std::vector<ConstraintKind> lower(const JointKind& joint, const std::vector<Body>& bodies) {
    using List = std::vector<ConstraintKind>;
    using Perp = PerpendicularDirections;
    const auto cylindrical = [](const Point& i, const Point& j, const Direction& axis_i,
                                const Direction& axis_j) {
        const auto [a, b] = across(axis_j);
        return List{PointInPlane{i, j, a}, PointInPlane{i, j, b}, Perp{axis_i, a}, Perp{axis_i, b}};
    };
    return std::visit(
        overloaded{
            [](const Spherical& s) {
                return List{CoincidentPoints{s.i, s.j}};
            },
            [](const Revolute& s) {
                const auto [a, b] = across(s.axis_j);
                return List{CoincidentPoints{s.i, s.j}, Perp{s.axis_i, a}, Perp{s.axis_i, b}};
            },
            [](const Universal& s) {
                return List{CoincidentPoints{s.i, s.j}, Perp{s.axis_i, s.axis_j}};
            },
            [&](const Cylindrical& s) { return cylindrical(s.i, s.j, s.axis_i, s.axis_j); },
            [&](const Translational& s) {
                List list = cylindrical(s.i, s.j, s.axis_i, s.axis_j);
                const auto [a, b] = across(s.axis_j);
                list.push_back(Perp{carried(a, s.axis_i.body, bodies), b});
                return list;
            },
            [](const Planar& s) {
                const auto [a, b] = across(s.normal_j);
                return List{PointInPlane{s.i, s.j, s.normal_j}, Perp{s.normal_i, a},
                            Perp{s.normal_i, b}};
            },
            [](const Fixed& s) {
                const Direction z_j{s.x_j.body, s.x_j.u_local.cross(s.y_j.u_local)};
                return List{CoincidentPoints{s.i, s.j}, Perp{s.x_i, s.y_j}, Perp{s.x_i, z_j},
                            Perp{s.y_i, z_j}};
            },
            [](const Distance& s) {
                return List{DistanceBetween{s.i, s.j, s.length}};
            },
            [](const InPlane& s) {
                return List{PointInPlane{s.i, s.j, s.normal_j, s.offset}};
            },
            [](const InLine& s) {
                const auto [a, b] = across(s.axis_j);
                return List{PointInPlane{s.i, s.j, a}, PointInPlane{s.i, s.j, b}};
            },
            [](const Perpendicular& s) {
                return List{Perp{s.i, s.j}};
            },
            [](const Parallel& s) {
                const auto [a, b] = across(s.j);
                return List{Perp{s.i, a}, Perp{s.i, b}};
            },
            [](const Angle& s) {
                return List{DirectionAtAngle{s.i, s.j, s.y_j, s.angle}};
            },
        },
        joint);
}

}  // namespace elastocheck
