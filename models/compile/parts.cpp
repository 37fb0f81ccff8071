#include "models/compile/parts.hpp"

#include <algorithm>
#include <cmath>

#include "models/laws.hpp"
#include "models/lowering.hpp"
#include "models/near.hpp"

namespace elastocheck::reduce {
namespace {

using std::cos, std::sin;

// Whether the force is zero somewhere in x ± rounding [m] or [rad].
bool is_free(const ScalarLaw& law, double x, double rounding) {
    const double below = force(law, x - rounding), above = force(law, x + rounding);
    return std::min(below, above) <= 0 && 0 <= std::max(below, above);
}
bool is_free(const SpatialLaw& law, const Vector6& e, double rounding) {
    return std::visit(
        overloaded{[&](const LinearStiffness& u) { return Vector6(u.K * e).isZero(0); },
                   [&](const PerAxis& u) {
                       bool free = true;
                       for (int k = 0; k < 6; ++k)
                           free =
                               free && is_free(u.axis[static_cast<std::size_t>(k)], e[k], rounding);
                       return free;
                   }},
        law);
}

// New positions of the kept parts, -1 for the others.
std::vector<int> renumbered(const std::vector<bool>& kept) {
    std::vector<int> ids(kept.size(), -1);
    int next = 0;
    for (std::size_t k = 0; k < kept.size(); ++k)
        if (kept[k]) ids[k] = next++;
    return ids;
}

template <class T>
void compact(std::vector<T>& list, const std::vector<bool>& kept) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (!kept[k]) continue;
        if (next != k) list[next] = std::move(list[k]);
        ++next;
    }
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(next), list.end());
}

}  // namespace

DrivenParts driven_parts(const Scene& scene) {
    DrivenParts parts{std::vector<bool>(scene.joints.size()),
                      std::vector<bool>(scene.elastics.size())};
    each_driven(scene, [&](const Driven& driven) {
        if (const int k = driven_joint(driven); k >= 0)
            parts.joints[static_cast<std::size_t>(k)] = true;
        if (const int k = driven_element(driven); k >= 0)
            parts.elastics[static_cast<std::size_t>(k)] = true;
    });
    return parts;
}

Pose design(const Scene& scene, BodyId body) {
    return body == ground ? Pose{} : scene.bodies[static_cast<std::size_t>(body)].design;
}
Vector3 position(const Scene& scene, const Point& p) {
    const Pose pose = design(scene, p.body);
    return pose.r + pose.p * p.s_local;
}
Vector3 direction(const Scene& scene, const Direction& u) {
    return design(scene, u.body).p * u.u_local;
}

bool is_strained_at_design(const JointKind& joint, const Scene& scene) {
    const std::vector<ConstraintKind> rows = lower(joint, scene.bodies);
    if (rows.size() != 1) return false;  // has no length, offset or angle
    return std::visit(
        overloaded{[](const CoincidentPoints&) { return false; },
                   [&](const PointInPlane& c) {
                       const Vector3 d = position(scene, c.i) - position(scene, c.j);
                       return !are_near(direction(scene, c.normal_j).dot(d), c.offset,
                                        design_tolerance);
                   },
                   [](const PerpendicularDirections&) { return false; },
                   [&](const DistanceBetween& c) {
                       const double drawn = (position(scene, c.j) - position(scene, c.i)).norm();
                       return !are_near(drawn, c.length, design_tolerance * c.length);
                   },
                   [&](const DirectionAtAngle& c) {
                       const Vector3 u = cos(c.angle) * direction(scene, c.y_j) -
                                         sin(c.angle) * direction(scene, c.j);
                       return !are_near(direction(scene, c.i).dot(u), 0, design_tolerance);
                   }},
        rows.front());
}

bool is_loaded_at_design(const ElasticKind& elastic, const Scene& scene) {
    const auto axes = [&](const Marker& m) { return design(scene, m.body).p * m.A_local; };
    bool free = false;  // so for a future kind without two points or two markers
    const std::vector<Point> points = points_of(elastic);
    const double* free_length = driven_number(elastic);
    if (points.size() == 2 && free_length != nullptr) {
        const double length = (position(scene, points[1]) - position(scene, points[0])).norm();
        const ScalarLaw* law = scalar_law(elastic, 0);
        free = law != nullptr && is_free(*law, length - *free_length, design_tolerance * length);
    }
    std::vector<Marker> markers;
    each_member(elastic, [&](const Marker& marker) { markers.push_back(marker); });
    if (markers.size() == 2) {
        const auto origin = [&](const Marker& m) { return position(scene, {m.body, m.s_local}); };
        free = (origin(markers[1]) - origin(markers[0])).norm() <= design_tolerance &&
               axes(markers[0]).angularDistance(axes(markers[1])) <= design_tolerance;
    }
    Vector6 e = Vector6::Zero();
    each_member(elastic,
                overloaded{[&](Deformation<const Vector6> undeformed) { e = -undeformed.value; },
                           [&](ForceAndMoment<const Vector6> w) { free &= w.value.isZero(0); }});
    if (const auto* law = member<SpatialLaw>(elastic)) free &= is_free(*law, e, design_tolerance);
    return !free;
}

