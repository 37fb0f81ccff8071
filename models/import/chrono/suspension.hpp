// What the templates of Chrono::Vehicle are built of, on one side of the car: parts, joints, springs, and where Chrono puts
// bushings. The file gives the left side; the right one has y turned round.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "models/import/import.hpp"
#include "models/reader/cursor.hpp"

namespace elastocheck::importer::chrono {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Chrono's joints, as far as a template may have a bushing in their place.
enum class Kind { revolute, spherical, universal };

class Suspension {
  public:
    Suspension(const reader::Cursor& file, const Options& options, Draft& draft)
        : file_(file), options_(options), draft_(draft) {}

    const reader::Cursor& file() const { return file_; }
    Draft& draft() { return draft_; }

    bool one_freedom = false;  // of both wheels together: one is driven, the other follows

    // ---- The side. `left` alone makes what a mirror turns round.
    int side = +1;
    std::string sided(const std::string& name) const { return name + (side > 0 ? "_left" : "_right"); }
    Vector3d mirrored(Vector3d v) const {
        if (side < 0) v.y() = -v.y();
        return v;
    }

    // ---- Reading. Fields are named "Part/Field".
    reader::Cursor at(const char* path) const;
    bool has(const char* path) const;
    Vector3d left(const char* path) const;  // as the file has it
    Vector3d point(const char* path) const { return mirrored(left(path)); }
    double real(const char* path) const { return at(path).number(); }
    Place place(const char* path) const;

    // ---- Writing. A body or a hardpoint is named by the caller, sided or not.
    std::string hardpoint(const std::string& name, const Vector3d& p, const char* path);
    void body(const std::string& name, const Vector3d& com, const char* part, const char* mass = "Mass");
    void joint(const std::string& name, const char* type, const std::string& i, const std::string& j,
               Fields fields, const Place& from);
    void spherical(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
                   const char* path);
    // x is fixed to body i and y to body j.
    void universal(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
                   const Vector3d& x, const Vector3d& y, const char* path);
    void revolute(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
                  const Vector3d& axis, const char* path);
    void fixed(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
               const char* path);
    void distance(const std::string& name, const std::string& i, const Vector3d& from, const std::string& j,
                  const Vector3d& to, const char* path);
    void in_plane(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
                  const Vector3d& normal, const Place& from);

    // A joint of Chrono's: with "Bushing Data" under `data` a bushing at its frame, else what its kind says.
    void joint_or_bushing(Kind kind, const std::string& name, const std::string& body1,
                          const std::string& body2, const Vector3d& p, const Matrix3d& frame,
                          const char* path, const std::optional<reader::Cursor>& data);
    // A translational spring and damper from `i` (on the chassis) to `j`.
    void tsda(const std::string& name, const std::string& i, const Vector3d& from, const std::string& j,
              const Vector3d& to, const reader::Cursor& data);
    void torsion(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
                 const Vector3d& axis, double rate, double moment, const char* path);

    // The spindle, held on `carrier`, and the wheel on it.
    void spindle(const std::string& carrier);
    // A link between a spherical joint and a universal one, or without mass a distance.
    void tierod(const char* part, const char* chassis_end, const char* outer_end,
                const std::string& on_outer);
    void link(const std::string& name, const char* part, const Vector3d& com, const std::string& i,
              const Vector3d& at_i, const std::string& j, const Vector3d& at_j, bool universal_at_j,
              const char* path_i, const char* path_j);

    void note_unused();  // what nobody asked for

  private:
    const reader::Cursor& file_;
    const Options& options_;
    Draft& draft_;
    Names body_names_, joint_names_, element_names_;
    mutable std::set<std::string> used_;
};

// Right-handed, with the third axis along w and the second nearest to across w and towards.
Matrix3d frame_along(const Vector3d& w, const Vector3d& towards);

}  // namespace elastocheck::importer::chrono
