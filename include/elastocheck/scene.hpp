// A scene: the user's input, from one YAML file (read_scene.hpp) or built in code.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck {

// ---- Inputs that a branch drives, all as start + rate · a, a the parameter of the branch.

// Offset of a joint relative to its value in the scene: the length of a Distance, the offset of an
// InPlane [m], the angle of an Angle [rad].
struct Motion {
    int joint = 0;  // position in Scene::joints or Model::joints
};
// Change of the free length ℓ₀ of an AxialSpring, or of the undeformed d_z of a Bushing [m].
struct FreeLength {
    int elastic = 0;  // position in Scene::elastics or Model::elastics
};
// Change of the preload of a Bushing.
struct Preload {
    int elastic = 0;
    Vector6 direction = Vector6::Zero();  // multiplied by the driver, (force, moment) [N, N·m]
};
using Driven = std::variant<Load, Motion, FreeLength, Preload>;

struct Driver {
    Driven what;
    double start = 0;  // at a = 0, constant while a changes
    double rate = 0;   // per unit of a
};

enum class ParameterUnit { newton, newton_metre, metre, radian, none };

// A path of equilibria. At a = 0 it starts from the equilibrium near the design position under the start
// values (the settled state). From there a goes to `to`, and to `from` if that is on the other side of 0:
// one path with two sides. The paper's example is two branches driven by a load, to +3000 and to -3000
// N, 300 steps each.
struct Branch {
    std::string name;
    double from = 0;  // of the parameter a
    double to = 0;
    int steps = 0;  // equal increments of a in the published sweep, over the whole branch
    ParameterUnit unit = ParameterUnit::newton;  // of a
    std::vector<Driver> drivers;
};

// Steering axis of the wheel at the design position: the line through two points, each fixed in its body (two
// ball joints of a wheel carrier; the top mount of a strut). For outputs only; the legs do not read it.
struct SteeringAxis {
    Point lower, upper;  // or ground
};

// A rolling wheel is a massless body of its own between its carrier and the road. With e the spin axis, n
// the normal of the road and h the unit vector along e × n at the design pose, its joints are
//
//   bearing   revolute about e at the wheel centre c, wheel on carrier
//   spin      h · n = 0, h fixed in the wheel, n in ground
//
// They keep e × h along -(n - (n·e) e), so that the patch, a point of this body, stays the lowest point of
// the disc of radius R: p(q) = c - R (n - (n·e) e) / |n - (n·e) e|.
struct Wheel {
    std::string name;                        // "left"; empty if the scene has one wheel
    BodyId body = ground;                    // the carrier
    Vector3 centre_local = Vector3::Zero();  // [m]
    Point contact;  // contact patch, of the rolling wheel or of the carrier
    Vector3 spin_axis_local = Vector3::UnitY();  // unit, pointing outboard
    int side = +1;                               // +1 left, -1 right
    double tyre_rate =
        0;  // vertical, k_t [N/m]; 0: no tyre given. Ride rate: 1 / (1/k_wheel + 1/k_t)
    // none where the geometry has none, as in a multi-link
    std::optional<SteeringAxis> steering_axis = {};

    bool rolls() const { return contact.body != body; }
};

// A body point whose position is an output, for scenes that are not suspensions.
struct Probe {
    std::string name;
    Point at;
};

// Two points whose distance is an output. A damper has no force in quasi-statics.
struct Damper {
    std::string name;
    Point i, j;  // or ground
};

// Vehicle data for the outputs that depend on it: anti-dive, Ackermann.
enum class Axle { front, rear };
struct Vehicle {
    double wheelbase = 0;  // [m] > 0
    // of the whole vehicle, above the contact patches of the design position [m] > 0
    double cg_height = 0;
    Axle axle = Axle::front;  // axle of the scene's wheels
    double brake_share = 0;   // of the vehicle's braking force, at this axle, 0 ... 1
    double drive_share = 0;   // of the driving force, 0 ... 1
};

// A named position of the design, ground axes [m]. For drawings; the legs do not read it.
struct Hardpoint {
    std::string name;
    Vector3 position = Vector3::Zero();
};

// A number of the scene file, as written and in the unit declared there.
struct Number {
    std::string path;  // "points.tie_rod_inner.z", as in Setting::path
    double value = 0;
    std::string unit;  // "mm", "N·m/deg"; empty for a pure number
    // Under a mirror, of a number of both sides: "left" and "right", each with its value. The number of one
    // side alone has the path PATH@left or PATH@right.
    std::vector<std::pair<std::string, double>> sides = {};
};

// ---- Trim: parameters adjusted until the design position is in equilibrium under the start values
// of every branch. As many conditions as adjustments. Solved first (compare/comparison/trim.hpp);
// the branches start from there.

// Kinds of conditions, by positions in Scene::wheels and Scene::probes.
// Rise of the wheel centre from the design position [m].
struct WheelTravel {
    int wheel = 0;
};
struct WheelToe {  // [rad]
    int wheel = 0;
};
struct WheelCamber {  // [rad]
    int wheel = 0;
};
// Displacement from the design position [m].
struct ProbeCoordinate {
    int probe = 0;
    int axis = 2;  // 0 x, 1 y, 2 z
};
using ConditionKind = std::variant<WheelTravel, WheelToe, WheelCamber, ProbeCoordinate>;

struct Trim {
    struct Adjustment {
        std::string name;  // named as a driver: "springs.coil.preload"
        Driven what;       // changed relative to its value in the scene; never a Load
        // change of `what` for one unit of the named quantity [SI/SI]
        double per_unit = 1;
        ParameterUnit unit = ParameterUnit::newton;  // of the named quantity
    };
    struct Condition {
        std::string name;  // "left.travel"
        ConditionKind what;
        std::optional<double> value;  // SI; none: its value in the scene at the design position
    };
    enum class Bushings { unloaded, balanced };
    std::vector<Adjustment> adjust;
    std::vector<Condition> until;
    int line = 0;  // of the file, 0 when built in code
    // balanced: with preloads of all bushings such that the drawn position is the equilibrium
    Bushings bushings = Bushings::unloaded;
};

// A part of the input that is not modelled.
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
    std::vector<Load> static_loads;  // act on every branch
    std::vector<Branch> branches;
    std::vector<Wheel> wheels;
    std::vector<Probe> probes;
    std::vector<Damper> dampers;
    std::optional<Vehicle> vehicle;
    std::optional<Trim> trim;
    std::vector<Omission> omitted;  // parts that the file defines and nothing uses
};

}  // namespace elastocheck
