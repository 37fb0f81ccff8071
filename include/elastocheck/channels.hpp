// Output channels: quantities computed from a state, by the same functions for every leg.
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
    // Units of rates.
    deg_per_m,
    deg_per_100mm,
    mm_per_100mm,
    deg_per_mm,
    deg_per_deg,
    newton_per_mm,
    deg_per_kN,
    deg_per_100Nm,
    percent,
    newton_metre_per_deg,
};
const char* symbol(Unit unit);  // "mm", ..., "-", "deg/kN"
double in_unit(Unit unit);      // factor from SI (m, rad, N, N·m, 1) to this unit
std::optional<Unit> find_unit(std::string_view symbol);
Unit unit_of(ParameterUnit unit);  // display unit of a branch parameter

// ---- Kinds of channels: the quantity that a channel reads, one type each.

enum class ChannelKind {
    motion,          // a position or an angle, of the poses alone
    drive,           // effort of a driver
    reaction,        // of a joint, or of several together
    element,         // deformation or force of an element, axial force of a link
    characteristic,  // a K&C rate, of the response to a small change
};
const char* name(ChannelKind kind);  // "motion", ...

// Coordinate of a point, p_axis - counted_from.
struct Coordinate {
    static constexpr ChannelKind kind = ChannelKind::motion;
    Point at;
    int axis = 0;             // 0 x, 1 y, 2 z
    double counted_from = 0;  // [m]
};
// Component of the deformation or elastic force of an element in its own axes. Evaluated only by
// compare/comparison/elements.hpp, since it needs the branch.
struct ElementComponent {
    static constexpr ChannelKind kind = ChannelKind::element;
    int element = 0;  // position in Model::elastics
    // 0-5: displacement and rotation along x y z; 6-11: force and moment; of a spring 0 and 6
    int component = 0;
};
// Axial force of a joint that fixes the distance of two points, positive in tension:
// F · (p_j - p_i) / |p_j - p_i|, F on its body i.
struct AxialForce {
    static constexpr ChannelKind kind = ChannelKind::element;
    int joint = 0;       // position in Model::joints
    int constraint = 0;  // position in Model::constraints, a DistanceBetween
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
// Component of the total wrench of several joints on one body, about the point of the first. The total is
// determined where redundant joints share a load in an undetermined way.
struct Total {
    static constexpr ChannelKind kind = ChannelKind::reaction;
    std::vector<int> joints;
    BodyId on = ground;
    int component = 0;  // as of Reaction
};
// A figure of a wheel, axle, spring or damper (compare/outputs/catalogue/catalogue.hpp).
struct Entry;
struct Catalogued {
    const Entry* entry = nullptr;
    std::size_t of = 0;  // its owner: position in Model::wheels, elastics or dampers
};
using Reads =
    std::variant<Coordinate, Catalogued, Effort, Reaction, Total, ElementComponent, AxialForce>;

// Value of an output that is undefined, for example the length of an arm whose end is at infinity.
// NaN means a failure.
inline constexpr double undefined = std::numeric_limits<double>::infinity();

struct Channel {
    std::string name;  // "toe", "left.travel", "tie_rod.force_x", "rack.drive_force"
    Unit unit = Unit::mm;
    bool main = true;  // false: joint forces, and alternative measures of the wheel's pose
    Reads reads = {};
    std::string definition = {};  // one line with its sign convention; written only here
    // meaning of an undefined value; empty where the channel always has a value
    std::string undefined = {};

    ChannelKind kind() const;
    bool kinematic() const { return kind() == ChannelKind::motion; }
    // whether it is a quotient: undefined where its denominator is zero, and large nearby
    bool may_be_undefined() const;
    std::vector<int> joints() const;  // joints whose wrenches it reads
};

// The channels of a model, in order; those of a wheel with a name are NAME.toe and so on:
//   figures of the catalogue that need the state alone: of each wheel, then of the axle
//   PROBE_x, _y, _z          position of a probe
//   NAME.compression         of every spring and damper
//   wheel_load               of every wheel
//   JOINT.drive_force or .drive_moment   driver effort of every joint moved by some branch
//   JOINT.force_x ... moment_z           wrench of a joint on its first body
std::vector<Channel> channels(const Model& model);

// For every group of joints that share a load in an undetermined way (positions in Model::joints):
// their total wrench on each body that two or more of them hold, "A+B.force_x" ... "A+B.moment_z".
std::vector<Channel> totals(const Model& model, std::span<const std::vector<int>> groups);

// Position of a channel by its name, or -1.
int find_channel(std::span<const Channel> channels, std::string_view name);

// Channel values at one state, in the same order and in the units of the channels. NaN for
// characteristics, elements and wheel loads, which need more than the state.
std::vector<double> evaluate(const Model& model, std::span<const Channel> channels,
                             const Equilibrium& state);
std::vector<double> evaluate(const Model& model, const Equilibrium& state);  // of channels(model)

// The model in its design position, without reactions.
Equilibrium design_state(const Model& model);

}  // namespace elastocheck::compare
