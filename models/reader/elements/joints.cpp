// Reads joints: a table with one entry per type.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "models/kinds.hpp"
#include "models/near.hpp"
#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

constexpr double max_cosine = 1e-9;  // between axes that must be perpendicular

// Fields of a joint. Its axes are fixed in both bodies, which start parallel to ground.
struct JointFields {
    const Cursor& joint;
    const Definitions& defs;
    BodyPair bodies;

    Vector3 position(const char* key) const { return hardpoint(joint.require(key), defs); }
    Point i(const char* key) const { return point_of(bodies.i, position(key), defs); }
    Point j(const char* key) const { return point_of(bodies.j, position(key), defs); }
    Direction axis_i(const char* key) const {
        return {bodies.i, direction(joint.require(key), defs)};
    }
    Direction axis_j(const char* key) const {
        return {bodies.j, direction(joint.require(key), defs)};
    }
};

// `axis_i` and `axis_j`, perpendicular as written within 1e-9; axis_j is made exactly perpendicular.
std::pair<Direction, Direction> perpendicular_axes(const JointFields& f) {
    const Direction i = f.axis_i("axis_i");
    Direction j = f.axis_j("axis_j");
    const double cosine = i.u_local.dot(j.u_local);
    if (!are_near(cosine, 0, max_cosine)) {
        const double sine = i.u_local.cross(j.u_local).norm();
        const double angle = std::atan2(sine, cosine) * 180 / std::numbers::pi;  // [deg]
        f.joint.require("axis_j").fail(
            fmt::format("{:.10g} deg from axis_i; the two axes must be perpendicular", angle));
    }
    j.u_local = (j.u_local - cosine * i.u_local).normalized();
    return {i, j};
}

JointKind spherical(const JointFields& f) { return Spherical{f.i("at"), f.j("at")}; }

template <class J>
JointKind along_axis(const JointFields& f) {
    return J{f.i("at"), f.j("at"), f.axis_i("axis"), f.axis_j("axis")};
}

JointKind planar(const JointFields& f) {
    return Planar{f.i("at"), f.j("at"), f.axis_i("normal"), f.axis_j("normal")};
}

JointKind universal(const JointFields& f) {
    const auto [axis_i, axis_j] = perpendicular_axes(f);
    return Universal{f.i("at"), f.j("at"), axis_i, axis_j};
}

JointKind fixed(const JointFields& f) {
    const auto [i, j] = f.bodies;
    const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
    return Fixed{f.i("at"), f.j("at"), {i, x}, {i, y}, {j, x}, {j, y}};
}

JointKind distance(const JointFields& f) {
    const auto [i, j, drawn] = between(f.joint, f.defs, "a distance joint");
    const auto given = f.joint.optional("length");
    return Distance{i, j, given ? above_zero(*given, "not a length", f.defs.units.length) : drawn};
}

JointKind in_plane(const JointFields& f) {
    return InPlane{f.i("at"), f.j("at"), f.axis_j("normal")};
}

JointKind in_line(const JointFields& f) { return InLine{f.i("at"), f.j("at"), f.axis_j("axis")}; }

JointKind perpendicular(const JointFields& f) {
    const auto [i, j] = perpendicular_axes(f);
    return Perpendicular{i, j};
}

JointKind parallel(const JointFields& f) { return Parallel{f.axis_i("axis"), f.axis_j("axis")}; }

struct JointType {
    std::string name;
    std::vector<std::string> fields;  // besides type and bodies
    JointKind (*read)(const JointFields&);
};

const std::vector<JointType>& joint_types() {
    static const std::vector<JointType> types{
        {Kind<Spherical>::name, {"at"}, spherical},
        {Kind<Revolute>::name, {"at", "axis", "held"}, along_axis<Revolute>},
        {Kind<Universal>::name, {"at", "axis_i", "axis_j"}, universal},
        {Kind<Cylindrical>::name, {"at", "axis", "held"}, along_axis<Cylindrical>},
        {Kind<Translational>::name, {"at", "axis", "held", "per_turn"}, along_axis<Translational>},
        {Kind<Planar>::name, {"at", "normal"}, planar},
        {Kind<Fixed>::name, {"at"}, fixed},
        {Kind<Distance>::name, {"from", "to", "length"}, distance},
        {Kind<InPlane>::name, {"at", "normal"}, in_plane},
        {Kind<InLine>::name, {"at", "axis"}, in_line},
        {Kind<Perpendicular>::name, {"axis_i", "axis_j"}, perpendicular},
        {Kind<Parallel>::name, {"axis"}, parallel},
    };
    return types;
}

const std::pair<std::vector<std::string>, std::vector<std::string>>& names_and_fields() {
    static const auto both = [] {
        std::pair<std::vector<std::string>, std::vector<std::string>> lists{{}, {"type", "bodies"}};
        auto& [names, fields] = lists;
        for (const JointType& type : joint_types()) {
            names.push_back(type.name);
            for (const std::string& field : type.fields)
                if (std::ranges::find(fields, field) == fields.end()) fields.push_back(field);
        }
        return lists;
    }();
    return both;
}

const JointType& joint_type(const Cursor& joint) {
    const auto& [names, fields] = names_and_fields();
    // Check against the fields of all types first: a misspelt `type` is then an unknown field, not
    // a missing one.
    joint.only_keys(fields);
    return joint_types()[joint.require("type").one_of("a joint type", names)];
}

}  // namespace

Joint read_joint(const std::string& name, const Cursor& field, const Definitions& defs) {
    const JointType& type = joint_type(field);
    if (field.first_reading) {
        std::vector<std::string> fields{"type", "bodies"};
        fields.insert(fields.end(), type.fields.begin(), type.fields.end());
        field.only_keys(fields);
    }
    const BodyPair bodies = body_pair(field.require("bodies"), defs);
    return {name, type.read({field, defs, bodies})};
}

bool is_held(const Cursor& joint) {
    const auto field = joint.optional("held");
    return field && field->yes_or_no();
}

}  // namespace elastocheck::reader
