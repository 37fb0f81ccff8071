#include "elastocheck/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "compare/outputs/dual.hpp"
#include "compare/outputs/positions.hpp"
#include "compare/outputs/rates.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr std::array towards{"forward", "to the left", "up"};

const ModelJoint& joint_of(const Model& model, int joint) {
    return model.joints[static_cast<std::size_t>(joint)];
}

template <class S>
using Vector = Eigen::Matrix<S, 3, 1>;

// A force and a moment, for S = Dual with their derivatives.
template <class S>
struct ForceMoment {
    Vector<S> force, moment;
};

// A state, for S = Dual with a motion of its bodies, d(r + A s) = dr + dπ × A s + A ds, and with
// the change of the model by one of its numbers: `rate`, a Model of the same shape. The features
// that a channel reads come in pairs: in the model, and their rates in their bodies.
template <class S>
struct Configuration {
    const Model& model;
    const Equilibrium& state;
    std::span<const Increment> motion = {};  // one per body, for S = Dual
    const Model* rate = nullptr;             // none: the model is constant
    std::span<const Wrench> wrench_rates = {};

    const Wheel& wheel(std::size_t w) const { return model.wheels[w]; }
    const Wheel& wheel_rate(std::size_t w) const { return changing().wheels[w]; }
    // Where the model is constant, its own parts stand in the place of rates and are not read.
    const Model& changing() const { return rate != nullptr ? *rate : model; }

    S number(double value, double derivative) const {
        if constexpr (std::is_same_v<S, Dual>)
            if (rate != nullptr) return S(value, derivative);
        return S(value);
    }
    Vector<S> direction(const Direction& u, const Direction& d) const {
        const Vector3d fixed = pose(state.poses, u.body).p * u.u_local;
        return carried(u.body, Vector3d::Zero(), fixed, d.u_local, false);
    }
    Vector<S> position(const Point& point, const Point& d) const {
        const Vector3d lever = pose(state.poses, point.body).p * point.s_local;
        return carried(point.body, pose(state.poses, point.body).r, lever, d.s_local, true);
    }
    Vector<S> spin_axis(std::size_t w) const {
        return direction({wheel(w).body, wheel(w).spin_axis_local},
                         {wheel(w).body, wheel_rate(w).spin_axis_local});
    }
    Vector<S> patch(std::size_t w) const {
        return position({wheel(w).body, wheel(w).contact_local},
                        {wheel(w).body, wheel_rate(w).contact_local});
    }
    ForceMoment<S> wrench(int joint) const {
        const auto k = static_cast<std::size_t>(joint);
        const Wrench &value = state.reactions[k],
                     derivative = wrench_rates.empty() ? Wrench{} : wrench_rates[k];
        return {with(value.force, derivative.force), with(value.moment, derivative.moment)};
    }

  private:
    // The sum of a body's origin r, or zero for a direction, and of its vector u, which changes by
    // its rotation and by du' in its axes.
    Vector<S> carried(BodyId body, const Vector3d& r, const Vector3d& u, const Vector3d& du_local,
                      bool with_origin) const {
        Vector3d derivative = Vector3d::Zero();
        if constexpr (std::is_same_v<S, Dual>) {
            if (body != ground && !motion.empty()) {
                const auto& [dr, dpi] = motion[static_cast<std::size_t>(body)];
                derivative = dpi.cross(u);
                if (with_origin) derivative += dr;
            }
            if (rate != nullptr) derivative += pose(state.poses, body).p * du_local;
        }
        return with(r + u, derivative);
    }
    static Vector<S> with(const Vector3d& value, const Vector3d& derivative) {
        if constexpr (std::is_same_v<S, Dual>)
            return {S(value.x(), derivative.x()), S(value.y(), derivative.y()),
                    S(value.z(), derivative.z())};
        else
            return value;
    }
};

// ---- Formulas: values in SI, one function per type that a channel reads; `d` holds the rates of
// its own points and numbers.

