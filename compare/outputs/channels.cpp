#include "compare/outputs/channels.hpp"

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

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr std::array axes{"x", "y", "z"};
constexpr std::array towards{"forward", "to the left", "up"};

const Pose& pose(const Equilibrium& state, BodyId body) { return compare::pose(state.poses, body); }

Vector3d position(const Equilibrium& state, const Point& point) {
    return compare::position(state.poses, point);
}

Vector3d direction(const Equilibrium& state, const Direction& u) {
    return pose(state, u.body).p * u.u_local;
}

Vector3d spin_axis(const Model& model, const Equilibrium& state, std::size_t wheel) {
    const Wheel& w = model.wheels[wheel];
    return pose(state, w.body).p * w.spin_axis_local;
}

const Wrench& wrench(const Equilibrium& state, int joint) {
    return state.reactions[static_cast<std::size_t>(joint)];
}

const ModelJoint& joint_of(const Model& model, int joint) {
    return model.joints[static_cast<std::size_t>(joint)];
}

// ---- Values in SI, one function per type that a channel reads.

double read(const Model&, const Equilibrium& state, const Coordinate& c) {
    return c.sign * (position(state, c.at)[c.axis] - c.counted_from);
}
double read(const Model&, const Equilibrium&, const Characteristic&) {
    return std::numeric_limits<double>::quiet_NaN();
}
double read(const Model& model, const Equilibrium& state, const Toe& c) {
    const Vector3d e = spin_axis(model, state, c.wheel);
    return std::atan2(e.x(), model.wheels[c.wheel].side * e.y());
}
double read(const Model& model, const Equilibrium& state, const Camber& c) {
    return -std::asin(spin_axis(model, state, c.wheel).z());
}

// ---- Steering axis.

constexpr double flattest = 0.1;  // [rad] smallest angle of a steering axis to the road
const double least_steering = 2 * std::numbers::pi / 180;

// Vector from the contact patch to the intersection of the steering axis with the road; undefined
// for a flat axis.
Vector3d pivot(const Model& model, const Equilibrium& state, std::size_t wheel) {
    const Wheel& w = model.wheels[wheel];
    const Vector3d l = position(state, w.steering_axis->lower),
                   u = position(state, w.steering_axis->upper) - l,
                   c = position(state, {w.body, w.contact_local});
    if (!(std::abs(u.z()) > std::sin(flattest) * u.norm())) return Vector3d::Constant(undefined);
    return l + u * ((c.z() - l.z()) / u.z()) - c;
}

double read(const Model& model, const Equilibrium& state, const Steering& c) {
    const Wheel& w = model.wheels[c.wheel];
    const Vector3d u =
        position(state, w.steering_axis->upper) - position(state, w.steering_axis->lower);
    const Vector3d off = pivot(model, state, c.wheel), e = spin_axis(model, state, c.wheel);
    if (std::isinf(off.x())) return undefined;
    const Vector3d n = Vector3d(e.x(), e.y(), 0).normalized(),
                   h = w.side * n.cross(Vector3d::UnitZ());
    switch (c.figure) {
        case Steering::Figure::caster: return std::atan(-u.x() / u.z());
        case Steering::Figure::kingpin_inclination: return std::atan(-w.side * u.y() / u.z());
        case Steering::Figure::scrub_radius: return -n.dot(off);
        case Steering::Figure::mechanical_trail: return h.dot(off);
    }
    return undefined;
}
double read(const Model& model, const Equilibrium& state, const Track& c) {
    const auto y = [&](std::size_t w) {
        return position(state, {model.wheels[w].body, model.wheels[w].contact_local}).y();
    };
    return y(c.left) - y(c.right);
}
double read(const Model& model, const Equilibrium& state, const Ackermann& c) {
    const double left = -read(model, state, Toe{c.left}), right = read(model, state, Toe{c.right});
    if (!(left * right > 0 && std::min(std::abs(left), std::abs(right)) >= least_steering))
        return undefined;
    return (1 / std::tan(right) - 1 / std::tan(left)) * c.wheelbase_by_pivots;
}
double read(const Model&, const Equilibrium& state, const Compression& c) {
    return c.drawn - (position(state, c.j) - position(state, c.i)).norm();
}
double read(const Model& model, const Equilibrium& state, const Effort& c) {
    const int driven = joint_of(model, c.joint).driven;
    if (driven < 0) return 0;  // inactive on this branch
    const Wrench& on_i = wrench(state, c.joint);
    return std::visit(
        overloaded{
            [&](const DistanceBetween& d) {
                return on_i.force.dot((position(state, d.i) - position(state, d.j)).normalized());
            },
            [&](const PointInPlane& p) { return on_i.force.dot(direction(state, p.normal_j)); },
            [&](const DirectionAtAngle& a) {
                return on_i.moment.dot(direction(state, a.j).cross(direction(state, a.y_j)));
            },
            // No offset to drive: lowering never drives these.
            [](const CoincidentPoints&) { return std::nan(""); },
            [](const PerpendicularDirections&) { return std::nan(""); }},
        model.constraints[static_cast<std::size_t>(driven)].kind);
}
double read(const Model&, const Equilibrium&, const OfElement&) { return std::nan(""); }
double read(const Model& model, const Equilibrium& state, const AxialForce& c) {
    const auto& rod =
        std::get<DistanceBetween>(model.constraints[static_cast<std::size_t>(c.constraint)].kind);
    return wrench(state, c.joint)
        .force.dot((position(state, rod.j) - position(state, rod.i)).normalized());
}
double read(const Model&, const Equilibrium& state, const Reaction& c) {
    const Wrench& on_i = wrench(state, c.joint);
    return c.component < 3 ? on_i.force[c.component] : on_i.moment[c.component - 3];
}
double read(const Model& model, const Equilibrium& state, const Total& c) {
    const Vector3d about = position(state, joint_of(model, c.joints.front()).at);
    double sum = 0;
    for (const int k : c.joints) {
        const ModelJoint& joint = joint_of(model, k);
        const double sign = joint.i == c.on ? 1 : -1;
        const Wrench& w = wrench(state, k);
        const Vector3d moment = w.moment + (position(state, joint.at) - about).cross(w.force);
        sum += sign * (c.component < 3 ? w.force[c.component] : moment[c.component - 3]);
    }
    return sum;
}

