#include "reports/live/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/compile.hpp"
#include "models/structure.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/path.hpp"
#include "reports/document/drawing.hpp"
#include "reports/given/wheels.hpp"
#include "reports/live/outputs.hpp"

namespace elastocheck::live {
namespace {

using json = nlohmann::ordered_json;
using compare::Channel;
using Eigen::Vector3d;

constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();
constexpr int max_points = 400;

// Points of a drawing in their bodies.
std::vector<Point> drawn_points(const Model& model, const reports::Drawing& drawing) {
    std::vector<Point> points;
    for (const auto& entry : drawing.points) {
        const Vector3d r = 1e-3 * Vector3d(entry.at[0], entry.at[1], entry.at[2]);
        Point point{ground, r};
        for (std::size_t b = 0; b < model.bodies.size(); ++b)
            if (const Body& body = model.bodies[b]; body.name == entry.body)
                point = {static_cast<BodyId>(b), body.design.p.conjugate() * (r - body.design.r)};
        points.push_back(point);
    }
    return points;
}

// The rows of one branch, in ascending order of the parameter.
struct Rows {
    std::vector<std::pair<double, std::vector<double>>> rows;  // by the parameter in SI
    // Appends the rows to `numbers`, and returns the index of the first of theirs.
    std::size_t append_to(std::vector<double>& numbers) {
        std::ranges::sort(rows, {}, [](const auto& row) { return row.first; });
        const std::size_t at = numbers.size();
        for (const auto& [a, row] : rows) numbers.insert(numbers.end(), row.begin(), row.end());
        return at;
    }
};

// Names of the active joints, one for each constraint, and of the elements.
std::vector<std::string> parts_of(const Model& model) {
    std::vector<std::string> names;
    for (const auto& constraint : model.constraints)
        names.push_back(model.joints[static_cast<std::size_t>(constraint.joint)].name);
    names.emplace_back();
    for (const auto& elastic : model.elastics) names.push_back(elastic.name);
    return names;
}

// Channels that are computed at a point, and their indices among all.
struct Reading {
    std::vector<Channel> channels;
    std::vector<std::size_t> place;

    template <class Chosen>
    Reading(const std::vector<Channel>& all, const Chosen& chosen) {
        for (std::size_t c = 0; c < all.size(); ++c)
            if (chosen(all[c])) channels.push_back(all[c]), place.push_back(c);
    }
    // The values in the order of all channels, of which there are `count`.
    std::vector<double> placed(const std::vector<double>& values, std::size_t count) const {
        std::vector<double> all(count, not_computed);
        for (std::size_t k = 0; k < place.size(); ++k) all[place[k]] = values[k];
        return all;
    }
};
bool is_characteristic(const Channel& channel) {
    return channel.kind() == compare::ChannelKind::characteristic;
}

struct Solver {
    const Model& model;
    std::size_t count;          // of channels
    std::vector<Point> points;  // of the drawing
    Reading all, everywhere, motions;
    // parameters at which `all` channels are read, and elsewhere `everywhere`; empty: all at every point
    std::optional<std::vector<double>> at = {};