template <class S>
S read(const Configuration<S>& at, const Coordinate& c, const Coordinate& d) {
    return S(c.sign) *
           (at.position(c.at, d.at)[c.axis] - at.number(c.counted_from, d.counted_from));
}
template <class S>
S read(const Configuration<S>& at, const Toe& c, const Toe&) {
    using std::atan2;
    const Vector<S> e = at.spin_axis(c.wheel);
    return atan2(e.x(), S(at.wheel(c.wheel).side) * e.y());
}
template <class S>
S read(const Configuration<S>& at, const Camber& c, const Camber&) {
    using std::asin;
    return -asin(at.spin_axis(c.wheel).z());
}

// ---- Steering axis.

constexpr double flattest = 0.1;  // [rad] smallest angle of a steering axis to the road
const double least_steering = 2 * std::numbers::pi / 180;

// Vector from the contact patch to the intersection of the steering axis with the road; undefined
// for a flat axis.
template <class S>
Vector<S> pivot(const Configuration<S>& at, std::size_t wheel) {
    const auto& [lower, upper] = *at.wheel(wheel).steering_axis;
    const auto& [dlower, dupper] = *at.wheel_rate(wheel).steering_axis;
    const Vector<S> l = at.position(lower, dlower), u = at.position(upper, dupper) - l,
                    c = at.patch(wheel);
    if (!(abs(u.z()) > S(std::sin(flattest)) * u.norm())) return Vector<S>::Constant(S(undefined));
    return l + u * ((c.z() - l.z()) / u.z()) - c;
}

