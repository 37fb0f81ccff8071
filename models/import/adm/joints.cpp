// Converts ADAMS joints and their motions.
//
// I and J of a joint coincide, or are in line, in the assembled model. A dataset has its parts at
// the design position, with the printed digits. A misalignment within round-off is removed by using
// I's position, a larger one is reported, and an unassembled model is rejected.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "models/import/adm/conversion.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::adm {
namespace {

using Eigen::Vector3d;

constexpr double round_off = 1e-6;  // of the model's size, or radians: not reported
constexpr std::size_t most_motions = 10'000;
constexpr double assembled = 1e-2;  // larger misalignment: rejected

// Arguments of a joint's friction: coefficients, torques, and the geometry of the contact.
constexpr const char* of_friction[] = {"FRICTION",
                                       "MAXFRIC",
                                       "MU1",
                                       "MU_DYN_ROT",
                                       "MU_STAT_ROT",
                                       "MAX_FRIC_ROT",
                                       "MU_DYN_TRANS",
                                       "MU_STAT_TRANS",
                                       "MAX_FRIC_TRANS",
                                       "DELTA_V",
                                       "INNER_RADIUS",
                                       "OUTER_RADIUS",
                                       "HEIGHT",
                                       "WIDTH",
                                       "PRELOAD_RADIAL",
                                       "PRELOAD_AXIAL",
                                       "MAXIMUM_DEFORMATION",
                                       "IMPLICIT"};
const Shape joint_shape = [] {
    Shape shape{{"REVOLUTE", "CYLINDRICAL", "TRANSLATIONAL", "SPHERICAL", "FIXED", "PLANAR",
                 "HOOKE", "UNIVERSAL", "CONVEL", "RACKPIN", "SCREW"},
                {"I", "J", "IC", "ICTRAN", "ICROT", "PD", "PITCH"},
                {}};
    std::ranges::copy(of_friction, std::back_inserter(shape.values));
    return shape;
}();
const Shape jprim_shape{
    {"ATPOINT", "INLINE", "INPLANE", "ORIENTATION", "PARALLEL_AXES", "PERPENDICULAR"},
    {"I", "J"},
    {}};
const Shape gcon_shape{{}, {"I"}, {"FUNCTION"}};
const Shape coupler_shape{{}, {"JOINTS", "TYPE", "SCALES"}, {"FUNCTION"}};

struct JointConversion {
    Conversion& c;
    const Statement& s;
    const Arguments& at;
    const Marker& I;
    const Marker& J;

    SourceLocation place() const { return s.place(); }
    Vector3d axis(const Marker& m, int k) const { return m.pose.A.col(k); }

    void require_small(double off, double scale, const std::string& what,
                       const std::string& unit) const {
        if (off <= round_off * scale) return;
        const std::string misalignment = fmt::format("{} {:.3g} {}", what, off, unit);
        if (!(off <= assembled * scale))
            at.fail(misalignment +
                    ": the parts do not meet in the file; write the file after the assembly of the "
                    "model");
        c.warn(s, misalignment + " in the file; in the scene they coincide");
    }
    void require_small_angle(double angle, const std::string& what) const {
        const double degree = std::numbers::pi / 180;
        require_small(angle / degree, 1 / degree, what, "deg");
    }
    void require_meeting() const {
        require_small((I.pose.r - J.pose.r).norm(), c.geometry.size, "I and J are apart by",
                      c.geometry.units.length_name);
    }
    void require_on_line() const {
        const Vector3d d = I.pose.r - J.pose.r, z = axis(J, 2);
        require_small((d - z * z.dot(d)).norm(), c.geometry.size, "I is off the axis of J by",
                      c.geometry.units.length_name);
    }
    void require_in_plane() const {
        require_small(std::abs(axis(J, 2).dot(I.pose.r - J.pose.r)), c.geometry.size,
                      "I is off the plane of J by", c.geometry.units.length_name);
    }
    void require_parallel(int k, bool either_way = true) const {
        const double cosine = axis(I, k).dot(axis(J, k));
        const double angle =
            std::atan2(axis(I, k).cross(axis(J, k)).norm(), either_way ? std::abs(cosine) : cosine);
        require_small_angle(angle, fmt::format("axes {} of I and J are apart by", "xyz"[k]));
        if (cosine < 0)
            c.warn(s, fmt::format("axes {} of I and J point in opposite "
                                  "directions; in the scene they are one line",
                                  "xyz"[k]));
    }
    // Two perpendicular directions; the second is made exactly perpendicular.
    std::pair<Vector3d, Vector3d> perpendicular(const Vector3d& u, const Vector3d& v) const {
        require_small_angle(std::abs(std::asin(std::clamp(u.dot(v), -1.0, 1.0))),
                            "the axes deviate from the right angle by");
        return {u, (v - u.dot(v) * u).normalized()};
    }

