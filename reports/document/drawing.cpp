#include "reports/document/drawing.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "compare/outputs/curve.hpp"
#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"
#include "reports/text/labels.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Vector3d;
using json = nlohmann::ordered_json;

constexpr double same_place = 1e-9;  // [m]

// Points and lines of the drawing while they are collected.
struct Sketch {
    const Scene* scene;
    const Model* model;
    std::vector<Point> points;
    std::vector<std::string> names;
    std::vector<bool> is_hardpoint;
    std::vector<Drawing::Link> links = {};

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

    // Index of a point in the list, new or existing; its name: of its hardpoint, else default_name.
    std::size_t add(const Point& point, const std::string& default_name) {
        for (std::size_t k = 0; k < points.size(); ++k)
            if (points[k].body == point.body &&
                (points[k].s_local - point.s_local).norm() < same_place)
                return k;
        std::string name = default_name;
        bool known = false;
        const Vector3d position = at(point, design());
        for (const auto& hardpoint : scene->hardpoints)
            if ((hardpoint.position - position).norm() < same_place) {
                name = hardpoint.name;
                known = true;
            }
        points.push_back(point);
        names.push_back(name);
        is_hardpoint.push_back(known);
        return points.size() - 1;
    }
    void link(const char* kind, const std::string& name, std::size_t i, std::size_t j) {
        links.push_back({kind, name, i, j});
    }
};

// ---- Bodies. The shape of a body is unknown, only its attachment points: coplanar points of an
// arm are drawn as their outline, all other bodies as the shortest tree of lines, which starts at
// the wheel's centre if the body carries a wheel.

// Points in order along the outline of a plate; empty if they are not coplanar, or nearly collinear.
std::vector<std::size_t> outline(const std::vector<Vector3d>& points) {
    if (points.size() < 3) return {};
    Vector3d middle = Vector3d::Zero();
    for (const auto& p : points) middle += p / static_cast<double>(points.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const auto& p : points) spread += (p - middle) * (p - middle).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(spread);
    const Vector3d extent = principal.eigenvalues().cwiseMax(0).cwiseSqrt();  // ascending
    if (!(extent[1] > 0.15 * extent[2]) || extent[0] > 0.35 * extent[1]) return {};
    const Vector3d u = principal.eigenvectors().col(2), v = principal.eigenvectors().col(1);
    std::vector<PaperPoint> flat;
    for (const auto& p : points) flat.push_back({u.dot(p - middle), v.dot(p - middle)});
    return convex_hull(flat);
}

// Minimum spanning tree (Prim 1957): joins each point to the nearest joined one.
void tree(Sketch& sketch, const std::string& name, std::vector<std::size_t> attached,
          std::size_t root) {
    std::vector<std::size_t> joined{root};
    std::erase(attached, root);
    while (!attached.empty()) {
        std::pair<std::size_t, std::size_t> nearest{attached.front(), root};
        double least = std::numeric_limits<double>::infinity();
        for (const auto k : attached)
            for (const auto l : joined)
                if (const double d = (sketch.points[k].s_local - sketch.points[l].s_local).norm();
                    d < least) {
                    least = d;
                    nearest = {k, l};
                }
        sketch.link("body", name, nearest.second, nearest.first);
        joined.push_back(nearest.first);
        std::erase(attached, nearest.first);
    }
}

