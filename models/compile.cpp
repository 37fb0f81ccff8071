#include "models/compile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "models/lowering.hpp"
#include "models/overloaded.hpp"

namespace elastocheck {
namespace {

struct Ends {
    BodyId i, j;
};

Ends ends(const JointKind& joint) {
    return std::visit([](const auto& s) { return Ends{s.i.body, s.j.body}; }, joint);
}

Ends ends(const ElasticKind& elastic) {
    return std::visit([](const auto& s) { return Ends{s.i.body, s.j.body}; }, elastic);
}

BodyId body_of(const LoadKind& load) {
    return std::visit(
        overloaded{[](const DeadForce& l) { return l.at.body; }, [](const DeadMoment& l) { return l.body; }},
        load);
}

bool is_zero(const LoadKind& load) {
    return std::visit(overloaded{[](const DeadForce& l) { return l.f.isZero(0); },
                                 [](const DeadMoment& l) { return l.m.isZero(0); }},
                      load);
}

bool is_zero(const ScalarLaw& law) {
    return std::visit(overloaded{[](const LinearRate& u) { return u.k == 0; }}, law);
}
bool is_zero(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) { return u.K.isZero(0); }}, law);
}
bool is_zero(const ElasticKind& elastic) {
    return std::visit(overloaded{[](const AxialSpring& e) { return is_zero(e.law); },
                                 [](const Bushing& e) { return is_zero(e.law) && e.preload.isZero(0); }},
                      elastic);
}

Eigen::Vector3d position(const std::vector<Body>& bodies, const Point& p) {
    if (p.body == ground) return p.s_local;
    const Pose& pose = bodies[static_cast<std::size_t>(p.body)].design;
    return pose.r + pose.p * p.s_local;
}

// Whether the element is deformed, or preloaded, at the design pose.
bool is_loaded_at_design(const ElasticKind& elastic, const std::vector<Body>& bodies) {
    const auto axes = [&](const Marker& m) {
        return m.body == ground ? m.A_local : bodies[static_cast<std::size_t>(m.body)].design.p * m.A_local;
    };
    return std::visit(overloaded{[&](const AxialSpring& e) {
                                     const double length =
                                         (position(bodies, e.j) - position(bodies, e.i)).norm();
                                     return !(std::abs(length - e.free_length) <= 1e-12 * length);
                                 },
                                 [&](const Bushing& e) {
                                     const double gap = (position(bodies, {e.j.body, e.j.s_local}) -
                                                         position(bodies, {e.i.body, e.i.s_local}))
                                                            .norm();
                                     return !(e.preload.isZero(0) && gap <= 1e-12 &&
                                              axes(e.i).angularDistance(axes(e.j)) <= 1e-12);
                                 }},
                      elastic);
}

// Whether a driver does anything: it has a value somewhere on the branch, of something that has a size.
bool is_zero(const Driver& driver, const Scene& scene) {
    if (std::holds_alternative<Motion>(driver.what)) return false;  // held at 0 is held
    if (driver.start == 0 && driver.rate == 0) return true;
    return std::visit(
        overloaded{[](const Load& l) { return is_zero(l.kind); }, [](const Motion&) { return false; },
                   [&](const FreeLength& l) {
                       const auto& kind = scene.elastics[static_cast<std::size_t>(l.elastic)].kind;
                       return std::visit(overloaded{[](const AxialSpring& e) { return is_zero(e.law); },
                                                    [](const Bushing&) { return true; }},
                                         kind);
                   },
                   [](const Preload& p) { return p.direction.isZero(0); }},
        driver.what);
}

// What the branches need, by position in the scene: joints that a driver moves or holds, elements whose preload
// it moves.
struct DrivenParts {
    std::vector<bool> joints, preloads;
};

DrivenParts driven_parts(const Scene& scene) {
    DrivenParts parts{std::vector<bool>(scene.joints.size()), std::vector<bool>(scene.elastics.size())};
    for (const auto& branch : scene.branches)
        for (const auto& driver : branch.drivers) {
            if (is_zero(driver, scene)) continue;
            std::visit(
                overloaded{
                    [](const Load&) {},
                    [&](const Motion& m) { parts.joints[static_cast<std::size_t>(m.joint)] = true; },
                    [](const FreeLength&) {},
                    [&](const Preload& p) { parts.preloads[static_cast<std::size_t>(p.elastic)] = true; }},
                driver.what);
        }
    return parts;
}

// Whether the joint stands on some branch.
bool ever_stands(const Joint& joint, bool driven) { return !joint.only_where_driven || driven; }

