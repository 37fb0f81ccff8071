// Removes bodies that no output depends on, and free followers: bodies attached to one other body only.
#include <numeric>
#include <optional>
#include <set>

#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"

namespace elastocheck::reduce {
namespace {

// Graph of bodies connected by joints and elements.
struct Graph {
    struct Edge {
        BodyId other;
        bool loaded;  // has a force at the design pose
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
    for (const Joint& joint : scene.joints)
        connect(ends(joint.kind), is_strained_at_design(joint.kind, scene));
    for (const Elastic& elastic : scene.elastics)
        connect(ends(elastic.kind), is_loaded_at_design(elastic.kind, scene));
    each_output_body(scene, [&](BodyId body) { graph.outputs.insert(body); });
    for (const auto& load : scene.static_loads) graph.loaded.insert(body_of(load.kind));
    const auto load_both = [&](Ends e) { graph.loaded.insert({e.i, e.j}); };
    each_driven(scene, [&](const Driven& driven) {
        if (const Load* load = driven_load(driven)) graph.loaded.insert(body_of(load->kind));
        if (const int k = driven_joint(driven); k >= 0)
            load_both(ends(scene.joints[static_cast<std::size_t>(k)].kind));
        if (const int k = driven_element(driven); k >= 0)
            load_both(ends(scene.elastics[static_cast<std::size_t>(k)].kind));
    });
    return graph;
}

// Bodies connected to an output by joints and elements, not through ground.
std::vector<bool> connected_to_output(const Graph& graph) {
    std::vector<bool> reached(graph.edges.size(), false);
    std::vector<BodyId> to_visit(graph.outputs.begin(), graph.outputs.end());
    while (!to_visit.empty()) {
        const BodyId body = to_visit.back();
        to_visit.pop_back();
        if (body == ground || reached[static_cast<std::size_t>(body)]) continue;
        reached[static_cast<std::size_t>(body)] = true;
        for (const auto& edge : graph.edges[static_cast<std::size_t>(body)])
            to_visit.push_back(edge.other);
    }
    return reached;
}

// Whether the body has no output and no load and is connected to at most one of the kept bodies. It
// then moves with that body as if welded to it: no joint is strained and no energy stored.
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

}  // namespace

void drop_unconnected_to_outputs(Scene& scene) {
    Kept kept(scene);
    kept.bodies = connected_to_output(graph_of(scene));
    for (std::size_t b = 0; b < kept.bodies.size(); ++b)
        if (!kept.bodies[b])
            leave_out(scene, named("body", scene.bodies[b].name), "no output is connected to it");
    keep_only(scene, kept);
}

// From the ends of chains inwards: a removed follower may make its neighbour one.
void drop_free_followers(Scene& scene) {
    const Graph graph = graph_of(scene);
    Kept kept(scene);
    std::vector<BodyId> candidates(kept.bodies.size());
    std::iota(candidates.begin(), candidates.end(), 0);
    for (std::size_t next = 0; next < candidates.size(); ++next) {
        const BodyId body = candidates[next];
        if (body == ground || !kept.bodies[static_cast<std::size_t>(body)]) continue;
        if (!is_free_follower(graph, kept.bodies, body)) continue;
        kept.bodies[static_cast<std::size_t>(body)] = false;
        leave_out(
            scene, named(scene, body),
            "it is attached to one other body only and has no load, no preload and no output");
        for (const auto& edge : graph.edges[static_cast<std::size_t>(body)])
            candidates.push_back(edge.other);
    }
    keep_only(scene, kept);
}

}  // namespace elastocheck::reduce
