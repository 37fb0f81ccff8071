// Output channels: quantities computed from a configuration, the same for every leg and independent
// of all legs.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

// Engineering units from here on: mm, deg, N, N·m.
enum class Unit {
    mm,
    deg,
    newton,
    newton_metre,
    none,
    // Units of rates, which are characteristics (characteristics.hpp).
    deg_per_m,
    deg_per_100mm,
    mm_per_100mm,
    deg_per_mm,
    deg_per_deg,
    newton_per_mm,
    deg_per_kN,
    deg_per_100Nm,
    percent,
};
const char* symbol(Unit unit);  // "mm", ..., "-", "deg/kN"
double in_unit(Unit unit);      // factor from SI (m, rad, N, N·m, 1) to this unit
std::optional<Unit> find_unit(std::string_view symbol);
Unit unit_of(ParameterUnit unit);  // display unit of a branch parameter

// ---- Kinds of channels: the quantity that a channel reads, one type each.

enum class ChannelKind {
    motion,    // of the configuration alone: a position or an angle
    drive,     // effort of a driver
    reaction,  // of a joint, or of several together
    element,   // deformation or force of an element, axial force of a link
    characteristic,
};
const char* name(ChannelKind kind);  // "motion", ...

// sign (p_axis - counted_from)
struct Coordinate {
    static constexpr ChannelKind kind = ChannelKind::motion;
    Point at;
    int axis = 0;             // 0 x, 1 y, 2 z
    double counted_from = 0;  // [m]
    int sign = +1;
};
struct Toe {
    static constexpr ChannelKind kind = ChannelKind::motion;
    std::size_t wheel = 0;  // position in Model::wheels
};
struct Camber {
    static constexpr ChannelKind kind = ChannelKind::motion;
    std::size_t wheel = 0;
};
// Position of a wheel's steering axis in the road plane, the horizontal plane through the contact
// patch. With u from the lower to the upper end of the axis, c the patch, e the spin axis pointing
// outboard, h and n horizontal unit vectors along the wheel and across it (outboard), p the
// intersection of the axis with the road plane (side +1 left, -1 right):
//
//   caster               atan(-u_x / u_z)             n = (e_x, e_y, 0) / |(e_x, e_y, 0)|
//   kingpin inclination  atan(-side u_y / u_z)        h = side n × z
//   scrub radius         -n · (p - c)                 p = l + u (c_z - l_z) / u_z,  l the lower end
//   mechanical trail      h · (p - c)
//
// All four are undefined (NaN) for an axis within 0.1 rad of the road plane.
struct Steering {
    static constexpr ChannelKind kind = ChannelKind::motion;
    enum class Figure {
        caster,
        kingpin_inclination,
        scrub_radius,
        mechanical_trail
    } figure = Figure::caster;
    std::size_t wheel = 0;  // position in Model::wheels, with a steering axis
};
// Track: y of the left contact patch minus that of the right.
struct Track {
    static constexpr ChannelKind kind = ChannelKind::motion;
    std::size_t left = 0, right = 0;  // positions in Model::wheels
};
// Ackermann fraction, 1 where the perpendiculars to the two steered wheels meet on the line of the
// other axle. With δ the steer angles, positive to the left, δ = -side · toe:
//
//   (cot δ_right - cot δ_left) l / j      1 where they meet on it, 0 for parallel wheels
//
// Undefined (NaN) unless both wheels turn the same way by 2 deg or more: 0/0 straight ahead.
struct Ackermann {
    static constexpr ChannelKind kind = ChannelKind::motion;
    std::size_t left = 0, right = 0;
    // wheelbase l over j: lateral distance between the points where the steering axes meet the road
    // in the design position, or between the patches for a wheel without an axis
    double wheelbase_by_pivots = 0;
};
// Reduction of the distance between two points since the design position.
struct Compression {
    static constexpr ChannelKind kind = ChannelKind::motion;
    Point i, j;
    double drawn = 0;  // distance in the design position [m]
};
// Deformation, or elastic force, of an element in its own axes; evaluated only by
// compare/comparison/elements.hpp, which needs the branch.
struct OfElement {
    static constexpr ChannelKind kind = ChannelKind::element;
    int element = 0;  // position in Model::elastics
    int component =
        0;  // 0-5 along and about x y z, of a spring 0; then 6-11 the conjugate forces and moments
};
// Axial force of a joint that fixes the distance of two points, positive in tension:
// F · (p_j - p_i) / |p_j - p_i|, F on its body i.
struct AxialForce {
    static constexpr ChannelKind kind = ChannelKind::element;
    int joint = 0;       // position in Model::joints
    int constraint = 0;  // position in Model::constraints, a DistanceBetween
};
// Vertical force of the road on a wheel (compare/outputs/wheel_load.hpp); evaluated with a branch only.
struct WheelLoad {
    static constexpr ChannelKind kind = ChannelKind::element;
    std::size_t wheel = 0;  // position in Model::wheels
};
// Driver effort of a joint, work-conjugate to the driven offset: effort · d(offset) is the work of
// the driver. With the wrench (F, M) of the joint on its body i:
//   distance between p_i and p_j    F · (p_i - p_j) / |p_i - p_j|     pushes them apart
//   point i above plane j           F · n_j                           pushes i along the normal
//   direction i at an angle in j    M · (x_j × y_j)                   turns i from x_j towards y_j
struct Effort {
    static constexpr ChannelKind kind = ChannelKind::drive;
    int joint = 0;  // position in Model::joints
};
// Component of the wrench of a joint on its body i, about the joint's point: 0-2 force, 3-5 moment.
struct Reaction {
    static constexpr ChannelKind kind = ChannelKind::reaction;
    int joint = 0;
    int component = 0;
};
// Total wrench of several joints on one body about the point of the first: it stays determined
// where redundant joints share a load in an undetermined way.
struct Total {
    static constexpr ChannelKind kind = ChannelKind::reaction;
    std::vector<int> joints;
    BodyId on = ground;
    int component = 0;
};
// Kinematics or compliance characteristic of a state and its response (characteristics.hpp).
struct Characteristic {
    static constexpr ChannelKind kind = ChannelKind::characteristic;
    std::size_t entry = 0;  // position in the list of characteristics
    std::size_t of = 0;     // index of the wheel, spring or damper
};
// A figure of a wheel by another definition (compare/definitions); it has no derivatives.
struct Defined {
    static constexpr ChannelKind kind = ChannelKind::motion;
    double (*value)(const Model& model, std::size_t wheel, const Equilibrium& state) = nullptr;
    std::size_t wheel = 0;
};
using Reads =
    std::variant<Coordinate, Toe, Camber, Steering, Track, Ackermann, Compression, Effort, Reaction,
                 Total, OfElement, AxialForce, WheelLoad, Characteristic, Defined>;

