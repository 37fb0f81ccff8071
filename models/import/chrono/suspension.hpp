// Building blocks of the Chrono::Vehicle suspension templates on one side of the car.
// Parts, joints, springs and bushings. The file gives the left side; the right side has -y.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/import/curves.hpp"
#include "models/import/import.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::importer::chrono {

using Eigen::Matrix3d, Eigen::Vector3d;

inline constexpr std::size_t largest_json = 1 << 20;  // [bytes]

// A parsed file, RFC 8259 with // and /* */ comments, as a tree as of YAML, so that error messages
// name file, line and field. Its cursors refer to it.
struct JsonFile {
    // Throws SceneError "file:line: ..." for invalid JSON, duplicate keys, excessive nesting, and
    // anything but an object.
    JsonFile(std::string_view text, const std::string& file);
    JsonFile(const JsonFile&) = delete;

    std::string name;
    reader::Value tree;
    mutable std::vector<Number> numbers;
    mutable reader::Accesses accesses;
    reader::Cursor root;
};

// Force of a stop in Chrono::Vehicle ("from an ADAMS/Car example") over its penetration [m, N];
// constant beyond the last row.
extern const Rows stop_table;

// Joints of Chrono that a template may replace by a bushing.
enum class Kind { revolute, spherical, universal };

// A position, and the field of the file that it is from.
struct FilePoint : Vector3d {
    FilePoint(const Vector3d& p, std::string field) : Vector3d(p), path(std::move(field)) {}
    std::string path;
};

class Suspension {
  public:
    Suspension(const reader::Cursor& file, const Options& options, Draft& draft)
        : file_(file), options_(options), draft_(draft) {}

    const reader::Cursor& file() const { return file_; }
    Draft& draft() { return draft_; }
    const Options& options() const { return options_; }

    bool one_freedom = false;  // the wheels share one freedom: one is driven, the other follows

    // ---- The rest of the vehicle.
    std::string steering_link = "ground";
    bool is_steered = false;  // something is attached to the steering link
    const std::string& steering() {
        is_steered = true;
        return steering_link;
    }
    // The frame of the file in that of the scene.
    Vector3d origin = Vector3d::Zero();
    Matrix3d turn = Matrix3d::Identity();

    // ---- The side. Mirrored scenes are written with left entries only.
    int side = +1;
    std::string sided(const std::string& name) const {
        return name + (side > 0 ? "_left" : "_right");
    }
    // The names of bodies, joints and hardpoints below may end in *, which stands for the side.
    std::string on_side(const std::string& name) const {
        return name.ends_with('*') ? sided(name.substr(0, name.size() - 1)) : name;
    }
    Vector3d mirrored(Vector3d v) const {
        if (side < 0) v.y() = -v.y();
        return v;
    }

    // ---- Reading. Fields are named "Part/Field".
    reader::Cursor at(const std::string& path) const { return *find(path, true); }
    std::optional<reader::Cursor> optional(const std::string& path) const {
        return find(path, false);
    }
    bool has(const std::string& path) const { return optional(path).has_value(); }
    FilePoint point(const std::string& path) const;
    FilePoint placed(const Vector3d& p, const std::string& path) const {
        return {mirrored(origin + turn * p), path};
    }
    double real(const std::string& path) const { return at(path).number(); }
    SourceLocation place(const std::string& path) const { return {at(path).value->line, path}; }

    // ---- Writing.
    // The midpoint of two points of the file. Both stay hardpoints, "name.first" and "name.second".
    FilePoint midpoint(const std::string& name, const std::string& first, const FilePoint& a,
                       const std::string& second, const FilePoint& b);
    // At a position, in the field `path`; without a field it is calculated.
    std::string hardpoint(const std::string& name, const Vector3d& p, const std::string& path);
    std::string hardpoint(const std::string& name, const FilePoint& p) {
        return hardpoint(name, p, p.path);
    }
    void body(const std::string& name, const Vector3d& com, const std::string& part,
              const char* mass = "Mass");
    void body(const std::string& name, const std::string& part) {
        body(name, point(part + "/COM"), part);
    }
    void joint(const std::string& name, const char* type, const std::string& i,
               const std::string& j, const Fields& fields, const SourceLocation& from);
    // At a point of the file; `fields` follow it.
    void joint(const std::string& name, const char* type, const std::string& i,
               const std::string& j, const FilePoint& at, const Fields& fields = {});
    void spherical(const std::string& name, const std::string& i, const std::string& j,
                   const FilePoint& at) {
        joint(name, "spherical", i, j, at);
    }
    void spherical(const std::string& name, const std::string& i, const std::string& j,
                   const std::string& path) {
        joint(name, "spherical", i, j, point(path));
    }
    // x is fixed to body i and y to body j.
    void universal(const std::string& name, const std::string& i, const std::string& j,
                   const FilePoint& at, const Vector3d& x, const Vector3d& y);
    void universal(const std::string& name, const std::string& i, const std::string& j,
                   const FilePoint& at, const Matrix3d& frame) {
        universal(name, i, j, at, frame.col(0), frame.col(1));
    }
    void revolute(const std::string& name, const std::string& i, const std::string& j,
                  const FilePoint& at, const Vector3d& axis) {
        joint(name, "revolute", i, j, at, Fields{}.add("axis", direction(axis.normalized())));
    }
    void distance(const std::string& name, const std::string& i, const FilePoint& from,
                  const std::string& j, const FilePoint& to);
    void in_plane(const std::string& name, const std::string& i, const std::string& j,
                  const FilePoint& p, const Vector3d& normal);

