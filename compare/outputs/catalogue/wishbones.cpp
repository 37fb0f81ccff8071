#include "compare/outputs/catalogue/wishbones.hpp"

#include <Eigen/Geometry>
#include <optional>

#include "compare/outputs/fixed_bodies.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

// Points at which ball joints or bushings hold a body to another, ground axes [m].
std::vector<Vector3d> points_between(const Subject& x, const FixedBodies& fixed, BodyId body,
                                     BodyId other) {
    std::vector<Vector3d> points;
    for (const Constraint& constraint : x.model.constraints)
        std::visit(overloaded{[&](const CoincidentPoints& c) {
                                  if (fixed.are_two(c.i.body, c.j.body, body, other))
                                      points.push_back(x.placed(c.i).position);
                              },
                              [](const auto&) {}},
                   constraint.kind);
    for (const auto& elastic : x.model.elastics)
        std::visit(overloaded{[&](const Bushing& b) {
                                  if (fixed.are_two(b.i.body, b.j.body, body, other))
                                      points.push_back(x.placed(b.i.body, b.i.s_local).position);
                              },
                              [](const auto&) {}},
                   elastic.kind);
    return points;
}

// Axis of a joint between two bodies: the direction that its two perpendicularity constraints share.
std::optional<Vector3d> axis_between(const Subject& x, const FixedBodies& fixed, BodyId body,
                                     BodyId other) {
    std::optional<Vector3d> axis;
    std::optional<PerpendicularDirections> first;
    int of_first = -1;
    for (const Constraint& constraint : x.model.constraints)
        std::visit(overloaded{[&](const PerpendicularDirections& c) {
                                  if (!fixed.are_two(c.i.body, c.j.body, body, other)) return;
                                  if (of_first == constraint.joint && first) {
                                      if (c.i.u_local == first->i.u_local) axis = x.direction(c.i);
                                      if (c.j.u_local == first->j.u_local) axis = x.direction(c.j);
                                  }
                                  first = c;
                                  of_first = constraint.joint;
                              },
                              [](const auto&) {}},
                   constraint.kind);
    return axis;
}

}  // namespace

std::vector<Plane> wishbone_planes(const Subject& x) {
    const BodyId wheel = x.wheel().body;
    const FixedBodies fixed(x.model);
    std::vector<Plane> planes;
    for (BodyId arm = 0; arm < static_cast<BodyId>(x.model.bodies.size()); ++arm) {
        if (!fixed.is_first(arm) || fixed.are_one(arm, wheel) || fixed.are_one(arm, ground))
            continue;
        const auto outer = points_between(x, fixed, arm, wheel),
                   inner = points_between(x, fixed, arm, ground);
        if (outer.size() != 1 || inner.empty()) continue;
        Vector3d line;
        if (inner.size() == 2)
            line = inner[1] - inner[0];
        else if (const auto axis = axis_between(x, fixed, arm, ground); axis)
            line = *axis;
        else
            continue;
        const Vector3d normal = line.cross(outer[0] - inner[0]);
        if (!(normal.norm() > 1e-9 * line.norm())) continue;
        planes.push_back({normal.normalized(), normal.normalized().dot(inner[0])});
    }
    return planes;
}

}  // namespace elastocheck::compare
