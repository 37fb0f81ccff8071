#include "reports/document/drawing.hpp"

#include <cmath>
#include <numbers>

namespace elastocheck::reports {
namespace {

using Eigen::Vector3d;
using json = nlohmann::ordered_json;

constexpr double same = 1e-9;  // [m]

struct Sketch {
    const Scene* scene;
    const Model* model;
    std::vector<Point> points;
    std::vector<std::string> names;
    json links = json::array();

    Vector3d at(const Point& point, const std::vector<Pose>& poses) const {
        if (point.body == ground) return point.s_local;
        const Pose& pose = poses[static_cast<std::size_t>(point.body)];
        return pose.r + pose.p * point.s_local;
    }
    std::vector<Pose> design() const {
        std::vector<Pose> poses;
        for (const auto& body : model->bodies) poses.push_back(body.design);
        return poses;
    }

    // The point's position in the list, new or known; the name is the hardpoint's, else that of what is
    // attached there.
    std::size_t add(const Point& point, const std::string& otherwise) {
        for (std::size_t k = 0; k < points.size(); ++k)
            if (points[k].body == point.body && (points[k].s_local - point.s_local).norm() < same) return k;
        std::string name = otherwise;
        const Vector3d position = at(point, design());
        for (const auto& hardpoint : scene->hardpoints)
            if ((hardpoint.position - position).norm() < same) name = hardpoint.name;
        points.push_back(point);
        names.push_back(name);
        return points.size() - 1;
    }
    void link(const char* kind, const std::string& name, std::size_t i, std::size_t j) {
        links.push_back({{"kind", kind}, {"name", name}, {"points", {i, j}}});
    }
};

// A body of up to three points is the polygon through them; one of more is a star about the wheel's centre,
// or about the point nearest to all others.
void outline(Sketch& sketch, BodyId body, std::optional<std::size_t> hub) {
    std::vector<std::size_t> mine;
    for (std::size_t k = 0; k < sketch.points.size(); ++k)
        if (sketch.points[k].body == body) mine.push_back(k);
    const std::string& name = sketch.model->bodies[static_cast<std::size_t>(body)].name;
    if (!hub && mine.size() <= 3) {
        for (std::size_t k = 0; k < mine.size(); ++k)
            for (std::size_t l = k + 1; l < mine.size(); ++l) sketch.link("body", name, mine[k], mine[l]);
        return;
    }
    if (!hub) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto k : mine) {
            double sum = 0;
            for (const auto l : mine) sum += (sketch.points[k].s_local - sketch.points[l].s_local).norm();
            if (sum < least) least = sum, hub = k;
        }
    }
    for (const auto k : mine)
        if (k != *hub) sketch.link("body", name, *hub, k);
}

json millimetres(const Vector3d& v) { return {1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z()}; }

// A circle through the contact patch about the spin axis; nothing where the patch is the centre.
json circle(const Wheel& wheel, const Pose& pose) {
    json list = json::array();
    const Vector3d arm = wheel.contact_local - wheel.centre_local;
    const Vector3d radius = arm - wheel.spin_axis_local * wheel.spin_axis_local.dot(arm);
    if (radius.norm() < same) return list;
    constexpr int corners = 48;
    for (int k = 0; k <= corners; ++k) {
        const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / corners, wheel.spin_axis_local);
        list.push_back(millimetres(pose.r + pose.p * (wheel.centre_local + turn * radius)));
    }
    return list;
}

json positions(const Sketch& sketch, const std::vector<Pose>& poses) {
    json points = json::array();
    for (const auto& point : sketch.points) points.push_back(millimetres(sketch.at(point, poses)));
    json result = {{"points_mm", points}};
    if (const auto& wheel = sketch.model->wheel)
        result["wheel_mm"] = circle(*wheel, poses[static_cast<std::size_t>(wheel->body)]);
    return result;
}

}  // namespace

json drawing_json(const Scene& scene, const Model& model, const compare::Comparison& comparison) {
    Sketch sketch{&scene, &model, {}, {}};
    json bushings = json::array();
    for (const auto& constraint : model.constraints) {
        const std::string& name = model.joints[static_cast<std::size_t>(constraint.joint)].name;
        std::visit(
            [&](const auto& kind) {
                using Kind = std::decay_t<decltype(kind)>;
                if constexpr (std::is_same_v<Kind, PerpendicularDirections>) {
                    return;
                } else {
                    const auto i = sketch.add(kind.i, name);
                    if constexpr (std::is_same_v<Kind, DistanceBetween>)
                        sketch.link("rod", name, i, sketch.add(kind.j, name));
                    if constexpr (std::is_same_v<Kind, CoincidentPoints>) sketch.add(kind.j, name);
                }
            },
            constraint.kind);
    }
    for (const auto& elastic : model.elastics) {
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            const auto i = sketch.add(spring->i, elastic.name), j = sketch.add(spring->j, elastic.name);
            sketch.link("spring", elastic.name, i, j);
        } else {
            const auto& bushing = std::get<Bushing>(elastic.kind);
            const auto i = sketch.add({bushing.i.body, bushing.i.s_local}, elastic.name);
            const auto j = sketch.add({bushing.j.body, bushing.j.s_local}, elastic.name);
            bushings.push_back(bushing.i.body == ground ? j : i);
        }
    }
    for (const auto& probe : model.probes) sketch.add(probe.at, probe.name);
    std::optional<std::size_t> hub;
    if (model.wheel) {
        hub = sketch.add({model.wheel->body, model.wheel->centre_local}, "wheel centre");
        sketch.add({model.wheel->body, model.wheel->contact_local}, "contact patch");
    }
    for (BodyId body = 0; body < static_cast<BodyId>(model.bodies.size()); ++body)
        outline(sketch, body, model.wheel && model.wheel->body == body ? hub : std::nullopt);

    json points = json::array(), along = json::array();
    const auto design = sketch.design();
    for (std::size_t k = 0; k < sketch.points.size(); ++k) {
        const BodyId body = sketch.points[k].body;
        points.push_back(
            {{"name", sketch.names[k]},
             {"body", body == ground ? "ground" : model.bodies[static_cast<std::size_t>(body)].name},
             {"design_mm", millimetres(sketch.at(sketch.points[k], design))}});
    }
    for (const auto& branch : comparison.branches) {
        const auto& path = branch.runs[static_cast<std::size_t>(compare::Leg::equilibrium)].path.points;
        if (path.empty()) continue;
        for (const auto& [where, k] :
             {std::pair{"middle", path.size() / 2}, std::pair{"end", path.size() - 1}}) {
            json entry = positions(sketch, path[k].poses);
            entry["branch"] = branch.branch;
            entry["where"] = where;
            entry["load"] = path[k].load;
            along.push_back(entry);
        }
    }
    json result = {{"points", points}, {"links", sketch.links}, {"bushings", bushings}};
    result["design"] = positions(sketch, design);
    result["positions"] = along;
    return result;
}

}  // namespace elastocheck::reports
