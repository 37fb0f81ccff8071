#include "models/reader/elements/driven.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "models/kinds.hpp"
#include "models/reader/definitions/look_up.hpp"
#include "models/reader/definitions/mirror.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reader {
namespace {

constexpr int no_joint = -1;

// The angle of i relative to j about the axis, zero at the design position. Bodies start parallel to
// ground, so that x has the same components on both.
Angle angle_about(const Direction& axis_i, const Direction& axis_j) {
    const Vector3 x = axis_j.u_local.unitOrthogonal();
    const Vector3 y = axis_j.u_local.cross(x).normalized();
    return {.i = {axis_i.body, x}, .j = {axis_j.body, x}, .y_j = {axis_j.body, y}, .angle = 0};
}

const char* type_of(const JointKind& joint) {
    return std::visit([]<class J>(const J&) { return Kind<J>::name; }, joint);
}

void add_joints(const Scene& scene, const Units& units, const std::map<int, int>& drives,
                Drivables& result) {
    for (int k = 0; k < static_cast<int>(scene.joints.size()); ++k) {
        const Joint& joint = scene.joints[static_cast<std::size_t>(k)];
        const bool is_drive =
            std::ranges::any_of(drives, [&](const auto& d) { return d.second == k; });
        if (is_drive) continue;
        const std::string name = "joints." + joint.name;
        if (driven_number(joint.kind) != nullptr && !is_angle(joint.kind)) {
            result.table[name] = {ParameterUnit::metre, units.length, Motion{k}, 1, std::nullopt};
        } else if (auto drive = drive_of(joint)) {
            const bool is_length = !is_angle(drive->kind);
            const auto existing = drives.find(k);
            Drivable entry{is_length ? ParameterUnit::metre : ParameterUnit::radian,
                           is_length ? units.length : units.angle, Motion{no_joint}, 1,
                           std::nullopt};
            if (existing != drives.end()) {
                entry.what = Motion{existing->second};
            } else {
                entry.joint = *drive;
                entry.joint->active_only_where_driven = true;
            }
            result.table[name] = entry;
        } else {
            result.not_driven[name] = fmt::format(
                "a {} joint, which cannot be driven; allowed: the length of a distance, the offset "
                "of an in_plane, the displacement of a translational, the angle of a revolute or "
                "cylindrical joint",
                type_of(joint.kind));
        }
    }
}

// The preload of a linear spring is driven by its free length: P = k (ℓ₀ - ℓ) at the design length ℓ.
void add_spring(int k, const std::string& name, const ScalarLaw& law, const Units& units,
                Drivables& result) {
    const auto add = [&](const char* field, ParameterUnit kind, const Unit& unit, double factor) {
        result.table[name + field] = {kind, unit, FreeLength{k}, factor, std::nullopt};
    };
    const double* rate = rate_of(law);
    if (const Curve* curve = curve_of(law); curve != nullptr && curve->knots.size() == 1)
        rate = &curve->pieces.front()[1];  // a linear spring with loose seats, while it pushes
    if (rate != nullptr && *rate == 0) {
        for (const char* field : {".free_length", ".preload"})
            result.not_driven[name + field] = "of a spring of rate zero, on which it has no effect";
        return;
    }
    add(".free_length", ParameterUnit::metre, units.length, 1);
    if (rate != nullptr)
        add(".preload", ParameterUnit::newton, units.force, 1 / *rate);
    else
        result.not_driven[name + ".preload"] =
            "the preload of a spring with a curve, which is not proportional to a length; allowed: "
            "its free_length";
}

// A torsion spring has a preload about its axis only, a spring at a wheel along z.
void add_bushing(int k, const NamedElement& element, const Units& units, Drivables& result) {
    const bool is_torsion = element.path.starts_with("torsion_springs."),
               is_at_wheel = element.path.starts_with("springs."),
               has_one_axis = is_torsion || is_at_wheel;
    const int first = is_torsion ? 5 : is_at_wheel ? 2 : 0;
    for (int axis = first; axis < (has_one_axis ? first + 1 : 6); ++axis) {
        Vector6 direction = Vector6::Unit(axis);
        if (element.is_twin) direction = reflected(direction);
        const bool is_force = axis < 3;
        const std::string field = is_force ? ".preload" : ".preload_moment";
        const std::string letter = has_one_axis ? "" : fmt::format(".{}", "xyz"[axis % 3]);
        result.table[element.path + field + letter] = {
            is_force ? ParameterUnit::newton : ParameterUnit::newton_metre,
            is_force ? units.force : units.moment, Preload{k, direction}, 1, std::nullopt};
    }
}

void add_elements(const Scene& scene, const Units& units, const NamedElements& elements,
                  Drivables& result) {
    // no structured binding: clang 14 cannot capture its parts
    for (const auto& entry : elements) {
        const int k = entry.first;
        const NamedElement& element = entry.second;
        const ElasticKind& kind = scene.elastics[static_cast<std::size_t>(k)].kind;
        if (driven_number(kind) != nullptr)
            add_spring(k, element.path, *scalar_law(kind, 0), units, result);
        if (preload(kind) != nullptr) add_bushing(k, element, units, result);
    }
}

// A jack holds the wheel centre, or the contact patch, at a height: in the plane z through its
// ground position in the design.
void add_jacks(const Scene& scene, const Units& units, Drivables& result) {
    for (const Wheel& wheel : scene.wheels) {
        const std::string of_wheel = wheel.name.empty() ? "" : wheel.name + ".";
        const auto add = [&](const char* quantity, const char* joint, const Point& at) {
            const Vector3& r = scene.bodies[static_cast<std::size_t>(at.body)].design.r;
            const InPlane jack{.i = at,
                               .j = {ground, r + at.s_local},
                               .normal_j = {ground, Vector3::UnitZ()},
                               .offset = 0};
            result.table[of_wheel + quantity] = {ParameterUnit::metre, units.length,
                                                 Motion{no_joint}, 1,
                                                 Joint{of_wheel + joint, jack, true}};
        };
        add("travel", "jack", {wheel.body, wheel.centre_local});
        add("patch_travel", "patch_jack", wheel.contact);
    }
}

}  // namespace

