// Replaces massless links with a ball at each end by distance constraints.
//
// Only its two joints act on such a body. Their forces are equal and opposite, along the line
// between the balls, so the link only keeps the distance of the balls.
#include <optional>
#include <set>

#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"

namespace elastocheck::reduce {
namespace {

struct Ball {
    Point on_link, on_other;
};

// The two points of a spherical joint on a body.
std::optional<Ball> ball(const Joint& joint, BodyId body) {
    const auto* s = std::get_if<Spherical>(&joint.kind);
    if (s == nullptr || joint.active_only_where_driven) return std::nullopt;
    return s->i.body == body ? Ball{s->i, s->j} : Ball{s->j, s->i};
}

// The joints on each body, and whether anything else is attached.
struct Attached {
    std::vector<std::vector<std::size_t>> joints;
    std::vector<bool> has_more;  // an element, a load, an output
};

Attached attached(const Scene& scene) {
    Attached result{std::vector<std::vector<std::size_t>>(scene.bodies.size()),
                    std::vector<bool>(scene.bodies.size())};
    const auto mark = [&](BodyId body) {
        if (body != ground) result.has_more[static_cast<std::size_t>(body)] = true;
    };
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        const auto [i, j] = ends(scene.joints[k].kind);
        for (const BodyId body : {i, j})
            if (body != ground) result.joints[static_cast<std::size_t>(body)].push_back(k);
    }
    for (const Elastic& elastic : scene.elastics) {
        const auto [i, j] = ends(elastic.kind);
        mark(i);
        mark(j);
    }
    for (const Load& load : scene.static_loads) mark(body_of(load.kind));
    each_driven(scene, [&](const Driven& driven) {
        if (const Load* load = driven_load(driven)) mark(body_of(load->kind));
    });
    each_output_body(scene, mark);
    return result;
}

}  // namespace

void replace_links(Scene& scene) {
    const Attached attachments = attached(scene);
    Kept kept(scene);
    std::set<std::string> names;
    for (const Joint& joint : scene.joints) names.insert(joint.name);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const std::vector<std::size_t>& joints = attachments.joints[b];
        if (attachments.has_more[b] || joints.size() != 2) continue;
        // Of two links in series one stays: the joint between them no longer exists.
        if (!kept.joints[joints[0]] || !kept.joints[joints[1]]) continue;
        const BodyId body = static_cast<BodyId>(b);
        Joint& joint = scene.joints[joints[0]];
        const std::size_t second = joints[1];
        const auto first_ball = ball(joint, body), second_ball = ball(scene.joints[second], body);
        if (!first_ball || !second_ball || first_ball->on_other.body == second_ball->on_other.body)
            continue;
        const double length = (second_ball->on_link.s_local - first_ball->on_link.s_local).norm();
        if (!(length > 1e-9)) continue;  // coincident balls have no direction

        names.erase(joint.name);
        names.erase(scene.joints[second].name);
        std::string name = scene.bodies[b].name;
        while (!names.insert(name).second) name += ".link";
        for (const std::size_t k : joints)
            if (scene.joints[k].name != name)
                leave_out(scene, named("joint", scene.joints[k].name),
                          "an end of " + named("body", scene.bodies[b].name) +
                              "; its reaction is not an output, that of joint '" + name + "' is");
        leave_out(scene, named("body", scene.bodies[b].name),
                  "a link with a ball at each end and no load: replaced by the distance joint '" +
                      name + "'");
        joint = {name, Distance{first_ball->on_other, second_ball->on_other, length}};
        kept.joints[second] = false;
        kept.bodies[b] = false;
    }
    keep_only(scene, kept);
}

}  // namespace elastocheck::reduce