template <class S>
S read(const Configuration<S>& at, const Steering& c, const Steering&) {
    using std::atan;
    const auto& [lower, upper] = *at.wheel(c.wheel).steering_axis;
    const auto& [dlower, dupper] = *at.wheel_rate(c.wheel).steering_axis;
    const Vector<S> u = at.position(upper, dupper) - at.position(lower, dlower),
                    off = pivot(at, c.wheel), e = at.spin_axis(c.wheel);
    if (std::isinf(value_of(off.x()))) return undefined;
    const S side = at.wheel(c.wheel).side;
    const Vector<S> n = Vector<S>(e.x(), e.y(), S(0)).normalized(),
                    h = side * n.cross(Vector<S>(S(0), S(0), S(1)));
    switch (c.figure) {
        case Steering::Figure::caster: return atan(-u.x() / u.z());
        case Steering::Figure::kingpin_inclination: return atan(-side * u.y() / u.z());
        case Steering::Figure::scrub_radius: return -n.dot(off);
        case Steering::Figure::mechanical_trail: return h.dot(off);
    }
    return undefined;
}
template <class S>
S read(const Configuration<S>& at, const Track& c, const Track&) {
    return at.patch(c.left).y() - at.patch(c.right).y();
}
template <class S>
S read(const Configuration<S>& at, const Ackermann& c, const Ackermann& d) {
    using std::abs, std::tan;
    const S left = -read(at, Toe{c.left}, {}), right = read(at, Toe{c.right}, {});
    if (!(left * right > S(0) && std::min(abs(left), abs(right)) >= S(least_steering)))
        return undefined;
    return (S(1) / tan(right) - S(1) / tan(left)) *
           at.number(c.wheelbase_by_pivots, d.wheelbase_by_pivots);
}
template <class S>
S read(const Configuration<S>& at, const Compression& c, const Compression& d) {
    return at.number(c.drawn, d.drawn) - (at.position(c.j, d.j) - at.position(c.i, d.i)).norm();
}
template <class S>
S read(const Configuration<S>& at, const Effort& c, const Effort&) {
    const int driven = joint_of(at.model, c.joint).driven;
    if (driven < 0) return S(0);  // inactive on this branch
    const auto k = static_cast<std::size_t>(driven);
    const ForceMoment<S> on_i = at.wrench(c.joint);
    const ConstraintKind& changing = at.changing().constraints[k].kind;
    return std::visit(
        overloaded{
            [&](const DistanceBetween& b) -> S {
                const auto& d = std::get<DistanceBetween>(changing);
                return on_i.force.dot((at.position(b.i, d.i) - at.position(b.j, d.j)).normalized());
            },
            [&](const PointInPlane& p) -> S {
                const auto& d = std::get<PointInPlane>(changing);
                return on_i.force.dot(at.direction(p.normal_j, d.normal_j));
            },
            [&](const DirectionAtAngle& a) -> S {
                const auto& d = std::get<DirectionAtAngle>(changing);
                return on_i.moment.dot(at.direction(a.j, d.j).cross(at.direction(a.y_j, d.y_j)));
            },
            // No offset to drive: lowering never drives these.
            [](const CoincidentPoints&) -> S { return std::nan(""); },
            [](const PerpendicularDirections&) -> S { return std::nan(""); }},
        at.model.constraints[k].kind);
}
template <class S>
S read(const Configuration<S>& at, const AxialForce& c, const AxialForce&) {
    const auto k = static_cast<std::size_t>(c.constraint);
    const auto& rod = std::get<DistanceBetween>(at.model.constraints[k].kind);
    const auto& d = std::get<DistanceBetween>(at.changing().constraints[k].kind);
    return at.wrench(c.joint).force.dot(
        (at.position(rod.j, d.j) - at.position(rod.i, d.i)).normalized());
}
template <class S>
S read(const Configuration<S>& at, const Reaction& c, const Reaction&) {
    const ForceMoment<S> on_i = at.wrench(c.joint);
    return c.component < 3 ? on_i.force[c.component] : on_i.moment[c.component - 3];
}
template <class S>
S read(const Configuration<S>& at, const Total& c, const Total&) {
    const auto point = [&](int joint) {
        return at.position(joint_of(at.model, joint).at, joint_of(at.changing(), joint).at);
    };
    const Vector<S> about = point(c.joints.front());
    S sum = 0;
    for (const int k : c.joints) {
        const ModelJoint& joint = joint_of(at.model, k);
        const S sign = joint.i == c.on ? 1 : -1;
        const ForceMoment<S> w = at.wrench(k);
        const Vector<S> moment = w.moment + (point(k) - about).cross(w.force);
        sum += sign * (c.component < 3 ? w.force[c.component] : moment[c.component - 3]);
    }
    return sum;
}
// Need more than the state.
template <class S>
S read(const Configuration<S>&, const OfElement&, const OfElement&) {
    return std::nan("");
}
template <class S>
S read(const Configuration<S>&, const Characteristic&, const Characteristic&) {
    return std::nan("");
}
template <class S>
S read(const Configuration<S>& at, const Defined& c, const Defined&) {
    if constexpr (std::is_same_v<S, double>) return c.value(at.model, c.wheel, at.state);
    return std::nan("");
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

// The model as drawn. With a rate of the model, the channels read the rates of their points and
// numbers in place of these.
struct Drawing {
    const Model& model;
    const Model* rate = nullptr;

    const Model& read() const { return rate != nullptr ? *rate : model; }
    // A number of the design position, `formula` of its configuration; its rate, with a rate.
    template <class Formula>
    double number(const Formula& formula) const {
        const Equilibrium drawn = design_state(model);
        if (rate == nullptr) return formula(Configuration<double>{model, drawn});
        std::vector<Increment> motion;
        for (std::size_t b = 0; b < model.bodies.size(); ++b) {
            const Pose &at = model.bodies[b].design, &by = rate->bodies[b].design;
            motion.push_back({by.r, 2 * (by.p * at.p.conjugate()).vec()});
        }
        return formula(Configuration<Dual>{model, drawn, motion, rate}).dx;
    }
    double coordinate(const Point& at, const Point& d, int axis) const {
        return number([&](const auto& design) { return design.position(at, d)[axis]; });
    }
};
Point centre_of(const Wheel& wheel) { return {wheel.body, wheel.centre_local}; }
Point patch_of(const Wheel& wheel) { return {wheel.body, wheel.contact_local}; }

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
    const Point patch = patch_of(design.read().wheels[w]);
    const auto drawn = [&](int axis) { return design.coordinate(patch_of(wheel), patch, axis); };
    const std::size_t first = list.size();
    add_position(list, prefix + "contact_patch",
                 "the point of the wheel's body that is the contact patch at the design position",
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
    const double wheelbase_by_pivots = design.number([&]<class S>(const Configuration<S>& at) {
        const auto y = [&](std::size_t w) -> S {
            const S patch = at.patch(w).y();
            if (!at.wheel(w).steering_axis) return patch;
            const S to_pivot = pivot(at, w).y();
            return std::isinf(value_of(to_pivot)) ? patch : patch + to_pivot;
        };
        const Vehicle &vehicle = *at.model.vehicle, &d = *at.changing().vehicle;
        return at.number(vehicle.wheelbase, d.wheelbase) / (y(left) - y(right));
    });
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

// i and j, and the same of design.read().
struct Between {
    Point i, j;
};
void add_compression(std::vector<Channel>& list, const Drawing& design, const std::string& name,
                     const char* what, const Between& ends, const Between& read) {
    const double drawn = design.number([&](const auto& at) {
        return (at.position(ends.j, read.j) - at.position(ends.i, read.i)).norm();
    });
    list.push_back(
        {.name = name + ".compression",
         .main = false,
         .reads = Compression{read.i, read.j, drawn},
         .definition = fmt::format("design length less length of {} '{}', positive in compression",
                                   what, name)});
}

void add_wheel(std::vector<Channel>& list, const Drawing& design, std::size_t w) {
    const Wheel& wheel = design.model.wheels[w];
    const std::string prefix = wheel.name.empty() ? "" : wheel.name + ".";
    const Point centre = centre_of(design.read().wheels[w]);
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
                    .reads = Coordinate{centre, 2, design.coordinate(centre_of(wheel), centre, 2)},
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

namespace {

std::vector<Channel> list_of(const Drawing& design) {
    const Model &model = design.model, &read = design.read();
    std::vector<Channel> list;
    for (std::size_t w = 0; w < model.wheels.size(); ++w) add_wheel(list, design, w);
    add_axle(list, design);
    for (std::size_t k = 0; k < model.probes.size(); ++k) {
        const std::string& name = model.probes[k].name;
        add_position(list, name, "'" + name + "'", read.probes[k].at);
    }
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        if (const auto ends = points_of(model.elastics[k].kind);
            ends.size() == 2 && model.elastics[k].written_as == WrittenAs::itself) {
            const auto of_read = points_of(read.elastics[k].kind);
            add_compression(list, design, model.elastics[k].name, "spring", {ends[0], ends[1]},
                            {of_read[0], of_read[1]});
        }
    for (std::size_t k = 0; k < model.dampers.size(); ++k)
        add_compression(list, design, model.dampers[k].name, "damper",
                        {model.dampers[k].i, model.dampers[k].j},
                        {read.dampers[k].i, read.dampers[k].j});
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

}  // namespace

std::vector<Channel> channels(const Model& model) { return list_of({model}); }
std::vector<Reads> read_rates(const Model& model, const Model& rate) {
    std::vector<Reads> reads;
    for (auto& channel : list_of({model, &rate})) reads.push_back(std::move(channel.reads));
    return reads;
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
                                 return read(Configuration<double>{model, state}, c, c);
                             },
                             channel.reads));
    return values;
}

double rate_of(const Model& model, const Reads& reads, const Equilibrium& state,
               std::span<const Increment> motion) {
    const Configuration<Dual> at{model, state, motion};
    return std::visit(
        [&](const auto& c) {
            if constexpr (std::decay_t<decltype(c)>::kind == ChannelKind::motion) {
                const Dual value = read(at, c, c);
                return std::isinf(value.x) ? std::nan("") : value.dx;
            } else
                return std::nan("");
        },
        reads);
}

double rate_of(const Model& model, const Reads& reads, const Equilibrium& state, const Model& rate,
               const Reads& reads_rate, const StateRate& state_rate) {
    if (state_rate.outcome != Outcome::converged) return std::nan("");
    const Configuration<Dual> at{model, state, state_rate.increments, &rate, state_rate.reactions};
    return std::visit(
        [&]<class Kind>(const Kind& c) {
            const Dual value = read(at, c, std::get<Kind>(reads_rate));
            return std::isinf(value.x) ? std::nan("") : value.dx;
        },
        reads);
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
