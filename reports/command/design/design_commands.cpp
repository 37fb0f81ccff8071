// `elastocheck solve-for`: numbers of a scene for wanted figures. `elastocheck fit`: numbers of a
// scene from measured curves. `elastocheck tolerances`: scatter of its figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "compare/comparison/characteristics.hpp"
#include "reports/command/design/request.hpp"
#include "reports/command/options/fitting.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// ---- solve-for

struct SolveForRequest : DesignRequest {
    std::vector<std::string> vary, want;
};

// Exit code 0: the wishes are met and confirmed; 1: they cannot be met; 3: a leg has no values or
// does not confirm them.
int solve_for(const SolveForRequest& request, const Delivery& delivery) {
    if (!request.output.empty()) check_may_write_scene(request.output);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Varied varied = parse_varied(request.vary, loaded.scene);
    for (Index k = 0; k < varied.start.size(); ++k)
        if (!std::isfinite(varied.low[k]))
            throw std::invalid_argument(
                fmt::format("--vary {}: needs limits, =LOW:HIGH; the smallest change is that of "
                            "the smallest shares of the ranges",
                            varied.numbers[static_cast<std::size_t>(k)].path));
    SolvedFor solved{
        .numbers = varied.numbers,
        .wishes = {VectorXd(std::ssize(request.want)), varied.start, varied.low, varied.high}};
    std::vector<std::string> units;
    for (const auto& word : request.want) {
        const auto [figure, value] = parse_wanted(word, loaded.model);
        solved.wishes.target[std::ssize(solved.wanted)] = value;
        solved.wanted.push_back(figure);
        units.push_back(symbol(figure.output.unit));
    }
    const auto figures = figures_of(solved.wanted);
    const auto scene = scene_at(request.scene, request.settings, varied.numbers);
    const compare::Solution& solution = solved.solution = compare::solve_for(
        compare::solved_figures(scene, varied.numbers, figures, threads_of(request.running)),
        solved.wishes);
    if (!solution.before.allFinite() || !solution.gradient.rate.allFinite()) {
        print_error("{}\n", why_no_start(loaded.scene, figures, solution.gradient));
        return could_not_judge;
    }
    for (std::size_t j = 0; j < solution.still.size(); ++j)
        if (solution.still[j])
            throw std::invalid_argument(fmt::format(
                "--want {}: none of the numbers moves it:\n  {}", request.want[j],
                fmt::join(compare::why_still(scene, figures[j], varied.numbers, varied.start),
                          "\n  ")));
    solved.by =
        compare::confirm(scene(solution.p), figures, units, solution.after, solution.movement);
    delivery.print_text(solve_for_text(solved));
    request.write(fmt::format("solve-for: {}{}", solution.met ? "" : "nearest to ",
                              fmt::join(request.want, ", ")),
                  varied, solution.p);
    print_result(delivery, solve_for_schema, solve_for_json(solved));
    return !solved.by.confirmed ? could_not_judge : solution.met ? fine : limit_broken;
}

// ---- fit

struct FitRequest : DesignRequest {
    std::string measured, map;
    std::vector<std::string> vary;
    bool robust = false;
};

// Exit code 0: the data determine all numbers; 3: not all, or there is no fit.
int fit(const FitRequest& request, const Delivery& delivery) {
    if (!request.output.empty()) check_may_write_scene(request.output);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Varied varied = parse_varied(request.vary, loaded.scene);
    const FittedScene result = fitted({request.scene, request.settings, request.measured,
                                       request.map, request.robust, threads_of(request.running)},
                                      loaded, varied);
    if (!result.fitted.why_not.empty()) {
        print_error("no fit: {}\n", result.fitted.why_not);
        return could_not_judge;
    }
    delivery.print_text(fit_text(result));
    request.write("fit: to " + request.measured, varied, result.fitted.p);
    print_result(delivery, fit_schema, fit_json(result));
    return result.fitted.converged && result.fitted.interval.allFinite() ? fine : could_not_judge;
}

// ---- tolerances

struct TolerancesRequest : SceneRequest {
    std::string file;
    std::vector<std::string> of;
    int most = 5;
};

// The requested figures; without a request the characteristics at the start of the first branch.
std::vector<NamedFigure> requested_figures(const std::vector<std::string>& of, const Model& model) {
    std::vector<NamedFigure> all;
    for (const auto& word : of) all.push_back(parse_figure(word, "--of", model));
    if (of.empty())
        for (const auto& channel : compare::characteristics(model))
            all.push_back(parse_figure(channel.name, "--of", model));
    if (all.empty())
        throw std::invalid_argument(
            "--of: a scene without a wheel has no characteristics; name "
            "outputs");
    return all;
}