    const Reading& reading(const Branch& branch, double a) const {
        if (!at) return all;
        const double parameter = compare::parameter_in(compare::unit_of(branch.unit), a);
        const bool is_listed = std::ranges::any_of(*at, [&](double listed) {
            return std::abs(parameter - listed) <= 1e-9 * std::max(1.0, std::abs(parameter));
        });
        return is_listed ? all : everywhere;
    }
    // Adds the rows of all sides: by the series with the geometry of the drawing, by the published
    // method without it and without characteristics.
    EquilibriumPath solve_branch(const Branch& branch,
                                 const std::vector<compare::BranchSide>& sides,
                                 const compare::SolverSettings& solver, compare::Analyses& analyses,
                                 Rows& rows) const {
        const compare::Unit unit = compare::unit_of(branch.unit);
        const bool drawn = solver.leg == compare::Leg::series;
        return compare::solve_branch(
            sides, solver,
            [&](const Equilibrium& state) {
                const Reading& read = drawn ? reading(branch, state.load) : motions;
                compare::Row row =
                    row_of(model, read.channels, sides.front(), solver, state, analyses);
                row.values = read.placed(row.values, count);
                if (!drawn) return row;
                for (const Point& point : points)
                    for (const double x : compare::position(state.poses, point))
                        row.values.push_back(1e3 * x);
                for (const Wheel& wheel : model.wheels)
                    for (const double x :
                         Vector3d(compare::pose(state.poses, wheel.body).p * wheel.spin_axis_local))
                        row.values.push_back(x);
                for (const Vector3d& p : compare::points_of_figures(
                         sides.front().model, state,
                         analyses.response.value_or(compare::WheelResponse{})))
                    for (const double x : p) row.values.push_back(1e3 * x);
                return row;
            },
            [&](compare::Row row) {
                std::vector<double> line{compare::parameter_in(unit, row.load)};
                line.insert(line.end(), row.values.begin(), row.values.end());
                rows.rows.emplace_back(row.load, std::move(line));
            });
    }
};

json outcome_json(const EquilibriumPath& path) {
    return {{"outcome", name(path.outcome)}, {"detail", path.detail}};
}

}  // namespace

// Analyses of a model, which depend on its joints, elements and bodies, not on its loads: shared by
// the branches on which the same parts are active.
struct Shared {
    std::vector<std::string> parts;  // names of the active joints and elements
    std::shared_ptr<const recursive::Analysis> analysis;
    compare::Analyses responses = {};
};

namespace {

// The analyses of a solve, which start from those of the last where the model differs in numbers only.
struct Sharing {
    std::vector<std::shared_ptr<Shared>> now = {};
    std::vector<std::shared_ptr<const Shared>> last = {};
    bool one_factorisation = false;

