// `elastocheck optimise`: numbers of a scene with which figures and curves stay within bands.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "compare/design/results.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"
#include "reports/command/design/request.hpp"
#include "reports/command/program/exit_code.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using compare::Figure;
using compare::Goal;
using Eigen::Index;
using Eigen::VectorXd;
using reader::Cursor;

// Repeated searches, with points added where a curve leaves its band between its points.
constexpr int max_rounds = 3;
constexpr double between_tolerance = 1e-6;  // outside of a band, as a share of the movement
constexpr int between_points = 3;           // checked in each gap of a curve
constexpr int default_points = 33;

struct OptimiseRequest : DesignRequest {
    std::string file;
    int starts = 4;
};

// ---- The file of goals: numbers that may change, and bands of figures and curves.

struct GoalsFile {
    compare::Varied varied = {};
    std::vector<Goal> goals = {};
    std::optional<Figure> minimised = {};
    int minimised_line = 0;
};

// The result of `read`; std::invalid_argument becomes an error at the place of the entry in the file.
template <class Read>
auto at_place(const Cursor& entry, const Read& read) {
    try {
        return read();
    } catch (const std::invalid_argument& error) {
        entry.fail(error.what());
    }
}
Figure figure_at(const Cursor& entry, const std::string& word, const Model& model) {
    return at_place(entry, [&] { return parse_figure(word, model); });
}

void read_band(const Cursor& entry, Goal& goal) {
    const auto within = entry.optional("within"), least = entry.optional("at_least"),
               most = entry.optional("at_most");
    if (within.has_value() == (least || most))
        entry.fail(
            "allowed: either within: [LOW, HIGH], or at_least: LOW and at_most: HIGH or one of "
            "them");
    if (within) {
        const auto both = within->list(2, "bounds, [LOW, HIGH]");
        goal.low = both[0].number();
        goal.high = both[1].number();
    }
    if (least) goal.low = least->number();
    if (most) goal.high = most->number();
    if (!(goal.low < goal.high)) entry.fail("the lower bound is not below the upper one");
}

// A point of a curve at another place.
Figure moved_to(const Goal& goal, Figure point, double place) {
    point.station = place;
    point.station_text =
        fmt::format("{} = {:g} {}", goal.along, goal.along_factor * place, goal.along_unit);
    return point;
}

// Puts each point of a curve over an output on the first branch where it has a value. Returns the values.
VectorXd put_on_branches(const Scene& scene, const Model& model, std::vector<Figure>& points) {
    VectorXd values = VectorXd::Constant(std::ssize(points), compare::nan);
    for (const Branch& branch : model.branches) {
        std::vector<Figure> here = points;
        for (Figure& point : here) point.branch = branch.name;
        const VectorXd here_values = compare::figure_values(scene, here).value;
        for (std::size_t k = 0; k < points.size(); ++k)
            if (const auto i = static_cast<Index>(k);
                std::isnan(values[i]) && !std::isnan(here_values[i])) {
                points[k].branch = branch.name;
                values[i] = here_values[i];
            }
    }
    return values;
}

void add_curve(const Cursor& entry, const LoadedScene& loaded, const std::string& name,
               Goal& goal) {
    const Model& model = loaded.model;
    const double from = entry.require("from").number(), to = entry.require("to").number();
    if (!(from < to)) entry.fail(fmt::format("from {:g} is not below to {:g}", from, to));
    const auto count = entry.optional("points"), branch = entry.optional("branch"),
               over = entry.optional("over");
    const int points = count ? count->whole_number(2, 1000) : default_points;
    if (name.find('@') != name.npos && goal.points.front().name != name)
        entry.require("figure").fail(
            "of a curve without @; its place is branch, over, from and to");
    const std::string on =
        branch ? branch->text("a branch of the scene") : model.branches.front().name;
    Figure point = figure_at(branch ? *branch : entry, name + "@" + on, model);
    if (over) {
        const Figure abscissa = figure_at(*over, over->text("an output of the scene"), model);
        point.abscissa = goal.along = abscissa.name;
        goal.along_unit = abscissa.unit;
        goal.any_branch = !branch;
    } else {
        const auto unit =
            compare::unit_of(std::ranges::find(model.branches, on, &Branch::name)->unit);
        goal.along = on;
        goal.along_unit = symbol(unit);
        goal.along_factor = compare::in_unit(unit);
        for (const double end : {from, to})
            (void)figure_at(entry, fmt::format("{}@{}:{}", name, on, end), model);
    }
    goal.where = fmt::format("{} from {:g} to {:g} {}{}", goal.along, from, to, goal.along_unit,
                             over && branch ? " on " + on : "");
    goal.points.clear();
    for (int k = 0; k < points; ++k)
        // A weighted sum of both ends, so that -80 to 80 has exactly 0 in its middle.
        goal.points.push_back(moved_to(
            goal, point, (from * (points - 1 - k) + to * k) / (points - 1) / goal.along_factor));
    if (!goal.any_branch) return;
    auto places = goal.points;
    for (Figure& place : places) place.name = place.abscissa;
    const VectorXd reached = put_on_branches(loaded.scene, model, places);
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (std::isnan(reached[static_cast<Index>(k)]))
            entry.fail(fmt::format("no branch reaches {} = {:g}", goal.along, places[k].station));
        goal.points[k].branch = places[k].branch;
    }
}