void draw_body(Sketch& sketch, BodyId body, const std::vector<std::size_t>& hubs,
               const std::set<std::size_t>& patches, std::vector<Drawing::Face>& faces) {
    std::vector<std::size_t> attached;
    for (std::size_t k = 0; k < sketch.points.size(); ++k)
        if (sketch.points[k].body == body && !patches.contains(k)) attached.push_back(k);
    const std::string& name = sketch.model->bodies[static_cast<std::size_t>(body)].name;
    if (attached.size() < 2) return;
    if (hubs.size() < 2) {
        // The wheel centre of a carrier lies outside the plane of its other points.
        std::vector<std::size_t> plate = attached;
        if (!hubs.empty()) std::erase(plate, hubs.front());
        std::vector<Vector3d> places;
        for (const auto k : plate) places.push_back(sketch.points[k].s_local);
        if (std::vector<std::size_t> corners = outline(places); corners.size() >= 3) {
            for (auto& corner : corners) corner = plate[corner];
            for (std::size_t k = 0; k < corners.size(); ++k)
                sketch.link("body", name, corners[k], corners[(k + 1) % corners.size()]);
            faces.push_back({name, corners});
            if (hubs.empty()) return;
            const auto distance = [&](std::size_t k) {
                return (sketch.points[k].s_local - sketch.points[hubs.front()].s_local).norm();
            };
            sketch.link("body", name, hubs.front(), *std::ranges::min_element(plate, {}, distance));
            return;
        }
    }
    tree(sketch, name, attached, hubs.empty() ? attached.front() : hubs.front());
}

// ---- Joints and bushings, where the scene has them, for their symbols.

struct Symbol {
    const char* kind;
    Point at;
    std::optional<Direction> axis = {};
};

std::vector<Symbol> symbols_of(const JointKind& kind) {
    const JointSymbol symbol = std::visit([]<class J>(const J&) { return Kind<J>::symbol; }, kind);
    std::vector<Symbol> symbols;
    if (*symbol.name == '\0') return symbols;
    each_member(kind, [&](const Point& point) {
        if (symbols.empty() || symbol.at_both_ends) symbols.push_back({symbol.name, point});
    });
    if (symbol.has_axis) symbols.front().axis = *member<Direction>(kind);
    return symbols;
}

bool is_segment(const Elastic& elastic) { return elastic.written_as == WrittenAs::beam; }

Position position(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Position millimetres(const Vector3d& v) { return position(1e3 * v); }

std::vector<Drawing::Symbol> symbols_of(const Sketch& sketch) {
    const Scene& scene = *sketch.scene;
    const auto design = sketch.design();
    std::vector<Drawing::Symbol> list;
    const auto pose = [&](BodyId body) {
        return body == ground ? Pose{} : scene.bodies[static_cast<std::size_t>(body)].design;
    };
    const auto add = [&](const char* kind, const std::string& name, const Vector3d& at,
                         const std::optional<Vector3d>& axis) {
        std::optional<std::size_t> point;
        for (std::size_t k = sketch.points.size(); k-- > 0;)
            if ((sketch.at(sketch.points[k], design) - at).norm() < 1e-5) point = k;
        list.push_back({kind, name, point, millimetres(at),
                        axis ? std::optional(position(*axis)) : std::nullopt});
    };
    const auto place = [&](const Point& p) -> Vector3d {
        return pose(p.body).r + pose(p.body).p * p.s_local;
    };
    const auto turned = [&](const Direction& u) -> Vector3d { return pose(u.body).p * u.u_local; };
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        const Joint& joint = scene.joints[k];
        const bool moved = std::ranges::any_of(scene.branches, [&](const Branch& branch) {
            return std::ranges::any_of(branch.drivers, [&](const Driver& driver) {
                return driver.rate != 0 && driven_joint(driver.what) == static_cast<int>(k);
            });
        });
        // The driver of a joint is a plane constraint on one of its points; under a wheel a jack.
        if (const auto* plane = std::get_if<InPlane>(&joint.kind)) {
            const bool jack = std::ranges::any_of(
                scene.wheels, [&](const Wheel& wheel) { return wheel.body == plane->i.body; });
            if (moved && !jack) add("drive", joint.name, place(plane->i), turned(plane->normal_j));
            if (moved || joint.active_only_where_driven) continue;
        }
        if (joint.active_only_where_driven) continue;
        for (const auto& symbol : symbols_of(joint.kind))
            add(symbol.kind, joint.name, place(symbol.at),
                symbol.axis ? std::optional(turned(*symbol.axis)) : std::nullopt);
    }
    for (const auto& elastic : scene.elastics) {
        const auto* marker = member<Marker>(elastic.kind);
        if (marker == nullptr || elastic.active_only_where_driven || is_segment(elastic)) continue;
        add("bushing", elastic.name, place({marker->body, marker->s_local}), std::nullopt);
    }
    return list;
}

