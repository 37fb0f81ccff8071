// Definitions that the rest of a scene file refers to: units, hardpoints, bodies.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastocheck/mechanism.hpp"
#include "models/reader/definitions/mirror.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::reader {

// A declared unit. Dividing by 1000 rounds once; multiplying by 0.001 would round twice.
struct Unit {
    std::string name;
    double divide = 1, multiply = 1;
    double si(double x) const { return x / divide * multiply; }
    double written(double si) const { return si * divide / multiply; }
};

struct Units {
    Unit length{"m"}, angle{"rad"}, force{"N"};
    Unit moment;           // force·length unless declared
    Unit rate;             // force/length
    Unit coupling;         // force/angle
    Unit rotational_rate;  // moment/angle
    Unit arm;              // moment/force: a length, for a moment proportional to a force
};

struct Definitions {
    Units units;
    std::optional<Mirror> mirror;
    std::map<std::string, Vector3> points;        // [m], ground axes
    std::map<std::string, BodyId> body_ids;       // ground included
    std::vector<Body> bodies;                     // twins at the end
    std::vector<BodyId> twin_of;                  // of each body; itself if it is shared
    std::optional<std::filesystem::path> folder;  // folder of the files that the scene refers to
};

// `twins`: definitions of the same scene with the numbers of the twins' side (one_side.hpp), from which
// the twins' hardpoints and bodies are taken.
Definitions read_definitions(const Cursor& scene, const Definitions* twins = nullptr);
void take_twin_bodies(const Definitions& twins, Definitions& defs);

// Hardpoints closer than this coincide [m]: a direction or length between them would be round-off.
inline constexpr double coincident = 1e-9;

double rate(const Cursor& field, const Unit& unit);  // zero or more, SI
// SI; `what` completes "'0' is ...; allowed: above zero".
double above_zero(const Cursor& field, const char* what, const Unit& unit = {});
Vector3 vector(const Cursor& field, const Unit& unit = {});       // three numbers, SI
Vector3 hardpoint(const Cursor& field, const Definitions& defs);  // [m]
Vector3 direction(const Cursor& field, const Definitions& defs);  // unit
BodyId body(const Cursor& field, const Definitions& defs);        // or ground
BodyId moving_body(const Cursor& field, const Definitions& defs, const char* what);  // not ground

struct BodyPair {
    BodyId i, j;
};
BodyPair body_pair(const Cursor& field, const Definitions& defs);  // [i, j], different

// A ground position as a point of the body: s_local = p - r, since bodies start parallel to ground.
Point point_of(BodyId body, const Vector3& p, const Definitions& defs);
// The unit quaternion of a rotation matrix.
Quaternion quaternion_of(const Matrix3& axes);
Marker marker_of(BodyId body, const Vector3& p, const Matrix3& axes, const Definitions& defs);

// The fields `bodies`, `from` and `to` of a part between two points; `what` names it in the error
// "... needs a length".
struct Between {
    Point i, j;
    double length;  // [m]
};
Between between(const Cursor& field, const Definitions& defs, const char* what);

}  // namespace elastocheck::reader
