#include "elastocheck/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr std::array towards{"forward", "to the left", "up"};

const ModelJoint& joint_of(const Model& model, int joint) {
    return model.joints[static_cast<std::size_t>(joint)];
}

// The features of a model in a state.
struct Configuration {
    const Model& model;
    const Equilibrium& state;

    const Wheel& wheel(std::size_t w) const { return model.wheels[w]; }
    Vector3d direction(const Direction& u) const { return pose(state.poses, u.body).p * u.u_local; }
    Vector3d position(const Point& point) const { return compare::position(state.poses, point); }
    Vector3d spin_axis(std::size_t w) const {
        return direction({wheel(w).body, wheel(w).spin_axis_local});
    }
    Vector3d patch(std::size_t w) const { return position(wheel(w).contact); }
    const Wrench& wrench(int joint) const {
        return state.reactions[static_cast<std::size_t>(joint)];
    }
};

// ---- Formulas: values in SI, one function per type that a channel reads.

double read(const Configuration& at, const Coordinate& c) {
    return c.sign * (at.position(c.at)[c.axis] - c.counted_from);
}
double read(const Configuration& at, const Toe& c) {
    using std::atan2;
    const Vector3d e = at.spin_axis(c.wheel);
    return atan2(e.x(), at.wheel(c.wheel).side * e.y());
}
double read(const Configuration& at, const Camber& c) {
    using std::asin;
    return -asin(at.spin_axis(c.wheel).z());
}

// ---- Steering axis.

constexpr double flattest = 0.1;  // [rad] smallest angle of a steering axis to the road
const double least_steering = 2 * std::numbers::pi / 180;

// Vector from the contact patch to the intersection of the steering axis with the road; undefined
// for a flat axis.
Vector3d pivot(const Configuration& at, std::size_t wheel) {
    const auto& [lower, upper] = *at.wheel(wheel).steering_axis;
    const Vector3d l = at.position(lower), u = at.position(upper) - l, c = at.patch(wheel);
    if (!(std::abs(u.z()) > std::sin(flattest) * u.norm())) return Vector3d::Constant(undefined);
    return l + u * ((c.z() - l.z()) / u.z()) - c;
}

double read(const Configuration& at, const Steering& c) {
    using std::atan;
    const auto& [lower, upper] = *at.wheel(c.wheel).steering_axis;
    const Vector3d u = at.position(upper) - at.position(lower), off = pivot(at, c.wheel),
                   e = at.spin_axis(c.wheel);
    if (std::isinf(off.x())) return undefined;
    const double side = at.wheel(c.wheel).side;
    const Vector3d n = Vector3d(e.x(), e.y(), 0).normalized(),
                   h = side * n.cross(Vector3d::UnitZ());
    switch (c.figure) {
        case Steering::Figure::caster: return atan(-u.x() / u.z());
        case Steering::Figure::kingpin_inclination: return atan(-side * u.y() / u.z());
        case Steering::Figure::scrub_radius: return -n.dot(off);
        case Steering::Figure::mechanical_trail: return h.dot(off);
    }
    return undefined;
}
double read(const Configuration& at, const Track& c) {
    return at.patch(c.left).y() - at.patch(c.right).y();
}
double read(const Configuration& at, const Ackermann& c) {
    using std::abs, std::tan;
    const double left = -read(at, Toe{c.left}), right = read(at, Toe{c.right});
    if (!(left * right > 0 && std::min(abs(left), abs(right)) >= least_steering)) return undefined;
    return (1 / tan(right) - 1 / tan(left)) * c.wheelbase_by_pivots;
}
double read(const Configuration& at, const Compression& c) {
    return c.drawn - (at.position(c.j) - at.position(c.i)).norm();
}
double read(const Configuration& at, const Effort& c) {
    const int driven = joint_of(at.model, c.joint).driven;
    if (driven < 0) return 0;  // inactive on this branch
    const auto k = static_cast<std::size_t>(driven);
    const Wrench on_i = at.wrench(c.joint);
    return std::visit(
        overloaded{[&](const DistanceBetween& b) {
                       return on_i.force.dot((at.position(b.i) - at.position(b.j)).normalized());
                   },
                   [&](const PointInPlane& p) { return on_i.force.dot(at.direction(p.normal_j)); },
                   [&](const DirectionAtAngle& a) {
                       return on_i.moment.dot(at.direction(a.j).cross(at.direction(a.y_j)));
                   },
                   // No offset to drive: lowering never drives these.
                   [](const CoincidentPoints&) { return std::nan(""); },
                   [](const PerpendicularDirections&) { return std::nan(""); }},
        at.model.constraints[k].kind);
}
double read(const Configuration& at, const AxialForce& c) {
    const auto k = static_cast<std::size_t>(c.constraint);
    const auto& rod = std::get<DistanceBetween>(at.model.constraints[k].kind);
    return at.wrench(c.joint).force.dot((at.position(rod.j) - at.position(rod.i)).normalized());
}
double read(const Configuration& at, const Reaction& c) {
    const Wrench on_i = at.wrench(c.joint);
    return c.component < 3 ? on_i.force[c.component] : on_i.moment[c.component - 3];
}
double read(const Configuration& at, const Total& c) {
    const auto point = [&](int joint) { return at.position(joint_of(at.model, joint).at); };
    const Vector3d about = point(c.joints.front());
    double sum = 0;
    for (const int k : c.joints) {
        const ModelJoint& joint = joint_of(at.model, k);
        const double sign = joint.i == c.on ? 1 : -1;
        const Wrench w = at.wrench(k);
        const Vector3d moment = w.moment + (point(k) - about).cross(w.force);
        sum += sign * (c.component < 3 ? w.force[c.component] : moment[c.component - 3]);
    }
    return sum;
}
// Need more than the state.
double read(const Configuration&, const OfElement&) { return std::nan(""); }
double read(const Configuration&, const Characteristic&) { return std::nan(""); }
double read(const Configuration& at, const Defined& c) {
    return c.value(at.model, c.wheel, at.state);
}

