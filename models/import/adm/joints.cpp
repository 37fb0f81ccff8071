// Converts ADAMS joints and their motions.
//
// I and J of a joint coincide, or are in line, in the assembled model. A dataset has its parts at
// the design position, with the printed digits. A misalignment within round-off is removed by using
// I's position, a larger one is reported, and an unassembled model is rejected.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "models/import/adm/conversion.hpp"
#include "models/import/adm/joint_kinds.hpp"

namespace elastocheck::importer::adm {
namespace {

using Eigen::Vector3d;
using enum Position;

// Misalignments in shares of the model's size, or radians: not reported up to the first, rejected above
// the second.
constexpr double round_off = 1e-6, assembled = 1e-2;
constexpr std::size_t max_motions = 10'000;

// Of ORIENTATION, the rotation about z; its `parallel` joint fixes the other two.
constexpr JointOfAdams about_z{
    "JPRIM", "ORIENTATION", "perpendicular", any, Parallel::none, nullptr, 0, 1};

struct JointConversion {
    Conversion& c;
    const Statement& s;
    const Marker& I;
    const Marker& J;

    Vector3d separation() const { return I.pose.r - J.pose.r; }

    void require_small(double off, double scale, const std::string& what,
                       const std::string& unit) const {
        if (off <= round_off * scale) return;
        const std::string misalignment = fmt::format("{} {:.3g} {}", what, off, unit);
        if (!(off <= assembled * scale))
            s.fail(
                "{}: the parts do not meet in the file; write the file after the assembly of "
                "the model",
                misalignment);
        c.warn(s, "{} in the file; in the scene they coincide", misalignment);
    }
    void require_small(double off, const std::string& what) const {
        require_small(off, c.geometry.size, what, c.geometry.units.length_name);
    }
    void require_small_angle(double angle, const std::string& what) const {
        const double degree = std::numbers::pi / 180;
        require_small(angle / degree, 1 / degree, what, "deg");
    }
    void require(Position position) const {
        const Vector3d d = separation(), z = J.axis(2);
        if (position == coincident) require_small(d.norm(), "I and J are apart by");
        if (position == on_line)
            require_small((d - z * z.dot(d)).norm(), "I is off the axis of J by");
        if (position == on_plane) require_small(std::abs(z.dot(d)), "I is off the plane of J by");
    }
    void require_parallel(int k, bool either_way) const {
        const double cosine = I.axis(k).dot(J.axis(k));
        const double angle =
            std::atan2(I.axis(k).cross(J.axis(k)).norm(), either_way ? std::abs(cosine) : cosine);
        require_small_angle(angle, fmt::format("axes {} of I and J are apart by", "xyz"[k]));
        if (cosine < 0)
            c.warn(s,
                   "axes {} of I and J point in opposite directions; in the scene they are one "
                   "line",
                   "xyz"[k]);
    }

    std::size_t put(const std::string& name, const Fields& fields) const {
        c.draft.joints.push_back({name, fields.braced(), s.place()});
        return c.draft.joints.size() - 1;
    }
    Fields fields(std::string_view type) const {
        return Fields{}.add("type", type).add("bodies", c.pair(I.part, J.part));
    }
    // Adds an in_plane joint: I stays in a plane of J with this normal.
    std::size_t in_plane(const std::string& name, const Vector3d& normal) const {
        return put(name, fields("in_plane").add("at", c.point(I)).add("normal", direction(normal)));
    }

