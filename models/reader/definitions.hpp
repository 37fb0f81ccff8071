// What the rest of a scene file refers to: units, hardpoints, bodies.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "models/mechanism.hpp"
#include "models/reader/cursor.hpp"

namespace elastocheck::reader {

// Declared units per SI unit. Dividing by 1000 rounds once; multiplying by 0.001 would round twice.
struct Units {
    double per_m = 1;    // 1 or 1000
    double per_rad = 1;  // 1 or 180/π
    std::string length = "m", angle = "rad";

    double length_si(double x) const { return x / per_m; }                     // -> m
    double rate_si(double x) const { return x * per_m; }                       // force/length -> N/m
    double coupling_si(double x) const { return x * per_rad; }                 // force/angle -> N/rad
    double moment_si(double x) const { return x / per_m; }                     // force·length -> N·m
    double rotational_rate_si(double x) const { return x / per_m * per_rad; }  // -> N·m/rad
};

struct Definitions {
    Units units;
    std::map<std::string, Eigen::Vector3d> points;  // [m], ground axes
    std::map<std::string, BodyId> body_ids;         // with ground
    std::vector<Body> bodies;
};

Definitions read_definitions(const Cursor& scene);

// Two hardpoints nearer than this are one [m]: a direction or a length between them would be round-off.
inline constexpr double coincident = 1e-9;

double rate(const Cursor& at);                                                    // zero or more, as written
Eigen::Vector3d vector(const Cursor& at);                                         // three numbers, as written
Eigen::Vector3d hardpoint(const Cursor& at, const Definitions& defs);             // [m]
Eigen::Vector3d direction(const Cursor& at, const Definitions& defs);             // unit
BodyId body(const Cursor& at, const Definitions& defs);                           // or ground
BodyId moving_body(const Cursor& at, const Definitions& defs, const char* what);  // not ground

struct BodyPair {
    BodyId i, j;
};
BodyPair body_pair(const Cursor& at, const Definitions& defs);  // [i, j], different

// A ground position as a point of the body: s_local = p - r, as bodies begin parallel to ground.
Point point_of(BodyId body, const Eigen::Vector3d& p, const Definitions& defs);

}  // namespace elastocheck::reader