// ---- Units, in the order of Unit.

struct UnitEntry {
    std::string_view symbol;
    double per_si;
};
constexpr double deg = 180 / std::numbers::pi;
constexpr std::array<UnitEntry, static_cast<std::size_t>(Unit::percent) + 1> units{
    {{"mm", 1e3},
     {"deg", deg},
     {"N", 1},
     {"N·m", 1},
     {"-", 1},
     {"deg/m", deg},
     {"deg/100 mm", deg / 10},
     {"mm/100 mm", 100},
     {"deg/mm", deg / 1e3},
     {"deg/deg", 1},
     {"N/mm", 1e-3},
     {"deg/kN", 1e3 * deg},
     {"deg/(100 N·m)", 100 * deg},
     {"%", 100}}};

// ---- The list

// The model as drawn.
struct Drawing {
    const Model& model;
    Equilibrium state = design_state(model);

    Configuration drawn() const { return {model, state}; }
};
Point centre_of(const Wheel& wheel) { return {wheel.body, wheel.centre_local}; }
Point patch_of(const Wheel& wheel) { return wheel.contact; }

std::string body_name(const Model& model, BodyId body) {
    return body == ground ? "ground"
                          : "'" + model.bodies[static_cast<std::size_t>(body)].name + "'";
}

void add_position(std::vector<Channel>& list, const std::string& stem, const std::string& of,
                  const Point& at) {
    for (int k = 0; k < 3; ++k)
        list.push_back({.name = stem + "_" + axes[static_cast<std::size_t>(k)],
                        .reads = Coordinate{at, k},
                        .definition = fmt::format("position of {}, ground axis {}, positive {}", of,
                                                  axes[static_cast<std::size_t>(k)],
                                                  towards[static_cast<std::size_t>(k)])});
}

