// Outputs: what is read off a configuration, the same for every leg and independent of all of them.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::compare {

// Engineering units from here on: mm, deg, N, N·m.
enum class Unit {
    mm,
    deg,
    newton,
    newton_metre,
    none,
    // Of rates, which are characteristics (characteristics.hpp).
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
inline constexpr std::array all_units{Unit::mm,
                                      Unit::deg,
                                      Unit::newton,
                                      Unit::newton_metre,
                                      Unit::none,
                                      Unit::deg_per_m,
                                      Unit::deg_per_100mm,
                                      Unit::mm_per_100mm,
                                      Unit::deg_per_mm,
                                      Unit::deg_per_deg,
                                      Unit::newton_per_mm,
                                      Unit::deg_per_kN,
                                      Unit::deg_per_100Nm,
                                      Unit::percent};
const char* symbol(Unit unit);     // "mm", ..., "-", "deg/kN"
double in_unit(Unit unit);         // how many of them one m, rad, N, N·m or 1 is
Unit unit_of(ParameterUnit unit);  // in which a branch's parameter is shown

// ---- What a channel reads.

// sign (p_axis - counted_from)
struct Coordinate {
    Point at;
    int axis = 0;             // 0 x, 1 y, 2 z
    double counted_from = 0;  // [m]
    int sign = +1;
};
struct Toe {
    std::size_t wheel = 0;  // position in Model::wheels
};
struct Camber {
    std::size_t wheel = 0;
};
// What the steering axis of a wheel is to the wheel, in the plane of the road, a horizontal one through the contact patch.
// With u from the lower to the upper end of the axis, c the patch, e the spin axis pointing outboard, h and n horizontal
// unit vectors along the wheel and across it, outboard, p where the axis meets the road (side +1 left, -1 right):
//
//   caster               atan(-u_x / u_z)             n = (e_x, e_y, 0) / |(e_x, e_y, 0)|
//   kingpin inclination  atan(-side u_y / u_z)        h = side n × z
//   scrub radius         -n · (p - c)                 p = l + u (c_z - l_z) / u_z,  l the lower end
//   mechanical trail      h · (p - c)
//
// An axis that lies flatter than 0.1 rad stands on no road: all four are undefined (NaN) there.
struct Steering {
    enum class Figure { caster, kingpin_inclination, scrub_radius, mechanical_trail } figure = Figure::caster;
    std::size_t wheel = 0;  // position in Model::wheels, with a steering axis
};
// y of the one contact patch less that of the other.
struct Track {
    std::size_t left = 0, right = 0;  // positions in Model::wheels
};
// How nearly the perpendiculars to two steered wheels meet on the line of the other axle. With δ the angles of the wheels,
// positive to the left, δ = -side · toe:   (cot δ_right - cot δ_left) l / j,   1 where they meet on it, 0 where the wheels are
// parallel. Undefined (NaN) unless both turn the same way by 2 deg or more: 0/0 straight ahead.
struct Ackermann {
    std::size_t left = 0, right = 0;
    double wheelbase_by_pivots =
        0;  // l / j, j the distance across between where the steering axes meet the road as drawn,
            // of the patches where a wheel has none
};
// How much nearer two points are than as drawn.
struct Compression {
    Point i, j;
    double drawn = 0;  // [m]
};
// What an element is deformed by, or bears, in its own axes; read by compare/elements.hpp alone, as it takes the branch.
struct OfElement {
    int element = 0;  // position in Model::elastics
    int component =
        0;  // 0-5 along and about x y z, of a spring 0; then 6-11 the forces and moments against these
};
// Of a joint that keeps two points apart, positive in tension: F · (p_j - p_i) / |p_j - p_i|, F on its body i.
struct AxialForce {
    int joint = 0;       // position in Model::joints
    int constraint = 0;  // position in Model::constraints, a DistanceBetween
};
// What the driver of a joint exerts along the offset that it moves, such that effort · d(offset) is the work
// that the driver does: with the wrench (F, M) of the joint on its body i,
//   distance between p_i and p_j    F · (p_i - p_j) / |p_i - p_j|     pushes them apart
//   point i above plane j           F · n_j                           pushes i along the normal
//   direction i at an angle in j    M · (x_j × y_j)                   turns i from x_j towards y_j
struct Effort {
    int joint = 0;  // position in Model::joints
};
// Component of the wrench of a joint on its body i, about the joint's point: 0-2 force, 3-5 moment.
struct Reaction {
    int joint = 0;
    int component = 0;
};
// The same of several joints on one body, added up about the point of the first: what stays determined where
// they share a load in a way that nothing decides.
struct Total {
    std::vector<int> joints;
    BodyId on = ground;
    int component = 0;
};
// Of a state and how it answers small changes (characteristics.hpp).
struct Characteristic {
    std::size_t entry = 0;  // which it is
    std::size_t of = 0;     // whose: of which wheel, spring, damper
};
using Reads = std::variant<Coordinate, Toe, Camber, Steering, Track, Ackermann, Compression, Effort, Reaction,
                           Total, OfElement, AxialForce, Characteristic>;

// The value of an output where it has none: the length of an arm whose end is nowhere. NaN is a failure.
inline constexpr double undefined = std::numeric_limits<double>::infinity();

struct Channel {
    std::string
        name;  // "toe", "left.travel", "wheel_centre_y", "tip_z", "tie_rod.force_x", "rack.drive_force"
    Unit unit = Unit::mm;
    bool main = true;  // false: joint forces, and what is the wheel's position and angles told otherwise
    Reads reads = {};
    std::string definition = {};  // one line with its sign: the only place where it is written
    std::string undefined = {};   // what it means where it has no value; empty where it always has one

