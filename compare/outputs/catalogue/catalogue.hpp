// The catalogue of outputs: one entry, with formula and properties, for every figure of a wheel, an axle,
// a spring or a damper. A figure is an output that has the same name in every model; outputs of probes,
// joints and elements have names of the model and are not in the catalogue.
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

// Kind of part that a figure belongs to. A model without such a part does not have the figure.
enum class Owner {
    wheel,
    rolling_wheel,
    wheel_with_fixed_patch,
    wheel_with_steering_axis,
    wheel_of_vehicle,
    wheel_on_tyre,
    steered_wheel,       // of a scene with a branch that drives a steering joint
    wheel_on_rack,       // of a scene with a branch that drives a steering joint by a translation
    wheel_on_column,     // of a scene with a branch that drives a steering joint by a rotation
    front_wheel,         // of a scene with a `vehicle` whose axle is the front axle
    rear_wheel,          // of a scene with a `vehicle` whose axle is the rear axle
    wheel_of_axle,       // of a scene with one left and one right wheel
    wheel_without_axle,  // of any other scene
    // Each of the following has one figure for all wheels together.
    wheels,
    hand_wheel,  // of a scene with a branch that moves the rack by the angle of the hand wheel
    two_wheels,
    axle,
    front_axle,  // of a scene with a `vehicle` whose axle is the front axle
    spring,
    damper,
};
// A part of a model that has figures: its name (may be empty), and its position in Model::wheels,
// Model::elastics or Model::dampers.
struct NamedOwner {
    std::string name;
    std::size_t k = 0;
};
// Parts of `model` of this kind, in the order of the model; empty if it has none.
std::vector<NamedOwner> owners(const Model& model, Owner owner);
struct Entry;
// Output of `model` that is the figure `entry` of the part `owner`.
Channel channel_of(const Model& model, const Entry& entry, const NamedOwner& owner);

// Quantity over which the report draws a figure. The abscissa of `springs` is wheel travel; figures of
// `if_given` are drawn only beside measured or computed curves.
enum class DrawnAbscissa { travel, roll, springs, steering, load, if_given };
// Value that a curve shows for a figure.
enum class Presentation {
    as_is,
    change,          // difference from the start of the branch, which is an equilibrium
    outward_change,  // the same difference of a y coordinate, positive outwards
    to_the_left,     // toe or a rate of toe, positive to the left
    off_centre,  // the value; the middle of the branch, where the figure has a pole, is left out
};
// A curve of the report. `rank` orders the figures over one abscissa, lowest first; `sign` says in words
// which sign is positive.
struct Drawing {
    DrawnAbscissa abscissa;
    int rank;
    const char *title, *sign;
    Presentation presentation = Presentation::as_is;
};

// Column of `export --format blocks`, whose file has axes that the user chooses.
struct Block {
    const char* name = nullptr;  // null: the figure is not exported
    // Component that changes its sign with the y axis of the file.
    enum class Component { none, lateral, yaw } component = Component::none;
    bool outwards = false;             // the output is positive outwards: along +y on the left only
    const char* definition = nullptr;  // replaces the definition of the output; null: it is kept
};
// Range outside which the value of a car at rest is implausible, in the unit of the output.
struct PlausibleRange {
    double from = -INFINITY, to = INFINITY;
    const char* question = nullptr;  // asked of the user outside the range; null: there is no range
};

// Rank of a figure among the curves that a live page shows first, per kind of motion or load of the
// branch: 1 is the first curve; 0: the figure is not among them.
struct LiveRank {
    int heave = 0, roll = 0, steering = 0, lateral = 0, longitudinal = 0, moment = 0;
};

inline constexpr const char* vertical_cause = "vertical travel and load";

struct Properties {
    const char* sources = "";         // standards and books, and names in other programs
    const char* definition_set = "";  // name of its set in definition_sets(); "": none
    bool is_main = false;             // an output that is judged and compared first
    // Length that is infinite where two links are parallel; its reciprocal is compared.
    bool swing_arm = false;
    // Coordinate that symmetry makes zero; references must agree within the tolerance of positions.
    bool is_position = false;
    // The formula reads WheelResponse::free. Rates in N/mm and figures on tyres do so without this flag.
    bool needs_free_response = false;
    bool may_be_undefined =
        false;                   // the value may be `undefined` although Entry::undefined is empty
    bool at_rest = false;        // part of the alignment of a car at rest
    bool is_key_figure = false;  // shown first in a report
    bool explained = false;      // a report shows which numbers of the scene change the figure
    bool compliance = false;     // coefficient of compliance at the design position
    LiveRank live_rank = {};     // rank on a live page
    const char* cause = vertical_cause;  // load or motion to which a characteristic responds
    const char* rig_headings = "";  // headings in files of test rigs, lower case, separated by ", "
    Block block = {};               // column of a block export
    PlausibleRange plausible_range = {};  // range for a car at rest
    std::vector<Drawing> drawings = {};   // curves of the report
};

