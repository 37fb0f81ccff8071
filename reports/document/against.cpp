#include "reports/document/against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/points.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/gate/gate.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "reports/document/scene_analyses.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using compare::BranchComparison;
using compare::Channel;
using compare::Digits;
using compare::nan;
using Line = Against::Line;

// The curve of a channel, which the scene has to have.
Line line_of(const SceneAnalyses& scene, const BranchComparison& branch, const Channel& channel) {
    const auto c =
        static_cast<std::size_t>(compare::find_channel(scene.comparison.channels, channel.name));
    const compare::Curve& curve = branch.run(compare::Leg::equilibrium).curve;
    Line line{curve.a, curve.channel(c)};
    for (double& y : line.y) y = compare::finite_or_nan(y);
    return line;
}

// The branch of this name and unit, or null.
const BranchComparison* branch_like(const SceneAnalyses& scene, const BranchComparison& like) {
    for (const auto& branch : scene.comparison.branches)
        if (branch.branch == like.branch && branch.unit == like.unit) return &branch;
    return nullptr;
}

bool has(const SceneAnalyses& scene, const Channel& channel) {
    const int c = compare::find_channel(scene.comparison.channels, channel.name);
    return c >= 0 && scene.comparison.channels[static_cast<std::size_t>(c)].unit == channel.unit;
}

double at_design(const Line& line) {
    const auto zero = std::ranges::find(line.a, 0.0);
    return zero == line.a.end() ? nan : line.y[static_cast<std::size_t>(zero - line.a.begin())];
}

// Beyond the rounding of a solution.
bool differs(double was, double is) {
    return std::isfinite(was) != std::isfinite(is) ||
           std::abs(is - was) > 1e-9 + 1e-9 * std::max(std::abs(was), std::abs(is));
}

// Ratio of a difference to what an engineer notices (tolerance class `physical`).
double noticed(const Channel& channel, double was, double is) {
    static const auto physical = compare::default_tolerances(compare::ToleranceClass::physical);
    const auto own = physical.find(symbol(channel.unit));
    const auto& t = own == physical.end() ? physical.at("characteristic") : own->second;
    return std::abs(is - was) / (t.atol + t.rtol * std::max(std::abs(was), std::abs(is)));
}

Line thinned(const Line& line) {
    constexpr std::size_t max_points = 41;
    Line sample;
    const std::size_t count = std::min(line.a.size(), max_points);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t from = count == 1 ? 0 : k * (line.a.size() - 1) / (count - 1);
        sample.a.push_back(line.a[from]);
        sample.y.push_back(line.y[from]);
    }
    return sample;
}

// Adds a figure, at the design position of the first branch that has it, if it differs.
void add_figure(std::vector<Against::Figure>& figures, const SceneAnalyses& base,
                const SceneAnalyses& variant, const Channel& channel) {
    for (const auto& branch : variant.comparison.branches) {
        const BranchComparison* same = branch_like(base, branch);
        if (same == nullptr) continue;
        const double a = at_design(line_of(base, *same, channel)),
                     b = at_design(line_of(variant, branch, channel));
        if (std::isnan(a) && std::isnan(b)) continue;  // no figure of this branch
        if (!differs(a, b)) return;
        const bool reciprocal = is_swing_arm(channel);
        const auto compared = [&](double x) {
            return reciprocal ? (std::isfinite(x) ? 1e3 / x : 0) : x;
        };
        const double size = noticed(channel, compared(a), compared(b));
        const std::string unit = symbol(channel.unit);
        figures.push_back({channel.name, unit, a, b, compared(b) - compared(a),
                           reciprocal ? compare::per_metre : unit,
                           std::isfinite(size) ? size : INFINITY});
        return;
    }
}