bool is_zero(const LoadKind& load) { return load_vector(load).isZero(0); }
bool is_zero(const ElasticKind& elastic) {
    bool zero = true;
    each_member(elastic,
                overloaded{[&](const ScalarLaw& law) { zero &= elastocheck::is_zero(law); },
                           [&](const SpatialLaw& law) { zero &= elastocheck::is_zero(law); },
                           [&](ForceAndMoment<const Vector6> preload) {
                               zero &= preload.value.isZero(0);
                           }});
    return zero;
}

std::string named(const char* kind, const std::string& name) {
    return std::string(kind) + " '" + name + "'";
}
std::string named(const Scene& scene, BodyId body) {
    return body == ground ? "ground"
                          : named("body", scene.bodies[static_cast<std::size_t>(body)].name);
}
void leave_out(Scene& scene, const std::string& what, const std::string& why) {
    scene.omitted.push_back({what, why});
}

void drop_parts(Scene& scene, const std::function<std::string(std::size_t)>& why_joint,
                const std::function<std::string(std::size_t)>& why_elastic) {
    Kept kept(scene);
    const auto drop = [&](const auto& list, std::vector<bool>& stays, const char* kind,
                          const auto& reason) {
        for (std::size_t k = 0; k < list.size(); ++k)
            if (const std::string why = reason(k); !why.empty()) {
                stays[k] = false;
                leave_out(scene, named(kind, list[k].name), why);
            }
    };
    drop(scene.joints, kept.joints, "joint", why_joint);
    drop(scene.elastics, kept.elastics, "element", why_elastic);
    keep_only(scene, kept);
}

void keep_only(Scene& scene, Kept kept) {
    const auto stays = [&](BodyId body) {
        return body == ground || kept.bodies[static_cast<std::size_t>(body)];
    };
    const auto keep_attached = [&](const auto& list, std::vector<bool>& stay, const char* kind) {
        for (std::size_t k = 0; k < list.size(); ++k) {
            const auto [i, j] = ends(list[k].kind);
            if (!stay[k] || (stays(i) && stays(j))) continue;
            stay[k] = false;
            leave_out(scene, named(kind, list[k].name), "a body that it connects is left out");
        }
    };
    keep_attached(scene.joints, kept.joints, "joint");
    keep_attached(scene.elastics, kept.elastics, "element");

    const auto body = renumbered(kept.bodies), joint = renumbered(kept.joints),
               elastic = renumbered(kept.elastics);
    const auto renumber = [&](BodyId& b) {
        if (b != ground) b = body[static_cast<std::size_t>(b)];
    };
    // these two return whether the load or driven input stays
    const auto renumber_load = [&](Load& load, const std::string& where) {
        if (!stays(body_of(load.kind))) {
            leave_out(scene, named("load", load.name), "its body is left out" + where);
            return false;
        }
        each_body(load.kind, renumber);
        return true;
    };
    const auto renumber_driven = [&](Driven& driven, const std::string& where) {
        const auto renumber_part = [](int& id, const std::vector<int>& ids) {
            id = ids[static_cast<std::size_t>(id)];
            return id >= 0;
        };
        bool stay = true;
        each_member(
            driven,
            overloaded{[&](Load& load) { stay = renumber_load(load, where); },
                       [&](JointIndex<int> k) { stay = renumber_part(k.value, joint); },
                       [&](ElasticIndex<int> k) { stay = renumber_part(k.value, elastic); }});
        return stay;
    };
    std::erase_if(scene.static_loads, [&](Load& load) { return !renumber_load(load, ""); });
    for (Branch& branch : scene.branches)
        std::erase_if(branch.drivers, [&](Driver& driver) {
            return !renumber_driven(driver.what, " (branch '" + branch.name + "')");
        });
    if (scene.trim)
        std::erase_if(scene.trim->adjust,
                      [&](Trim::Adjustment& a) { return !renumber_driven(a.what, " (trim)"); });

    compact(scene.bodies, kept.bodies);
    compact(scene.joints, kept.joints);
    compact(scene.elastics, kept.elastics);
    for (Joint& j : scene.joints) each_body(j.kind, renumber);
    for (Elastic& e : scene.elastics) each_body(e.kind, renumber);
    each_output_body(scene, renumber);
}

}  // namespace elastocheck::reduce