// Channels of a wheel beside its position and angles.
void add_patch(std::vector<Channel>& list, const Drawing& design, std::size_t w,
               const std::string& prefix) {
    const Model& model = design.model;
    const Wheel& wheel = model.wheels[w];
    const Point patch = patch_of(wheel);
    const Vector3d drawn = design.drawn().position(patch);
    const std::size_t first = list.size();
    add_position(list, prefix + "contact_patch",
                 wheel.rolls() ? "the contact patch, the lowest point of the rolling wheel"
                               : "the point of the carrier that is the contact patch at the design "
                                 "position",
                 patch);
    for (std::size_t k = first; k < list.size(); ++k) list[k].main = false;
    list.push_back({.name = prefix + "track_change",
                    .main = false,
                    .reads = Coordinate{patch, 1, drawn(1), wheel.side},
                    .definition = "lateral displacement of this wheel's contact patch from its "
                                  "design position, positive outwards"});
    if (model.vehicle)
        list.push_back(
            {.name = prefix + "wheelbase_change",
             .main = false,
             .reads = Coordinate{patch, 0, drawn(0), model.vehicle->axle == Axle::front ? +1 : -1},
             .definition = "longitudinal displacement of this wheel's contact patch from its "
                           "design position, positive where the wheelbase grows (forward in front, "
                           "rearward at the rear)"});
}

void add_steering(std::vector<Channel>& list, std::size_t w, const std::string& prefix) {
    using Figure = Steering::Figure;
    const auto add = [&](const char* name, Unit unit, Figure figure, const char* definition) {
        list.push_back({.name = prefix + name,
                        .unit = unit,
                        .main = false,
                        .reads = Steering{figure, w},
                        .definition = definition});
    };
    add("caster", Unit::deg, Figure::caster,
        "angle of the steering axis to the vertical seen from the side, positive where its top "
        "leans "
        "backwards; undefined where it lies flatter than 0.1 rad");
    add("kingpin_inclination", Unit::deg, Figure::kingpin_inclination,
        "angle of the steering axis to the vertical seen from behind, positive where its top leans "
        "inwards; "
        "undefined where it lies flatter than 0.1 rad");
    add("scrub_radius", Unit::mm, Figure::scrub_radius,
        "distance across the wheel from the contact patch to the intersection of the steering axis "
        "with the road (the horizontal plane through the patch), positive inboard; undefined where "
        "the axis lies flatter than 0.1 rad");
    add("mechanical_trail", Unit::mm, Figure::mechanical_trail,
        "distance along the wheel from the contact patch to the intersection of the steering axis "
        "with the road (the horizontal plane through the patch), positive in front; undefined "
        "where the axis lies flatter than 0.1 rad");
}

// Channels of two opposite wheels.
void add_axle(std::vector<Channel>& list, const Drawing& design) {
    const Model& model = design.model;
    if (model.wheels.size() != 2 || model.wheels[0].side == model.wheels[1].side) return;
    const std::size_t left = model.wheels[0].side > 0 ? 0 : 1, right = 1 - left;
    list.push_back({.name = "track",
                    .main = false,
                    .reads = Track{left, right},
                    .definition = "lateral distance between the contact patches of the two wheels, "
                                  "positive where the left one is to the left"});
    if (!model.vehicle || model.vehicle->axle != Axle::front) return;
    const Configuration drawn = design.drawn();
    const auto y = [&](std::size_t w) {
        const double patch = drawn.patch(w).y();
        if (!drawn.wheel(w).steering_axis) return patch;
        const double to_pivot = pivot(drawn, w).y();
        return std::isinf(to_pivot) ? patch : patch + to_pivot;
    };
    const double wheelbase_by_pivots = model.vehicle->wheelbase / (y(left) - y(right));
    list.push_back(
        {.name = "ackermann",
         .unit = Unit::percent,
         .main = false,
         .reads = Ackermann{left, right, wheelbase_by_pivots},
         .definition =
             "(cot of the right wheel's angle less cot of the left one's) times the wheelbase over "
             "the lateral distance between the pivots on the road: positive where the inner wheel "
             "turns more, 100 % where the perpendiculars to the two wheels meet on the line of the "
             "rear axle; undefined unless both are turned in the same direction by 2 deg or more"});
}

void add_compression(std::vector<Channel>& list, const Drawing& design, const std::string& name,
                     const char* what, const Point& i, const Point& j) {
    const double drawn = (design.drawn().position(j) - design.drawn().position(i)).norm();
    list.push_back(
        {.name = name + ".compression",
         .main = false,
         .reads = Compression{i, j, drawn},
         .definition = fmt::format("design length less length of {} '{}', positive in compression",
                                   what, name)});
}