// Whether a length, offset or angle of the joint is other than drawn, so that something moves before any load
// does.
bool is_strained_at_design(const JointKind& joint, const std::vector<Body>& bodies) {
    const auto turned = [&](const Direction& u) -> Eigen::Vector3d {
        return u.body == ground ? u.u_local : bodies[static_cast<std::size_t>(u.body)].design.p * u.u_local;
    };
    const auto as_drawn = [](const auto&) { return false; };
    return std::visit(
        overloaded{
            [&](const Distance& s) {
                const double drawn = (position(bodies, s.j) - position(bodies, s.i)).norm();
                return !(std::abs(drawn - s.length) <= 1e-12 * s.length);
            },
            [&](const InPlane& s) {
                const Eigen::Vector3d d = position(bodies, s.i) - position(bodies, s.j);
                return !(std::abs(turned(s.normal_j).dot(d) - s.offset) <= 1e-12);
            },
            [&](const Angle& s) {
                const Eigen::Vector3d u = std::cos(s.angle) * turned(s.y_j) - std::sin(s.angle) * turned(s.j);
                return !(std::abs(turned(s.i).dot(u)) <= 1e-12);
            },
            [&](const Spherical& s) { return as_drawn(s); }, [&](const Revolute& s) { return as_drawn(s); },
            [&](const Universal& s) { return as_drawn(s); },
            [&](const Cylindrical& s) { return as_drawn(s); },
            [&](const Translational& s) { return as_drawn(s); }, [&](const Planar& s) { return as_drawn(s); },
            [&](const Fixed& s) { return as_drawn(s); }, [&](const InLine& s) { return as_drawn(s); },
            [&](const Perpendicular& s) { return as_drawn(s); },
            [&](const Parallel& s) { return as_drawn(s); }},
        joint);
}

// Which bodies hang together: every joint that stands on some branch, and every element that is not zero.
struct Graph {
    struct Edge {
        BodyId other;
        bool loaded;  // holds a force at the design pose
    };
    std::vector<std::vector<Edge>> edges;  // of each body
    std::set<BodyId> outputs, loaded;
};

Graph graph_of(const Scene& scene, const DrivenParts& driven) {
    Graph graph;
    graph.edges.resize(scene.bodies.size());
    const auto connect = [&](Ends e, bool loaded) {
        if (e.i != ground) graph.edges[static_cast<std::size_t>(e.i)].push_back({e.j, loaded});
        if (e.j != ground) graph.edges[static_cast<std::size_t>(e.j)].push_back({e.i, loaded});
    };
    for (std::size_t k = 0; k < scene.joints.size(); ++k)
        if (const JointKind& kind = scene.joints[k].kind; ever_stands(scene.joints[k], driven.joints[k]))
            connect(ends(kind), is_strained_at_design(kind, scene.bodies));
    for (std::size_t k = 0; k < scene.elastics.size(); ++k)
        if (const ElasticKind& kind = scene.elastics[k].kind; !is_zero(kind) || driven.preloads[k])
            connect(ends(kind), is_loaded_at_design(kind, scene.bodies));
    for (const auto& wheel : scene.wheels) graph.outputs.insert(wheel.body);
    for (const auto& probe : scene.probes) graph.outputs.insert(probe.at.body);
    const auto load = [&](const Load& l) {
        if (!is_zero(l.kind)) graph.loaded.insert(body_of(l.kind));
    };
    for (const auto& l : scene.static_loads) load(l);
    const auto both = [&](Ends e) { graph.loaded.insert({e.i, e.j}); };
    const auto element = [&](int k) { both(ends(scene.elastics[static_cast<std::size_t>(k)].kind)); };
    for (const auto& branch : scene.branches)
        for (const auto& driver : branch.drivers) {
            if (is_zero(driver, scene)) continue;
            std::visit(overloaded{[&](const Load& l) { load(l); },
                                  [&](const Motion& m) {
                                      both(ends(scene.joints[static_cast<std::size_t>(m.joint)].kind));
                                  },
                                  [&](const FreeLength& f) { element(f.elastic); },
                                  [&](const Preload& p) { element(p.elastic); }},
                       driver.what);
        }
    return graph;
}

// Bodies that some chain of joints and elements, not through ground, connects to an output.
std::vector<bool> connected_to_output(const Graph& graph) {
    std::vector<bool> reached(graph.edges.size(), false);
    std::vector<BodyId> to_visit(graph.outputs.begin(), graph.outputs.end());
    while (!to_visit.empty()) {
        const BodyId body = to_visit.back();
        to_visit.pop_back();
        if (body == ground || reached[static_cast<std::size_t>(body)]) continue;
        reached[static_cast<std::size_t>(body)] = true;
        for (const auto& edge : graph.edges[static_cast<std::size_t>(body)]) to_visit.push_back(edge.other);
    }
    return reached;
}