// ---- The list

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
void add_patch(std::vector<Channel>& list, const Model& model, std::size_t w,
               const std::string& prefix) {
    const Wheel& wheel = model.wheels[w];
    const Point patch{wheel.body, wheel.contact_local};
    const Vector3d drawn = position(design_state(model), patch);
    const std::size_t first = list.size();
    add_position(list, prefix + "contact_patch",
                 "the point of the wheel's body that is the contact patch as drawn", patch);
    for (std::size_t k = first; k < list.size(); ++k) list[k].main = false;
    list.push_back({.name = prefix + "track_change",
                    .main = false,
                    .reads = Coordinate{patch, 1, drawn.y(), wheel.side},
                    .definition =
                        "how far the contact patch of this wheel is across from where it is drawn, "
                        "positive outwards"});
    if (model.vehicle)
        list.push_back(
            {.name = prefix + "wheelbase_change",
             .main = false,
             .reads = Coordinate{patch, 0, drawn.x(), model.vehicle->axle == Axle::front ? +1 : -1},
             .definition =
                 "how far the contact patch of this wheel is along from where it is drawn, "
                 "positive where the wheelbase grows (forward in front, rearward at the "
                 "rear)"});
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
        "across the wheel, from the contact patch to where the steering axis meets the road (a "
        "horizontal "
        "plane through the patch), positive where that is inboard; undefined where the axis lies "
        "flatter "
        "than "
        "0.1 rad");
    add("mechanical_trail", Unit::mm, Figure::mechanical_trail,
        "along the wheel, from the contact patch to where the steering axis meets the road (a "
        "horizontal "
        "plane through the patch), positive where that is in front; undefined where the axis lies "
        "flatter "
        "than 0.1 rad");
}

// Channels of two opposite wheels.
void add_axle(std::vector<Channel>& list, const Model& model) {
    if (model.wheels.size() != 2 || model.wheels[0].side == model.wheels[1].side) return;
    const std::size_t left = model.wheels[0].side > 0 ? 0 : 1, right = 1 - left;
    list.push_back({.name = "track",
                    .main = false,
                    .reads = Track{left, right},
                    .definition =
                        "distance across between the contact patches of the two wheels, positive "
                        "where the left one is to the left"});
    if (!model.vehicle || model.vehicle->axle != Axle::front) return;
    const Equilibrium drawn = design_state(model);
    const auto y = [&](std::size_t w) {
        const Wheel& wheel = model.wheels[w];
        const double to_pivot = wheel.steering_axis ? pivot(model, drawn, w).y() : 0;
        return position(drawn, {wheel.body, wheel.contact_local}).y() +
               (std::isinf(to_pivot) ? 0 : to_pivot);
    };
    list.push_back(
        {.name = "ackermann",
         .unit = Unit::percent,
         .main = false,
         .reads = Ackermann{left, right, model.vehicle->wheelbase / (y(left) - y(right))},
         .definition =
             "how nearly the perpendiculars to the two wheels meet on the line of the rear axle: "
             "(cot of the right wheel's angle less cot of the left one's) times the wheelbase over "
             "the "
             "distance across between the pivots on the road, positive where the inner wheel turns "
             "more, 100 % where they meet there; undefined unless both are turned the same way by "
             "2 "
             "deg or more"});
}

void add_compression(std::vector<Channel>& list, const Model& model, const std::string& name,
                     const char* what, const Point& i, const Point& j) {
    const Equilibrium drawn = design_state(model);
    list.push_back(
        {.name = name + ".compression",
         .main = false,
         .reads = Compression{i, j, (position(drawn, j) - position(drawn, i)).norm()},
         .definition = fmt::format("how much shorter {} '{}' is than as drawn, positive in "
                                   "compression",
                                   what, name)});
}

