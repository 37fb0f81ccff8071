#include "compare/warnings/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Plausible ranges for a car at rest beside those of the catalogue, in mm and N.

constexpr PlausibleRange movement{0, 50,
                                  "is a preload or a trim missing, or a rate in another unit?"};
constexpr PlausibleRange spring_force{
    -20, infinity, "it is in tension: does a load point down, or is its preload missing?"};
constexpr PlausibleRange bushing_displacement{0, 20, "is its rate in another unit?"};
// x points rearward where caster, mechanical trail and anti-dive or anti-lift are all below this.
constexpr double clearly_negative = -0.5;  // [deg], [mm], [%]

// ---- The state at rest.

struct AtRest {
    const Model& model;
    std::vector<Channel> channels;
    std::vector<double> values, drawn;

    std::optional<double> find(const std::string& name) const {
        const int k = find_channel(channels, name);
        if (k < 0) return std::nullopt;
        const double value = values[static_cast<std::size_t>(k)];
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
    }
    double moved(const std::string& name) const {
        const auto k = static_cast<std::size_t>(find_channel(channels, name));
        return values[k] - drawn[k];
    }
};

std::optional<AtRest> at_rest(const Model& model) {
    if (model.wheels.empty() || model.branches.empty()) return std::nullopt;
    const auto sides = sides_of(model, model.branches.front());
    if (sides.empty()) return std::nullopt;
    const BranchSide& side = sides.front();
    const EquilibriumPath path = settle_start(side, Leg::equilibrium);
    if (path.points.empty()) return std::nullopt;
    AtRest found{model, channels(model), {}, {}};
    std::ranges::move(characteristics(model), std::back_inserter(found.channels));
    std::ranges::move(element_channels(model), std::back_inserter(found.channels));
    found.values =
        row_of(model, found.channels, side, {.leg = Leg::equilibrium}, path.points.front()).values;
    found.drawn = evaluate(model, found.channels, design_state(model));
    return found;
}

std::string prefix(const std::string& name) { return name.empty() ? "" : name + "."; }

struct PrintedValue {
    std::vector<std::string> place;
    double value;
    const char* unit;
};
std::vector<std::string> place_of(const Wheel& wheel) {
    if (wheel.name.empty()) return {"wheel"};
    return {"wheels", wheel.name};
}

std::vector<PrintedValue> of_wheels(const AtRest& state, const Entry& entry) {
    std::vector<PrintedValue> list;
    for (const auto& wheel : state.model.wheels)
        if (const auto value = state.find(prefix(wheel.name) + entry.name))
            list.push_back({place_of(wheel), *value, symbol(entry.unit)});
    return list;
}
// Distances of the wheel centres from where they are drawn.
std::vector<PrintedValue> movements(const AtRest& state) {
    std::vector<PrintedValue> list;
    for (std::size_t w = 0; w < state.model.wheels.size(); ++w) {
        const Wheel& wheel = state.model.wheels[w];
        Vector3d by;
        for (const Entry& entry : catalogue())
            if (entry.point != nullptr && entry.properties.is_main)
                by[entry.axis] = state.moved(prefix(wheel.name) + entry.name);
        list.push_back({place_of(wheel), by.norm(), "mm"});
    }
    return list;
}
std::vector<PrintedValue> of_elements(const AtRest& state, bool springs) {
    std::vector<PrintedValue> list;
    for (const auto& elastic : state.model.elastics) {
        const bool is_spring = member<ScalarLaw>(elastic.kind) != nullptr;
        if (elastic.written_as != WrittenAs::itself || is_spring != springs) continue;
        if (is_spring) {
            if (const auto value = state.find(elastic.name + ".force"))
                list.push_back({{"springs", elastic.name}, *value, "N"});
            continue;
        }
        double sum = 0;
        for (const char* axis : axes)
            sum = std::hypot(
                sum, state.find(fmt::format("{}.displacement_{}", elastic.name, axis)).value_or(0));
        list.push_back({{"bushings", elastic.name}, sum, "mm"});
    }
    return list;
}

std::string words_of(const PlausibleRange& range) {
    return range.to == infinity      ? fmt::format("at least {:g}", range.from)
           : range.from == -infinity ? fmt::format("at most {:g}", range.to)
                                     : fmt::format("{:g} to {:g}", range.from, range.to);
}