// The two markers of a segment of a beam.
struct Segment {
    Marker i, j;
};

// Consecutive segments of a beam: its nodes lie between their middles, and beyond the first and the
// last middle the beam continues by the same distance.
void draw_beam(Sketch& sketch, const std::string& name, const std::vector<Segment>& segments) {
    std::vector<Point> line;
    const auto end = [&](const Marker& middle, const Marker& other) {
        // the node of `other`'s body is symmetric to this end about the middle
        if (other.body == ground) return Point{middle.body, middle.s_local};
        const Pose& node = sketch.model->bodies[static_cast<std::size_t>(other.body)].design;
        const Vector3d at = 2 * sketch.at({middle.body, middle.s_local}, sketch.design()) - node.r;
        if (middle.body == ground) return Point{ground, at};
        const Pose& own = sketch.model->bodies[static_cast<std::size_t>(middle.body)].design;
        return Point{middle.body, own.p.conjugate() * (at - own.r)};
    };
    if (segments.size() > 1) line.push_back(end(segments.front().i, segments.front().j));
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const Marker& middle =
            k == 0 ? segments[k].j : segments[k].i;  // on a node, not on the body at the end
        line.push_back({middle.body, middle.s_local});
        if (k + 1 < segments.size()) line.push_back({segments[k].j.body, Vector3d::Zero()});
    }
    if (segments.size() > 1) line.push_back(end(segments.back().j, segments.back().i));
    std::size_t before = sketch.add(line.front(), name);
    for (std::size_t k = 1; k < line.size(); ++k) {
        const std::size_t now = sketch.add(line[k], name);
        sketch.link("beam", name, before, now);
        before = now;
    }
}

// Circle through the contact patch about the spin axis; empty where patch and centre coincide.
std::vector<Position> rim(const Model& model, const Wheel& wheel, const std::vector<Pose>& poses) {
    std::vector<Position> list;
    const auto body = static_cast<std::size_t>(wheel.body);
    const Pose& pose = poses[body];
    const Vector3d arm = model.bodies[body].design.p.conjugate() * compare::drawn_arm(model, wheel);
    const Vector3d radius = arm - wheel.spin_axis_local * wheel.spin_axis_local.dot(arm);
    if (radius.norm() < same_place) return list;
    constexpr int corners = 48;
    for (int k = 0; k <= corners; ++k) {
        const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / corners, wheel.spin_axis_local);
        list.push_back(millimetres(pose.r + pose.p * (wheel.centre_local + turn * radius)));
    }
    return list;
}

// Stations of a branch, to move the drawing along it.
Drawing::Motion motion(const Sketch& sketch, const compare::BranchComparison& branch) {
    Drawing::Motion motion{branch.branch, symbol(branch.unit)};
    const auto append = [](std::vector<double>& list, const Vector3d& v, double per_unit) {
        for (const double x : v)
            list.push_back(std::round(x * per_unit) / per_unit + 0.0);  // + 0.0: no negative zero
    };
    for (const auto& state : branch.run(compare::Leg::equilibrium).stations) {
        auto& points = motion.points.emplace_back();
        auto& axes = motion.axes.emplace_back();
        for (const auto& point : sketch.points)
            append(points, 1e3 * sketch.at(point, state.poses), 1e3);
        for (const auto& wheel : sketch.model->wheels)
            append(axes,
                   state.poses[static_cast<std::size_t>(wheel.body)].p * wheel.spin_axis_local,
                   1e6);
        motion.a.push_back(parameter_in(branch.unit, state.load));
    }
    return motion;
}