// Adds a curve if it differs at the variant's parameters.
void add_curve(std::vector<Against::Curve>& curves, const Channel& channel, const Line& was,
               const Line& is) {
    double largest = 0, place = nan;
    for (std::size_t k = 0; k < is.a.size(); ++k) {
        if (!compare::reaches(was.a, is.a[k])) continue;
        const double difference = is.y[k] - compare::interpolate(was.a, was.y, is.a[k], 6);
        if (std::abs(difference) > std::abs(largest)) {
            largest = difference;
            place = is.a[k];
        }
    }
    if (std::abs(largest) > 1e-9)
        curves.push_back({channel.name, symbol(channel.unit), largest, place,
                          noticed(channel, 0, largest), thinned(was), thinned(is)});
}

}  // namespace

Against differences(const SceneAnalyses& base, const SceneAnalyses& variant) {
    Against against{variant.scene.name, variant.scene.source, variant.hash};
    against.numbers = compare::changes(base.scene.numbers, variant.scene.numbers);
    std::vector<Channel> common;
    for (const auto& channel : variant.comparison.channels)
        if (has(base, channel))
            common.push_back(channel);
        else
            against.only_variant.push_back("output " + channel.name);
    for (const auto& channel : base.comparison.channels)
        if (!has(variant, channel)) against.only_base.push_back("output " + channel.name);
    for (const auto& channel : common)
        if (channel.kinematic() || channel.kind() == compare::ChannelKind::characteristic)
            add_figure(against.figures, base, variant, channel);
    // The most noticed first; before all those that are undefined in one of the two.
    std::ranges::stable_sort(against.figures, std::greater{}, &Against::Figure::noticed);
    for (const auto& branch : variant.comparison.branches) {
        const BranchComparison* same = branch_like(base, branch);
        if (same == nullptr) {
            against.only_variant.push_back("branch " + branch.branch);
            continue;
        }
        auto& both =
            against.branches.emplace_back(Against::Branch{branch.branch, symbol(branch.unit), {}});
        for (const auto& channel : common)
            if (channel.main && channel.kinematic())
                add_curve(both.curves, channel, line_of(base, *same, channel),
                          line_of(variant, branch, channel));
    }
    for (const auto& branch : base.comparison.branches)
        if (branch_like(variant, branch) == nullptr)
            against.only_base.push_back("branch " + branch.branch);
    return against;
}

