#include "reports/command/options/goals_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "compare/definitions/figure_words.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using reader::Cursor;

constexpr double no_bound = std::numeric_limits<double>::infinity();
constexpr int default_points = 33;
constexpr int between_points = 3;

// What a word of a command line is read by, with the place in the file in its messages.
template <class Read>
auto at_place(const Cursor& at, const std::string& option, const Read& read) {
    try {
        return read();
    } catch (const std::invalid_argument& error) {
        std::string what = error.what();
        if (what.starts_with(option + ": ")) what.erase(0, option.size() + 2);
        at.fail(what);
    }
}

NamedFigure figure_at(const Cursor& at, const std::string& word, const Model& model) {
    return at_place(at, "goal", [&] { return parse_figure(word, "goal", model); });
}

struct Band {
    double low = -no_bound, high = no_bound;
};
Band band_of(const Cursor& at) {
    const auto within = at.optional("within"), least = at.optional("at_least"),
               most = at.optional("at_most");
    if (within.has_value() == (least || most))
        at.fail(
            "allowed: either within: [LOW, HIGH], or at_least: LOW and at_most: HIGH or one of "
            "them");
    Band band;
    if (within) {
        const auto both = within->list(2, "bounds, [LOW, HIGH]");
        band = {both[0].number(), both[1].number()};
    }
    if (least) band.low = least->number();
    if (most) band.high = most->number();
    if (!(band.low < band.high)) at.fail("the lower bound is not below the upper one");
    return band;
}

std::string place_on(const Along& along, double at) {
    return fmt::format("{} = {:g} {}", along.name, along.factor * at, along.unit);
}

// The branches on which an output comes to these values, in the scene as it is: of several the
// first.
std::vector<std::string> branches_reaching(const Cursor& at, const std::string& output,
                                           const std::vector<double>& values, const Scene& scene,
                                           const Model& model) {
    std::vector<std::string> all(values.size());
    for (const Branch& branch : model.branches) {
        std::vector<compare::Figure> figures;
        for (const double value : values)
            figures.push_back({.name = output, .branch = branch.name, .at = value, .over = output});
        const VectorXd found =
            compare::figure_values(scene, figures, compare::Leg::equilibrium).value;
        for (std::size_t k = 0; k < values.size(); ++k)
            if (all[k].empty() && std::isfinite(found[static_cast<Index>(k)])) all[k] = branch.name;
        if (std::ranges::find(all, "") == all.end()) return all;
    }
    const auto missing = static_cast<std::size_t>(std::ranges::find(all, "") - all.begin());
    at.fail(fmt::format("no branch reaches {} = {:g}", output, values[missing]));
}

void add_curve(const Cursor& at, const Scene& scene, const Model& model, Goal& goal) {
    const double from = at.require("from").number(), to = at.require("to").number();
    if (!(from < to)) at.fail("from is not below to");
    const auto count = at.optional("points");
    const int points = count ? count->whole_number(2, 1000) : default_points;
    std::vector<double> values;
    for (int k = 0; k < points; ++k)
        // from a share on either side, so that ±80 has exactly 0 in its middle
        values.push_back((from * (points - 1 - k) + to * k) / (points - 1));
    if (compare::parse_figure_words(goal.output, model, compare::figure_outputs(model)).placed)
        at.require("figure").fail("of a curve without @; its place is branch, over, from and to");
    const auto branch = at.optional("branch");
    const std::string on =
        branch ? branch->text("a branch of the scene") : model.branches.front().name;
    const NamedFigure first = figure_at(branch ? *branch : at, goal.output + "@" + on, model);
    const auto over = at.optional("over");
    if (!over) {
        const compare::Unit unit =
            compare::unit_of(std::ranges::find(model.branches, on, &Branch::name)->unit);
        goal.along = {on, symbol(unit), compare::in_unit(unit)};
        goal.where = fmt::format("{} from {:g} to {:g} {}", on, from, to, goal.along.unit);
        for (const double value : values) {
            NamedFigure one = figure_at(at, fmt::format("{}@{}:{}", goal.output, on, value), model);
            goal.points.push_back({one.figure, one.place});
        }
        return;
    }
    const std::string output = over->text("an output of the scene");
    const NamedFigure abscissa = figure_at(*over, output, model);
    const char* unit = symbol(abscissa.output.unit);
    goal.along = {.name = output, .unit = unit};
    goal.where =
        fmt::format("{} from {:g} to {:g} {}{}", output, from, to, unit, branch ? " on " + on : "");
    const auto branches = branch ? std::vector<std::string>(values.size(), on)
                                 : branches_reaching(at, output, values, scene, model);
    for (std::size_t k = 0; k < values.size(); ++k)
        goal.points.push_back(
            {{.name = goal.output, .branch = branches[k], .at = values[k], .over = output},
             place_on(goal.along, values[k])});
}

