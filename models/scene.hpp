// A scene: what the user asked. One YAML file (scene_file.hpp), or built in code.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "models/mechanism.hpp"

namespace elastocheck {

// ---- What a branch moves: all of it as start + rate · a, a the parameter of the branch.

// A joint's offset: the length of a Distance, the offset of an InPlane [m], the angle of an Angle [rad],
// counted from what the joint itself says.
struct Motion {
    int joint = 0;  // position in Scene::joints or Model::joints
};
// The free length of an AxialSpring, counted from its ℓ₀ [m].
struct FreeLength {
    int elastic = 0;  // position in Scene::elastics or Model::elastics
};
// A preload of a Bushing, counted from its own.
struct Preload {
    int elastic = 0;
    Vector6 direction = Vector6::Zero();  // what the driver multiplies, as (force, moment) [N, N·m]
};
using Driven = std::variant<Load, Motion, FreeLength, Preload>;

struct Driver {
    Driven what;
    double start = 0;  // at a = 0: what is held while a moves
    double rate = 0;   // per unit of a
};

enum class ParameterUnit { newton, newton_metre, metre, radian, none };

// A path of equilibria. At a = 0 it begins with the scene as drawn, settled under what is held; from there a
// goes to `to`, and to `from` where that is on the other side of 0: one curve, walked both ways. The paper's
// example is two branches driven by a load, to +3000 and to -3000 N, 300 steps each.
struct Branch {
    std::string name;
    double from = 0;  // of the parameter a
    double to = 0;
    int steps = 0;  // equal increments of a in the published sweep, over the whole branch
    ParameterUnit unit = ParameterUnit::newton;  // of a
    std::vector<Driver> drivers;
};

// About which the wheel is steered, as it is drawn: the line through two points, each on the body where it sits (two
// ball joints of a wheel carrier; the top mount of a strut). For outputs alone: no leg sees it.
struct SteeringAxis {
    Point lower, upper;  // or ground
};

struct Wheel {
    std::string name;  // "left"; empty where the scene has only the one
    BodyId body = ground;
    Eigen::Vector3d centre_local = Eigen::Vector3d::Zero();  // [m]
    Eigen::Vector3d contact_local =
        Eigen::Vector3d::Zero();  // contact patch at the design pose, a point of the body [m]
    Eigen::Vector3d spin_axis_local = Eigen::Vector3d::UnitY();  // unit, pointing outboard
    int side = +1;                                               // +1 left, -1 right
    double tyre_rate =
        0;  // vertical, k_t [N/m]; 0 where no tyre is given. Ride rate: 1 / (1/k_wheel + 1/k_t)
    std::optional<SteeringAxis> steering_axis = {};  // none where the geometry has none, as of a multi-link
};

// A body point whose position is an output, for scenes that are not suspensions.
struct Probe {
    std::string name;
    Point at;
};

// Two points whose distance is an output. In quasi-statics a damper has no force.
struct Damper {
    std::string name;
    Point i, j;  // or ground
};

// What the wheels of the scene belong to, for the outputs that depend on it: anti-dive, Ackermann.
enum class Axle { front, rear };
struct Vehicle {
    double wheelbase = 0;  // [m] > 0
    double cg_height =
        0;  // of the whole vehicle, above the road: the contact patches of the design position [m] > 0
    Axle axle = Axle::front;  // that the wheels of the scene are on
    double brake_share = 0;   // of the vehicle's braking force, at this axle, 0 ... 1
    double drive_share = 0;   // of its driving force, likewise
};

// A named position of the design, ground axes [m]. For drawings; no leg sees it.
struct Hardpoint {
    std::string name;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

// A number of the file that a scene was read from, as written there, in the unit declared there.
struct Number {
    std::string path;  // "points.tie_rod_inner.z": the name by which a Setting varies it
    double value = 0;
    std::string unit;  // "mm", "N·m/deg"; empty for a pure number
};

// ---- Trim: what is adjusted until the design position is one of equilibrium, under what is held on every
// branch. As many conditions as adjustments. Solved before anything else (compare/trim.hpp); the branches start
// from there.

struct WheelTravel {
    int wheel = 0;
};  // of the centre, up from the design position [m]
struct WheelToe {
    int wheel = 0;
};  // [rad]
struct WheelCamber {
    int wheel = 0;
};  // [rad]
struct ProbeCoordinate {
    int probe = 0;
    int axis = 2;  // 0 x, 1 y, 2 z
};                 // position less that at the design position [m]
using ConditionKind = std::variant<WheelTravel, WheelToe, WheelCamber, ProbeCoordinate>;

struct Trim {
    struct Adjustment {
        std::string name;                            // as a branch would drive it: "springs.coil.preload"
        Driven what;                                 // counted from what the scene says; never a Load
        double per_unit = 1;                         // of `what`, for one unit of the quantity named [SI/SI]
        ParameterUnit unit = ParameterUnit::newton;  // of the quantity named
    };
    struct Condition {
        std::string name;  // "left.travel"
        ConditionKind what;
        std::optional<double> value;  // SI; none: as it is in the scene as drawn
    };
    std::vector<Adjustment> adjust;
    std::vector<Condition> until;
    int line = 0;  // of the file, 0 when built in code
};

// What was asked for and is not modelled.
struct Omission {
    std::string what;  // "body 'antiroll_bar'"
    std::string why;
};

struct Scene {
    std::string name;
    std::string source;           // file it was read from, empty when built in code
    std::vector<Number> numbers;  // of the file, in the order of reading; empty when built in code
    std::vector<Hardpoint> hardpoints;
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<Elastic> elastics;
    std::vector<Load> static_loads;  // held on every branch
    std::vector<Branch> branches;
    std::vector<Wheel> wheels;
    std::vector<Probe> probes;
    std::vector<Damper> dampers;
    std::optional<Vehicle> vehicle;
    std::optional<Trim> trim;
    std::vector<Omission> left_out;  // what the file defines and nothing uses
};

}  // namespace elastocheck