    std::size_t put(const std::string& name, Fields fields) const {
        c.draft.joints.push_back({name, fields.braced(), place()});
        return c.draft.joints.size() - 1;
    }
    Fields fields(const char* type) const {
        return Fields{}.add("type", type).add("bodies", c.pair(I.part, J.part));
    }
    std::size_t along(const std::string& name, const char* type, const char* key) const {
        return put(name, fields(type).add("at", c.point(I)).add(key, direction(axis(J, 2))));
    }
};

// A joint or primitive of ADAMS, by its flag, and what a scene has for it.
struct JointOfAdams {
    std::string_view flag;
    const char* type;  // in a scene
    void (JointConversion::*require_position)() const = nullptr;
    enum class Parallel { none, z, z_and_x, one_way } parallel = Parallel::none;
    const char* along = nullptr;  // its field for the axis z of J
    bool has_point = true;
    int axis_i = -1, axis_j = -1;  // of the markers, which the joint keeps perpendicular
};
using Parallel = JointOfAdams::Parallel;
constexpr auto meet = &JointConversion::require_meeting,
               on_line = &JointConversion::require_on_line,
               on_plane = &JointConversion::require_in_plane;
constexpr JointOfAdams joints_of_adams[] = {
    {"REVOLUTE", "revolute", meet, Parallel::z, "axis"},
    {"CYLINDRICAL", "cylindrical", on_line, Parallel::z, "axis"},
    {"TRANSLATIONAL", "translational", on_line, Parallel::z_and_x, "axis"},
    {"SPHERICAL", "spherical", meet},
    {"FIXED", "fixed", meet, Parallel::one_way},
    {"PLANAR", "planar", on_plane, Parallel::z, "normal"},
    {"HOOKE", "universal", meet, Parallel::none, nullptr, true, 0, 1},
    {"UNIVERSAL", "universal", meet, Parallel::none, nullptr, true, 2, 2},
    {"ATPOINT", "spherical", meet},
    {"INLINE", "in_line", on_line, Parallel::none, "axis"},
    {"INPLANE", "in_plane", on_plane, Parallel::none, "normal"},
    {"PARALLEL_AXES", "parallel", nullptr, Parallel::z, "axis", false},
    {"PERPENDICULAR", "perpendicular", nullptr, Parallel::none, nullptr, false, 2, 2},
    {"ORIENTATION", "parallel", nullptr, Parallel::one_way, "axis", false},
};
// Keeps ORIENTATION from turning about z.
constexpr JointOfAdams about_z{"ORIENTATION", "perpendicular", nullptr, Parallel::none,
                               nullptr,       false,           0,       1};

std::size_t write(const JointConversion& joint, const std::string& name, const JointOfAdams& kind) {
    const bool either_way = kind.parallel != Parallel::one_way;
    if (kind.require_position) (joint.*kind.require_position)();
    if (kind.parallel != Parallel::none) joint.require_parallel(2, either_way);
    if (kind.parallel == Parallel::z_and_x || kind.parallel == Parallel::one_way)
        joint.require_parallel(0, either_way);
    Fields fields = joint.fields(kind.type);
    if (kind.has_point) fields.add("at", joint.c.point(joint.I));
    if (kind.along) fields.add(kind.along, direction(joint.axis(joint.J, 2)));
    if (kind.axis_i >= 0) {
        const auto [u, v] =
            joint.perpendicular(joint.axis(joint.I, kind.axis_i), joint.axis(joint.J, kind.axis_j));
        fields.add("axis_i", triple(u)).add("axis_j", triple(v));
    }
    return joint.put(name, fields);
}

// Notes the arguments of friction, which a scene does not have.
void leave_out_friction(Conversion& c, const Statement& s, const Arguments& at) {
    std::string friction;
    for (const char* field : of_friction)
        if (at.has(field)) {
            at.mark_read(field);
            friction += (friction.empty() ? "" : ", ") + std::string(field);
        }
    if (friction.empty()) return;
    if (c.options.drop_dynamics) return c.leave_out(s, friction, "by --drop dynamics");
    c.miss(s, friction +
                  ": its friction also acts at rest, and a scene has no friction (--drop dynamics "
                  "leaves it out)");
}

// JOINT and JPRIM.
void convert_joint(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, s.keyword == "JOINT" ? joint_shape : jprim_shape);
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    if (!is_between_two(c, s, I, J, at)) return;
    const JointConversion joint{c, s, at, I, J};
    std::string kind;
    for (const std::string& flag : at.flags()) {
        if (!kind.empty())
            at.fail(fmt::format("is both {} and {}; exactly one type is needed", kind, flag));
        kind = flag;
    }
    if (kind.empty()) at.fail("has no type");
    if (kind == "CONVEL")
        return c.miss(s,
                      "CONVEL: a constant-velocity joint, which a scene does not have (a universal "
                      "joint transmits another angle)");
    if (kind == "RACKPIN" || kind == "SCREW")
        return c.miss(
            s, kind + ": it couples a rotation with a displacement, which no joint of a scene can");
    const std::string name = c.name(c.joint_names, s);
    c.count(s.keyword + " " + kind);
    if (s.keyword == "JOINT") leave_out_friction(c, s, at);
    const auto& found = *std::ranges::find(joints_of_adams, kind, &JointOfAdams::flag);
    const std::size_t entry = write(joint, name, found);
    if (kind == about_z.flag) write(joint, c.joint_names.take(name + ".about"), about_z);
    if (s.keyword == "JOINT") c.joints[s.id] = {kind, entry, I.statement->id, J.statement->id};
}

