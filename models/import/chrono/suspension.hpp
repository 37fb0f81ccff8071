// Building blocks of the Chrono::Vehicle suspension templates: parts, joints, springs and bushings on one
// side of the car. The file gives the left side; the right side has -y.
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

// A position in the axes of the scene, and its place in the file.
struct FilePoint : Vector3d {
    FilePoint(const Vector3d& p, SourceLocation place, std::string how = {})
        : Vector3d(p), from(std::move(place)), calculated(std::move(how)) {}
    SourceLocation from;
    std::string calculated;  // "midpoint of A and B"; empty: it is a field of the file
};

// The name of a joint or element, and the bodies that it connects.
struct Between {
    std::string name, i, j;
};

class Suspension {
  public:
    Suspension(const reader::Cursor& file, const Options& options, Draft& draft)
        : file_(file), options_(options), draft_(draft) {}

    const reader::Cursor& file() const { return file_; }
    Draft& draft() { return draft_; }
    const Options& options() const { return options_; }

    bool one_freedom = false;  // both wheels share one degree of freedom: the left one is driven

    // ---- The rest of the vehicle: the bodies for "steering link" and "bar body" of templates.yaml.
    std::string steering_link = "ground", antiroll_body = {};
    bool is_steered = false;          // something is attached to the steering link
    std::string steering_joint = {};  // of a steering: the joint that moves its link,
    double steering_range = 0;        // and how far to each side [m] or [rad]
    // Frame of the file in the axes of the scene.
    Vector3d origin = Vector3d::Zero();
    Matrix3d turn = Matrix3d::Identity();

    // ---- The side. Mirrored scenes are written with left entries only.
    int side = +1;
    Vector3d mirrored(Vector3d v) const {
        if (side < 0) v.y() = -v.y();
        return v;
    }
    // Name in the scene of a body, joint or hardpoint of a template: * is the side; "steering link" and "bar
    // body" are the bodies above; "knuckle beside FIELD" is the one on the side of that point.
    std::string on_side(const std::string& name);

    // ---- Reading. Fields are named "Part/Field".
    reader::Cursor at(const std::string& path) const { return *find(path, true); }
    std::optional<reader::Cursor> optional(const std::string& path) const {
        return find(path, false);
    }
    bool has(const std::string& path) const { return optional(path).has_value(); }
    double real(const std::string& path) const { return at(path).number(); }
    double positive(const std::string& path) const;
    SourceLocation place(const std::string& path) const { return {at(path).value->line, path}; }
    // Points and vectors as templates.yaml describes them.
    FilePoint point(const std::string& words) const;
    Vector3d vector_of(const std::string& words) const;

    // ---- Writing.
    std::string hardpoint(const std::string& name, const FilePoint& p);
    void body(const std::string& name, const std::string& part, const Vector3d& com,
              const std::string& mass = "Mass");
    // `along`: the directions that a joint of the type has.
    void joint(const std::string& type, const Between& part, const FilePoint& at,
               const std::vector<Vector3d>& along = {}, bool held = false);
    void distance(const std::string& name, const std::string& i, const FilePoint& from,
                  const std::string& j, const FilePoint& to);
    // A spherical, revolute or universal joint of Chrono: with `data`, its "Bushing Data", a bushing
    // at its frame.
    void joint_or_bushing(const std::string& type, const Between& part, const FilePoint& at,
                          const Matrix3d& frame, const std::optional<reader::Cursor>& data);
    // A translational spring and damper from `i` (on the chassis) to `j`.
    void tsda(const std::string& name, const std::string& i, const Vector3d& from,
              const std::string& j, const Vector3d& to, const reader::Cursor& data);
    // A rotational spring and damper of `j` relative to `i`.
    void rsda(const std::string& name, const std::string& i, const std::string& j,
              const Vector3d& p, const Vector3d& axis, const reader::Cursor& data);
    void torsion(const Between& part, const FilePoint& at, const Vector3d& axis, const Fields& law);
    void torsion(const Between& part, const FilePoint& at, const Vector3d& axis, double rate,
                 double moment = 0);

    // The spindle, held on `carrier`, and the wheel on it.
    void spindle(const std::string& carrier);

    // Notes a field without influence, with the reason. ignore() warns, for a field that a user may
    // expect to have an influence.
    void leave_out(const reader::Cursor& field, const std::string& why);
    void ignore(const std::optional<reader::Cursor>& field, const std::string& why);
    // Notes every field that was neither read nor left out: as without influence if its name is
    // known to be so, else as missing.
    void report_unread();

  private:
    std::optional<reader::Cursor> find(const std::string& path, bool required) const;
    std::string pair(const std::string& i, const std::string& j) {
        const std::string first = on_side(i);
        return "[" + first + ", " + on_side(j) + "]";
    }
    enum class Law { none, damper, linear, curve, map };
    Law law_of(const reader::Cursor& data);
    void add_stops(const reader::Cursor& data, double drawn, bool alone, Fields& fields);

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

// Runs the steps of a template, of `section` of templates.yaml, and reports what they do not read.
// False for a template that the section does not have.
bool run_template(Suspension& s, std::string_view section);

// Adds a suspension of any template to the draft of `s`. Returns whether the scene mirrors it.
bool make(Suspension& s);

// Adds the branch of travel, and that of roll.
void add_travel(const Suspension& s, bool roll, Draft& draft);

// The axle in `options` of a vehicle, with its steering and anti-roll bar from their files, which are
// in the data folder, the closest folder above the vehicle's that has the file of the suspension.
// Throws SceneError "file:line: ...".
Draft import_vehicle(const JsonFile& vehicle, const Options& options);

}  // namespace elastocheck::importer::chrono