Goal read_goal(const Cursor& entry, const LoadedScene& loaded) {
    entry.only_keys({"figure", "within", "at_least", "at_most", "branch", "over", "from", "to",
                     "points", "change"});
    const Cursor figure = entry.require("figure");
    const std::string& name = figure.text("an output of the scene");
    Goal goal{.line = entry.value->line};
    read_band(entry, goal);
    goal.points = {figure_at(figure, name, loaded.model)};
    goal.where = goal.points.front().station_text;
    if (entry.optional("from") || entry.optional("to"))
        add_curve(entry, loaded, name, goal);
    else
        for (const char* field : {"branch", "over", "points"})
            if (const auto extra = entry.optional(field))
                extra->fail(
                    "only of a curve, with from and to; a point is OUTPUT@BRANCH:PARAMETER");
    const auto change = entry.optional("change");
    for (Figure& point : goal.points) point.change = change && change->yes_or_no();
    return goal;
}

void add_varied(const Cursor& entry, const std::string& name, const Scene& scene,
                compare::Varied& varied) {
    const auto limits = entry.list(2, "limits, [LOW, HIGH]");
    const double low = limits[0].number(), high = limits[1].number();
    const std::size_t before = varied.numbers.size();
    at_place(entry, [&] { add_numbers(varied, scene, name, low, high); });
    for (const Number& number : std::span(varied.numbers).subspan(before))
        if (!(number.value >= low && number.value <= high))
            entry.fail(fmt::format("{} is {:g} in the scene, which is not within {:g} to {:g}",
                                   number.path, number.value, low, high));
}

// reports/README.md, "Goals". Curves over an output are placed on the branches of the scene as it
// is. Throws SceneError "file:line: field: ...".
GoalsFile read_goals(const std::string& file, const LoadedScene& loaded) {
    const reader::Value tree = reader::parse_yaml(read_whole(file, largest_baseline), file);
    std::vector<Number> ignored;
    const Cursor whole{&tree, "", &file, &ignored};
    whole.only_keys({"vary", "goals", "minimise"});
    GoalsFile result;
    const Cursor vary = whole.require("vary");
    if (vary.value->kind != reader::Value::Kind::map || vary.value->keys.empty())
        vary.fail("expected numbers with their limits, such as points.tie_rod_inner.z: [260, 340]");
    for (std::size_t k = 0; k < vary.value->keys.size(); ++k) {
        const std::string& name = vary.value->keys[k];
        add_varied(vary.at(vary.value->items[k], reader::child_path(vary.path, name)), name,
                   loaded.scene, result.varied);
    }
    const auto goals = whole.optional("goals"), minimised = whole.optional("minimise");
    if (goals) {
        if (!goals->is_list())
            goals->fail("expected a list of goals, such as - {figure: toe, within: [-0.1, 0.1]}");
        for (const Cursor& goal : goals->items()) result.goals.push_back(read_goal(goal, loaded));
    }
    if (minimised) {
        result.minimised =
            figure_at(*minimised, minimised->text("an output of the scene"), loaded.model);
        result.minimised_line = minimised->value->line;
    }
    if (result.goals.empty() && !result.minimised)
        whole.fail("neither goals nor a figure to minimise; required: goals, minimise or both");
    return result;
}

// ---- The search.

