#include "compare/channels.hpp"

#include <cmath>
#include <numbers>

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double millimetres = 1e3;

const Pose& pose(const Equilibrium& state, BodyId body) {
    static const Pose at_rest;
    return body == ground ? at_rest : state.poses[static_cast<std::size_t>(body)];
}

Vector3d position(const Equilibrium& state, const Point& point) {
    const Pose& b = pose(state, point.body);
    return b.r + b.p * point.s_local;
}

// The point whose displacement is the travel.
std::optional<Point> leading_point(const Model& model) {
    if (model.wheel) return Point{model.wheel->body, model.wheel->centre_local};
    if (!model.probes.empty()) return model.probes.front().at;
    return std::nullopt;
}

}  // namespace

const char* symbol(Unit unit) {
    switch (unit) {
        case Unit::mm: return "mm";
        case Unit::deg: return "deg";
        case Unit::newton: return "N";
        case Unit::newton_metre: return "N·m";
    }
    return "";
}

std::vector<Channel> channels(const Model& model) {
    std::vector<Channel> list;
    const auto add = [&](const std::string& stem, Unit unit, bool main, int joint) {
        for (const char* axis : {"_x", "_y", "_z"}) list.push_back({stem + axis, unit, main, joint});
    };
    if (model.wheel) {
        add("wheel_centre", Unit::mm, true, -1);
        list.push_back({"toe", Unit::deg});
        list.push_back({"camber", Unit::deg});
    }
    for (const auto& probe : model.probes) add(probe.name, Unit::mm, true, -1);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
        add(model.joints[k].name + ".force", Unit::newton, false, static_cast<int>(k));
        add(model.joints[k].name + ".moment", Unit::newton_metre, false, static_cast<int>(k));
    }
    return list;
}

std::vector<double> evaluate(const Model& model, const Equilibrium& state) {
    std::vector<double> values;
    const auto add = [&](const Vector3d& v) { values.insert(values.end(), {v.x(), v.y(), v.z()}); };
    if (model.wheel) {
        const Wheel& wheel = *model.wheel;
        const Vector3d e = pose(state, wheel.body).p * wheel.spin_axis_local;
        add(millimetres * position(state, {wheel.body, wheel.centre_local}));
        values.push_back(degrees * std::atan2(e.x(), wheel.side * e.y()));
        values.push_back(degrees * -std::asin(e.z()));
    }
    for (const auto& probe : model.probes) add(millimetres * position(state, probe.at));
    for (const auto& wrench : state.reactions) {
        add(wrench.force);
        add(wrench.moment);
    }
    return values;
}

std::optional<Vector3d> travel_direction(const Branch& branch) {
    Vector3d direction = Vector3d::Zero();
    for (const auto& load : branch.loads)
        if (const auto* force = std::get_if<DeadForce>(&load.kind)) direction += force->f;
    if (direction.isZero(0)) return std::nullopt;
    return direction.normalized();
}

Curve curve(const Model& model, const Branch& branch, const std::vector<Equilibrium>& points) {
    const auto direction = travel_direction(branch);
    const auto leading = leading_point(model);

    Curve result;
    for (const auto& point : points) {
        result.load.push_back(point.load);
        result.values.push_back(evaluate(model, point));
        if (direction && leading)
            result.travel.push_back(
                millimetres * direction->dot(position(point, *leading) - position(points.front(), *leading)));
    }
    return result;
}

}  // namespace elastocheck::compare
