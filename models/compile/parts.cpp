#include "models/compile/parts.hpp"

#include <algorithm>
#include <cmath>

#include "models/curve.hpp"

namespace elastocheck::reduce {
namespace {

using Eigen::Vector3d;

bool is_zero(const ScalarLaw& law) {
    const auto nothing = [](const std::array<double, 4>& c) {
        return std::ranges::all_of(c, [](double c_n) { return c_n == 0; });
    };
    return std::visit(
        overloaded{[](const LinearRate& u) { return u.k == 0; },
                   [&](const Curve& u) { return std::ranges::all_of(u.pieces, nothing); }},
        law);
}
bool is_zero(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) { return u.K.isZero(0); },
                                 [](const PerAxis& u) {
                                     return std::ranges::all_of(
                                         u.axis, [](const ScalarLaw& l) { return is_zero(l); });
                                 }},
                      law);
}

// Whether the law has zero force at x within the rounding of a position [m] or [rad].
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

BodyId& body_of(LoadKind& load) {
    return std::visit(overloaded{[](DeadForce& l) -> BodyId& { return l.at.body; },
                                 [](DeadMoment& l) -> BodyId& { return l.body; },
                                 [](FollowerForce& l) -> BodyId& { return l.at.body; },
                                 [](FollowerMoment& l) -> BodyId& { return l.body; }},
                      load);
}

}  // namespace

Ends ends(const JointKind& joint) {
    return std::visit([](const auto& s) { return Ends{s.i.body, s.j.body}; }, joint);
}
Ends ends(const ElasticKind& elastic) {
    return std::visit([](const auto& s) { return Ends{s.i.body, s.j.body}; }, elastic);
}
BodyId body_of(const LoadKind& load) {
    LoadKind copy = load;
    return body_of(copy);
}

DrivenParts driven_parts(const Scene& scene) {
    DrivenParts parts{std::vector<bool>(scene.joints.size()),
                      std::vector<bool>(scene.elastics.size())};
    const auto element = [&](int k) { parts.elastics[static_cast<std::size_t>(k)] = true; };
    each_driven(scene, [&](const Driven& driven) {
        std::visit(overloaded{[](const Load&) {},
                              [&](const Motion& m) {
                                  parts.joints[static_cast<std::size_t>(m.joint)] = true;
                              },
                              [&](const FreeLength& f) { element(f.elastic); },
                              [&](const Preload& p) { element(p.elastic); }},
                   driven);
    });
    return parts;
}

Pose design(const Scene& scene, BodyId body) {
    return body == ground ? Pose{} : scene.bodies[static_cast<std::size_t>(body)].design;
}
Vector3d position(const Scene& scene, const Point& p) {
    const Pose pose = design(scene, p.body);
    return pose.r + pose.p * p.s_local;
}
Vector3d direction(const Scene& scene, const Direction& u) {
    return design(scene, u.body).p * u.u_local;
}

bool is_strained_at_design(const JointKind& joint, const Scene& scene) {
    const auto never = [](const auto&) { return false; };
    return std::visit(
        overloaded{
            [&](const Distance& s) {
                const double drawn = (position(scene, s.j) - position(scene, s.i)).norm();
                return !(std::abs(drawn - s.length) <= as_drawn * s.length);
            },
            [&](const InPlane& s) {
                const Vector3d d = position(scene, s.i) - position(scene, s.j);
                return !(std::abs(direction(scene, s.normal_j).dot(d) - s.offset) <= as_drawn);
            },
            [&](const Angle& s) {
                const Vector3d u = std::cos(s.angle) * direction(scene, s.y_j) -
                                   std::sin(s.angle) * direction(scene, s.j);
                return !(std::abs(direction(scene, s.i).dot(u)) <= as_drawn);
            },
            [&](const Spherical& s) { return never(s); },
            [&](const Revolute& s) { return never(s); },
            [&](const Universal& s) { return never(s); },
            [&](const Cylindrical& s) { return never(s); },
            [&](const Translational& s) { return never(s); },
            [&](const Planar& s) { return never(s); }, [&](const Fixed& s) { return never(s); },
            [&](const InLine& s) { return never(s); },
            [&](const Perpendicular& s) { return never(s); },
            [&](const Parallel& s) { return never(s); }},
        joint);
}

bool is_loaded_at_design(const ElasticKind& elastic, const Scene& scene) {
    const auto axes = [&](const Marker& m) { return design(scene, m.body).p * m.A_local; };
    return std::visit(
        overloaded{[&](const AxialSpring& e) {
                       const double length = (position(scene, e.j) - position(scene, e.i)).norm();
                       return !is_free(e.law, length - e.free_length, as_drawn * length);
                   },
                   [&](const Bushing& e) {
                       const double gap = (position(scene, {e.j.body, e.j.s_local}) -
                                           position(scene, {e.i.body, e.i.s_local}))
                                              .norm();
                       return !(e.preload.isZero(0) && gap <= as_drawn &&
                                axes(e.i).angularDistance(axes(e.j)) <= as_drawn &&
                                is_free(e.law, Vector6(-e.undeformed), as_drawn));
                   }},
        elastic);
}

bool is_zero(const LoadKind& load) {
    return std::visit(overloaded{[](const DeadForce& l) { return l.f.isZero(0); },
                                 [](const DeadMoment& l) { return l.m.isZero(0); },
                                 [](const FollowerForce& l) { return l.f_local.isZero(0); },
                                 [](const FollowerMoment& l) { return l.m_local.isZero(0); }},
                      load);
}
bool is_zero(const ElasticKind& elastic) {
    return std::visit(
        overloaded{[](const AxialSpring& e) { return is_zero(e.law); },
                   [](const Bushing& e) { return is_zero(e.law) && e.preload.isZero(0); }},
        elastic);
}

std::string named(const char* kind, const std::string& name) {
    return std::string(kind) + " '" + name + "'";
}
void leave_out(Scene& scene, const std::string& what, const std::string& why) {
    scene.omitted.push_back({what, why});
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
            leave_out(scene, named(kind, list[k].name), "a body it connects is left out");
        }
    };
    keep_attached(scene.joints, kept.joints, "joint");
    keep_attached(scene.elastics, kept.elastics, "element");

    const auto body = renumbered(kept.bodies), joint = renumbered(kept.joints),
               elastic = renumbered(kept.elastics);
    const auto renumber = [&](BodyId& b) {
        if (b != ground) b = body[static_cast<std::size_t>(b)];
    };
    // returns whether it stays
    const auto renumber_load = [&](Load& load, const std::string& where) {
        if (!stays(body_of(load.kind))) {
            leave_out(scene, named("load", load.name), "its body is left out" + where);
            return false;
        }
        renumber(body_of(load.kind));
        return true;
    };
    const auto renumber_driven = [&](Driven& driven, const std::string& where) {
        const auto part = [](int& id, const std::vector<int>& ids) {
            return (id = ids[static_cast<std::size_t>(id)]) >= 0;
        };
        return std::visit(overloaded{[&](Load& load) { return renumber_load(load, where); },
                                     [&](Motion& m) { return part(m.joint, joint); },
                                     [&](FreeLength& f) { return part(f.elastic, elastic); },
                                     [&](Preload& p) { return part(p.elastic, elastic); }},
                          driven);
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
    const auto renumber_place = [&](auto& place) { renumber(place.body); };
    for (Joint& j : scene.joints) each_place(j.kind, renumber_place);
    for (Elastic& e : scene.elastics) each_place(e.kind, renumber_place);
    each_output_body(scene, renumber);
}

}  // namespace elastocheck::reduce
