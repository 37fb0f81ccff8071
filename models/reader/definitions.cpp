#include "models/reader/definitions.hpp"

#include <fmt/format.h>

#include <numbers>

#include "models/reader/look_up.hpp"

namespace elastocheck::reader {
namespace {

using Eigen::Vector3d;

Units read_units(const Cursor& at) {
    at.only_keys({"length", "angle", "force"});
    Units units;
    const auto is_mm = at.require("length").one_of("a unit of length", {"m", "mm"});
    const auto is_rad = at.require("angle").one_of("a unit of angle", {"deg", "rad"});
    at.require("force").one_of("a unit of force", {"N"});
    if (is_mm) units.per_m = 1000, units.length = "mm";
    if (!is_rad) units.per_rad = 180 / std::numbers::pi, units.angle = "deg";
    return units;
}

void read_points(const Cursor& section, Definitions& defs) {
    for (const auto& [name, at] : section.entries()) {
        const Vector3d p = vector(at);
        defs.points[name] = p.unaryExpr([&](double x) { return defs.units.length_si(x); });
    }
    if (defs.points.empty()) section.fail("empty; at least one hardpoint is needed");
}

void read_bodies(const Cursor& section, Definitions& defs) {
    defs.body_ids["ground"] = ground;
    for (const auto& [name, at] : section.entries()) {
        if (name == "ground") at.fail("ground is always there and cannot be defined; choose another name");
        at.only_keys({"origin"});
        const Vector3d origin = hardpoint(at.require("origin"), defs);
        defs.body_ids[name] = static_cast<BodyId>(defs.bodies.size());
        defs.bodies.push_back({name, {.r = origin, .p = Eigen::Quaterniond::Identity()}});
    }
    if (defs.bodies.empty()) section.fail("empty; at least one body is needed");
}

// x, y, z or -x, -y, -z
Vector3d named_axis(const Cursor& at) {
    const std::string& word = at.value->text;
    const double sign = word.starts_with('-') ? -1 : 1;
    const std::string letter = sign < 0 ? word.substr(1) : word;
    if (letter == "x") return sign * Vector3d::UnitX();
    if (letter == "y") return sign * Vector3d::UnitY();
    if (letter == "z") return sign * Vector3d::UnitZ();
    at.fail(fmt::format(
        "{} is no direction; allowed: x, y, z, -x, -y, -z, [x, y, z] or two hardpoints [from, to]",
        at.found()));
}

}  // namespace

Definitions read_definitions(const Cursor& scene) {
    Definitions defs;
    defs.units = read_units(scene.require("units"));
    read_points(scene.require("points"), defs);
    read_bodies(scene.require("bodies"), defs);
    return defs;
}

double rate(const Cursor& at) {
    const double k = at.number();
    if (k < 0) at.fail(fmt::format("negative rate {}; allowed: zero or more", at.found()));
    return k;
}

Vector3d vector(const Cursor& at) {
    const auto items = at.list(3, "numbers");
    return {items[0].number(), items[1].number(), items[2].number()};
}

Vector3d hardpoint(const Cursor& at, const Definitions& defs) {
    return look_up(at, "hardpoint", defs.points);
}

Vector3d direction(const Cursor& at, const Definitions& defs) {
    const auto items = at.items();
    if (at.is_list() && items.size() == 2) {
        const Vector3d u = hardpoint(items[1], defs) - hardpoint(items[0], defs);
        if (!(u.norm() > coincident))
            at.fail("the two hardpoints coincide; a direction needs two different ones");
        return u.normalized();
    }
    if (at.is_list() && items.size() == 3) {
        const Vector3d u = vector(at);
        if (u.isZero(0)) at.fail("the vector has no length; a direction needs one");
        return u.normalized();
    }
    if (at.value->kind == Value::Kind::scalar) return named_axis(at);
    at.fail(fmt::format(
        "expected a direction (x, y, z, -x, -y, -z, [x, y, z] or two hardpoints [from, to]), found {}",
        at.found()));
}

BodyId body(const Cursor& at, const Definitions& defs) { return look_up(at, "body", defs.body_ids); }

BodyId moving_body(const Cursor& at, const Definitions& defs, const char* what) {
    const BodyId id = body(at, defs);
    if (id == ground)
        at.fail(fmt::format("{} cannot be on ground, which never moves; allowed: a body", what));
    return id;
}

BodyPair body_pair(const Cursor& at, const Definitions& defs) {
    const auto items = at.list(2, "bodies");
    const BodyPair pair{body(items[0], defs), body(items[1], defs)};
    if (pair.i == pair.j) at.fail(fmt::format("{} twice; two different bodies are needed", items[0].found()));
    return pair;
}

Point point_of(BodyId body, const Vector3d& p, const Definitions& defs) {
    if (body == ground) return {ground, p};
    return {body, p - defs.bodies[static_cast<std::size_t>(body)].design.r};
}

}  // namespace elastocheck::reader