// Whether the body has nothing of its own to say and hangs on at most one of those that are kept. It then
// moves with that one as if welded to it: no joint is strained and no energy stored.
bool is_free_follower(const Graph& graph, const std::vector<bool>& kept, BodyId body) {
    if (graph.outputs.contains(body) || graph.loaded.contains(body)) return false;
    std::optional<BodyId> neighbour;
    for (const auto& [other, loaded] : graph.edges[static_cast<std::size_t>(body)]) {
        if (other != ground && !kept[static_cast<std::size_t>(other)]) continue;
        if (loaded || other != neighbour.value_or(other)) return false;
        neighbour = other;
    }
    return true;
}

// Takes free followers away, one after the other,
// from the loose ends inwards. Returns them; `kept` is updated.
std::vector<BodyId> drop_free_followers(const Graph& graph, std::vector<bool>& kept) {
    std::vector<BodyId> dropped;
    std::vector<BodyId> candidates(kept.size());
    std::iota(candidates.begin(), candidates.end(), 0);
    for (std::size_t next = 0; next < candidates.size(); ++next) {
        const BodyId body = candidates[next];
        if (body == ground || !kept[static_cast<std::size_t>(body)]) continue;
        if (!is_free_follower(graph, kept, body)) continue;
        kept[static_cast<std::size_t>(body)] = false;
        dropped.push_back(body);
        for (const auto& edge : graph.edges[static_cast<std::size_t>(body)]) candidates.push_back(edge.other);
    }
    return dropped;
}

// Where on its body an end of a joint is.
Point place(const Point& end) { return end; }
Point place(const Direction& end) { return {end.body, Eigen::Vector3d::Zero()}; }

ModelJoint summary(const Joint& joint) {
    const auto [i, j] = ends(joint.kind);
    const Point at = std::visit([](const auto& s) { return place(s.i); }, joint.kind);
    return {joint.name, i, j, at, -1, joint.only_where_driven};
}

// Whether a driver can move the constraint's offset, length or angle.
bool can_be_driven(const ConstraintKind& kind) {
    return std::visit(
        overloaded{[](const CoincidentPoints&) { return false; }, [](const PointInPlane&) { return true; },
                   [](const PerpendicularDirections&) { return false; },
                   [](const DistanceBetween&) { return true; }, [](const DirectionAtAngle&) { return true; }},
        kind);
}

}  // namespace

