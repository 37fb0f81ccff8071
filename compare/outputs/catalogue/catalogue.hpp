// The catalogue of outputs: every figure of a wheel, an axle, a spring or a damper, once, with its
// formula and properties. Outputs of probes, joints and elements, which have names of the model, are
// not in it.
//
// A new figure is one entry in angles.cpp (read from the state alone), rates.cpp (from a response) or
// force_tests.cpp. Tables, documents, pages and studies choose by the properties of an entry.
#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

struct Subject;        // subject.hpp
struct WheelResponse;  // outputs/wheel_response.hpp

// What a figure belongs to. A model without an owner of the kind has no such figure.
enum class Owner {
    wheel,
    rolling_wheel,
    wheel_with_fixed_patch,
    wheel_with_steering_axis,
    wheel_of_vehicle,
    wheel_on_tyre,
    steered_wheel,    // some branch drives a steering joint, ...
    wheel_on_rack,    // ... by a translation
    wheel_on_column,  // ... by a rotation
    front_wheel,      // of a scene with a `vehicle`
    rear_wheel,
    wheel_of_axle,       // of a scene with one left and one right wheel
    wheel_without_axle,  // of any other scene
    // one figure for all wheels together:
    wheels,
    hand_wheel,  // of a scene that moves the rack by its angle
    two_wheels,
    axle,
    front_axle,  // of a scene with a `vehicle`
    spring,
    damper,
};
// An owner in a model: its name (may be empty), and its position in Model::wheels, elastics or dampers.
struct Named {
    std::string name;
    std::size_t k = 0;
};
std::vector<Named> owners(const Model& model, Owner owner);
struct Entry;
Channel channel_of(const Model& model, const Entry& entry, const Named& owner);

// A curve of the report: its abscissa, its place among the figures over it, and how it is drawn. The
// abscissa of `springs` is wheel travel; `if_given`: only beside measured or computed curves.
enum class Over { travel, roll, springs, steering, load, if_given };
enum class Shown {
    as_is,
    change,          // since the start of the branch, where the suspension is settled
    outward_change,  // likewise, of a y coordinate
    to_the_left,     // toe or its rate, positive to the left
    off_centre,      // without the middle of the branch, where it has a pole
};
struct Drawing {
    Over over;
    int place;
    const char *title, *sign;
    Shown shown = Shown::as_is;
};

// A block of `export --format blocks`: its name, and how its values change with the axes of the file.
struct Block {
    const char* name = nullptr;  // null: none
    enum class Component { none, lateral, yaw } component = Component::none;
    bool outwards = false;             // the output is positive outwards: along +y on the left only
    const char* definition = nullptr;  // instead of that of the output
};
// Plausible range for a car at rest, in the unit of the output.
struct Plausible {
    double from = -INFINITY, to = INFINITY;
    const char* asks = nullptr;  // question to the user beyond the range; null: no range
};

// Place among the first curves of a live page on a branch of this kind, from 1; 0: not among them.
struct Usual {
    int heave = 0, roll = 0, steering = 0, lateral = 0, longitudinal = 0, moment = 0;
};

inline constexpr const char* vertical_cause = "vertical travel and load";

struct Properties {
    const char* elsewhere = "";  // sources, and names in other programs
    const char* set = "";        // the definition set that it belongs to: definition_sets()
    bool main = false;           // judged and compared first
    bool swing_arm = false;   // infinite where two links are parallel: compared by its reciprocal
    bool place = false;       // a coordinate, zero by symmetry: references agree as on positions
    bool reads_free = false;  // reads WheelResponse::free, as every rate in N/mm and on tyres does
    bool quotient = false;    // may be undefined although Entry::undefined is empty
    bool at_rest = false;     // part of the alignment of a car at rest
    bool key = false;         // shown first in a report
    bool explained = false;   // a report shows which numbers of the scene move it
    bool compliance = false;  // a coefficient of compliance at the design position
    Usual live = {};          // on a live page
    const char* cause = vertical_cause;  // what a characteristic responds to
    const char* rig = "";  // headings of measured files, lower case, separated by ", "
    Block block = {};
    Plausible plausible = {};
    std::vector<Drawing> drawn = {};
};