// Value of an output that is undefined, for example the length of an arm whose end is at infinity.
// NaN means a failure.
inline constexpr double undefined = std::numeric_limits<double>::infinity();

struct Channel {
    std::string name;  // "toe", "left.travel", "tie_rod.force_x", "rack.drive_force"
    Unit unit = Unit::mm;
    bool main = true;  // false: joint forces, and other forms of the wheel's position and angles
    Reads reads = {};
    std::string definition = {};  // one line with its sign convention; written only here
    // meaning of an undefined value; empty where the channel always has a value
    std::string undefined = {};

    ChannelKind kind() const;
    bool kinematic() const { return kind() == ChannelKind::motion; }
    // a quotient: `undefined` at a zero of its denominator, and large beside it
    bool may_be_undefined() const;
    std::vector<int> joints() const;  // joints whose wrenches it reads
};

// The channels of a model, in order; those of a wheel with a name as NAME.toe and so on:
//   wheel_centre_x, _y, _z   position of the wheel centre, ground axes
//   toe      = atan2(e_x, side·e_y), positive toe-in          e = unit spin axis pointing outboard
//   camber   = -asin(e_z), positive when the top leans out    side = +1 left, -1 right
//                            of each wheel, never the axle total
//   travel                   z of the wheel centre minus its design value, positive in jounce
//   contact_patch_x, _y, _z  position of the body point that is the contact patch in the design
//                            position
//   track_change             of this wheel's patch, positive outwards
//   wheelbase_change         likewise, where the scene has a vehicle
//   caster, kingpin_inclination, scrub_radius, mechanical_trail   of wheels with a steering axis
//   track                    of two opposite wheels
//   ackermann                of two opposite wheels at the front of a vehicle
//   PROBE_x, _y, _z          position of a probe
//   NAME.compression         of every spring and damper
//   wheel_load               vertical force of the road on every wheel, positive up
//   JOINT.drive_force or .drive_moment   effort of the driver, of every joint moved by some branch
//   JOINT.force_x ... moment_z           wrench of a joint on its first body
std::vector<Channel> channels(const Model& model);

// For every group of joints that share a load in an undetermined way (positions in Model::joints):
// their total wrench on each body that two or more of them hold, "A+B.force_x" ... "A+B.moment_z".
std::vector<Channel> totals(const Model& model, std::span<const std::vector<int>> groups);

// Position of a channel by its name, or -1.
int find_channel(std::span<const Channel> channels, std::string_view name);

// Channel values at one equilibrium, in the same order. NaN for a characteristic, an element and a
// wheel load, which need more than the state.
std::vector<double> evaluate(const Model& model, std::span<const Channel> channels,
                             const Equilibrium& state);
std::vector<double> evaluate(const Model& model, const Equilibrium& state);  // of channels(model)

// The scene in its design position, no load acting.
Equilibrium design_state(const Model& model);

}  // namespace elastocheck::compare