    // With the settled start, which all branches with the same active parts share.
    Shared& analyses_of(const compare::BranchSide& side) {
        const auto parts = parts_of(side.model);
        const auto same = [&](const auto& shared) { return shared->parts == parts; };
        if (const auto known = std::ranges::find_if(now, same); known != now.end()) return **known;
        const auto before = std::ranges::find_if(last, same);
        const Shared* previous = before == last.end() ? nullptr : before->get();
        auto analysis = std::make_shared<recursive::Analysis>(recursive::analyse(
            side.model, previous == nullptr ? nullptr : previous->analysis->system.lu.order));
        if (previous != nullptr) analysis->settled = previous->analysis->settled;
        recursive::series::keep_start(side.model, side.branch, {}, *analysis);
        Shared shared{parts, std::move(analysis)};
        if (previous != nullptr) shared.responses = compare::with_orders_of(previous->responses);
        shared.responses.one_factorisation = one_factorisation;
        now.push_back(std::make_shared<Shared>(std::move(shared)));
        return *now.back();
    }
};

json branch_json(const Solver& solver, Sharing& sharing, const Branch& branch,
                 const Request& request, std::vector<double>& numbers) {
    auto sides = compare::sides_of(solver.model, branch, request.points);
    Shared& shared = sharing.analyses_of(sides.front());
    for (auto& side : sides) side.analysis = shared.analysis;
    Rows rows;
    const EquilibriumPath path =
        solver.solve_branch(branch, sides, {.leg = compare::Leg::series}, shared.responses, rows);
    json result = {{"name", branch.name}, {"unit", symbol(compare::unit_of(branch.unit))}};
    result.update(outcome_json(path));
    result["idle"] = recursive::describe_idle_modes(shared.analysis->diagnosis);
    result["points"] = rows.rows.size();
    result["at"] = rows.append_to(numbers);
    const auto start = std::ranges::min_element(
        rows.rows, {}, [](const auto& row) { return std::abs(row.first); });
    result["start"] = start - rows.rows.begin();
    result["published"] = nullptr;
    if (!request.published) return result;
    const int refine = std::max(1, (branch.steps + request.points / 2) / request.points);
    Rows fast;
    const EquilibriumPath published = solver.solve_branch(
        branch, sides, {.leg = compare::Leg::recursive, .refine = refine}, shared.responses, fast);
    json& part = result["published"] = outcome_json(published);
    part["steps"] = refine * request.points;
    part["points"] = fast.rows.size();
    part["at"] = fast.append_to(numbers);
    return result;
}

// Figures that are shown first over a branch, by its load case; of another load case those of heave.
std::vector<std::string> usual_curves(const Model& model, const Branch& branch) {
    using compare::LiveRank;
    static const std::map<std::string_view, int LiveRank::*> branch_kinds{
        {"roll", &LiveRank::roll},
        {"steering", &LiveRank::steering},
        {"lateral force", &LiveRank::lateral},
        {"longitudinal force", &LiveRank::longitudinal},
        {"moment", &LiveRank::moment}};
    const auto known = branch_kinds.find(reports::load_case(model, branch));
    return compare::first_live_figures(known == branch_kinds.end() ? &LiveRank::heave
                                                                   : known->second);
}
// Index of the wheel whose figure a channel is; null if it is not of one wheel.
json wheel_of(const Model& model, const Channel& channel) {
    for (std::size_t w = 0; w < model.wheels.size(); ++w)
        if (const std::string& name = model.wheels[w].name;
            !name.empty() && channel.name.starts_with(name + "."))
            return w;
    return nullptr;
}

}  // namespace

std::vector<Channel> channels_of(const Model& model) {
    auto all = compare::channels(model);
    std::ranges::move(compare::element_channels(model), std::back_inserter(all));
    std::ranges::move(compare::characteristics(model), std::back_inserter(all));
    return all;
}

json open(Session& session, std::string_view text, const std::string& name,
          const reader::Folder& folder) {
    session = {std::string(text), name, std::nullopt, {}};
    session.parsed.emplace(session.text, name, folder);
    std::vector<std::string> warnings;
    const Scene scene = session.parsed->read({}, &warnings);
    json answer = {{"title", scene.name}, {"warnings", warnings}};
    answer["numbers"] = json::array();
    for (const Number& number : scene.numbers)
        answer["numbers"].push_back(
            {{"path", number.path}, {"value", number.value}, {"unit", number.unit}});
    answer["points"] = json::array();
    for (const Hardpoint& point : scene.hardpoints)
        answer["points"].push_back(
            {{"name", point.name},
             {"at",
              {1e3 * point.position.x(), 1e3 * point.position.y(), 1e3 * point.position.z()}}});
    const Model model = compile(scene);
    answer["branches"] = json::array();
    for (const Branch& branch : model.branches) {
        const compare::Unit unit = compare::unit_of(branch.unit);
        answer["branches"].push_back({{"name", branch.name},
                                      {"unit", symbol(unit)},
                                      {"from", compare::parameter_in(unit, branch.from)},
                                      {"to", compare::parameter_in(unit, branch.to)},
                                      {"steps", branch.steps},
                                      {"usual", usual_curves(model, branch)}});
    }
    answer["channels"] = json::array();
    for (const Channel& channel : channels_of(model)) {
        const compare::Entry* entry = compare::find_entry(channel.name);
        const compare::Properties properties =
            entry == nullptr ? compare::Properties{} : entry->properties;
        answer["channels"].push_back({{"name", channel.name},
                                      {"unit", symbol(channel.unit)},
                                      {"kind", compare::name(channel.kind())},
                                      {"main", channel.main},
                                      {"at_rest", properties.at_rest},
                                      {"cause", properties.cause},
                                      {"figure", compare::without_owner(channel.name)},
                                      {"wheel", wheel_of(model, channel)},
                                      {"definition", channel.definition},
                                      {"undefined", compare::why_undefined(channel)}});
    }
    return answer;
}

Answer solve(Session& session, const Request& request) {
    if (!session.parsed) throw std::logic_error("no scene is open");
    if (request.points < 1 || request.points > max_points)
        throw std::invalid_argument(
            fmt::format("points: {} is not from 1 to {}", request.points, max_points));
    const compare::Trimmed trimmed =
        compare::trim_by_series(session.parsed->read(request.settings), &session.trim);
    Answer answer;
    answer.head["trim"] = nullptr;
    if (trimmed.record) {
        if (!trimmed.record->reached()) {
            answer.head["trouble"] = "trim: " + trimmed.record->detail;
            return answer;
        }
        json list = json::array();
        for (const auto& adjusted : trimmed.record->adjusted)
            list.push_back({{"name", adjusted.name},
                            {"by", adjusted.change},
                            {"unit", symbol(adjusted.unit)},
                            {"makes", adjusted.resulting}});
        answer.head["trim"] = std::move(list);
    }
    const Model model = compile(trimmed.scene);
    const auto channels = channels_of(model);
    answer.head["channels"] = json::array();
    for (const Channel& channel : channels) answer.head["channels"].push_back(channel.name);
    const auto drawing = reports::drawing_of(trimmed.scene, model, {});
    answer.head["drawing"] = reports::drawing_json(drawing);
    const auto& shown = request.shown;
    Solver solver{model,
                  channels.size(),
                  drawn_points(model, drawing),
                  Reading(channels, [](const Channel&) { return true; }),
                  Reading(channels,
                          [&](const Channel& c) {
                              return !is_characteristic(c) ||
                                     (shown && std::ranges::find(shown->everywhere, c.name) !=
                                                   shown->everywhere.end());
                          }),
                  Reading(channels, [](const Channel& c) { return !is_characteristic(c); })};
    if (shown) solver.at = shown->at;
    std::vector<int> parts;
    structure(model, parts);
    Sharing sharing{.one_factorisation = shown.has_value()};
    if (shown && parts == session.structure) sharing.last = session.shared;
    answer.head["branches"] = json::array();
    for (const Branch& branch : model.branches) {
        if (!request.only.empty() && branch.name != request.only) continue;
        answer.head["branches"].push_back(
            branch_json(solver, sharing, branch, request, answer.numbers));
    }
    session.structure = std::move(parts);
    session.shared.assign(sharing.now.begin(), sharing.now.end());
    return answer;
}

std::string rewrite(const Session& session, const std::vector<Setting>& settings) {
    return rewrite_scene(session.text, session.name, settings);
}

Request request_of(std::string_view text) {
    const json read = json::parse(text, nullptr, false);
    Request request;
    const auto require = [](bool met) {
        if (!met) throw std::invalid_argument("the request is not as engine.hpp describes it");
    };
    require(read.is_object() && read.contains("settings") && read["settings"].is_array());
    for (const json& pair : read["settings"]) {
        require(pair.is_array() && pair.size() == 2 && pair[0].is_string() && pair[1].is_string());
        request.settings.push_back({pair[0].get<std::string>(), pair[1].get<std::string>()});
    }
    if (read.contains("points")) {
        require(read["points"].is_number_integer());
        request.points = read["points"].get<int>();
    }
    if (read.contains("only")) {
        require(read["only"].is_string());
        request.only = read["only"].get<std::string>();
    }
    if (read.contains("published")) {
        require(read["published"].is_boolean());
        request.published = read["published"].get<bool>();
    }
    if (read.contains("shown")) {
        const json& given = read["shown"];
        require(given.is_object() && given.contains("everywhere") && given.contains("at") &&
                given["everywhere"].is_array() && given["at"].is_array());
        auto& shown = request.shown.emplace();
        for (const json& name : given["everywhere"]) {
            require(name.is_string());
            shown.everywhere.push_back(name.get<std::string>());
        }
        for (const json& a : given["at"]) {
            require(a.is_number());
            shown.at.push_back(a.get<double>());
        }
    }
    return request;
}

}  // namespace elastocheck::live