void add_wheel(std::vector<Channel>& list, const Drawing& design, std::size_t w) {
    const Wheel& wheel = design.model.wheels[w];
    const std::string prefix = wheel.name.empty() ? "" : wheel.name + ".";
    const Point centre = centre_of(wheel);
    add_position(list, prefix + "wheel_centre", "the wheel centre", centre);
    list.push_back(
        {.name = prefix + "toe",
         .unit = Unit::deg,
         .reads = Toe{w},
         .definition = "angle of the wheel plane to the x axis seen from above, positive toe-in "
                       "(front of the wheel turned to the vehicle's middle), of this wheel alone"});
    list.push_back({.name = prefix + "camber",
                    .unit = Unit::deg,
                    .reads = Camber{w},
                    .definition =
                        "angle of the wheel plane to the vertical, positive where the top leans "
                        "outwards"});
    list.push_back({.name = prefix + "travel",
                    .main = false,
                    .reads = Coordinate{centre, 2, design.drawn().position(centre).z()},
                    .definition =
                        "vertical displacement of the wheel centre from its design position, "
                        "positive in jounce (up)"});
    add_patch(list, design, w, prefix);
    if (wheel.steering_axis) add_steering(list, w, prefix);
}

void add_wrench(std::vector<Channel>& list, const std::string& stem, const std::string& what,
                const std::string& about, const auto& reads) {
    for (int k = 0; k < 6; ++k) {
        const auto axis = static_cast<std::size_t>(k % 3);
        list.push_back(
            {.name = fmt::format("{}.{}_{}", stem, k < 3 ? "force" : "moment", axes[axis]),
             .unit = k < 3 ? Unit::newton : Unit::newton_metre,
             .main = false,
             .reads = reads(k),
             .definition = k < 3 ? fmt::format("force of {}, ground axis {}, positive {}", what,
                                               axes[axis], towards[axis])
                                 : fmt::format("moment of {}, about {}, ground axis {}, "
                                               "right-handed",
                                               what, about, axes[axis])});
    }
}

void add_effort(std::vector<Channel>& list, const Model& model, int k) {
    const ModelJoint& joint = joint_of(model, k);
    if (joint.driven < 0) return;
    const bool turns = is_angle(model.constraints[static_cast<std::size_t>(joint.driven)].kind);
    // The driver of joint `rack` is a separate joint, `rack.drive`; its effort is reported for the
    // rack.
    const std::string stem =
        joint.name.ends_with(".drive") ? joint.name.substr(0, joint.name.size() - 6) : joint.name;
    list.push_back(
        {.name = stem + (turns ? ".drive_moment" : ".drive_force"),
         .unit = turns ? Unit::newton_metre : Unit::newton,
         .main = false,
         .reads = Effort{k},
         .definition = fmt::format("{} that holds or moves '{}', positive where it would make its "
                                   "{} grow: it times the change is the work done",
                                   turns ? "moment" : "force", joint.name,
                                   turns ? "angle" : "length or displacement")});
}

std::set<int> joints_moved(const Model& model) {
    std::set<int> moved;
    for (const auto& branch : model.branches)
        for (const auto& driver : branch.drivers)
            if (const int joint = driven_joint(driver.what); joint >= 0) moved.insert(joint);
    return moved;
}

}  // namespace

const char* symbol(Unit unit) { return units[static_cast<std::size_t>(unit)].symbol.data(); }
double in_unit(Unit unit) { return units[static_cast<std::size_t>(unit)].per_si; }

std::optional<Unit> find_unit(std::string_view symbol) {
    const auto found = std::ranges::find(units, symbol, &UnitEntry::symbol);
    if (found == units.end()) return std::nullopt;
    return static_cast<Unit>(found - units.begin());
}

Unit unit_of(ParameterUnit unit) {
    switch (unit) {
        case ParameterUnit::newton: return Unit::newton;
        case ParameterUnit::newton_metre: return Unit::newton_metre;
        case ParameterUnit::metre: return Unit::mm;
        case ParameterUnit::radian: return Unit::deg;
        case ParameterUnit::none: return Unit::none;
    }
    return Unit::none;
}

const char* name(ChannelKind kind) {
    constexpr std::array names{"motion", "drive", "reaction", "element", "characteristic"};
    return names[static_cast<std::size_t>(kind)];
}