    std::size_t put(const std::string& name, const JointOfAdams& kind) const {
        const bool either_way = kind.parallel != Parallel::z_and_x_same_sense;
        require(kind.position);
        if (kind.parallel != Parallel::none) require_parallel(2, either_way);
        if (kind.parallel == Parallel::z_and_x || !either_way) require_parallel(0, either_way);
        Fields joint_fields = fields(kind.type);
        if (kind.position != any) joint_fields.add("at", c.point(I));
        if (kind.z_field) joint_fields.add(kind.z_field, direction(J.axis(2)));
        if (kind.axis_i >= 0) {  // the second is made exactly perpendicular
            const Vector3d u = I.axis(kind.axis_i), v = J.axis(kind.axis_j);
            require_small_angle(std::abs(std::asin(std::clamp(u.dot(v), -1.0, 1.0))),
                                "the axes deviate from the right angle by");
            joint_fields.add("axis_i", triple(u))
                .add("axis_j", triple((v - u.dot(v) * u).normalized()));
        }
        return put(name, joint_fields);
    }
};

// Notes the arguments of friction, which a scene does not have.
void leave_out_friction(Conversion& c, const Statement& s) {
    std::string given;
    for (std::string_view rest = dataset_table("friction").text; !rest.empty();) {
        const std::string_view field = rest.substr(0, rest.find('='));
        if (s.mark_read(field)) given += (given.empty() ? "" : ", ") + std::string(field);
        rest.remove_prefix(std::min(field.size() + 2, rest.size()));
    }
    if (given.empty()) return;
    if (c.options.drop_dynamics) return c.leave_out(s, given, "by --drop dynamics");
    c.miss(s,
           "{}: its friction also acts at rest, and a scene has no friction (--drop dynamics "
           "leaves it out)",
           given);
}

// JOINT and JPRIM.
void convert_joint(Conversion& c, const Statement& s) {
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    if (!c.is_between_two(s, I, J)) return;
    const auto flags = s.flags();
    if (flags.empty()) s.fail("has no type");
    if (flags.size() > 1)
        s.fail("is both {} and {}; exactly one type is needed", flags[0], flags[1]);
    const std::string& kind = flags[0];
    if (kind == "CONVEL")
        return c.miss(s,
                      "CONVEL: a constant-velocity joint, which a scene does not have (a universal "
                      "joint transmits another angle)");
    if (kind == "RACKPIN" || kind == "SCREW")
        return c.miss(
            s, "{}: it couples a rotation with a displacement, which no joint of a scene can",
            kind);
    const JointConversion joint{c, s, I, J};
    const std::string name = c.name(c.joint_names, s);
    c.count(fmt::format("{} {}", s.keyword, kind));
    if (s.is("JOINT")) leave_out_friction(c, s);
    const auto entry =
        joint.put(name, *std::ranges::find(joints_of_adams, kind, &JointOfAdams::flag));
    if (kind == about_z.flag) joint.put(c.joint_names.take(name + ".about"), about_z);
    if (s.is("JOINT")) c.joints[s.id] = {kind, entry, I.statement->id, J.statement->id};
}

// k DM(i, j) + c = 0 is a rigid link of length -c/k; k D*(i, j, rm) + c = 0 keeps i in a plane.
void convert_gcon(Conversion& c, const Statement& s) {
    const std::string* text = s.expression("FUNCTION");
    if (!text) s.fail("FUNCTION is missing");
    s.mark_read("I");  // where ADAMS shows the reaction
    const Value value = c.function(*text);
    if (!value.is_known()) return c.miss(s, value.unknown);
    if (value.of_time || value.curves.size() || value.linear.size() != 1)
        return c.miss(s, "a constraint other than of one distance or one displacement");
    const auto& [measure, k] = *value.linear.begin();
    const double offset = -value.constant / k * c.geometry.units.length;
    if (measure.j == 0)
        return c.miss(s, "measured in the global frame, without a marker on ground");
    const Marker &I = c.marker(s, measure.i), &J = c.marker(s, measure.j);
    if (!c.is_between_two(s, I, J)) return;
    const JointConversion joint{c, s, I, J};
    const std::string name = c.name(c.joint_names, s);
    if (measure.kind == Measure::Kind::DM) {
        const double drawn = joint.separation().norm();
        if (!(offset > 0) || !(drawn > 0)) return c.miss(s, "a distance that is zero or negative");
        c.count("GCON of a distance");
        Fields fields = joint.fields("distance").add("from", c.point(I)).add("to", c.point(J));
        if (std::abs(offset - drawn) > 1e-9 * c.geometry.size) {
            fields.add("length", computed(offset, c.geometry.size));
            c.warn(s, "the markers are {:.6g} {} apart in the file, and constrained to {:.6g}",
                   drawn, c.geometry.units.length_name, offset);
        }
        joint.put(name, fields);
        return;
    }
    const int axis = static_cast<int>(measure.kind) - static_cast<int>(Measure::Kind::DX);
    if (axis > 2 || measure.rm == 0 || c.marker(s, measure.rm).part != J.part)
        return c.miss(s,
                      "a constraint other than of a distance, or of a displacement in the axes "
                      "of its second marker");
    const Vector3d normal = c.marker(s, measure.rm).axis(axis);
    joint.require_small(std::abs(normal.dot(joint.separation()) - offset),
                        "the constraint is off by");
    c.count("GCON of a displacement");
    joint.in_plane(name, normal);
}

// ---- Motions. ADAMS measures from where I and J coincide, a scene from the design position.

// The displacement of a MOTION over c.times; none if it is not known.
struct Displacement {
    std::vector<double> path = {};  // one value if it does not change
    double least = 0, most = 0;
    bool from_design = false;  // given as a velocity: it starts at the design position
};

std::optional<Displacement> displacement(Conversion& c, const Statement& s) {
    const std::string* text = s.expression("FUNCTION");
    if (!text) s.fail("FUNCTION is missing");
    const bool is_velocity = s.has("VELOCITY"), is_acceleration = s.has("ACCELERATION");
    s.has("DISPLACEMENT");
    const TimeFunction f = c.time_function(*text);
    if (!f.first.is_constant()) {
        c.miss(s, f.first.is_known() ? "a motion that depends on displacements"
                                     : "its motion: " + f.first.unknown);
        return std::nullopt;
    }
    if (!is_velocity && !is_acceleration) return Displacement{f.path, f.least, f.most, false};
    if (!f.varies() && f.least == 0) return Displacement{{0}, 0, 0, true};
    if (is_velocity && !f.varies()) {
        Displacement result{.from_design = true};
        for (const double time : c.times) result.path.push_back(f.least * time);
        result.least = std::min(0.0, result.path.back());
        result.most = std::max(0.0, result.path.back());
        return result;
    }
    if (c.options.drop_dynamics)
        c.leave_out(s, "by --drop dynamics: the coordinate remains free");
    else
        c.miss(s,
               "a motion with a variable velocity or an acceleration (--drop dynamics "
               "leaves the coordinate free)");
    return std::nullopt;
}

// Adds the drive of a joint. `scale`: scene units per unit of the file; `drawn`: the file's displacement at
// the design position [length of the scene, rad].
void drive(Conversion& c, const Statement& s, const std::string& joint, const Displacement& motion,
           double scale, double drawn) {
    const bool is_angle = s.has("JOINT") && s.has("ROTATIONAL");
    const double start = motion.path[0] * scale;
    double offset = 0;  // to add to the file's displacement to count from the design position
    if (!motion.from_design) {
        offset = -drawn;  // of equivalent angles the closest to zero
        if (is_angle) offset = std::remainder(start + offset, 2 * std::numbers::pi) - start;
        if (std::abs(start + offset) <= 1e-9 * (is_angle ? 1 : c.geometry.size))
            offset = -start;  // the motion begins at the design position
    }
    Drive drive{.quantity = "joints." + joint, .from = s.place()};
    for (const double x : motion.path) drive.path.push_back(x * scale + offset);
    drive.least = motion.least * scale + offset;
    drive.most = motion.most * scale + offset;
    c.drives.push_back(std::move(drive));
    c.count("MOTION");
}

// Adds `held: true` to a joint.
void hold(Conversion& c, std::size_t entry) {
    std::string& fields = c.draft.joints[entry].fields;
    if (!fields.ends_with(", held: true}")) fields.replace(fields.size() - 1, 1, ", held: true}");
}

void convert_motion_of_joint(Conversion& c, const Statement& s,
                             const std::optional<Displacement>& motion) {
    const int id = s.id_of("JOINT");
    const auto found = c.joints.find(id);
    if (found == c.joints.end()) {
        if (std::ranges::none_of(c.data.statements, [&](const Statement& other) {
                return other.is("JOINT") && other.id == id;
            }))
            s.fail("there is no JOINT/{}", id);
        return c.miss(s, "JOINT/{} is not in the scene", id);
    }
    if (!motion) return;
    const WrittenJoint& joint = found->second;
    const JointConversion ends{c, s, c.marker(s, joint.i), c.marker(s, joint.j)};
    const bool rotates = s.has("ROTATIONAL");
    const double length = c.geometry.units.length, along = ends.J.axis(2).dot(ends.separation());
    std::string name = c.draft.joints[joint.entry].name;
    if (rotates && (joint.kind == "REVOLUTE" || joint.kind == "CYLINDRICAL")) {
        hold(c, joint.entry);
        drive(c, s, name, *motion, 1, angle_about_z(ends.I, ends.J));
    } else if (!rotates && joint.kind == "TRANSLATIONAL") {
        hold(c, joint.entry);
        drive(c, s, name, *motion, length, along);
    } else if (!rotates && joint.kind == "CYLINDRICAL") {
        name = c.name(c.joint_names, s);
        ends.in_plane(name, ends.J.axis(2));
        drive(c, s, name, *motion, length, along);
    } else {
        s.fail("{} of a {} joint, which does not have this coordinate",
               rotates ? "ROTATIONAL" : "TRANSLATIONAL", joint.kind);
    }
}

void convert_motion(Conversion& c, const Statement& s) {
    if (c.drives.size() >= max_motions) s.fail("more than {} motions", max_motions);
    const auto motion = displacement(c, s);
    if (!s.has("ROTATIONAL")) s.has("TRANSLATIONAL");
    if (s.has("JOINT")) return convert_motion_of_joint(c, s, motion);
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    int axis = -1;
    for (int k = 0; k < 3; ++k)
        if (s.has(std::string(1, "XYZ"[k]))) axis = k;
    if (axis < 0)
        return c.miss(s,
                      "a motion of an angle between two markers; only the angle of a joint can "
                      "be driven");
    if (!motion || !c.is_between_two(s, I, J)) return;
    const JointConversion ends{c, s, I, J};
    const std::string name = c.name(c.joint_names, s);
    ends.in_plane(name, J.axis(axis));
    drive(c, s, name, *motion, c.geometry.units.length, J.axis(axis).dot(ends.separation()));
}

// COUPLER: Σ scale · displacement = 0 for two or three joints. A scene has no such joint. If MOTIONs prescribe
// all displacements but one, that one is driven in proportion: the same motion, but without the effort.
void convert_coupler(Conversion& c, const Statement& s) {
    const auto joints = s.ids("JOINTS");
    const auto scales = s.numbers("SCALES", 1, 3);
    if (joints.size() < 2 || joints.size() > 3) s.fail("JOINTS: two or three are needed");
    if (s.has("FUNCTION")) return c.miss(s, "it couples by a user-written function");
    // One scale may be missing: that of the first joint is then 1.
    std::vector<double> scale = scales;
    if (scale.size() == joints.size() - 1) scale.insert(scale.begin(), 1);
    if (scale.size() != joints.size())
        s.fail("SCALES: {} for {} joints", scales.size(), joints.size());
    for (const int id : joints)
        if (!c.joints.contains(id)) return c.miss(s, "JOINT/{} is not in the scene", id);
    const auto unit = [&](const WrittenJoint& joint) {  // scene units per unit of the file
        return joint.kind == "TRANSLATIONAL" ? c.geometry.units.length : 1;
    };
    const auto quantity = [&](const WrittenJoint& joint) {
        return "joints." + c.draft.joints[joint.entry].name;
    };
    std::size_t free = joints.size();
    std::vector<double> sum{0};
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const WrittenJoint& joint = c.joints.at(joints[k]);
        const auto found = std::ranges::find(c.drives, quantity(joint), &Drive::quantity);
        if (found == c.drives.end()) {
            if (std::exchange(free, k) == joints.size()) continue;
            return c.miss(
                s, "it couples joints that no MOTION prescribes, which no joint of a scene can");
        }
        if (sum.size() < found->path.size()) sum.resize(found->path.size(), sum[0]);
        for (std::size_t n = 0; n < sum.size(); ++n)
            sum[n] += scale[k] * found->path[std::min(n, found->path.size() - 1)] / unit(joint);
    }
    if (free == joints.size()) return c.miss(s, "it couples joints that MOTIONs already prescribe");
    const WrittenJoint& joint = c.joints.at(joints[free]);
    if (joint.kind != "REVOLUTE" && joint.kind != "TRANSLATIONAL")
        return c.miss(s, "it couples a {} joint, which does not have exactly one coordinate",
                      joint.kind);
    if (scale[free] == 0) s.fail("SCALES: zero for a joint without a MOTION");
    hold(c, joint.entry);
    Drive drive{.quantity = quantity(joint), .path = sum, .from = s.place()};
    for (double& x : drive.path) x *= -unit(joint) / scale[free];
    drive.least = std::ranges::min(drive.path);
    drive.most = std::ranges::max(drive.path);
    c.warn(s,
           "{} is driven in proportion: it has the coupler's motion, but its reaction is that of "
           "a separate drive",
           drive.quantity);
    c.drives.push_back(std::move(drive));
    c.count("COUPLER");
}

}  // namespace

double angle_about_z(const Marker& I, const Marker& J) {
    return std::atan2(I.axis(0).dot(J.axis(1)), I.axis(0).dot(J.axis(0)));
}

void convert_joints(Conversion& c) {
    const auto each = [&](std::string_view keywords, const auto& convert) {
        for (const Statement& s : c.data.statements)
            if (s.is(keywords)) convert(c, s);
    };
    each("JOINT JPRIM GCON", [](Conversion& all, const Statement& s) {
        s.is("GCON") ? convert_gcon(all, s) : convert_joint(all, s);
    });
    each("MOTION", convert_motion);
    each("COUPLER", convert_coupler);
}

}  // namespace elastocheck::importer::adm