// Adds the first value outside of the range to the list, with the number of the others.
void judge(const std::vector<PrintedValue>& readings, const std::string& output,
           const PlausibleRange& range, std::vector<Implausible>& list) {
    int more = -1;
    for (const auto& [place, value, unit] : readings)
        if (!(value >= range.from && value <= range.to) && ++more == 0)
            list.push_back({place, fmt::format("{} {:.4g} {} at rest, plausible: {}; {}", output,
                                               value, unit, words_of(range), range.question)});
    if (more > 0) list.back().what += fmt::format(" (and {} more)", more);
}

// Warning where figures of a wheel show that x points rearward.
std::optional<Implausible> rearward(const AtRest& state, const Wheel& wheel) {
    const auto find = [&](std::string_view name) {
        return state.find(prefix(wheel.name) + std::string(name));
    };
    const auto caster = find(figure::caster), trail = find(figure::mechanical_trail);
    const bool front = find(figure::anti_dive).has_value();
    const auto anti = find(front ? figure::anti_dive : figure::anti_lift);
    if (!caster || !trail || !anti || *caster > clearly_negative || *trail > clearly_negative ||
        *anti > clearly_negative)
        return std::nullopt;
    return Implausible{
        place_of(wheel),
        fmt::format("caster {:.3g} deg, mechanical trail {:.3g} mm and {} {:.3g} % are all "
                    "negative; does x point rearward?",
                    *caster, *trail, front ? "anti-dive" : "anti-lift", *anti)};
}

// ---- Points and bodies.

struct Attached {
    BodyId body;
    Vector3d at;
    std::size_t connection = std::string::npos;  // none: the origin of the body
};
struct Connection {
    std::string name;
    Attached i, j;

    bool is_link() const { return (i.at - j.at).norm() > 1e-3; }  // [m]
};
struct Drawn {
    const Scene& scene;
    std::vector<Connection> connections{};
    std::map<BodyId, std::vector<Attached>> points{};

    // Distance [m] from p of the nearest point of a body, and the largest distance of two of its points,
    // both without the points of the connection `without`.
    double nearest(BodyId body, const Vector3d& p, std::size_t without) const {
        double least = infinity;
        if (const auto of = points.find(body); of != points.end())
            for (const auto& point : of->second)
                if (point.connection != without) least = std::min(least, (point.at - p).norm());
        return least;
    }
    double extent(BodyId body, std::size_t without) const {
        double largest = 0;
        for (const auto& a : points.at(body))
            for (const auto& b : points.at(body))
                if (a.connection != without && b.connection != without)
                    largest = std::max(largest, (a.at - b.at).norm());
        return largest;
    }
    std::string name(BodyId body) const { return body_name(scene, body); }
};

Drawn drawn(const Scene& scene) {
    Drawn drawing{scene};
    std::vector<Pose> poses;
    for (const auto& body : scene.bodies) {
        drawing.points[static_cast<BodyId>(poses.size())].push_back(
            {static_cast<BodyId>(poses.size()), body.design.r});
        poses.push_back(body.design);
    }
    const auto add = [&](const std::string& name, const auto& kind) {
        std::vector<Attached> ends;
        each_point(kind, [&](const auto& end) {
            ends.push_back(
                {end.body, position(poses, end.body, end.s_local), drawing.connections.size()});
        });
        if (ends.size() != 2) return;
        const auto same = [&](const Attached& a) {  // a stop beside its spring, a drive
            if (a.connection == std::string::npos || !a.at.isApprox(ends[0].at)) return false;
            const Connection& c = drawing.connections[a.connection];
            return c.i.body == ends[0].body && c.j.body == ends[1].body &&
                   c.i.at.isApprox(ends[0].at) && c.j.at.isApprox(ends[1].at);
        };
        if (std::ranges::any_of(drawing.points[ends[0].body], same)) return;
        drawing.connections.push_back({name, ends[0], ends[1]});
        for (const auto& end : ends) drawing.points[end.body].push_back(end);
    };
    for (const auto& joint : scene.joints) add(joint.name, joint.kind);
    for (const auto& elastic : scene.elastics) add(elastic.name, elastic.kind);
    return drawing;
}

constexpr double much_farther = 2;  // ratio of distances

