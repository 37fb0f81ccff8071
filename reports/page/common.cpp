#include "reports/page/common.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/curve.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/wheel_response.hpp"
#include "reports/document/document.hpp"
#include "reports/given/wheels.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::string heading(const compare::Channel& channel) {
    return fmt::format("{} [{}]", as_words(channel.name), symbol(channel.unit));
}

std::string output_of(const Wheel& wheel, std::string_view quantity) {
    return fmt::format("{}{}{}", wheel.name, wheel.name.empty() ? "" : ".", quantity);
}

double ComparedBranch::from() const { return parameter_in(result->unit, requested->from); }
double ComparedBranch::to() const { return parameter_in(result->unit, requested->to); }

std::vector<ComparedBranch> branches_of(const SceneAnalyses& scene) {
    std::vector<ComparedBranch> branches;
    for (std::size_t b = 0; b < scene.comparison.branches.size(); ++b)
        branches.push_back({&scene.model.branches[b], &scene.comparison.branches[b]});
    return branches;
}

std::vector<double> values_of(const compare::Curve& curve, std::size_t channel) {
    auto values = curve.channel(channel);
    for (double& value : values) value = compare::finite_or_nan(value);
    return values;
}

bool Sweep::has(std::string_view branch) const {
    return std::ranges::find(branches, branch, &ComparedBranch::name) != branches.end();
}

std::string Sweep::at_equal_parameter() const { return compare::parameter_reading(unit); }
std::string Sweep::at_equal_abscissa() const {
    return compare::abscissa_reading(abscissa.substr(0, abscissa.find(" [")));
}

namespace {

// Drivers of a branch that move with its parameter, or that are held.
std::vector<std::string> drivers_of(const Model& model, const Branch& branch, bool moved) {
    std::vector<std::string> names;
    for (const auto& driver : branch.drivers)
        if ((driver.rate != 0) == moved) names.push_back(driven_name(model, driver.what));
    return names;
}

// "load", "travel", "rack".
std::string parameter_word(const Model& model, const Sweep& sweep) {
    const std::string word = compare::parameter_word(sweep.unit);
    if (word == "load") return word;
    if (sweep.lifts()) return "travel";
    if (sweep.kind == "steering" && sweep.unit == "deg" && compare::rack_per_hand_wheel(model) != 0)
        return "hand wheel";
    auto moved = drivers_of(model, *sweep.branches.front().requested, true);
    for (auto& joint : moved)
        joint = as_words(joint.ends_with(".drive") ? joint.substr(0, joint.rfind('.')) : joint);
    return moved.empty() ? word : enumerated(moved);
}

}  // namespace

Sweep sweep_of(const SceneAnalyses& scene, const ComparedBranch& branch) {
    const int c = branch.result->abscissa;
    Sweep sweep{
        .name = branch.name(),
        .unit = branch.unit(),
        .parameter = {},
        .abscissa = c < 0 ? "" : heading(scene.comparison.channels[static_cast<std::size_t>(c)]),
        .branches = {branch},
        .kind = load_case(scene.model, *branch.requested)};
    sweep.parameter = fmt::format("{} [{}]", parameter_word(scene.model, sweep), sweep.unit);
    return sweep;
}

namespace {

// Whether the branch has an abscissa that is monotonic along every leg's curve. A travel below a
// millimetre does not count: the branch does not lift the wheel.
bool has_monotonic_abscissa(const SceneAnalyses& scene, const ComparedBranch& branch) {
    const auto c = static_cast<std::size_t>(branch.result->abscissa);
    if (branch.result->abscissa < 0) return false;
    if (scene.comparison.channels[c].name.ends_with("travel")) {
        const auto x = branch.truth().channel(c);
        const auto [low, high] = std::ranges::minmax_element(x);
        if (low == x.end() || !(*high - *low >= compare::min_travel)) return false;
    }
    return std::ranges::all_of(branch.result->runs, [&](const compare::LegRun& run) {
        return run.curve.a.empty() || compare::trend(run.curve.channel(c)).monotonic();
    });
}

// Whether both start at zero and go opposite ways.
bool are_sides(const Model& model, const ComparedBranch& a, const ComparedBranch& b) {
    const auto same = [&](bool moved) {
        return drivers_of(model, *a.requested, moved) == drivers_of(model, *b.requested, moved);
    };
    return a.unit() == b.unit() && same(true) && same(false) && a.from() == 0 && b.from() == 0 &&
           a.to() * b.to() < 0;
}

}  // namespace