Drawing::Placed placed(const Sketch& sketch, const std::vector<Pose>& poses) {
    Drawing::Placed result;
    for (const auto& point : sketch.points)
        result.points.push_back(millimetres(sketch.at(point, poses)));
    for (const auto& wheel : sketch.model->wheels)
        result.rims.push_back(rim(*sketch.model, wheel, poses));
    return result;
}

using Beams = std::vector<std::pair<std::string, std::vector<Segment>>>;

// Joints and elements; returns the beams.
Beams draw_connections(Sketch& sketch) {
    const Model& model = *sketch.model;
    for (const auto& constraint : model.constraints) {
        const ModelJoint& joint = model.joints[static_cast<std::size_t>(constraint.joint)];
        if (joint.active_only_where_driven) continue;  // a jack is not part of the suspension
        std::visit(overloaded{[&](const CoincidentPoints& c) {
                                  sketch.add(c.i, joint.name);
                                  sketch.add(c.j, joint.name);
                              },
                              [&](const PointInPlane& c) { sketch.add(c.i, joint.name); },
                              [](const PerpendicularDirections&) {},
                              [&](const DistanceBetween& c) {
                                  const auto i = sketch.add(c.i, joint.name);
                                  sketch.link("rod", joint.name, i, sketch.add(c.j, joint.name));
                              },
                              [](const DirectionAtAngle&) {}},
                   constraint.kind);
    }
    Beams beams;
    for (const auto& elastic : model.elastics) {
        if (const auto ends = points_of(elastic.kind); ends.size() == 2) {
            const auto i = sketch.add(ends[0], elastic.name), j = sketch.add(ends[1], elastic.name);
            const bool stop = elastic.written_as == WrittenAs::stop;
            sketch.link(stop ? "stop" : "spring", elastic.name, i, j);
        }
        std::vector<const Marker*> markers;
        each_member(elastic.kind, [&](const Marker& marker) { markers.push_back(&marker); });
        if (markers.size() != 2 || elastic.active_only_where_driven) continue;  // a tyre
        const Marker &a = *markers[0], &b = *markers[1];
        if (is_segment(elastic)) {
            const std::string beam = elastic.name.substr(0, elastic.name.rfind('.'));
            if (beams.empty() || beams.back().first != beam) beams.push_back({beam, {}});
            beams.back().second.push_back({a, b});
            continue;
        }
        sketch.add({a.body, a.s_local}, elastic.name);
        sketch.add({b.body, b.s_local}, elastic.name);
    }
    return beams;
}

// Positions along the branches.
void add_stations(Drawing& drawing, const Sketch& sketch, const compare::Comparison& comparison) {
    for (const auto& branch : comparison.branches) {
        const auto& [front, start, middle, back] = branch.run(compare::Leg::equilibrium).landmarks;
        const auto add = [&](const std::string& side, bool end, const Equilibrium& state) {
            drawing.stations.push_back({placed(sketch, state.poses), side, branch.branch,
                                        symbol(branch.unit), end,
                                        parameter_in(branch.unit, state.load)});
        };
        if (middle) add(branch.branch, false, *middle);
        if (front && back && front->load * back->load < 0)  // a two-sided branch
            add(fmt::format("{} to {:.4g} {}", branch.branch, in_unit(branch.unit) * front->load,
                            symbol(branch.unit)),
                true, *front);
        if (back) add(branch.branch, true, *back);
        drawing.motion.push_back(motion(sketch, branch));
    }
}

}  // namespace

