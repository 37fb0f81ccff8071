#include "models/reader/definitions/definitions.hpp"

#include <fmt/format.h>

#include <numbers>
#include <numeric>

#include "models/reader/definitions/beams.hpp"
#include "models/reader/definitions/look_up.hpp"
#include "models/reader/document/limits.hpp"

namespace elastocheck::reader {
namespace {

struct Moment {
    const char *name, *dot, *star;  // "N·m", and its keyboard forms
    double divide, multiply;
};
constexpr Moment moments[] = {{"N·m", "N*m", "Nm", 1, 1},
                              {"N·mm", "N*mm", "Nmm", 1000, 1},
                              {"kN·m", "kN*m", "kNm", 1, 1000},
                              {"kN·mm", "kN*mm", "kNmm", 1000, 1000}};

Unit read_moment(const Cursor& field) {
    std::vector<std::string> names;
    for (const Moment& moment : moments)
        names.insert(names.end(), {moment.name, moment.dot, moment.star});
    const Moment& chosen = moments[field.one_of("a unit of moment", names) / 3];
    return {chosen.name, chosen.divide, chosen.multiply};
}

Units read_units(const Cursor& field) {
    field.only_keys({"length", "angle", "force", "moment"});
    Units units;
    if (field.require("length").one_of("a unit of length", {"m", "mm"}))
        units.length = {"mm", 1000};
    const double per_rad = 180 / std::numbers::pi;
    if (field.require("angle").one_of("a unit of angle", {"deg", "rad"}) == 0)
        units.angle = {"deg", per_rad};
    if (field.require("force").one_of("a unit of force", {"N", "kN"}))
        units.force = {"kN", 1, 1000};

    const auto &L = units.length, &A = units.angle, &F = units.force;
    const auto moment = field.optional("moment");
    units.moment =
        moment ? read_moment(*moment) : Unit{F.name + "·" + L.name, L.divide, F.multiply};
    const Unit& M = units.moment;
    units.rate = {F.name + "/" + L.name, 1, F.multiply * L.divide};
    units.coupling = {F.name + "/" + A.name, 1, F.multiply * A.divide};
    units.rotational_rate = {M.name + "/" + A.name, M.divide, M.multiply * A.divide};
    units.arm = {moment ? M.name + "/" + F.name : L.name, M.divide, M.multiply / F.multiply};
    return units;
}

void read_points(const Cursor& section, const Definitions* twins, Definitions& defs) {
    for (const auto& [name, field] : section.entries())
        defs.points[name] = vector(field, defs.units.length);
    if (defs.points.empty()) section.fail("empty; at least one hardpoint is needed");
    if (!defs.mirror) return;
    for (const auto& [name, field] : section.entries())
        if (const auto twin = twin_name(*defs.mirror, name, section))
            defs.points[*twin] = twins ? twins->points.at(*twin) : reflected(defs.points.at(name));
}

void read_bodies(const Cursor& section, Definitions& defs) {
    defs.body_ids["ground"] = ground;
    for (const auto& [name, field] : section.entries()) {
        if (name == "ground")
            field.fail("ground is predefined and cannot be defined again; choose another name");
        // gravity.cpp reads the last two
        field.only_keys({"origin", "mass", "centre_of_gravity"});
        const Vector3 origin = hardpoint(field.require("origin"), defs);
        defs.body_ids[name] = static_cast<BodyId>(defs.bodies.size());
        defs.bodies.push_back({name, {.r = origin, .p = Quaternion::Identity()}});
    }
    if (defs.bodies.empty()) section.fail("empty; at least one body is needed");
    const std::size_t written = defs.bodies.size();
    defs.twin_of.resize(written);
    std::iota(defs.twin_of.begin(), defs.twin_of.end(), 0);
    for (std::size_t b = 0; defs.mirror && b < written; ++b) {
        const Body body = defs.bodies[b];
        const auto twin = twin_name(*defs.mirror, body.name, section);
        if (!twin) continue;
        defs.twin_of[b] = static_cast<BodyId>(defs.bodies.size());
        defs.twin_of.push_back(static_cast<BodyId>(b));
        defs.body_ids[*twin] = defs.twin_of[b];
        defs.bodies.push_back({*twin, {.r = reflected(body.design.r), .p = body.design.p}});
    }
    if (defs.bodies.size() > max_bodies)
        section.fail(fmt::format("{} bodies; allowed: at most {}", defs.bodies.size(), max_bodies));
}

// x, y, z or -x, -y, -z
Vector3 named_axis(const Cursor& field) {
    const std::string& word = field.value->text;
    const double sign = word.starts_with('-') ? -1 : 1;
    const std::string letter = sign < 0 ? word.substr(1) : word;
    for (int k = 0; k < 3; ++k)
        if (letter == std::string(1, "xyz"[k])) return sign * Vector3::Unit(k);
    field.fail(
        fmt::format("{} is not a direction; allowed: x, y, z, -x, -y, -z, [x, y, z] or two "
                    "hardpoints [from, to]",
                    field.found()));
}

}  // namespace

void take_twin_bodies(const Definitions& twins, Definitions& defs) {
    for (std::size_t b = 0; b < defs.bodies.size(); ++b)
        if (is_twin(*defs.mirror, defs.bodies[b].name)) defs.bodies[b] = twins.bodies[b];
}

Definitions read_definitions(const Cursor& scene, const Definitions* twins) {
    Definitions defs;
    defs.units = read_units(scene.require("units"));
    if (const auto mirror = scene.optional("mirror")) defs.mirror = read_mirror(*mirror, scene);
    read_points(scene.require("points"), twins, defs);
    read_bodies(scene.require("bodies"), defs);
    add_beam_bodies(scene, defs);
    if (twins != nullptr) take_twin_bodies(*twins, defs);
    return defs;
}

double rate(const Cursor& field, const Unit& unit) {
    const double k = field.number(unit.name);
    if (k < 0) field.fail(fmt::format("negative rate {}; allowed: zero or more", field.found()));
    return unit.si(k);
}

double above_zero(const Cursor& field, const char* what, const Unit& unit) {
    const double x = unit.si(field.number(unit.name));
    if (!(x > 0)) field.fail(fmt::format("{} is {}; allowed: above zero", field.found(), what));
    return x;
}

Vector3 vector(const Cursor& field, const Unit& unit) {
    const auto items = field.list(3, "numbers");
    const auto si = [&](std::size_t k) { return unit.si(items[k].number(unit.name)); };
    return {si(0), si(1), si(2)};  // braces: numbers are recorded in this order
}

Vector3 hardpoint(const Cursor& field, const Definitions& defs) {
    return look_up(field, "hardpoint", defs.points);
}

Vector3 direction(const Cursor& field, const Definitions& defs) {
    const auto items = field.items();
    if (field.is_list() && items.size() == 2) {
        const Vector3 u = hardpoint(items[1], defs) - hardpoint(items[0], defs);
        if (!(u.norm() > coincident))
            field.fail("the two hardpoints coincide; a direction needs two different ones");
        return u.normalized();
    }
    if (field.is_list() && items.size() == 3) {
        const Vector3 u = vector(field);
        if (u.isZero(0)) field.fail("the vector has length zero; a direction needs a length");
        return u.normalized();
    }
    if (field.value->kind == Value::Kind::scalar) return named_axis(field);
    field.fail(
        fmt::format("expected a direction (x, y, z, -x, -y, -z, [x, y, z] or two hardpoints [from, "
                    "to]), found {}",
                    field.found()));
}

BodyId body(const Cursor& field, const Definitions& defs) {
    return look_up(field, "body", defs.body_ids);
}

BodyId moving_body(const Cursor& field, const Definitions& defs, const char* what) {
    const BodyId id = body(field, defs);
    if (id == ground)
        field.fail(fmt::format("{} cannot be on ground, which is fixed; allowed: a body", what));
    return id;
}

BodyPair body_pair(const Cursor& field, const Definitions& defs) {
    const auto items = field.list(2, "bodies");
    const BodyPair pair{body(items[0], defs), body(items[1], defs)};
    if (pair.i == pair.j)
        field.fail(
            fmt::format("both bodies are {}; two different bodies are needed", items[0].found()));
    return pair;
}

Point point_of(BodyId body, const Vector3& p, const Definitions& defs) {
    if (body == ground) return {ground, p};
    return {body, p - defs.bodies[static_cast<std::size_t>(body)].design.r};
}

// Eigen chooses among several formulas by the trace; they differ in the sign of the quaternion at most.
Quaternion quaternion_of(const Matrix3& axes) { return Quaternion(axes).normalized(); }

Marker marker_of(BodyId body, const Vector3& p, const Matrix3& axes, const Definitions& defs) {
    return {body, point_of(body, p, defs).s_local, quaternion_of(axes)};
}

Between between(const Cursor& field, const Definitions& defs, const char* what) {
    const auto [i, j] = body_pair(field.require("bodies"), defs);
    const Vector3 from = hardpoint(field.require("from"), defs),
                  to = hardpoint(field.require("to"), defs);
    const double length = (to - from).norm();
    if (!(length > coincident))
        field.require("to").fail(
            fmt::format("the same position as `from`; {} needs a length", what));
    return {point_of(i, from, defs), point_of(j, to, defs), length};
}

}  // namespace elastocheck::reader
