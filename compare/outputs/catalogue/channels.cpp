#include "elastocheck/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "compare/outputs/catalogue/subject.hpp"
#include "compare/outputs/curve.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

const ModelJoint& joint_of(const Model& model, int joint) {
    return model.joints[static_cast<std::size_t>(joint)];
}

// ---- Formulas: values in SI, one function per type that a channel reads.

double read(const Subject& subject, const Coordinate& c) {
    return subject.placed(c.at).position[c.axis] - c.counted_from;
}
double read(const Subject& subject, const Catalogued& c) {
    // needs the response, which is not known here
    if (c.entry->kind == ChannelKind::characteristic) return nan;
    return c.entry->formula({subject.model, subject.state, c.of, subject.branch});
}
double read(const Subject& subject, const Effort& c) {
    const int driven = joint_of(subject.model, c.joint).driven;
    if (driven < 0) return 0;  // inactive on this branch
    const auto k = static_cast<std::size_t>(driven);
    const Wrench on_i = subject.wrench(c.joint);
    return std::visit(
        overloaded{
            [&](const DistanceBetween& b) {
                return on_i.force.dot(
                    (subject.placed(b.i).position - subject.placed(b.j).position).normalized());
            },
            [&](const PointInPlane& p) { return on_i.force.dot(subject.direction(p.normal_j)); },
            [&](const DirectionAtAngle& a) {
                return on_i.moment.dot(subject.direction(a.j).cross(subject.direction(a.y_j)));
            },
            // No offset to drive: lowering never drives these.
            [](const CoincidentPoints&) { return std::nan(""); },
            [](const PerpendicularDirections&) { return std::nan(""); }},
        subject.model.constraints[k].kind);
}
double read(const Subject& subject, const AxialForce& c) {
    const auto k = static_cast<std::size_t>(c.constraint);
    const auto& rod = std::get<DistanceBetween>(subject.model.constraints[k].kind);
    return subject.wrench(c.joint).force.dot(
        (subject.placed(rod.j).position - subject.placed(rod.i).position).normalized());
}
double read(const Subject& subject, const Reaction& c) {
    const Wrench on_i = subject.wrench(c.joint);
    return c.component < 3 ? on_i.force[c.component] : on_i.moment[c.component - 3];
}
double read(const Subject& subject, const Total& c) {
    const auto point = [&](int joint) {
        return subject.placed(joint_of(subject.model, joint).at).position;
    };
    const Vector3d about = point(c.joints.front());
    double sum = 0;
    for (const int k : c.joints) {
        const ModelJoint& joint = joint_of(subject.model, k);
        const double sign = joint.i == c.on ? 1 : -1;
        const Wrench w = subject.wrench(k);
        const Vector3d moment = w.moment + (point(k) - about).cross(w.force);
        sum += sign * (c.component < 3 ? w.force[c.component] : moment[c.component - 3]);
    }
    return sum;
}
// Needs the branch: comparison/elements.cpp.
double read(const Subject&, const ElementComponent&) { return nan; }

// ---- Units, in the order of Unit.

struct UnitEntry {
    std::string_view symbol;
    double per_si;
};
constexpr double deg = 180 / std::numbers::pi;
constexpr std::array<UnitEntry, static_cast<std::size_t>(Unit::newton_metre_per_deg) + 1> units{
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
     {"%", 100},
     {"N·m/deg", 1 / deg}}};

// ---- The list

std::string quoted_body(const Model& model, BodyId body) {
    return body == ground ? "ground"
                          : "'" + model.bodies[static_cast<std::size_t>(body)].name + "'";
}

void add_wrench(std::vector<Channel>& list, const std::string& stem, const std::string& quantity,
                const std::string& about, const auto& reads) {
    for (int k = 0; k < 6; ++k) {
        const auto axis = static_cast<std::size_t>(k % 3);
        list.push_back(
            {.name = fmt::format("{}.{}_{}", stem, k < 3 ? "force" : "moment", axes[axis]),
             .unit = k < 3 ? Unit::newton : Unit::newton_metre,
             .main = false,
             .reads = reads(k),
             .definition = k < 3 ? fmt::format("force of {}, {}", quantity, axis_words(k))
                                 : fmt::format("moment of {}, about {}, ground axis {}, "
                                               "right-handed",
                                               quantity, about, axes[axis])});
    }
}