// k DM(i, j) + c = 0 is a rigid link of length -c/k; k D*(i, j, rm) + c = 0 keeps i in a plane.
void convert_gcon(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, gcon_shape);
    const std::string* text = at.expression("FUNCTION");
    if (!text) at.fail("FUNCTION is missing");
    at.mark_read("I");  // where ADAMS shows the reaction
    const Value value = c.function(*text);
    const auto miss = [&](const std::string& why) { c.miss(s, why); };
    if (!value.is_known()) return miss(value.unknown);
    if (value.of_time || value.curves.size() || value.linear.size() != 1)
        return miss("a constraint other than of one distance or one displacement");
    const auto& [measure, k] = *value.linear.begin();
    const double offset = -value.constant / k * c.geometry.units.length;
    if (measure.j == 0) return miss("measured in the global frame, without a marker on ground");
    const Marker &I = c.marker(at, measure.i), &J = c.marker(at, measure.j);
    if (!is_between_two(c, s, I, J, at)) return;
    const JointConversion joint{c, s, at, I, J};
    const std::string name = c.name(c.joint_names, s);
    if (measure.kind == Measure::Kind::DM) {
        const double drawn = (I.pose.r - J.pose.r).norm();
        if (!(offset > 0) || !(drawn > 0)) return miss("a distance that is zero or negative");
        c.count("GCON of a distance");
        Fields fields = joint.fields("distance").add("from", c.point(I)).add("to", c.point(J));
        if (std::abs(offset - drawn) > 1e-9 * c.geometry.size) {
            fields.add("length", computed(offset, c.geometry.size));
            c.warn(s, fmt::format(
                          "the markers are {:.6g} {} apart in the file, and constrained to {:.6g}",
                          drawn, c.geometry.units.length_name, offset));
        }
        joint.put(name, fields);
        return;
    }
    const int axis = static_cast<int>(measure.kind) - static_cast<int>(Measure::Kind::DX);
    if (axis > 2 || measure.rm == 0 || c.marker(at, measure.rm).part != J.part)
        return miss(
            "a constraint other than of a distance, or of a displacement in the axes of its second "
            "marker");
    const Vector3d normal = c.marker(at, measure.rm).pose.A.col(axis);
    joint.require_small(std::abs(normal.dot(I.pose.r - J.pose.r) - offset), c.geometry.size,
                        "the constraint is off by", c.geometry.units.length_name);
    c.count("GCON of a displacement");
    joint.put(name,
              joint.fields("in_plane").add("at", c.point(I)).add("normal", direction(normal)));
}

// ---- Motions. ADAMS measures from where I and J coincide, a scene from the design position.

// The displacement of a MOTION over c.times; none if it is not known.
struct Displacement {
    std::vector<double> path = {};  // one value if it does not change
    double least = 0, most = 0;
    bool from_design = false;  // given as a velocity: it starts at the design position
};