Model compile(const Scene& scene) {
    const DrivenParts driven = driven_parts(scene);
    const Graph graph = graph_of(scene, driven);
    Model model;
    model.name = scene.name;
    model.left_out = scene.left_out;

    auto kept = connected_to_output(graph);
    for (std::size_t b = 0; b < kept.size(); ++b)
        if (!kept[b])
            model.left_out.push_back({"body '" + scene.bodies[b].name + "'", "no output is connected to it"});
    for (const BodyId body : drop_free_followers(graph, kept))
        model.left_out.push_back(
            {"body '" + scene.bodies[static_cast<std::size_t>(body)].name + "'",
             "it hangs on one other body and carries no load, no preload and no output"});

    std::vector<BodyId> renumbered(kept.size(), ground);
    for (std::size_t b = 0; b < kept.size(); ++b) {
        if (!kept[b]) continue;
        renumbered[b] = static_cast<BodyId>(model.bodies.size());
        model.bodies.push_back(scene.bodies[b]);
    }
    const auto is_kept = [&](BodyId body) { return body == ground || kept[static_cast<std::size_t>(body)]; };
    const auto renumber = [&](BodyId& body) {
        if (body != ground) body = renumbered[static_cast<std::size_t>(body)];
    };
    const auto leave_out = [&](const char* kind, const std::string& name, const char* why) {
        model.left_out.push_back({std::string(kind) + " '" + name + "'", why});
    };

    std::vector<int> joint_ids(scene.joints.size(), -1), elastic_ids(scene.elastics.size(), -1);
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        const Joint& joint = scene.joints[k];
        const auto [i, j] = ends(joint.kind);
        if (!ever_stands(joint, driven.joints[k])) {
            leave_out("joint", joint.name, "no branch drives it");
            continue;
        }
        if (!is_kept(i) || !is_kept(j)) {
            leave_out("joint", joint.name, "a body it connects is left out");
            continue;
        }
        const int id = joint_ids[k] = static_cast<int>(model.joints.size());
        ModelJoint& kept_joint = model.joints.emplace_back(summary(joint));
        for (BodyId* body : {&kept_joint.i, &kept_joint.j, &kept_joint.at.body}) renumber(*body);
        const auto kinds = lower(joint.kind, scene.bodies);
        for (auto kind : kinds) {
            if (kinds.size() == 1 && can_be_driven(kind))
                kept_joint.driven = static_cast<int>(model.constraints.size());
            std::visit(overloaded{[&](CoincidentPoints& c) { renumber(c.i.body), renumber(c.j.body); },
                                  [&](PointInPlane& c) {
                                      renumber(c.i.body), renumber(c.j.body), renumber(c.normal_j.body);
                                  },
                                  [&](PerpendicularDirections& c) { renumber(c.i.body), renumber(c.j.body); },
                                  [&](DistanceBetween& c) { renumber(c.i.body), renumber(c.j.body); },
                                  [&](DirectionAtAngle& c) {
                                      renumber(c.i.body), renumber(c.j.body), renumber(c.y_j.body);
                                  }},
                       kind);
            model.constraints.push_back({id, kind});
        }
    }
    for (std::size_t k = 0; k < scene.elastics.size(); ++k) {
        Elastic elastic = scene.elastics[k];
        const auto [i, j] = ends(elastic.kind);
        if (is_zero(elastic.kind) && !driven.preloads[k]) {
            leave_out("element", elastic.name, "its rates and preload are zero");
        } else if (!is_kept(i) || !is_kept(j)) {
            leave_out("element", elastic.name, "a body it connects is left out");
        } else {
            std::visit([&](auto& e) { renumber(e.i.body), renumber(e.j.body); }, elastic.kind);
            elastic_ids[k] = static_cast<int>(model.elastics.size());
            model.elastics.push_back(elastic);
        }
    }
    // The load as the model has it, or none.
    const auto kept_load = [&](Load load, const std::string& where) -> std::optional<Load> {
        if (is_zero(load.kind)) {
            leave_out("load", load.name, ("it is zero" + where).c_str());
            return std::nullopt;
        }
        if (!is_kept(body_of(load.kind))) {
            leave_out("load", load.name, ("its body is left out" + where).c_str());
            return std::nullopt;
        }
        std::visit(
            overloaded{[&](DeadForce& l) { renumber(l.at.body); }, [&](DeadMoment& l) { renumber(l.body); }},
            load.kind);
        return load;
    };
    for (const auto& load : scene.static_loads)
        if (const auto kept_one = kept_load(load, "")) model.static_loads.push_back(*kept_one);
    for (const auto& branch : scene.branches) {
        Branch& result = model.branches.emplace_back(branch);
        result.drivers.clear();
        const std::string where = " (branch '" + branch.name + "')";
        // The driver as the model has it, or none: its part is left out above with its reason, or it is here.
        const auto kept_part = [&](int id, auto what) -> std::optional<Driven> {
            return id < 0 ? std::nullopt : std::optional<Driven>(what);
        };
        const auto drop = [&](const std::string& kind, const std::string& name, const char* why) {
            leave_out(kind.c_str(), name, (why + where).c_str());
            return std::optional<Driven>();
        };
        const auto name_of = [&](int k) { return scene.elastics[static_cast<std::size_t>(k)].name; };
        for (const auto& driver : branch.drivers) {
            const bool zero = is_zero(driver, scene);
            const auto what = std::visit(
                overloaded{[&](const Load& load) -> std::optional<Driven> {
                               if (zero) return drop("load", load.name, "it is zero");
                               if (auto kept_one = kept_load(load, where)) return *kept_one;
                               return std::nullopt;
                           },
                           [&](const Motion& motion) {
                               const int id = joint_ids[static_cast<std::size_t>(motion.joint)];
                               if (id >= 0 && model.joints[static_cast<std::size_t>(id)].driven < 0)
                                   return drop("motion of joint",
                                               model.joints[static_cast<std::size_t>(id)].name,
                                               "it has no length, offset or angle");
                               return kept_part(id, Motion{id});
                           },
                           [&](const FreeLength& length) {
                               const int id = elastic_ids[static_cast<std::size_t>(length.elastic)];
                               if (zero)
                                   return drop("free length of", name_of(length.elastic), "it moves nothing");
                               return kept_part(id, FreeLength{id});
                           },
                           [&](const Preload& preload) {
                               const int id = elastic_ids[static_cast<std::size_t>(preload.elastic)];
                               if (zero) return drop("preload of", name_of(preload.elastic), "it is zero");
                               return kept_part(id, Preload{id, preload.direction});
                           }},
                driver.what);
            if (what) result.drivers.push_back({*what, driver.start, driver.rate});
        }
        if (std::ranges::none_of(result.drivers, [](const Driver& driver) { return driver.rate != 0; }))
            leave_out("branch", branch.name, "nothing that it moves is left");
    }

    model.wheels = scene.wheels;
    for (auto& wheel : model.wheels) renumber(wheel.body);
    model.probes = scene.probes;
    for (auto& probe : model.probes) renumber(probe.at.body);
    return model;
}

}  // namespace elastocheck