// A figure. Its value at a Subject is `formula`, in SI.
struct Entry {
    Owner owner;
    std::string name;        // "toe", "wheel_rate@patch"
    Unit unit;               // unit in which the value is shown
    std::string definition;  // one line that says the positive sign; "{}" is the name of the owner
    std::string
        undefined;  // meaning of the value `undefined`; empty where the figure always has one
    // Value in SI; `undefined` where the figure has none, NaN where the solver failed to compute the
    // response.
    std::function<double(const Subject&)> formula;
    Properties properties = {};
    ChannelKind kind = ChannelKind::motion;  // characteristic: the formula reads a response
    bool on_request = false;  // a definition beside the project's own, computed only on request
    // Only of a coordinate of a point of the wheel: its axis 0, 1, 2 for x, y, z, and the point.
    int axis = -1;
    Point (*point)(const Wheel&) = nullptr;
};

// All entries in four groups: the project's own figures of states, then of responses; the other
// definitions of states, then of responses.
const std::vector<Entry>& catalogue();

// Entries with "@" in their names, figures of states before figures of responses: the other definitions,
// "wheel_rate@patch", and the tests of an axle, "lateral_force_steer@parallel".
std::vector<const Entry*> definitions();

// A figure as a curve of the report (see Drawing).
struct CurveOfFigure {
    std::string name, title, sign;
    Presentation presentation = Presentation::as_is;
    bool has_gradient = false;  // the figure depends on the state alone
};
// Figures that the report draws over `abscissa`, by rank; each name once.
std::vector<CurveOfFigure> figures_over(DrawnAbscissa abscissa);
// Names of the figures that a live page shows first for a branch of kind `branch_kind`, by rank.
std::vector<std::string> first_live_figures(int LiveRank::*branch_kind);

// Points that a drawing of the suspension shows [m]: four per wheel, the lower and the upper end of its
// steering axis, and the instant centres of its carrier seen from the front and from the side while all
// wheels rise alike; then one roll centre for all wheels. A point that does not exist is not finite.
std::vector<Vector3> points_of_figures(const Model& model, const Equilibrium& state,
                                       const WheelResponse& response);

// First entry of an output by its name, "left.camber@kingpin" or "camber"; null if there is none. Owners
// of several kinds may have figures of one name.
const Entry* find_entry(std::string_view output);
// Entry by a column heading of a test rig, "wheel toe" (lower case); null if there is none.
const Entry* find_by_heading(std::string_view heading);
// Name of an output without its owner: "camber@kingpin" of "left.camber@kingpin".
std::string_view without_owner(std::string_view output);
// Name of an output without its owner and its definition: "camber" of "left.camber@kingpin".
std::string figure_of(std::string_view output);

// Whether a channel is this figure, "toe", of any owner.
bool is_figure(const Channel& channel, std::string_view figure);
// Channel of a figure of a wheel. Pre: `figure` is in the catalogue.
Channel figure_channel(const Model& model, std::string_view figure, std::size_t wheel);

// ---- The outputs of a model.

// Characteristics of the model, which channels(model) does not contain. None of them is a main output;
// the list is empty for a model without a wheel.
std::vector<Channel> characteristics(const Model& model);

// Outputs by other definitions that have a value in the design position: one per definition and wheel,
// "left.camber@kingpin", and one per definition for an axle, without the name of a wheel. None of them
// is a main output.
std::vector<Channel> definition_channels(const Model& model);
// Outputs in `defined` that are other definitions of `figure`, "left.camber".
std::vector<Channel> definitions_of(std::span<const Channel> defined, const std::string& figure);

// Definitions of one standard or method of drawing, which a scene can request together.
struct DefinitionSet {
    std::string name;                  // "sae"
    const char* source;                // common property of the members, and where it is defined
    std::vector<std::string> members;  // "scrub_radius@ground_axes"
};
std::vector<DefinitionSet> definition_sets();

// Value of a characteristic in SI; `undefined` where it has none, NaN where the solver failed.
double value_of(const Model& model, const Catalogued& catalogued, const Equilibrium& state,
                const WheelResponse& response);
// Whether the formula of a channel reads WheelResponse::free.
bool needs_free_response(const Channel& channel);
// Whether the reciprocal of a channel is compared (Properties::swing_arm).
bool is_swing_arm(const Channel& channel);
// Whether a channel is compared within the tolerance of positions (Properties::is_position).
bool is_position(const Channel& channel);
// Whether a channel is a figure of the drawn steering axis.
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
