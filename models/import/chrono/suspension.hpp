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

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Force of a stop in Chrono::Vehicle ("from an ADAMS/Car example") over its penetration [m, N];
// constant beyond the last row.
extern const Rows stop_table;

// Joints of Chrono that a template may replace by a bushing.
enum class Kind { revolute, spherical, universal };

class Suspension {
  public:
    Suspension(const reader::Cursor& file, const Options& options, Draft& draft)
        : file_(file), options_(options), draft_(draft) {}

    const reader::Cursor& file() const { return file_; }
    Draft& draft() { return draft_; }

    bool one_freedom = false;  // the wheels share one freedom: one is driven, the other follows

    // ---- The side. Mirrored scenes are written with left entries only.
    int side = +1;
    std::string sided(const std::string& name) const {
        return name + (side > 0 ? "_left" : "_right");
    }
    Vector3d mirrored(Vector3d v) const {
        if (side < 0) v.y() = -v.y();
        return v;
    }

    // ---- Reading. Fields are named "Part/Field".
    reader::Cursor at(const char* path) const;
    bool has(const char* path) const;
    Vector3d left(const char* path) const;  // as in the file
    Vector3d point(const char* path) const { return mirrored(left(path)); }
    double real(const char* path) const { return at(path).number(); }
    SourceLocation place(const char* path) const;

    // ---- Writing. A body or a hardpoint is named by the caller, sided or not.
    // Midpoint of two points of the file, named `name` on its side. Both points stay hardpoints,
    // "name.first" and "name.second".
    Vector3d midpoint(const std::string& name, const char* first, const char* first_path,
                      const char* second, const char* second_path);
    std::string hardpoint(const std::string& name, const Vector3d& p, const char* path);
    void body(const std::string& name, const Vector3d& com, const char* part,
              const char* mass = "Mass");
    void joint(const std::string& name, const char* type, const std::string& i,
               const std::string& j, Fields fields, const SourceLocation& from);
    void spherical(const std::string& name, const std::string& i, const std::string& j,
                   const Vector3d& p, const char* path);
    // x is fixed to body i and y to body j.
    void universal(const std::string& name, const std::string& i, const std::string& j,
                   const Vector3d& p, const Vector3d& x, const Vector3d& y, const char* path);
    void revolute(const std::string& name, const std::string& i, const std::string& j,
                  const Vector3d& p, const Vector3d& axis, const char* path);
    void fixed(const std::string& name, const std::string& i, const std::string& j,
               const Vector3d& p, const char* path);
    void distance(const std::string& name, const std::string& i, const Vector3d& from,
                  const char* path_i, const std::string& j, const Vector3d& to, const char* path_j);
    void in_plane(const std::string& name, const std::string& i, const std::string& j,
                  const Vector3d& p, const Vector3d& normal, const SourceLocation& from);

    // A joint of Chrono: with "Bushing Data" under `data` a bushing at its frame, else a joint of
    // the given kind.
    void joint_or_bushing(Kind kind, const std::string& name, const std::string& body1,
                          const std::string& body2, const Vector3d& p, const Matrix3d& frame,
                          const char* path, const std::optional<reader::Cursor>& data);
    // A translational spring and damper from `i` (on the chassis) to `j`.
    void tsda(const std::string& name, const std::string& i, const Vector3d& from,
              const std::string& j, const Vector3d& to, const reader::Cursor& data);
    // A rotational spring and damper of `j` relative to `i`.
    void rsda(const std::string& name, const std::string& i, const std::string& j,
              const Vector3d& p, const Vector3d& axis, const reader::Cursor& data);
    void torsion(const std::string& name, const std::string& i, const std::string& j,
                 const Vector3d& p, const Vector3d& axis, double rate, double moment,
                 const char* path);

    // The spindle, held on `carrier`, and the wheel on it.
    void spindle(const std::string& carrier);
    // A link between a spherical and a universal joint, or a distance if it has no mass.
    void tierod(const char* part, const char* chassis_end, const char* outer_end,
                const std::string& on_outer);
    void link(const std::string& name, const char* part, const Vector3d& com, const std::string& i,
              const Vector3d& at_i, const std::string& j, const Vector3d& at_j, bool universal_at_j,
              const char* path_i, const char* path_j);

    // Notes a field without influence, with the reason. ignore() warns, for a field that a user may
    // expect to have an influence.
    void leave_out(const reader::Cursor& field, const std::string& why);
    void ignore(const reader::Cursor& field, const std::string& why);
    // Notes every field that was neither read nor left out: as without influence if its name is
    // known to be so, else as missing.
    void report_unread();

  private:
    enum class Law { none, damper, linear, curve, map };
    Law law_of(const reader::Cursor& data);
    static Rows rows_of(const reader::Cursor& curve, double offset, double preload);
    static Rows map_at_rest(const reader::Cursor& data, double offset, double preload);
    static void require_rising(const reader::Cursor& at, const Rows& rows);
    void torsion(const std::string& name, const std::string& i, const std::string& j,
                 const Vector3d& p, const Vector3d& axis, const Fields& law,
                 const SourceLocation& from);

    const reader::Cursor& file_;
    const Options& options_;
    Draft& draft_;
    Names body_names_, joint_names_, element_names_;
};

// Right-handed frame with the third axis along w and the second closest to w × towards.
Matrix3d frame_along(const Vector3d& w, const Vector3d& towards);

}  // namespace elastocheck::importer::chrono