std::vector<Sweep> sweeps_of(const SceneAnalyses& scene) {
    std::vector<Sweep> sweeps;
    for (const auto& branch : branches_of(scene)) {
        Sweep* twin = nullptr;
        for (auto& sweep : sweeps)
            if (sweep.branches.size() == 1 &&
                are_sides(scene.model, sweep.branches.front(), branch))
                twin = &sweep;
        Sweep alone = sweep_of(scene, branch);
        if (!has_monotonic_abscissa(scene, branch)) alone.abscissa.clear();
        if (twin == nullptr) {
            sweeps.push_back(std::move(alone));
        } else {
            twin->name += " and " + alone.name;
            if (twin->abscissa != alone.abscissa) twin->abscissa.clear();
            twin->branches.push_back(branch);
        }
    }
    return sweeps;
}

std::optional<Sweep> leading_sweep(const SceneAnalyses& scene) {
    const auto sweeps = sweeps_of(scene);
    if (sweeps.empty()) return std::nullopt;
    auto leading = std::ranges::find(sweeps, "heave", &Sweep::kind);
    if (leading == sweeps.end()) leading = std::ranges::find_if(sweeps, &Sweep::lifts);
    return leading == sweeps.end() ? sweeps.front() : *leading;
}

bool leads(const SceneAnalyses& scene, const std::string& side) {
    const auto sweep = leading_sweep(scene);
    return sweep && (sweep->has(side) || sweep->has(side.substr(0, side.rfind(" to "))));
}

SweepCurve::SweepCurve(const SceneAnalyses& scene, const Sweep& sweep)
    : channels(&scene.comparison.channels) {
    for (const auto& branch : sweep.branches) {
        curves.push_back(&branch.truth());
        const auto& points = curves.back()->a;
        for (std::size_t k = 0; k < points.size(); ++k)
            if (curves.size() == 1 || points[k] != 0) order.emplace_back(curves.size() - 1, k);
    }
    const auto at = [&](const auto& place) { return curves[place.first]->a[place.second]; };
    std::ranges::stable_sort(order, {}, at);
    for (const auto& place : order) a.push_back(at(place));
    for (std::size_t k = 0; k < a.size(); ++k)
        if (std::abs(a[k]) < std::abs(a[start])) start = k;
}

std::vector<double> SweepCurve::channel(const std::string& name) const {
    std::vector<double> values;
    const int c = compare::find_channel(*channels, name);
    if (c < 0) return values;
    for (const auto& [curve, point] : order)
        values.push_back(
            compare::finite_or_nan(curves[curve]->values[point][static_cast<std::size_t>(c)]));
    return values;
}

std::vector<std::size_t> thinned(std::size_t size, std::size_t count) {
    std::vector<std::size_t> kept;
    if (size == 0) return kept;
    count = std::min(size, count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = count == 1 ? size - 1 : k * (size - 1) / (count - 1);
        kept.push_back(at);
    }
    return kept;
}

Table words_table(std::string caption, const std::vector<const char*>& columns) {
    Table table{.caption = std::move(caption)};
    for (const char* name : columns)
        table.columns.push_back({.name = name, .words = true, .digits = Digits::words});
    return table;
}

std::string configuration(const compare::TradePoint& chosen) {
    if (chosen.steps > 0)
        return fmt::format("{}, {} steps", chosen.method, whole_number(chosen.steps));
    if (chosen.own_tolerance > 0)
        return fmt::format("{}, tolerance {}", chosen.method,
                           setting(1e3 * chosen.own_tolerance, "mm"));
    return chosen.method + " solution";
}

std::string slug(const std::string& text) {
    std::string result = fmt::format("{}", fmt::join(lower_words(text), "-")).substr(0, 40);
    if (result.ends_with('-')) result.pop_back();
    return result.empty() ? "x" : result;
}

}  // namespace elastocheck::reports
