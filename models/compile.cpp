#include "models/compile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "models/lowering.hpp"

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
    if (const auto* force = std::get_if<DeadForce>(&load)) return force->at.body;
    return std::get<DeadMoment>(load).body;
}

bool is_zero(const LoadKind& load) {
    if (const auto* force = std::get_if<DeadForce>(&load)) return force->f.isZero(0);
    return std::get<DeadMoment>(load).m.isZero(0);
}

bool is_zero(const ElasticKind& elastic) {
    if (const auto* spring = std::get_if<AxialSpring>(&elastic)) return spring->k == 0;
    const auto& bushing = std::get<Bushing>(elastic);
    return bushing.K.isZero(0) && bushing.preload.isZero(0);
}

Eigen::Vector3d position(const std::vector<Body>& bodies, const Point& p) {
    if (p.body == ground) return p.s_local;
    const Pose& pose = bodies[static_cast<std::size_t>(p.body)].design;
    return pose.r + pose.p * p.s_local;
}

// Whether the element holds a force at the design pose.
bool is_loaded_at_design(const ElasticKind& elastic, const std::vector<Body>& bodies) {
    if (const auto* spring = std::get_if<AxialSpring>(&elastic)) {
        const double length = (position(bodies, spring->j) - position(bodies, spring->i)).norm();
        return !(std::abs(length - spring->free_length) <= 1e-12 * length);
    }
    const auto& b = std::get<Bushing>(elastic);
    const auto axes = [&](const Marker& m) {
        return m.body == ground ? m.A_local : bodies[static_cast<std::size_t>(m.body)].design.p * m.A_local;
    };
    const double gap =
        (position(bodies, {b.j.body, b.j.s_local}) - position(bodies, {b.i.body, b.i.s_local})).norm();
    return !(b.preload.isZero(0) && gap <= 1e-12 && axes(b.i).angularDistance(axes(b.j)) <= 1e-12);
}

// Which bodies hang together: every joint, and every element that is not zero.
struct Graph {
    struct Edge {
        BodyId other;
        bool loaded;  // holds a force at the design pose
    };
    std::vector<std::vector<Edge>> edges;  // of each body
    std::set<BodyId> outputs, loaded;
};

Graph graph_of(const Scene& scene) {
    Graph graph;
    graph.edges.resize(scene.bodies.size());
    const auto connect = [&](Ends e, bool loaded) {
        if (e.i != ground) graph.edges[static_cast<std::size_t>(e.i)].push_back({e.j, loaded});
        if (e.j != ground) graph.edges[static_cast<std::size_t>(e.j)].push_back({e.i, loaded});
    };
    for (const auto& joint : scene.joints) connect(ends(joint.kind), false);
    for (const auto& elastic : scene.elastics)
        if (!is_zero(elastic.kind))
            connect(ends(elastic.kind), is_loaded_at_design(elastic.kind, scene.bodies));
    if (scene.wheel) graph.outputs.insert(scene.wheel->body);
    for (const auto& probe : scene.probes) graph.outputs.insert(probe.at.body);
    const auto load = [&](const Load& l) {
        if (!is_zero(l.kind)) graph.loaded.insert(body_of(l.kind));
    };
    for (const auto& l : scene.static_loads) load(l);
    for (const auto& branch : scene.branches) std::for_each(branch.loads.begin(), branch.loads.end(), load);
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

ModelJoint summary(const Joint& joint) {
    const auto [i, j] = ends(joint.kind);
    const Point at = std::visit(
        [i = i](const auto& s) {
            if constexpr (requires { s.i.s_local; })
                return s.i;
            else
                return Point{i, Eigen::Vector3d::Zero()};
        },
        joint.kind);
    return {joint.name, i, j, at};
}

}  // namespace

Model compile(const Scene& scene) {
    const Graph graph = graph_of(scene);
    Model model;
    model.name = scene.name;

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

    for (const auto& joint : scene.joints) {
        const auto [i, j] = ends(joint.kind);
        if (!is_kept(i) || !is_kept(j)) {
            leave_out("joint", joint.name, "a body it connects is left out");
            continue;
        }
        const int id = static_cast<int>(model.joints.size());
        model.joints.push_back(summary(joint));
        renumber(model.joints.back().i);
        renumber(model.joints.back().j);
        renumber(model.joints.back().at.body);
        for (auto& kind : lower(joint.kind, scene.bodies)) {
            std::visit(
                [&](auto& c) {
                    renumber(c.i.body);
                    renumber(c.j.body);
                    if constexpr (requires { c.normal_j; }) renumber(c.normal_j.body);
                },
                kind);
            model.constraints.push_back({id, kind});
        }
    }
    for (auto elastic : scene.elastics) {
        const auto [i, j] = ends(elastic.kind);
        if (is_zero(elastic.kind)) {
            leave_out("element", elastic.name, "its rates and preload are zero");
        } else if (!is_kept(i) || !is_kept(j)) {
            leave_out("element", elastic.name, "a body it connects is left out");
        } else {
            std::visit([&](auto& e) { renumber(e.i.body), renumber(e.j.body); }, elastic.kind);
            model.elastics.push_back(elastic);
        }
    }
    const auto keep_loads = [&](const std::vector<Load>& loads, const std::string& where) {
        std::vector<Load> result;
        for (auto load : loads) {
            if (is_zero(load.kind)) {
                leave_out("load", load.name, ("it is zero" + where).c_str());
            } else if (!is_kept(body_of(load.kind))) {
                leave_out("load", load.name, ("its body is left out" + where).c_str());
            } else {
                std::visit(
                    [&](auto& l) {
                        if constexpr (requires { l.at; })
                            renumber(l.at.body);
                        else
                            renumber(l.body);
                    },
                    load.kind);
                result.push_back(load);
            }
        }
        return result;
    };
    model.static_loads = keep_loads(scene.static_loads, "");
    for (const auto& branch : scene.branches)
        model.branches.push_back({branch.name, keep_loads(branch.loads, " (branch '" + branch.name + "')"),
                                  branch.to, branch.steps});

    model.wheel = scene.wheel;
    if (model.wheel) renumber(model.wheel->body);
    model.probes = scene.probes;
    for (auto& probe : model.probes) renumber(probe.at.body);
    return model;
}

}  // namespace elastocheck