    bool kinematic() const;           // of the configuration alone: a position or an angle
    bool may_be_undefined() const;    // a quotient: `undefined` where it says nothing, and large beside
    std::vector<int> joints() const;  // whose wrenches it reads
};

// The channels of a model, in order; those of a wheel with a name as NAME.toe and so on:
//   wheel_centre_x, _y, _z   position of the wheel centre, ground axes
//   toe      = atan2(e_x, side·e_y), positive toe-in            e = unit spin axis pointing outboard
//   camber   = -asin(e_z), positive when the top leans out      side = +1 left, -1 right; never the axle total
//   travel                   z of the wheel centre from its design position, positive in jounce
//   contact_patch_x, _y, _z  position of the point of the wheel's body that is the contact patch as drawn
//   track_change             of this wheel's patch, positive outwards;   wheelbase_change where the scene has a vehicle
//   caster, kingpin_inclination, scrub_radius, mechanical_trail      of wheels with a steering axis
//   track                    of two wheels that are opposite;   ackermann where they are the front ones of a vehicle
//   PROBE_x, _y, _z          position of a probe
//   NAME.compression         of every spring and damper
//   JOINT.drive_force or .drive_moment          effort of the driver, of every joint that some branch moves
//   JOINT.force_x ... moment_z                  wrench of a joint on its first body
std::vector<Channel> channels(const Model& model);

// For every group of joints that share a load without anything deciding how (positions in Model::joints):
// what they exert together on each body that two or more of them hold, "A+B.force_x" ... "A+B.moment_z".
std::vector<Channel> totals(const Model& model, std::span<const std::vector<int>> groups);

// Position of a channel by its name, or -1.
int find_channel(std::span<const Channel> channels, std::string_view name);

// Their values at one equilibrium, same order. What a characteristic is, the state alone does not tell: NaN.
std::vector<double> evaluate(const Model& model, std::span<const Channel> channels, const Equilibrium& state);
std::vector<double> evaluate(const Model& model, const Equilibrium& state);  // of channels(model)

// The scene as drawn, nothing acting.
Equilibrium design_state(const Model& model);

}  // namespace elastocheck::compare