// Exit code 0: every figure has a scatter; 3: not every requested one.
int tolerances(const TolerancesRequest& request, const Delivery& delivery) {
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Tolerances given =
        read_tolerances(read_whole(request.file, largest_baseline), request.file, loaded.scene);
    const auto named = requested_figures(request.of, loaded.model);
    std::vector<std::string> words;
    for (const auto& number : given.numbers) words.push_back(number.path);
    const Varied varied = parse_varied(words, loaded.scene);
    const auto scene = scene_at(request.scene, request.settings, varied.numbers);
    const compare::Figures figures = compare::solved_figures(
        scene, varied.numbers, figures_of(named), threads_of(request.running));
    const VectorXd nominal = figures.value(varied.start);
    const compare::FigureGradient gradient = figures.gradient(varied.start);
    const auto scatter = compare::scatter(gradient.rate, given.numbers, given.correlation);
    ToleratedScene all{.numbers = given.numbers, .figures = {}};
    int code = fine;
    for (std::size_t k = 0; k < named.size(); ++k) {
        const auto i = static_cast<Index>(k);
        if (!std::isfinite(nominal[i]) || !gradient.rate.row(i).allFinite()) {
            if (request.of.empty()) continue;
            const bool has_value = std::isfinite(nominal[i]);
            print_error("{}: no {} here: {}\n", request.of[k], has_value ? "rate" : "value",
                        has_value ? gradient.why_not
                                  : compare::figure_values(scene(varied.start),
                                                           std::span(&named[k].figure, 1),
                                                           compare::Leg::equilibrium)
                                        .why_not);
            code = could_not_judge;
            continue;
        }
        // A figure that moves by rounding does not move.
        const bool moves = scatter[k].sd > compare::least_movement(nominal[i]);
        all.figures.push_back({named[k], nominal[i],
                               moves ? scatter[k] : compare::Scatter{0, 0, 0 * scatter[k].share}});
    }
    delivery.print_text(tolerances_text(all, request.most));
    print_result(delivery, tolerances_schema, tolerances_json(all));
    return all.figures.empty() ? could_not_judge : code;
}

}  // namespace

const Command tolerances_command{
    Group::change, "tolerances",
    "Scatter of the figures by the tolerances of the numbers of a scene; exact rates by the "
    "equilibrium leg",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<TolerancesRequest>();
        add_scene_and_run(command, *request);
        as_file(command.add_option("TOLERANCES", request->file,
                                   "file with the tolerances, such as points.tie_rod_inner.z: "
                                   "{normal: {sd: 0.5}}"))
            ->required();
        command
            .add_option("--of", request->of,
                        "outputs, OUTPUT or OUTPUT@BRANCH:PARAMETER (default: the characteristics "
                        "at the start of the first branch)")
            ->delimiter(',');
        command.add_option("--most", request->most, "shares shown per output (default: 5; 0: all)")
            ->check(CLI::Range(0, 100000));
        return [request](const std::string& line) {
            return tolerances(*request, request->delivery(line));
        };
    }};

const Command solve_for_command{
    Group::change, "solve-for",
    "Change numbers of a scene as little as possible so that figures have wanted values; "
    "gradients by the equilibrium leg",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<SolveForRequest>();
        add_design(command, *request);
        repeated(command.add_option("--vary", request->vary,
                                    "number that may change, with its limits: "
                                    "points.tie_rod_inner.z=260:340; repeat it"))
            ->required();
        repeated(command.add_option("--want", request->want,
                                    "figure and value: bump_steer=0 at the start of the first "
                                    "branch, toe@jounce:3000=-0.1 elsewhere; repeat it"))
            ->required();
        return [request](const std::string& line) {
            return solve_for(*request, request->delivery(line));
        };
    }};

const Command fit_command{
    Group::change, "fit",
    "Fit numbers of a scene to measured curves, with 95 % intervals; gradients "
    "of the equilibrium leg",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<FitRequest>();
        add_design(command, *request);
        as_file(command.add_option("--measured", request->measured,
                                   "measured points (CSV), as for report"))
            ->required();
        repeated(command.add_option(
                     "--vary", request->vary,
                     "number to fit, or pattern with *; limits as NAME=LOW:HIGH; repeat it"))
            ->required();
        as_file(command.add_option(
            "--map", request->map,
            "YAML file with the table's column names, units, signs and offsets"));
        command.add_flag("--robust", request->robust,
                         "give gross outliers little weight (Cauchy's loss)");
        return
            [request](const std::string& line) { return fit(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