// The figures of the goals, curve by curve, and then the minimised one; with their bands.
struct GoalFigures {
    std::vector<Figure> figures = {};
    compare::Goals bands = {};

    void add(const Figure& figure, int goal, double low, double high) {
        figures.push_back(figure);
        bands.goal.push_back(goal);
        const auto n = std::ssize(figures);
        bands.low.conservativeResize(n);
        bands.high.conservativeResize(n);
        bands.low[n - 1] = low;
        bands.high[n - 1] = high;
    }
};
GoalFigures figures_of(const std::vector<Goal>& goals, const std::optional<Figure>& minimised) {
    GoalFigures result;
    for (std::size_t g = 0; g < goals.size(); ++g)
        for (const Figure& point : goals[g].points)
            result.add(point, static_cast<int>(g), goals[g].low, goals[g].high);
    if (minimised) {
        result.bands.minimised = static_cast<int>(result.figures.size());
        result.add(*minimised, static_cast<int>(goals.size()), -INFINITY, INFINITY);
    }
    return result;
}

// Adds points to the curves where they leave their bands between points; returns the farthest outside.
std::optional<compare::Between> add_points_outside(const compare::OptimisedScene& optimised,
                                                   const Model& model, std::vector<Goal>& goals) {
    const Scene scene = optimised.varied.scene(optimised.optimum.p);
    std::optional<compare::Between> worst;
    Index first = 0;
    for (Goal& goal : goals) {
        const double within = between_tolerance * optimised.optimum.scale[first];
        first += std::ssize(goal.points);
        std::vector<Figure> between;
        for (std::size_t k = 0; k + 1 < goal.points.size(); ++k)
            for (int i = 1; i <= between_points; ++i) {
                const double a = goal.points[k].station, b = goal.points[k + 1].station;
                between.push_back(
                    moved_to(goal, goal.points[k], a + (b - a) * i / (between_points + 1)));
            }
        if (between.empty()) continue;
        const VectorXd values = goal.any_branch ? put_on_branches(scene, model, between)
                                                : compare::figure_values(scene, between).value;
        for (std::size_t k = 0; k < between.size(); ++k) {
            const double value = values[static_cast<Index>(k)];
            const double excess = std::max(goal.low - value, value - goal.high);
            if (excess <= within) continue;
            if (std::isfinite(excess)) goal.points.push_back(between[k]);
            if (!worst || (!std::isnan(worst->excess) && !(excess <= worst->excess)))
                worst = {excess, goal.output() + " at " + between[k].station_text +
                                     (std::isnan(excess) ? " (no value there)" : "")};
        }
        std::ranges::stable_sort(goal.points, {}, &Figure::station);
    }
    return worst;
}

// Searches, adds points to curves that leave their bands between theirs, and searches again.
struct Searching {
    const OptimiseRequest& request;
    const LoadedScene& loaded;
    compare::OptimisedScene& optimised;

    void write(const VectorXd& p, bool met, bool last) const {
        request.write(fmt::format("optimise: {}{}{}", last ? "" : "not finished, ",
                                  met ? "" : "nearest to ", request.file),
                      optimised.varied, p, last);
    }
    compare::Optimum search(const GoalFigures& goal_figures,
                            const std::vector<VectorXd>& starts) const {
        return compare::optimise(compare::solved_figures(optimised.varied, goal_figures.figures,
                                                         threads_of(request.running)),
                                 goal_figures.bands, optimised.varied, starts, progress,
                                 [&](const VectorXd& p, bool met) { write(p, met, false); });
    }
    void add_points(const std::vector<VectorXd>& starts) const {
        for (int round = 0; optimised.optimum.met; ++round) {
            std::vector<Goal> goals = optimised.goals;
            optimised.between = add_points_outside(optimised, loaded.model, goals);
            if (!optimised.between || round == max_rounds ||
                !std::isfinite(optimised.between->excess))
                return;
            const GoalFigures goal_figures = figures_of(goals, optimised.minimised);
            compare::Optimum next = search(goal_figures, {optimised.optimum.p});
            if (!next.met) next = search(goal_figures, starts);
            if (next.best < 0) return;  // an added point has no value in the scene as it is
            optimised.goals = std::move(goals);
            optimised.figures = goal_figures.figures;
            optimised.optimum = std::move(next);
        }
    }
};

