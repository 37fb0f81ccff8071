// Removes joints whose constraints another joint already imposes. Other redundancy depends on the
// position and is found by the legs.
#include <algorithm>
#include <map>

#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"
#include "models/lowering.hpp"
#include "models/near.hpp"

namespace elastocheck::reduce {
namespace {

bool same(double a, double b) { return are_near(a, b, design_tolerance); }
bool same(const Point& a, const Point& b) {
    return a.body == b.body && are_near(a.s_local, b.s_local, design_tolerance);
}
bool same(const Direction& a, const Direction& b) {
    return a.body == b.body && are_near(a.u_local, b.u_local, design_tolerance);
}
bool same_line(const Direction& a, const Direction& b) {
    return same(a, b) || same(a, {b.body, -b.u_local});
}
// Whether the ends i and j are the same, in either order.
template <class T>
bool same_pair(const T& a, const T& b,
               bool (*same_end)(const decltype(T::i)&, const decltype(T::i)&)) {
    return (same_end(a.i, b.i) && same_end(a.j, b.j)) || (same_end(a.i, b.j) && same_end(a.j, b.i));
}

// Whether two constraints are the same equation up to sign.
bool same(const CoincidentPoints& a, const CoincidentPoints& b) { return same_pair(a, b, same); }
bool same(const PointInPlane& a, const PointInPlane& b) {
    if (!same(a.i, b.i) || !same(a.j, b.j)) return false;
    return (same(a.normal_j, b.normal_j) && same(a.offset, b.offset)) ||
           (same(a.normal_j, {b.normal_j.body, -b.normal_j.u_local}) && same(a.offset, -b.offset));
}
bool same(const PerpendicularDirections& a, const PerpendicularDirections& b) {
    return same_pair(a, b, same_line);
}
bool same(const DistanceBetween& a, const DistanceBetween& b) {
    return same(a.length, b.length) && same_pair(a, b, same);
}
bool same(const DirectionAtAngle& a, const DirectionAtAngle& b) {
    return same(a.i, b.i) && same(a.j, b.j) && same(a.y_j, b.y_j) && same(a.angle, b.angle);
}

using Equations = std::vector<ConstraintKind>;

bool contains(const Equations& equations, const ConstraintKind& wanted) {
    return std::ranges::any_of(equations, [&](const ConstraintKind& other) {
        return other.index() == wanted.index() &&
               std::visit(
                   [&](const auto& a) {
                       return same(a, std::get<std::decay_t<decltype(a)>>(other));
                   },
                   wanted);
    });
}
bool contains(const Equations& equations, const Equations& wanted) {
    return std::ranges::all_of(
        wanted, [&](const ConstraintKind& equation) { return contains(equations, equation); });
}

}  // namespace

void drop_duplicates(Scene& scene) {
    const DrivenParts driven = driven_parts(scene);
    std::map<std::pair<BodyId, BodyId>, std::vector<std::size_t>> between;
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        const auto [i, j] = ends(scene.joints[k].kind);
        if (!driven.joints[k] && !scene.joints[k].active_only_where_driven)
            between[std::minmax(i, j)].push_back(k);
    }
    Kept kept(scene);
    for (const auto& [pair, joints] : between) {
        if (joints.size() < 2) continue;
        std::vector<Equations> equations;
        for (const std::size_t k : joints)
            equations.push_back(lower(scene.joints[k].kind, scene.bodies));
        for (std::size_t k = 0; k < joints.size(); ++k)
            for (std::size_t l = 0; l < joints.size(); ++l) {
                if (l == k || !kept.joints[joints[l]] || !kept.joints[joints[k]]) continue;
                if (!contains(equations[l], equations[k])) continue;
                if (l > k && contains(equations[k], equations[l]))
                    continue;  // of two equal joints the first stays
                kept.joints[joints[k]] = false;
                leave_out(scene, named("joint", scene.joints[joints[k]].name),
                          "joint '" + scene.joints[joints[l]].name +
                              "' imposes the same constraint and carries the whole reaction");
            }
    }
    keep_only(scene, kept);
}

}  // namespace elastocheck::reduce
