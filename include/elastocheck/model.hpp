// Compiled model: the input of all legs.
//
// Compilation does two things: it removes or condenses parts that cannot influence a requested
// output (models/compile/passes.hpp), and lowers joints to basic constraints (lowering.hpp).
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "elastocheck/mechanism.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck {

// The four basic constraints (Nikravesh 1988), and one more for a driven angle, as data. Each leg
// has its own equations for them.

// p_i = p_j                     3 rows
struct CoincidentPoints {
    Point i, j;
};
// n_j · (p_i - p_j) = offset    1 row
struct PointInPlane {
    Point i, j;
    Direction normal_j;
    double offset = 0;  // [m]
};
// u_i · u_j = 0                 1 row
struct PerpendicularDirections {
    Direction i, j;
};
// |p_i - p_j| = length          1 row
struct DistanceBetween {
    Point i, j;
    double length = 0;
};

// u_i · (cos α y_j - sin α x_j) = 0,  α = angle   1 row
struct DirectionAtAngle {
    Direction i, j, y_j;  // x_j = j, perpendicular to y_j on the same body; u_i lies in their plane
    double angle = 0;     // [rad]
};

using ConstraintKind = std::variant<CoincidentPoints, PointInPlane, PerpendicularDirections,
                                    DistanceBetween, DirectionAtAngle>;
struct Constraint {
    int joint = 0;  // position in Model::joints
    ConstraintKind kind;
};

constexpr int rows(const ConstraintKind& kind) {
    return std::holds_alternative<CoincidentPoints>(kind) ? 3 : 1;
}

// A joint after lowering: its name, its bodies and the point of its reaction wrench.
struct ModelJoint {
    std::string name;
    BodyId i = ground, j = ground;
    Point at;  // on body i (its origin for joints without a point)
    // position in Model::constraints of the one whose offset, length or angle may move, or -1
    int driven = -1;
    bool active_only_where_driven = false;
};

struct Size {
    int bodies = 0, joints = 0, elastics = 0;
    int rows = 0;  // of the joints' constraints
    friend bool operator==(const Size&, const Size&) = default;
};

struct Model {
    std::string name;
    std::vector<Body> bodies;
    std::vector<ModelJoint> joints;
    std::vector<Constraint> constraints;  // in the order of `joints`
    std::vector<Elastic> elastics;
    std::vector<Load> static_loads;
    std::vector<Branch> branches;  // their drivers refer to Model::joints and Model::elastics
    std::vector<Wheel> wheels;
    std::vector<Probe> probes;
    std::vector<Damper> dampers;
    std::optional<Vehicle> vehicle;
    std::vector<Omission> omitted;
    Size as_written, as_solved;  // of the scene, and of the reduced model
};

// 6 nb, the number of coordinates.
inline int coordinates(const Model& model) { return 6 * static_cast<int>(model.bodies.size()); }
// m, the number of constraint equations.
inline int constraint_rows(const Model& model) {
    int m = 0;
    for (const auto& constraint : model.constraints) m += rows(constraint.kind);
    return m;
}

}  // namespace elastocheck