// A goal that no number moves is an error unless it is met; then the reason is noted.
void check_unmoved_goals(const GoalsFile& file, const std::string& name,
                         const GoalFigures& goal_figures, compare::OptimisedScene& optimised) {
    for (std::size_t g = 0; g < optimised.optimum.still.size(); ++g) {
        if (!optimised.optimum.still[g]) continue;
        const bool is_goal = g < optimised.goals.size();
        bool met = is_goal;
        std::size_t last = 0;
        for (std::size_t k = 0; k < goal_figures.figures.size(); ++k)
            if (goal_figures.bands.goal[k] == static_cast<int>(g)) {
                const auto i = static_cast<Index>(k);
                const double value = optimised.optimum.start.value[i];
                met = met && value >= goal_figures.bands.low[i] &&
                      value <= goal_figures.bands.high[i];
                last = k;
            }
        const std::string why = compare::why_still(optimised.varied, goal_figures.figures[last]);
        if (!met)
            reader::fail(name, is_goal ? optimised.goals[g].line : file.minimised_line,
                         is_goal ? "goals" : "minimise",
                         fmt::format("{}: none of the numbers moves it:\n  {}",
                                     goal_figures.figures[last].name, why));
        optimised.goals[g].not_moved = why;
    }
}

// Interval proofs of the equilibrium leg's states on the branches of the goals.
compare::CertifyStudy certificate(const Scene& scene, const std::vector<Figure>& figures,
                                  int threads) {
    Model model = compile(compare::trim(scene).scene);
    std::erase_if(model.branches, [&](const Branch& branch) {
        return std::ranges::find(figures, branch.name, &Figure::branch) == figures.end();
    });
    return compare::certify(model, {.solvers = {{.leg = compare::Leg::equilibrium}},
                                    .tolerance = compare::claim(compare::claimed_accuracy),
                                    .curves = false,
                                    .threads = threads,
                                    .progress = progress});
}

// Exit code 0: the bands are met at the least cost that was found, confirmed and proved; 1:
// they cannot be met; 3: a figure has no value, or the result is not confirmed, not proved
// or not converged.
int optimise(const OptimiseRequest& request, const Delivery& delivery) {
    check_may_write_scene(request.scene, request.output, request.settings);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    GoalsFile file = read_goals(request.file, loaded);
    set_scene(file.varied, request.scene, request.settings);
    const GoalFigures goal_figures = figures_of(file.goals, file.minimised);
    compare::OptimisedScene optimised{file.varied, file.goals, file.minimised,
                                      goal_figures.figures};
    const Searching searching{request, loaded, optimised};
    const auto starts = compare::starts_of(file.varied, request.starts);
    optimised.optimum = searching.search(goal_figures, starts);
    if (!optimised.optimum.start.complete()) {
        progress("");
        print_error("{}\n",
                    why_not_solved(optimised.varied, optimised.figures, optimised.varied.start));
        return could_not_judge;
    }
    check_unmoved_goals(file, request.file, goal_figures, optimised);
    optimised.searches = optimised.optimum.searches;
    searching.add_points(starts);
    const Scene changed = optimised.varied.scene(optimised.optimum.p);
    optimised.by = compare::confirm(changed, optimised.figures, optimised.optimum.after,
                                    optimised.optimum.scale);
    if (optimised.optimum.met)
        optimised.certificate =
            certificate(changed, optimised.figures, threads_of(request.running));
    progress("");
    const int code =
        deliver_result(delivery, document_of(loaded, request.scene), result_of(optimised));
    searching.write(optimised.optimum.p, optimised.optimum.met, true);
    return code;
}

}  // namespace

const Command optimise_command{
    Group::change, "optimise",
    "Change numbers of a scene within limits so that figures and curves stay within bands, "
    "with the smallest change or the least value of a figure; the prices of the bounds "
    "that hold, and proofs of the result",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<OptimiseRequest>();
        add_design(command, *request);
        as_file(command.add_option(
                    "GOALS", request->file,
                    "file with the numbers, their limits and the bands, such as vary: "
                    "{points.tie_rod_inner.z: [260, 340]} and goals: [{figure: toe, over: travel, "
                    "from: -80, to: 80, within: [-0.1, 0.1]}]"))
            ->required();
        command
            .add_option("--starts", request->starts,
                        "points to search from: the scene, and others within the limits, the same "
                        "on every run (default: 4)")
            ->check(CLI::Range(1, 1000));
        return [request](const std::string& line) {
            return optimise(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
