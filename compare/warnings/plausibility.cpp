#include "compare/warnings/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- What is plausible of a car at rest, in the unit of the output.

enum class Of { wheel, spring, bushing };
struct Range {
    Of of;
    const char* output;
    double from, to;
    const char* asks;
};
constexpr Range ranges[] = {
    {Of::wheel, "toe", -10, 10, "is a tie rod missing, or a rate in another unit?"},
    {Of::wheel, "camber", -15, 15, "is a link missing, or a rate in another unit?"},
    {Of::wheel, "shift", 0, 50,
     "is a preload or a trim missing, or a rate in another unit?"},  // of the centre, from the drawing
    {Of::wheel, "wheel_rate", -infinity, 2000, "is a rate in another unit?"},
    {Of::spring, "force", -20, infinity,
     "it is in tension: does a load point down, or is its preload missing?"},
    {Of::bushing, "displacement", 0, 20, "is its rate in another unit?"},
};
// Figures of a wheel that together turn negative where x points rearward.
constexpr double clearly = -0.5;  // [deg], [mm], [%]

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
    const EquilibriumPath path = rest(side, Leg::equilibrium);
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

struct Read {
    std::vector<std::string> place;
    double value;
    const char* unit;
};

// The values of one row, in the order of the wheels or elements.
std::vector<Read> read(const AtRest& state, const Range& range) {
    std::vector<Read> list;
    const std::string output = range.output;
    if (range.of == Of::wheel) {
        for (const auto& wheel : state.model.wheels) {
            const std::string of = prefix(wheel.name);
            const auto place = wheel.name.empty() ? std::vector<std::string>{"wheel"}
                                                  : std::vector<std::string>{"wheels", wheel.name};
            if (output == "shift") {
                const Vector3d by(state.moved(of + "wheel_centre_x"),
                                  state.moved(of + "wheel_centre_y"),
                                  state.moved(of + "wheel_centre_z"));
                list.push_back({place, by.norm(), "mm"});
            } else if (const auto value = state.find(of + output)) {
                const int k = find_channel(state.channels, of + output);
                list.push_back(
                    {place, *value, symbol(state.channels[static_cast<std::size_t>(k)].unit)});
            }
        }
        return list;
    }
    for (const auto& elastic : state.model.elastics) {
        const bool is_spring = member<ScalarLaw>(elastic.kind) != nullptr;
        if (elastic.written_as != WrittenAs::itself || is_spring != (range.of == Of::spring))
            continue;
        if (is_spring) {
            if (const auto value = state.find(elastic.name + "." + output))
                list.push_back({{"springs", elastic.name}, *value, "N"});
            continue;
        }
        double sum = 0;
        for (const char* axis : axes)
            sum = std::hypot(
                sum, state.find(fmt::format("{}.{}_{}", elastic.name, output, axis)).value_or(0));
        list.push_back({{"bushings", elastic.name}, sum, "mm"});
    }
    return list;
}

std::string plausible(const Range& range) {
    return range.to == infinity      ? fmt::format("at least {:g}", range.from)
           : range.from == -infinity ? fmt::format("at most {:g}", range.to)
                                     : fmt::format("{:g} to {:g}", range.from, range.to);
}

// Caster, trail and the support under braking of a wheel.
std::optional<Implausible> rearward(const AtRest& state, const Wheel& wheel) {
    const std::string of = prefix(wheel.name);
    const auto caster = state.find(of + "caster"), trail = state.find(of + "mechanical_trail");
    const bool front = state.find(of + "anti_dive").has_value();
    const auto anti = state.find(of + (front ? "anti_dive" : "anti_lift"));
    if (!caster || !trail || !anti || *caster > clearly || *trail > clearly || *anti > clearly)
        return std::nullopt;
    std::vector<std::string> place{"wheel"};
    if (!wheel.name.empty()) place = {"wheels", wheel.name};
    return Implausible{
        place, fmt::format("caster {:.3g} deg, mechanical trail {:.3g} mm and {} {:.3g} % are all "
                           "negative; does x point rearward?",
                           *caster, *trail, front ? "anti-dive" : "anti-lift", *anti)};
}

// ---- Points and bodies.

struct Attached {
    BodyId body;
    Vector3d at;
};
struct Connection {
    std::string name;
    Attached i, j;
};

