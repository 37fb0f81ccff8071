#include "reports/document/drawing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "models/overloaded.hpp"

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
    for (const auto& wheel : sketch.model->wheels)
        result["wheels_mm"].push_back(circle(wheel, poses[static_cast<std::size_t>(wheel.body)]));
    return result;
}

}  // namespace

json drawing_json(const Scene& scene, const Model& model, const compare::Comparison& comparison) {
    Sketch sketch{&scene, &model, {}, {}};
    json bushings = json::array();
    for (const auto& constraint : model.constraints) {
        const std::string& name = model.joints[static_cast<std::size_t>(constraint.joint)].name;
        std::visit(
            overloaded{[&](const CoincidentPoints& c) { sketch.add(c.i, name), sketch.add(c.j, name); },
                       [&](const PointInPlane& c) { sketch.add(c.i, name); },
                       [](const PerpendicularDirections&) {},
                       [&](const DistanceBetween& c) {
                           const auto i = sketch.add(c.i, name);
                           sketch.link("rod", name, i, sketch.add(c.j, name));
                       },
                       [](const DirectionAtAngle&) {}},
            constraint.kind);
    }
    for (const auto& elastic : model.elastics)
        std::visit(overloaded{[&](const AxialSpring& e) {
                                  const auto i = sketch.add(e.i, elastic.name);
                                  sketch.link("spring", elastic.name, i, sketch.add(e.j, elastic.name));
                              },
                              [&](const Bushing& e) {
                                  const auto i = sketch.add({e.i.body, e.i.s_local}, elastic.name);
                                  const auto j = sketch.add({e.j.body, e.j.s_local}, elastic.name);
                                  bushings.push_back(e.i.body == ground ? j : i);
                              }},
                   elastic.kind);
    for (const auto& probe : model.probes) sketch.add(probe.at, probe.name);
    std::vector<std::optional<std::size_t>> hubs(model.bodies.size());
    for (const auto& wheel : model.wheels) {
        const std::string whose = wheel.name.empty() ? "" : wheel.name + " ";
        hubs[static_cast<std::size_t>(wheel.body)] =
            sketch.add({wheel.body, wheel.centre_local}, whose + "wheel centre");
        sketch.add({wheel.body, wheel.contact_local}, whose + "contact patch");
    }
    for (BodyId body = 0; body < static_cast<BodyId>(model.bodies.size()); ++body)
        outline(sketch, body, hubs[static_cast<std::size_t>(body)]);

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
        const auto& [front, start, middle, back] =
            branch.runs[static_cast<std::size_t>(compare::Leg::equilibrium)].landmarks;
        const auto put = [&](const std::string& name, const char* where, const Equilibrium& state) {
            json entry = positions(sketch, state.poses);
            entry["branch"] = name;
            entry["where"] = where;
            entry["a"] = in_unit(branch.unit) * state.load;
            along.push_back(entry);
        };
        if (middle) put(branch.branch, "middle", *middle);
        if (front && back && front->load * back->load < 0)  // walked both ways
            put(fmt::format("{} to {:.4g} {}", branch.branch, in_unit(branch.unit) * front->load,
                            symbol(branch.unit)),
                "end", *front);
        if (back) put(branch.branch, "end", *back);
    }
    json result = {{"points", points}, {"links", sketch.links}, {"bushings", bushings}};
    result["design"] = positions(sketch, design);
    result["positions"] = along;
    return result;
}

}  // namespace elastocheck::reports