ChannelKind Channel::kind() const {
    return std::visit([](const auto& c) { return c.kind; }, reads);
}

bool Channel::may_be_undefined() const {
    return !undefined.empty() || std::holds_alternative<Steering>(reads) ||
           std::holds_alternative<Ackermann>(reads) || std::holds_alternative<Defined>(reads);
}

std::vector<int> Channel::joints() const {
    return std::visit(
        overloaded{[](const Effort& e) { return std::vector{e.joint}; },
                   [](const Reaction& r) { return std::vector{r.joint}; },
                   [](const AxialForce& f) { return std::vector{f.joint}; },
                   [](const Total& t) { return t.joints; },
                   [](const auto& c) {
                       static_assert(std::decay_t<decltype(c)>::kind != ChannelKind::drive &&
                                     std::decay_t<decltype(c)>::kind != ChannelKind::reaction);
                       return std::vector<int>{};
                   }},
        reads);
}

std::vector<Channel> channels(const Model& model) {
    const Drawing design{model};
    std::vector<Channel> list;
    for (std::size_t w = 0; w < model.wheels.size(); ++w) add_wheel(list, design, w);
    add_axle(list, design);
    for (std::size_t k = 0; k < model.probes.size(); ++k) {
        const std::string& name = model.probes[k].name;
        add_position(list, name, "'" + name + "'", model.probes[k].at);
    }
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        if (const auto ends = points_of(model.elastics[k].kind);
            ends.size() == 2 && model.elastics[k].written_as == WrittenAs::itself) {
            add_compression(list, design, model.elastics[k].name, "spring", ends[0], ends[1]);
        }
    for (std::size_t k = 0; k < model.dampers.size(); ++k)
        add_compression(list, design, model.dampers[k].name, "damper", model.dampers[k].i,
                        model.dampers[k].j);
    for (const int k : joints_moved(model)) add_effort(list, model, k);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
        const ModelJoint& joint = model.joints[k];
        add_wrench(list, joint.name,
                   fmt::format("joint '{}' on {}", joint.name, body_name(model, joint.i)),
                   "the joint's point", [&](int component) {
                       return Reaction{static_cast<int>(k), component};
                   });
    }
    return list;
}

std::vector<Channel> totals(const Model& model, std::span<const std::vector<int>> groups) {
    std::vector<Channel> list;
    std::set<std::vector<int>> done;  // the total on the other body differs only in sign
    for (const auto& group : groups) {
        std::map<BodyId, std::vector<int>> held;  // by the joints of the group
        for (const int k : group)
            for (const BodyId body : std::set{joint_of(model, k).i, joint_of(model, k).j})
                if (body != ground) held[body].push_back(k);
        for (const auto& [body, on] : held) {
            if (on.size() < 2 || !done.insert(on).second) continue;
            std::string stem, names;
            for (const int k : on) {
                stem += (stem.empty() ? "" : "+") + joint_of(model, k).name;
                names += (names.empty() ? "'" : ", '") + joint_of(model, k).name + "'";
            }
            add_wrench(list, stem,
                       fmt::format("joints {} together on {}", names, body_name(model, body)),
                       fmt::format("the point of '{}'", joint_of(model, on.front()).name),
                       [&, body = body, on = on](int component) {
                           return Total{on, body, component};
                       });
        }
    }
    return list;
}

int find_channel(std::span<const Channel> channels, std::string_view name) {
    const auto found = std::ranges::find(channels, name, &Channel::name);
    return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

std::vector<double> evaluate(const Model& model, std::span<const Channel> channels,
                             const Equilibrium& state) {
    std::vector<double> values;
    values.reserve(channels.size());
    for (const auto& channel : channels)
        values.push_back(in_unit(channel.unit) *
                         std::visit(
                             [&](const auto& c) {
                                 return read(Configuration{model, state}, c);
                             },
                             channel.reads));
    return values;
}

std::vector<double> evaluate(const Model& model, const Equilibrium& state) {
    return evaluate(model, channels(model), state);
}

Equilibrium design_state(const Model& model) {
    Equilibrium state;
    for (const auto& body : model.bodies) state.poses.push_back(body.design);
    state.reactions.resize(model.joints.size());
    return state;
}

}  // namespace elastocheck::compare