std::optional<Displacement> displacement(Conversion& c, const Statement& s, const Arguments& at) {
    const std::string* text = at.expression("FUNCTION");
    if (!text) at.fail("FUNCTION is missing");
    const bool is_velocity = at.has("VELOCITY"), is_acceleration = at.has("ACCELERATION");
    at.has("DISPLACEMENT");
    const Programme f = c.programme(*text);
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

double turn_of(const Marker& I, const Marker& J) {  // AZ
    return std::atan2(I.pose.A.col(0).dot(J.pose.A.col(1)), I.pose.A.col(0).dot(J.pose.A.col(0)));
}
// The equivalent angle closest to zero.
double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

void drive(Conversion& c, const Statement& s, const std::string& quantity, const Displacement& by,
           double scale, double drawn, bool is_angle) {
    double offset = 0;  // from the file's displacement to that from the design position
    if (!by.from_design) {
        offset = -drawn;
        if (is_angle) offset = wrapped(by.path[0] * scale + offset) - by.path[0] * scale;
        if (std::abs(by.path[0] * scale + offset) <= 1e-9 * (is_angle ? 1 : c.geometry.size))
            offset = -by.path[0] * scale;  // the motion begins at the design position
    }
    Drive drive{.quantity = quantity, .from = s.place()};
    for (const double x : by.path) drive.path.push_back(x * scale + offset);
    drive.least = by.least * scale + offset;
    drive.most = by.most * scale + offset;
    c.drives.push_back(std::move(drive));
}

void hold(Conversion& c, std::size_t entry) {
    std::string& fields = c.draft.joints[entry].fields;
    if (!fields.ends_with(", held: true}")) fields.replace(fields.size() - 1, 1, ", held: true}");
}

void convert_motion(Conversion& c, const Statement& s, const std::set<int>& in_the_file) {
    const Arguments at(c.data.file, s, motion_shape());
    if (c.drives.size() >= most_motions) at.fail(fmt::format("more than {} motions", most_motions));
    const auto by = displacement(c, s, at);
    const bool rotates = at.has("ROTATIONAL");
    if (!rotates) at.has("TRANSLATIONAL");
    const double length = c.geometry.units.length;
    if (at.has("JOINT")) {
        const auto found = c.joints.find(at.id("JOINT"));
        if (found == c.joints.end()) {
            if (!in_the_file.contains(at.id("JOINT")))
                at.fail(fmt::format("there is no JOINT/{}", at.id("JOINT")));
            c.miss(s, fmt::format("JOINT/{} is not in the scene", at.id("JOINT")));
            return;
        }
        if (!by) return;
        const WrittenJoint& joint = found->second;
        const Marker &I = c.marker(at, joint.i), &J = c.marker(at, joint.j);
        const Vector3d axis = J.pose.A.col(2);
        const std::string quantity = "joints." + c.draft.joints[joint.entry].name;
        if (rotates && (joint.kind == "REVOLUTE" || joint.kind == "CYLINDRICAL")) {
            hold(c, joint.entry);
            drive(c, s, quantity, *by, 1, turn_of(I, J), true);
        } else if (!rotates && joint.kind == "TRANSLATIONAL") {
            hold(c, joint.entry);
            drive(c, s, quantity, *by, length, axis.dot(I.pose.r - J.pose.r), false);
        } else if (!rotates && joint.kind == "CYLINDRICAL") {
            const JointConversion plane{c, s, at, I, J};
            const std::string name = c.name(c.joint_names, s);
            plane.along(name, "in_plane", "normal");
            drive(c, s, "joints." + name, *by, length, axis.dot(I.pose.r - J.pose.r), false);
        } else {
            at.fail(fmt::format("{} of a {} joint, which does not have this coordinate",
                                rotates ? "ROTATIONAL" : "TRANSLATIONAL", joint.kind));
        }
        c.count("MOTION");
        return;
    }
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    int axis = -1;
    for (int k = 0; k < 3; ++k)
        if (at.has(std::string(1, "XYZ"[k]))) axis = k;
    if (axis < 0) {
        c.miss(s,
               "a motion of an angle between two markers; only the angle of a joint can be driven");
        return;
    }
    if (!by || !is_between_two(c, s, I, J, at)) return;
    const JointConversion plane{c, s, at, I, J};
    const std::string name = c.name(c.joint_names, s);
    const Vector3d normal = J.pose.A.col(axis);
    plane.put(name,
              plane.fields("in_plane").add("at", c.point(I)).add("normal", direction(normal)));
    drive(c, s, "joints." + name, *by, length, normal.dot(I.pose.r - J.pose.r), false);
    c.count("MOTION");
}

// COUPLER: Σ scale · displacement = 0 for two or three joints. A scene has no such joint. If
// MOTIONs prescribe all displacements but one, that one is driven in proportion: the same motion,
// but without the effort.
void convert_coupler(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, coupler_shape);
    const auto joints = at.ids("JOINTS");
    const auto scales = at.numbers("SCALES", 1, 3);
    if (joints.size() < 2 || joints.size() > 3) at.fail("JOINTS: two or three are needed");
    const auto miss = [&](const std::string& why) { c.miss(s, why); };
    if (at.has("FUNCTION")) return miss("it couples by a user-written function");
    // For two joints one scale may be missing: that of the first is then 1.
    std::vector<double> scale = scales;
    if (scale.size() == joints.size() - 1) scale.insert(scale.begin(), 1);
    if (scale.size() != joints.size())
        at.fail(fmt::format("SCALES: {} for {} joints", scales.size(), joints.size()));
    std::vector<const WrittenJoint*> written;
    for (const int id : joints) {
        const auto found = c.joints.find(id);
        if (found == c.joints.end()) return miss(fmt::format("JOINT/{} is not in the scene", id));
        written.push_back(&found->second);
    }
    const auto unit = [&](const WrittenJoint& joint) {  // scene units per unit of the file
        return joint.kind == "TRANSLATIONAL" ? c.geometry.units.length : 1;
    };
    const auto quantity = [&](const WrittenJoint& joint) {
        return "joints." + c.draft.joints[joint.entry].name;
    };
    std::size_t free = joints.size();
    std::vector<double> sum{0};
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const auto found = std::ranges::find(c.drives, quantity(*written[k]), &Drive::quantity);
        if (found != c.drives.end()) {
            if (sum.size() < found->path.size()) sum.resize(found->path.size(), sum[0]);
            for (std::size_t n = 0; n < sum.size(); ++n)
                sum[n] +=
                    scale[k] * found->path[std::min(n, found->path.size() - 1)] / unit(*written[k]);
        } else if (free == joints.size())
            free = k;
        else
            return miss(
                "it couples joints that no MOTION prescribes, which no joint of a scene can");
    }
    if (free == joints.size()) return miss("it couples joints that MOTIONs already prescribe");
    const WrittenJoint& joint = *written[free];
    if (joint.kind != "REVOLUTE" && joint.kind != "TRANSLATIONAL")
        return miss(fmt::format("it couples a {} joint, which does not have exactly one coordinate",
                                joint.kind));
    if (scale[free] == 0) at.fail("SCALES: zero for a joint without a MOTION");
    hold(c, joint.entry);
    Drive drive{.quantity = quantity(joint), .path = sum, .from = s.place()};
    for (double& x : drive.path) x *= -unit(joint) / scale[free];
    std::tie(drive.least, drive.most) =
        std::pair(std::ranges::min(drive.path), std::ranges::max(drive.path));
    c.drives.push_back(std::move(drive));
    c.count("COUPLER");
    c.warn(s, fmt::format("{} is driven in proportion: it has the coupler's motion, but "
                          "its reaction is that of a separate drive",
                          quantity(joint)));
}

}  // namespace

const Shape& motion_shape() {
    static const Shape shape{{"TRANSLATIONAL", "ROTATIONAL", "X", "Y", "Z", "B1", "B2", "B3",
                              "DISPLACEMENT", "VELOCITY", "ACCELERATION"},
                             {"JOINT", "I", "J", "ICDISP", "ICVEL"},
                             {"FUNCTION"}};
    return shape;
}

void convert_joints(Conversion& c) {
    for (const Statement& s : c.data.statements) {
        if (s.keyword == "JOINT" || s.keyword == "JPRIM") convert_joint(c, s);
        if (s.keyword == "GCON") convert_gcon(c, s);
    }
    std::set<int> in_the_file;
    for (const Statement& s : c.data.statements)
        if (s.keyword == "JOINT") in_the_file.insert(s.id);
    for (const Statement& s : c.data.statements)
        if (s.keyword == "MOTION") convert_motion(c, s, in_the_file);
    for (const Statement& s : c.data.statements)
        if (s.keyword == "COUPLER") convert_coupler(c, s);
}

}  // namespace elastocheck::importer::adm