Goal read_goal(const Cursor& at, const Scene& scene, const Model& model) {
    at.only_keys({"figure", "within", "at_least", "at_most", "branch", "over", "from", "to",
                  "points", "change"});
    const Cursor name = at.require("figure");
    Goal goal{.output = name.text("an output of the scene"),
              .unit = {},
              .where = {},
              .points = {},
              .line = at.value->line};
    const Band band = band_of(at);
    goal.low = band.low, goal.high = band.high;
    const NamedFigure figure = figure_at(name, goal.output, model);
    goal.unit = symbol(figure.output.unit);
    if (at.optional("from") || at.optional("to")) {
        add_curve(at, scene, model, goal);
    } else {
        for (const char* field : {"branch", "over", "points"})
            if (const auto extra = at.optional(field))
                extra->fail(
                    "only of a curve, with from and to; a point is OUTPUT@BRANCH:PARAMETER");
        goal.points = {{figure.figure, figure.place}};
        goal.where = figure.place;
        goal.output = figure.figure.name;
    }
    if (const auto change = at.optional("change"); change && change->yes_or_no()) {
        for (GoalPoint& point : goal.points) point.figure.change = true;
        goal.output += " (change)";
    }
    return goal;
}

void add_varied(const Cursor& at, const std::string& name, const Scene& scene, Varied& varied) {
    const auto limits = at.list(2, "limits, [LOW, HIGH]");
    const Varied one = at_place(at, "--vary", [&] { return parse_varied({name}, scene); });
    const double low = limits[0].number(), high = limits[1].number();
    if (!(low < high)) at.fail("the lower limit is not below the upper one");
    for (std::size_t k = 0; k < one.numbers.size(); ++k) {
        const Number& number = one.numbers[k];
        if (std::ranges::find(varied.numbers, number.path, &Number::path) != varied.numbers.end())
            at.fail(number.path + " is given twice");
        if (!(number.value >= low && number.value <= high))
            at.fail(fmt::format("{} is {:g} in the scene, which is not within {:g} to {:g}",
                                number.path, number.value, low, high));
        varied.numbers.push_back(number);
        const auto n = static_cast<Index>(varied.numbers.size());
        for (VectorXd* each : {&varied.start, &varied.low, &varied.high})
            each->conservativeResize(n);
        varied.start[n - 1] = number.value;
        varied.low[n - 1] = low, varied.high[n - 1] = high;
    }
}

}  // namespace

GoalsFile read_goals(std::string_view yaml, const std::string& file, const Scene& scene,
                     const Model& model) {
    const reader::Value tree = reader::parse_yaml(yaml, file);
    std::vector<Number> ignored;
    const Cursor whole{&tree, "", &file, &ignored};
    whole.only_keys({"vary", "goals", "minimise"});
    GoalsFile all;
    const Cursor vary = whole.require("vary");
    if (vary.value->kind != reader::Value::Kind::map || vary.value->keys.empty())
        vary.fail("expected numbers with their limits, such as points.tie_rod_inner.z: [260, 340]");
    for (std::size_t k = 0; k < vary.value->keys.size(); ++k) {
        const std::string& name = vary.value->keys[k];
        add_varied(vary.at(vary.value->items[k], reader::child_path(vary.path, name)), name, scene,
                   all.varied);
    }
    const auto goals = whole.optional("goals"), minimised = whole.optional("minimise");
    if (goals) {
        if (!goals->is_list())
            goals->fail("expected a list of goals, such as - {figure: toe, within: [-0.1, 0.1]}");
        for (const Cursor& goal : goals->items())
            all.goals.push_back(read_goal(goal, scene, model));
    }
    if (minimised) {
        all.minimised = figure_at(*minimised, minimised->text("an output of the scene"), model);
        all.minimised_line = minimised->value->line;
    }
    if (all.goals.empty() && !all.minimised) whole.fail("neither goals nor a figure to minimise");
    return all;
}

GoalFigures figures_of(const GoalsFile& file) {
    GoalFigures all;
    std::vector<double> low, high;
    for (std::size_t g = 0; g < file.goals.size(); ++g)
        for (const GoalPoint& point : file.goals[g].points) {
            all.figures.push_back(point.figure);
            all.goals.goal.push_back(static_cast<int>(g));
            low.push_back(file.goals[g].low), high.push_back(file.goals[g].high);
        }
    if (file.minimised) {
        all.goals.minimised = static_cast<int>(all.figures.size());
        all.figures.push_back(file.minimised->figure);
        all.goals.goal.push_back(static_cast<int>(file.goals.size()));
        low.push_back(-no_bound), high.push_back(no_bound);
    }
    const auto m = static_cast<Index>(low.size());
    all.goals.low = Eigen::Map<const VectorXd>(low.data(), m);
    all.goals.high = Eigen::Map<const VectorXd>(high.data(), m);
    all.goals.start = file.varied.start;
    all.goals.least = file.varied.low, all.goals.most = file.varied.high;
    return all;
}

std::vector<GoalPoint> points_between(const Goal& goal, BranchOf branch) {
    std::vector<GoalPoint> all;
    for (std::size_t k = 0; k + 1 < goal.points.size(); ++k) {
        const GoalPoint &a = goal.points[k], &b = goal.points[k + 1];
        for (int i = 1; i <= between_points; ++i) {
            GoalPoint point = branch == BranchOf::before ? a : b;
            point.figure.at = a.figure.at + (b.figure.at - a.figure.at) * i / (between_points + 1);
            point.place = place_on(goal.along, point.figure.at);
            all.push_back(point);
        }
    }
    return all;
}

}  // namespace elastocheck::reports