namespace {

// Row of a table: a curve of base and variant, and a point of one of them.
struct CurveRow {
    const Against::Branch* branch;
    const Against::Curve* curve;
    const Line* line = nullptr;
    std::size_t k = 0;
};

compare::Table numbers_of(const Against& against) {
    using compare::Change;
    const auto number = [](const std::optional<Number>& n) { return n ? n->value : nan; };
    const auto either = [](const Change& c) { return *(c.is ? c.is : c.was); };
    compare::Table table = compare::table<Change>(
        {.id = "numbers", .caption = "Numbers of the scene that differ"},
        {{"number", Digits::words, [=](const Change& c) { return either(c).path; }},
         {"base", Digits::given, [=](const Change& c) { return number(c.was); }},
         {"variant", Digits::given, [=](const Change& c) { return number(c.is); }},
         {"unit", Digits::words, [=](const Change& c) { return either(c).unit; }}},
        against.numbers);
    return table;
}

// The figures whose difference an engineer notices, or the others.
compare::Table figures_of(const Against& against, bool noticed) {
    using F = Against::Figure;
    std::vector<F> rows = against.figures;
    std::erase_if(rows, [&](const F& f) { return noticed == (f.noticed <= 1); });
    compare::Table table = compare::table<F>(
        {.id = "figures",
         .caption = noticed ? "Figures at the design position that differ"
                            : "Figures that differ by less than an engineer notices",
         .detail = !noticed},
        {{"figure", Digits::words, [](const F& f) { return as_words(f.output); }},
         {"output", Digits::hidden, &F::output},
         {"base", Digits::four, &F::base},
         {"variant", Digits::four, &F::variant},
         {"unit", Digits::words, &F::unit},
         {"difference", Digits::deviation, &F::difference},
         {"unit of difference", Digits::words, &F::unit_of_difference, "", "", "its unit"},
         {"noticed", Digits::hidden, &F::noticed,
          "ratio to what an engineer notices; none: no value of one of them"}},
        rows);
    return table;
}

std::vector<compare::ColumnOf<CurveRow>> curve_columns() {
    return {
        {"branch", Digits::words, [](const CurveRow& row) { return row.branch->name; }},
        {"output", Digits::words, [](const CurveRow& row) { return as_words(row.curve->output); }},
        {"unit", Digits::words, [](const CurveRow& row) { return row.curve->unit; }}};
}

compare::Table largest_of(const Against& against) {
    std::vector<CurveRow> rows;
    for (const auto& branch : against.branches)
        for (const auto& curve : branch.curves) rows.push_back({&branch, &curve});
    auto columns = curve_columns();
    columns.insert(
        columns.end(),
        {{"largest difference", Digits::deviation,
          [](const CurveRow& row) { return row.curve->largest; }},
         {"at", Digits::place, [](const CurveRow& row) { return row.curve->at; },
          "parameter there"},
         {"parameter unit", Digits::words, [](const CurveRow& row) { return row.branch->unit; }, "",
          "", "its unit"},
         {"noticed", Digits::hidden, [](const CurveRow& row) { return row.curve->noticed; }}});
    compare::Table table =
        compare::table({.id = "differences",
                        .caption = "Largest difference over each branch, at equal load or drive"},
                       columns, rows);
    return table;
}

compare::Table lines_of(const Against& against) {
    std::vector<CurveRow> rows;
    for (const auto& branch : against.branches)
        for (const auto& curve : branch.curves)
            for (const Line* line : {&curve.base, &curve.variant})
                for (std::size_t k = 0; k < line->a.size(); ++k)
                    rows.push_back({&branch, &curve, line, k});
    auto columns = curve_columns();
    columns.insert(
        columns.end(),
        {{"of", Digits::words,
          [](const CurveRow& row) { return row.line == &row.curve->base ? "base" : "variant"; }},
         {"parameter", Digits::place, [](const CurveRow& row) { return row.line->a[row.k]; }},
         {"value", Digits::four, [](const CurveRow& row) { return row.line->y[row.k]; }}});
    compare::Table table = compare::table({.id = "lines", .detail = true}, columns, rows);
    return table;
}

}  // namespace

compare::Result result_of(const Against& against) {
    compare::Result result{.analysis = "against"};
    result.about = {
        fmt::format("the variant {} of {}, hash {}", against.name, against.source, against.hash)};
    result.verdict.requested = false;
    result.verdict.grade = compare::Grade::pass;
    result.tables = {numbers_of(against), figures_of(against, true), figures_of(against, false),
                     largest_of(against), lines_of(against)};
    result.charts = {{.id = "lines",
                      .title = "Base and variant",
                      .table = "lines",
                      .x = "parameter",
                      .y = {"value"},
                      .by = {"branch", "output", "of"}}};
    for (const auto& what : against.only_base) result.notes.push_back("only of the base: " + what);
    for (const auto& what : against.only_variant)
        result.notes.push_back("only of the variant: " + what);
    return result;
}

std::string against_sentence(const std::string& base_source, const Against& against) {
    std::string text =
        fmt::format("{} against {}: {} of the scene and {} at the design position differ",
                    against.source, base_source, counted(against.numbers.size(), "number"),
                    counted(against.figures.size(), "figure"));
    // The most noticed of the figures that both have.
    const auto most = std::ranges::find_if(against.figures, [](const Against::Figure& figure) {
        return std::isfinite(figure.base) && std::isfinite(figure.variant);
    });
    if (most != against.figures.end())
        text += fmt::format(", most {} [{}] from {:.3g} to {:.3g}", most->output, most->unit,
                            most->base, most->variant);
    return text + ".";
}

}  // namespace elastocheck::reports