std::optional<Joint> drive_of(const Joint& joint) {
    using Drive = std::optional<JointKind>;
    const Drive kind = std::visit(
        []<class J>(const J& s) -> Drive {
            if constexpr (Kind<J>::drive == JointDrive::angle)
                return angle_about(s.axis_i, s.axis_j);
            else if constexpr (Kind<J>::drive == JointDrive::displacement)
                return InPlane{s.i, s.j, s.axis_j, 0};
            else
                return std::nullopt;
        },
        joint.kind);
    if (!kind) return std::nullopt;
    return Joint{joint.name + ".drive", *kind};
}

Drivables drivables(const Scene& scene, const Units& units, const std::map<int, int>& drives,
                    const NamedElements& elements) {
    Drivables result;
    add_jacks(scene, units, result);
    add_joints(scene, units, drives, result);
    add_elements(scene, units, elements, result);
    return result;
}

bool is_same(const Driven& a, const Driven& b) {
    if (a.index() != b.index() || driven_load(a) != nullptr) return false;
    const Vector6 *direction_a = preload(a), *direction_b = preload(b);
    return driven_joint(a) == driven_joint(b) && driven_element(a) == driven_element(b) &&
           (direction_a == nullptr || *direction_a == *direction_b);
}

int add_joint(const Cursor& field, const Joint& joint, Scene& scene) {
    if (std::ranges::any_of(scene.joints,
                            [&](const Joint& other) { return other.name == joint.name; }))
        field.fail(
            fmt::format("the joint name {} is reserved for its drive, but already in use; rename "
                        "the other joint",
                        quote(joint.name)));
    scene.joints.push_back(joint);
    return static_cast<int>(scene.joints.size()) - 1;
}

const Drivable& drivable(const Cursor& field, const std::string& name, Drivables& drivables,
                         Scene& scene) {
    const auto found = drivables.table.find(name);
    if (found == drivables.table.end()) {
        if (const auto why = drivables.not_driven.find(name); why != drivables.not_driven.end())
            field.fail(fmt::format("{} is {}", quote(name), why->second));
        field.fail(fmt::format("{} cannot be driven{}", quote(name),
                               did_you_mean(name, names_of(drivables.table), "allowed")));
    }
    Drivable& result = found->second;
    if (result.joint) {
        result.what = Motion{add_joint(field, *result.joint, scene)};
        result.joint.reset();
    }
    if (!result.drives.empty()) result.what = drivable(field, result.drives, drivables, scene).what;
    return result;
}

}  // namespace elastocheck::reader