    // A joint of Chrono: with `data`, its "Bushing Data", a bushing at its frame, else a joint of
    // the given kind.
    void joint_or_bushing(Kind kind, const std::string& name, const std::string& body1,
                          const std::string& body2, const FilePoint& at, const Matrix3d& frame,
                          const std::optional<reader::Cursor>& data);
    // A translational spring and damper from `i` (on the chassis) to `j`.
    void tsda(const std::string& name, const std::string& i, const Vector3d& from,
              const std::string& j, const Vector3d& to, const reader::Cursor& data);
    // A rotational spring and damper of `j` relative to `i`.
    void rsda(const std::string& name, const std::string& i, const std::string& j,
              const Vector3d& p, const Vector3d& axis, const reader::Cursor& data);
    void torsion(const std::string& name, const std::string& i, const std::string& j,
                 const FilePoint& at, const Vector3d& axis, double rate, double moment = 0);

    // The spindle, held on `carrier`, and the wheel on it.
    void spindle(const std::string& carrier);
    // A link between a spherical and a universal joint, or a distance if it has no mass.
    void tierod(const std::string& chassis_end, const std::string& outer_end,
                const std::string& on_outer);
    // A body from a spherical joint on `i` to one on `j`, or to a universal joint.
    enum class OuterEnd { spherical, universal };
    void link(const std::string& name, const std::string& part, const std::string& i,
              const FilePoint& at_i, const std::string& j, const FilePoint& at_j,
              OuterEnd outer = OuterEnd::spherical);

    // Notes a field without influence, with the reason. ignore() warns, for a field that a user may
    // expect to have an influence.
    void leave_out(const reader::Cursor& field, const std::string& why);
    void ignore(const std::optional<reader::Cursor>& field, const std::string& why);
    // Notes every field that was neither read nor left out: as without influence if its name is
    // known to be so, else as missing.
    void report_unread();

  private:
    std::optional<reader::Cursor> find(const std::string& path, bool required) const;
    enum class Law { none, damper, linear, curve, map };
    Law law_of(const reader::Cursor& data);
    void add_stops(const reader::Cursor& data, double drawn, bool alone, Fields& fields);
    void torsion(const std::string& name, const std::string& i, const std::string& j,
                 const Vector3d& p, const Vector3d& axis, const Fields& law,
                 const SourceLocation& from);

    const reader::Cursor& file_;
    const Options& options_;
    Draft& draft_;
    Names body_names_, joint_names_, element_names_;
};

// A section of templates.yaml.
const reader::Value& templates_section(std::string_view name);

// Three numbers of the file.
Vector3d vector(const reader::Cursor& at);
// A rotation by four numbers, a quaternion.
Matrix3d rotation(const reader::Cursor& at);
// A number of an object; 0 if it does not have it.
double number_or_zero(const reader::Cursor& object, const std::string& key);

// Right-handed frame with the third axis along w and the second closest to w × towards.
Matrix3d frame_along(const Vector3d& w, const Vector3d& towards);

// Adds a suspension of any template to the draft of `s`.
struct Made {
    bool mirrors;               // the left side is written, the scene mirrors it
    std::string antiroll_body;  // "lower_arm*", of one that mirrors; empty: unknown
};
Made make(Suspension& s);

// Adds the branch of travel, and that of roll.
void add_travel(const Suspension& s, bool roll, Draft& draft);

// The axle in `options` of a vehicle, with its steering and anti-roll bar from their files, which are
// in the data folder, the closest folder above the vehicle's that has the file of the suspension.
// Throws SceneError "file:line: ...".
Draft import_vehicle(const JsonFile& vehicle, const Options& options);

}  // namespace elastocheck::importer::chrono