// Warning if the ends i and j of a link or body are more than twice as far from the other points of
// their own bodies (`own`) as from those of the body of the other end (`other`); else empty. For a
// link the sums of both ends are compared. For a body between two joints (`by_each`) the distances
// of each end are compared too, since the bodies at these joints may be long.
std::string exchanged_ends(const Drawn& d, const std::string& name, const Attached& i,
                           const Attached& j, bool by_each) {
    const double own = d.nearest(i.body, i.at, i.connection),
                 other = d.nearest(j.body, i.at, j.connection),
                 own_j = d.nearest(j.body, j.at, j.connection),
                 other_j = d.nearest(i.body, j.at, i.connection);
    if (!(std::isfinite(own + own_j) && own + own_j > much_farther * (other + other_j))) return {};
    if (by_each && !(own > much_farther * other && own_j > much_farther * other_j)) return {};
    return fmt::format(
        "'{}': its end on '{}' is {:.0f} mm from the other points of '{}' and {:.0f} mm from those "
        "of '{}'; are its ends exchanged?",
        name, d.name(i.body), 1e3 * own, d.name(i.body), 1e3 * other, d.name(j.body));
}

// Warning for the first two joints of a body whose other bodies are exchanged; else empty. Bodies
// with more than eight joints (a hub or subframe) are not examined.
std::string exchanged_joints(const Drawn& d, BodyId body) {
    constexpr std::size_t max_joints = 8;
    std::vector<Attached> ends;  // on the other bodies
    for (const auto& point : d.points.at(body)) {
        if (point.connection == std::string::npos) continue;
        const Connection& c = d.connections[point.connection];
        if (!c.is_link()) ends.push_back(c.i.body == body ? c.j : c.i);
    }
    if (ends.size() > max_joints) return {};
    for (std::size_t k = 0; k < ends.size(); ++k)
        for (std::size_t l = 0; l < k; ++l)
            if (ends[k].body != ends[l].body)
                if (auto note = exchanged_ends(d, d.name(body), ends[l], ends[k], true);
                    !note.empty())
                    return note;
    return {};
}

// Warning if a joint's point is more than 1 m, and more than twice their extent, from the other
// points of its body, and less than half as far from those of its other body; else empty.
std::string wrong_body(const Drawn& d, const std::string& name, const Attached& end,
                       const Attached& other) {
    constexpr double distinct = 1e-3, min_distance = 1;  // [m]
    const double away = d.nearest(end.body, end.at, end.connection);
    if (end.body == ground || !std::isfinite(away) || away <= min_distance) return {};
    const double extent = d.extent(end.body, end.connection),
                 near = d.nearest(other.body, end.at, other.connection);
    if (extent <= distinct || away <= much_farther * extent || away <= much_farther * near)
        return {};
    return fmt::format(
        "'{}' is {:.0f} mm from the other points of '{}', which extend over {:.0f} mm, and {:.0f} "
        "mm from those of '{}'; is '{}' the body meant?",
        name, 1e3 * away, d.name(end.body), 1e3 * extent, 1e3 * near, d.name(other.body),
        d.name(end.body));
}

}  // namespace

std::vector<Implausible> implausible(const Model& model) {
    std::vector<Implausible> list;
    const auto state = at_rest(model);
    if (!state) return list;
    for (const Entry& entry : catalogue())
        if (entry.properties.plausible_range.question != nullptr) {
            std::string output = entry.name;
            std::ranges::replace(output, '_', ' ');
            judge(of_wheels(*state, entry), output, entry.properties.plausible_range, list);
        }
    judge(movements(*state), "shift", movement, list);
    judge(of_elements(*state, true), "force", spring_force, list);
    judge(of_elements(*state, false), "displacement", bushing_displacement, list);
    for (const auto& wheel : model.wheels)
        if (auto found = rearward(*state, wheel)) {
            list.push_back(std::move(*found));
            break;
        }
    return list;
}

std::vector<std::string> misplaced_points(const Scene& scene) {
    std::vector<std::string> notes;
    const auto add = [&](std::string note) {
        if (!note.empty()) notes.push_back(std::move(note));
    };
    const Drawn all = drawn(scene);
    for (const auto& c : all.connections) {
        if (c.is_link()) {
            add(exchanged_ends(all, c.name, c.i, c.j, false));
            continue;
        }
        add(wrong_body(all, c.name, c.i, c.j));
        add(wrong_body(all, c.name, c.j, c.i));
    }
    for (std::size_t body = 0; body < scene.bodies.size(); ++body)
        add(exchanged_joints(all, static_cast<BodyId>(body)));
    return notes;
}

}  // namespace elastocheck::compare