void add_wheel(std::vector<Channel>& list, const Model& model, std::size_t w) {
    const Wheel& wheel = model.wheels[w];
    const std::string prefix = wheel.name.empty() ? "" : wheel.name + ".";
    const Point centre{wheel.body, wheel.centre_local};
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
                    .reads = Coordinate{centre, 2, position(design_state(model), centre).z()},
                    .definition =
                        "vertical displacement of the wheel centre from its design position, "
                        "positive in jounce (up)"});
    add_patch(list, model, w, prefix);
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

const char* symbol(Unit unit) {
    switch (unit) {
        case Unit::mm: return "mm";
        case Unit::deg: return "deg";
        case Unit::newton: return "N";
        case Unit::newton_metre: return "N·m";
        case Unit::none: return "-";
        case Unit::deg_per_m: return "deg/m";
        case Unit::deg_per_100mm: return "deg/100 mm";
        case Unit::mm_per_100mm: return "mm/100 mm";
        case Unit::deg_per_mm: return "deg/mm";
        case Unit::deg_per_deg: return "deg/deg";
        case Unit::newton_per_mm: return "N/mm";
        case Unit::deg_per_kN: return "deg/kN";
        case Unit::deg_per_100Nm: return "deg/(100 N·m)";
        case Unit::percent: return "%";
    }
    return "";
}

double in_unit(Unit unit) {
    constexpr double deg = 180 / std::numbers::pi;
    switch (unit) {
        case Unit::mm: return 1e3;
        case Unit::deg:
        case Unit::deg_per_m: return deg;
        case Unit::newton:
        case Unit::newton_metre:
        case Unit::deg_per_deg:
        case Unit::none: return 1;
        case Unit::deg_per_100mm: return deg / 10;
        case Unit::mm_per_100mm: return 100;
        case Unit::deg_per_mm: return deg / 1e3;
        case Unit::newton_per_mm: return 1e-3;
        case Unit::deg_per_kN: return 1e3 * deg;
        case Unit::deg_per_100Nm: return 100 * deg;
        case Unit::percent: return 100;
    }
    return 1;
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

bool Channel::kinematic() const {
    return joints().empty() && !std::holds_alternative<OfElement>(reads) &&
           !std::holds_alternative<Characteristic>(reads);
}

bool Channel::may_be_undefined() const {
    return !undefined.empty() || std::holds_alternative<Steering>(reads) ||
           std::holds_alternative<Ackermann>(reads);
}

std::vector<int> Channel::joints() const {
    return std::visit(overloaded{[](const Coordinate&) { return std::vector<int>{}; },
                                 [](const Toe&) { return std::vector<int>{}; },
                                 [](const Camber&) { return std::vector<int>{}; },
                                 [](const Steering&) { return std::vector<int>{}; },
                                 [](const Track&) { return std::vector<int>{}; },
                                 [](const Ackermann&) { return std::vector<int>{}; },
                                 [](const Compression&) { return std::vector<int>{}; },
                                 [](const Effort& e) { return std::vector<int>{e.joint}; },
                                 [](const Reaction& r) { return std::vector<int>{r.joint}; },
                                 [](const Total& t) { return t.joints; },
                                 [](const Characteristic&) { return std::vector<int>{}; },
                                 [](const OfElement&) { return std::vector<int>{}; },
                                 [](const AxialForce& f) { return std::vector<int>{f.joint}; }},
                      reads);
}

std::vector<Channel> channels(const Model& model) {
    std::vector<Channel> list;
    for (std::size_t w = 0; w < model.wheels.size(); ++w) add_wheel(list, model, w);
    add_axle(list, model);
    for (const auto& probe : model.probes)
        add_position(list, probe.name, "'" + probe.name + "'", probe.at);
    for (const auto& elastic : model.elastics)
        if (const auto ends = points_of(elastic.kind);
            ends.size() == 2 && elastic.written_as == WrittenAs::itself)
            add_compression(list, model, elastic.name, "spring", ends[0], ends[1]);
    for (const auto& damper : model.dampers)
        add_compression(list, model, damper.name, "damper", damper.i, damper.j);
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

std::vector<bool> determined_channels(std::span<const Channel> channels, const Model& standing,
                                      const std::vector<bool>& determined) {
    std::vector<bool> stands(standing.joints.size(), false), list;
    for (const auto& constraint : standing.constraints)
        stands[static_cast<std::size_t>(constraint.joint)] = true;
    for (const auto& channel : channels) {
        const bool total = std::holds_alternative<Total>(channel.reads);
        list.push_back(std::ranges::all_of(channel.joints(), [&](int k) {
            const auto j = static_cast<std::size_t>(k);
            return stands[j] && (total || determined[j]);
        }));
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
        values.push_back(
            in_unit(channel.unit) *
            std::visit([&](const auto& c) { return read(model, state, c); }, channel.reads));
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