struct Entry {
    Owner owner;
    std::string name;  // "toe", "wheel_rate@patch"
    Unit unit;
    std::string definition;  // one line with its sign; "{}" is the name of the owner
    std::string undefined;   // meaning of an undefined value; empty where it always has one
    // Value in SI; `undefined` where there is none, NaN where the leg failed to compute the response.
    std::function<double(const Subject&)> formula;
    Properties properties = {};
    ChannelKind kind = ChannelKind::motion;  // characteristic: reads a response
    bool on_request = false;                 // by another definition than the project's own
    // of a coordinate: its axis and its point
    int axis = -1;
    Point (*point)(const Wheel&) = nullptr;
};

// All entries: the project's own, of states, then of responses; then those by other definitions.
const std::vector<Entry>& catalogue();

// Entries by other definitions, "wheel_rate@patch", and the figures under the tests of an axle,
// "lateral_force_steer@parallel": of states, then of responses.
std::vector<const Entry*> definitions();

// Figures drawn over this abscissa, in the order of their places.
struct DrawnFigure {
    std::string name, title, sign;
    Shown shown = Shown::as_is;
    bool has_gradient = false;  // read from the state alone
};
std::vector<DrawnFigure> drawn_over(Over over);
// Figures that a live page shows first over such a branch, in their places.
std::vector<std::string> usual_over(int Usual::*moved);

// Points of a drawing from which figures of wheels are read [m]: four per wheel, the lower and the upper
// end of its steering axis, the instant centres of its carrier seen from the front and from the side,
// all wheels rising alike; then the roll centre of all. Not finite where there is none.
std::vector<Vector3> points_of_figures(const Model& model, const Equilibrium& state,
                                       const WheelResponse& response);

// The entry of an output of this name, "left.camber@kingpin" or "camber"; null if there is none. Owners
// of several kinds may have it.
const Entry* find_entry(std::string_view output);
// The entry with this heading of a measured file, "wheel toe"; null if there is none.
const Entry* find_by_heading(std::string_view words);
// "camber@kingpin" of "left.camber@kingpin"; and "camber" of it and of "left.camber".
std::string_view without_owner(std::string_view output);
std::string figure_of(std::string_view output);

// Whether a channel is this figure, "toe", of any owner; and the channel of a figure of a wheel.
bool is_figure(const Channel& channel, std::string_view figure);
Channel figure_channel(const Model& model, std::string_view figure, std::size_t wheel);

// ---- The outputs of a model.

// Characteristics, as outputs beside channels(model), none of them a main output; empty without a wheel.
std::vector<Channel> characteristics(const Model& model);

// An output per definition and wheel that has a value in the design position, "left.camber@kingpin";
// figures of an axle once, without the name of a wheel. None of them is a main output.
std::vector<Channel> definition_channels(const Model& model);
// The outputs among them that define `figure`, "left.camber", otherwise.
std::vector<Channel> definitions_of(std::span<const Channel> defined, const std::string& figure);

// Definitions of one standard or method of drawing, for scenes that request them together.
struct DefinitionSet {
    std::string name;                  // "sae"
    const char* source;                // what they have in common, and where it is defined
    std::vector<std::string> members;  // "scrub_radius@ground_axes"
};
std::vector<DefinitionSet> definition_sets();

// Value of a characteristic in SI; `undefined` where it has none, NaN where the leg failed.
double value_of(const Model& model, const Catalogued& what, const Equilibrium& state,
                const WheelResponse& response);
// Whether it reads WheelResponse::free.
bool needs_free(const Channel& channel);
// Whether it is compared by its reciprocal; as a position; whether it is a figure of the steering axis.
bool is_swing_arm(const Channel& channel);
bool is_place(const Channel& channel);
bool reads_steering_axis(const Channel& channel);

// Names of figures that code refers to.
namespace figure {
inline constexpr std::string_view toe = "toe", camber = "camber", travel = "travel",
                                  caster = "caster", mechanical_trail = "mechanical_trail",
                                  track = "track", wheel_rate = "wheel_rate",
                                  wheel_rate_in_roll = "wheel_rate_in_roll",
                                  anti_dive = "anti_dive", anti_lift = "anti_lift",
                                  wheel_load = "wheel_load", roll_angle = "roll_angle";
}

}  // namespace elastocheck::compare