std::vector<Connection> connections(const Scene& scene) {
    std::vector<Pose> poses;
    for (const auto& body : scene.bodies) poses.push_back(body.design);
    std::vector<Connection> list;
    const auto add = [&](const std::string& name, const auto& kind) {
        std::vector<Attached> ends;
        each_point(kind, [&](const auto& end) {
            ends.push_back({end.body, position(poses, end.body, end.s_local)});
        });
        if (ends.size() != 2) return;
        const auto same = [&](const Connection& c) {  // a stop beside its spring, a drive
            return c.i.body == ends[0].body && c.j.body == ends[1].body &&
                   c.i.at.isApprox(ends[0].at) && c.j.at.isApprox(ends[1].at);
        };
        if (std::ranges::none_of(list, same)) list.push_back({name, ends[0], ends[1]});
    };
    for (const auto& joint : scene.joints) add(joint.name, joint.kind);
    for (const auto& elastic : scene.elastics) add(elastic.name, elastic.kind);
    return list;
}

// The points of a body without those of one connection.
std::vector<Vector3d> others(const Scene& scene, const std::vector<Connection>& all,
                             const Connection& without, BodyId body) {
    std::vector<Vector3d> points;
    if (body != ground) points.push_back(scene.bodies[static_cast<std::size_t>(body)].design.r);
    for (const auto& c : all)
        for (const Attached* end : {&c.i, &c.j})
            if (&c != &without && end->body == body) points.push_back(end->at);
    return points;
}

double nearest(const std::vector<Vector3d>& points, const Vector3d& p) {
    double least = infinity;
    for (const auto& point : points) least = std::min(least, (point - p).norm());
    return least;
}
double extent(const std::vector<Vector3d>& points) {
    double largest = 0;
    for (const auto& a : points)
        for (const auto& b : points) largest = std::max(largest, (a - b).norm());
    return largest;
}

std::string body_name(const Scene& scene, BodyId body) {
    return body == ground ? "ground" : scene.bodies[static_cast<std::size_t>(body)].name;
}

}  // namespace

std::vector<Implausible> implausible(const Model& model) {
    std::vector<Implausible> list;
    const auto state = at_rest(model);
    if (!state) return list;
    for (const Range& range : ranges) {
        int more = -1;
        for (const auto& [place, value, unit] : read(*state, range)) {
            if (value >= range.from && value <= range.to) continue;
            if (++more > 0) continue;
            std::string output = range.output;
            std::ranges::replace(output, '_', ' ');
            list.push_back({place, fmt::format("{} {:.4g} {} at rest, plausible: {}; {}", output,
                                               value, unit, plausible(range), range.asks)});
        }
        if (more > 0) list.back().what += fmt::format(" (and {} more)", more);
    }
    for (const auto& wheel : model.wheels)
        if (auto found = rearward(*state, wheel)) {
            list.push_back(std::move(*found));
            break;
        }
    return list;
}

std::vector<std::string> misplaced_points(const Scene& scene) {
    constexpr double by_far = 2, apart = 1e-3, far = 1;  // [m]
    std::vector<std::string> notes;
    const auto all = connections(scene);
    for (const auto& c : all) {
        const auto of_i = others(scene, all, c, c.i.body), of_j = others(scene, all, c, c.j.body);
        if ((c.i.at - c.j.at).norm() > apart) {
            const double own = nearest(of_i, c.i.at) + nearest(of_j, c.j.at),
                         exchanged = nearest(of_j, c.i.at) + nearest(of_i, c.j.at);
            if (std::isfinite(own) && own > by_far * exchanged)
                notes.push_back(fmt::format(
                    "'{}': its end on '{}' is {:.0f} mm from the other points of '{}' and {:.0f} "
                    "mm from those of '{}'; are its ends exchanged?",
                    c.name, body_name(scene, c.i.body), 1e3 * nearest(of_i, c.i.at),
                    body_name(scene, c.i.body), 1e3 * nearest(of_j, c.i.at),
                    body_name(scene, c.j.body)));
            continue;
        }
        for (const auto& [body, mine, other, theirs] :
             {std::tuple(c.i.body, &of_i, c.j.body, &of_j), {c.j.body, &of_j, c.i.body, &of_i}}) {
            const double size = extent(*mine), away = nearest(*mine, c.i.at),
                         near = nearest(*theirs, c.i.at);
            if (body != ground && size > apart && std::isfinite(away) && away > far &&
                away > by_far * size && away > by_far * near)
                notes.push_back(fmt::format(
                    "'{}' is {:.0f} mm from the other points of '{}', which extend over {:.0f} mm, "
                    "and {:.0f} mm from those of '{}'; is '{}' the body meant?",
                    c.name, 1e3 * away, body_name(scene, body), 1e3 * size, 1e3 * near,
                    body_name(scene, other), body_name(scene, body)));
        }
    }
    return notes;
}

}  // namespace elastocheck::compare