void add_effort(std::vector<Channel>& list, const Model& model, int k) {
    const ModelJoint& joint = joint_of(model, k);
    if (joint.driven < 0) return;
    const bool turns = is_angle(model.constraints[static_cast<std::size_t>(joint.driven)].kind);
    // The driver of joint `rack` is a separate joint, `rack.drive`; its effort is reported
    // for the rack.
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

// Parts of the list channels(), in its order; responses are not in it.
enum class Part { wheel, axle, spring, load, response };
Part part_of(const Entry& entry) {
    if (entry.kind == ChannelKind::characteristic) return Part::response;
    if (entry.kind == ChannelKind::element) return Part::load;
    switch (entry.owner) {
        case Owner::axle:
        case Owner::front_axle: return Part::axle;
        case Owner::spring:
        case Owner::damper: return Part::spring;
        default: return Part::wheel;
    }
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
    return std::visit(overloaded{[](const Catalogued& c) { return c.entry->kind; },
                                 [](const auto& c) { return c.kind; }},
                      reads);
}

bool Channel::may_be_undefined() const {
    const auto* figure = std::get_if<Catalogued>(&reads);
    return !undefined.empty() || (figure != nullptr && figure->entry->properties.may_be_undefined);
}

std::vector<int> Channel::joints() const {
    return std::visit(
        overloaded{[](const Effort& e) { return std::vector{e.joint}; },
                   [](const Reaction& r) { return std::vector{r.joint}; },
                   [](const AxialForce& f) { return std::vector{f.joint}; },
                   [](const Total& t) { return t.joints; },
                   [](const Catalogued&) { return std::vector<int>{}; },
                   [](const auto& c) {
                       static_assert(std::decay_t<decltype(c)>::kind != ChannelKind::drive &&
                                     std::decay_t<decltype(c)>::kind != ChannelKind::reaction);
                       return std::vector<int>{};
                   }},
        reads);
}

std::vector<Channel> channels(const Model& model) {
    std::vector<Channel> list;
    const auto add = [&](Part part, int wheel = -1) {
        for (const Entry& entry : catalogue())
            if (!entry.on_request && part_of(entry) == part)
                for (const NamedOwner& owner : owners(model, entry.owner))
                    if (wheel < 0 || owner.k == static_cast<std::size_t>(wheel))
                        list.push_back(channel_of(model, entry, owner));
    };
    for (int w = 0; w < static_cast<int>(model.wheels.size()); ++w) add(Part::wheel, w);
    add(Part::axle);
    for (const Probe& probe : model.probes)
        for (int k = 0; k < 3; ++k)
            list.push_back(
                {.name = probe.name + "_" + axes[static_cast<std::size_t>(k)],
                 .reads = Coordinate{probe.at, k},
                 .definition = fmt::format("position of '{}', {}", probe.name, axis_words(k))});
    add(Part::spring);
    add(Part::load);
    for (const int k : joints_moved(model)) add_effort(list, model, k);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
        const ModelJoint& joint = model.joints[k];
        add_wrench(list, joint.name,
                   fmt::format("joint '{}' on {}", joint.name, quoted_body(model, joint.i)),
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
        std::map<BodyId, std::vector<int>> held;  // joints of the group on each body
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
                       fmt::format("joints {} together on {}", names, quoted_body(model, body)),
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

int default_abscissa(std::span<const Channel> channels, const Curve& curve) {
    int best = -1;
    double farthest = -1;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (is_figure(channels[c], figure::travel)) return static_cast<int>(c);
        if (!channels[c].main || !std::holds_alternative<Coordinate>(channels[c].reads)) continue;
        const auto y = curve.channel(c);
        const auto [low, high] =
            y.empty() ? std::pair(0., 0.) : std::pair(std::ranges::min(y), std::ranges::max(y));
        const double range = high - low;
        if (range > farthest) {
            farthest = range;
            best = static_cast<int>(c);
        }
    }
    return best;
}

std::vector<double> evaluate(const Model& model, std::span<const Channel> channels,
                             const Equilibrium& state) {
    const Subject subject{model, &state};
    std::vector<double> values;
    values.reserve(channels.size());
    for (const auto& channel : channels)
        values.push_back(
            in_unit(channel.unit) *
            std::visit([&](const auto& c) { return read(subject, c); }, channel.reads));
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