Drawing drawing_of(const Scene& scene, const Model& model, const compare::Comparison& comparison) {
    Drawing drawing;
    Sketch sketch{&scene, &model, {}, {}, {}};
    const Beams beams = draw_connections(sketch);
    for (const auto& [name, segments] : beams) draw_beam(sketch, name, segments);
    for (const auto& damper : model.dampers) {
        const auto i = sketch.add(damper.i, damper.name);
        sketch.link("damper", damper.name, i, sketch.add(damper.j, damper.name));
    }
    for (const auto& probe : model.probes) sketch.add(probe.at, probe.name);
    std::vector<std::vector<std::size_t>> hubs(model.bodies.size());
    std::set<std::size_t> patches;
    for (const auto& wheel : model.wheels) {
        const std::string prefix = wheel.name.empty() ? "" : wheel.name + " ";
        const auto centre = sketch.add({wheel.body, wheel.centre_local}, prefix + "wheel centre"),
                   patch = sketch.add(wheel.contact, prefix + "contact patch");
        hubs[static_cast<std::size_t>(wheel.body)].push_back(centre);
        if (patch != centre) patches.insert(patch);
        const Pose& pose = model.bodies[static_cast<std::size_t>(wheel.body)].design;
        drawing.wheels.push_back(
            {wheel.name, centre, patch, position(pose.p * wheel.spin_axis_local)});
    }
    std::set<std::string> beam_nodes;
    for (const auto& [name, segments] : beams)
        for (std::size_t k = 0; k + 1 < segments.size(); ++k)
            beam_nodes.insert(model.bodies[static_cast<std::size_t>(segments[k].j.body)].name);
    for (BodyId body = 0; body < static_cast<BodyId>(model.bodies.size()); ++body)
        if (!beam_nodes.contains(model.bodies[static_cast<std::size_t>(body)].name))
            draw_body(sketch, body, hubs[static_cast<std::size_t>(body)], patches, drawing.faces);
    drawing.design = placed(sketch, sketch.design());
    for (std::size_t k = 0; k < sketch.points.size(); ++k) {
        const BodyId body = sketch.points[k].body;
        drawing.points.push_back({sketch.names[k], body_name(model, body), sketch.is_hardpoint[k],
                                  drawing.design.points[k]});
    }
    drawing.links = std::move(sketch.links);
    drawing.symbols = symbols_of(sketch);
    add_stations(drawing, sketch, comparison);
    return drawing;
}

namespace {

json placed_json(const Drawing::Placed& placed) {
    json result = {{"points_mm", placed.points}};
    if (!placed.rims.empty()) result["wheels_mm"] = placed.rims;
    return result;
}

}  // namespace

json drawing_json(const Drawing& drawing) {
    json points = json::array(), links = json::array(), faces = json::array(),
         symbols = json::array(), wheels = json::array(), positions = json::array(),
         motions = json::array();
    for (const auto& p : drawing.points)
        points.push_back(
            {{"name", p.name}, {"body", p.body}, {"hardpoint", p.hardpoint}, {"design_mm", p.at}});
    for (const auto& l : drawing.links)
        links.push_back({{"kind", l.kind}, {"name", l.name}, {"points", {l.i, l.j}}});
    for (const auto& f : drawing.faces) faces.push_back({{"body", f.body}, {"points", f.points}});
    for (const auto& s : drawing.symbols)
        symbols.push_back({{"kind", s.kind},
                           {"name", s.name},
                           {"point", s.point ? json(*s.point) : json(nullptr)},
                           {"at_mm", s.at},
                           {"axis", s.axis ? json(*s.axis) : json(nullptr)}});
    for (const auto& w : drawing.wheels)
        wheels.push_back({{"name", w.name},
                          {"centre", w.centre},
                          {"patch", w.patch},
                          {"spin_axis", w.spin_axis}});
    for (const auto& s : drawing.stations) {
        positions.push_back(placed_json(s));
        positions.back().update({{"branch", s.side},
                                 {"of", s.branch},
                                 {"unit", s.unit},
                                 {"where", s.end ? "end" : "middle"},
                                 {"a", s.a}});
    }
    for (const auto& m : drawing.motion)
        motions.push_back({{"branch", m.branch},
                           {"unit", m.unit},
                           {"a", m.a},
                           {"points_mm", m.points},
                           {"spin_axes", m.axes}});
    return {{"points", points},       {"links", links},   {"faces", faces},
            {"symbols", symbols},     {"wheels", wheels}, {"design", placed_json(drawing.design)},
            {"positions", positions}, {"motion", motions}};
}

}  // namespace elastocheck::reports
