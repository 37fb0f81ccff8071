// `elastocheck solve-for`: numbers of a scene for wanted figures. `elastocheck fit`: numbers of a
// scene from measured curves. `elastocheck tolerances`: scatter of its figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "compare/comparison/characteristics.hpp"
#include "compare/design/confirm.hpp"
#include "compare/design/fit.hpp"
#include "compare/design/solve_for.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/command/options/design_options.hpp"
#include "reports/command/options/fitting.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/terminal.hpp"
#include "reports/tables/studies/design_tables.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

void print_result(const Delivery& delivery, const char* schema, nlohmann::ordered_json result) {
    if (!delivery.as_json) return;
    nlohmann::ordered_json document = {{"schema", schema},
                                       {"reproduce", delivery.command},
                                       {"provenance", provenance_json(provenance())}};
    document.update(result);
    print_document(document);
}

// ---- solve-for

struct SolveForRequest {
    std::string scene, output;
    Settings settings;
    std::vector<std::string> vary, want;
    Running running;
    bool as_json = false;
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
    std::vector<NamedFigure> wanted;
    VectorXd target(static_cast<Index>(request.want.size()));
    for (const auto& word : request.want) {
        const auto [figure, value] = parse_wanted(word, loaded.model);
        target[static_cast<Index>(wanted.size())] = value;
        wanted.push_back(figure);
    }
    const auto figures = figures_of(wanted);
    const auto scene = scene_at(request.scene, request.settings, varied.numbers);
    SolvedFor solved{.numbers = varied.numbers,
                     .wishes = {target, varied.start, varied.low, varied.high},
                     .solution = {},
                     .rows = {}};
    solved.solution = compare::solve_for(
        compare::solved_figures(scene, varied.numbers, figures, threads_of(request.running)),
        solved.wishes);
    const compare::Solution& solution = solved.solution;
    if (!solution.before.allFinite()) {
        print_error(
            "no value at the start: {}\n",
            compare::figure_values(loaded.scene, figures, compare::Leg::equilibrium).why_not);
        return could_not_judge;
    }
    for (std::size_t j = 0; j < solution.still.size(); ++j)
        if (solution.still[j])
            throw std::invalid_argument(fmt::format(
                "--want {}: none of the numbers moves it:\n  {}", request.want[j],
                fmt::join(compare::why_still(scene, figures[j], varied.numbers, varied.start),
                          "\n  ")));
    if (!solution.gradient.rate.allFinite()) {
        print_error("no rate at the start: {}\n", solution.gradient.why_not);
        return could_not_judge;
    }
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const auto i = static_cast<Index>(k);
        solved.rows.push_back({.output = wanted[k].figure.name,
                               .unit = symbol(wanted[k].output.unit),
                               .place = wanted[k].place,
                               .asked = target[i],
                               .before = solution.before[i],
                               .after = solution.after[i]});
    }
    std::vector<std::string> units;
    for (const WishRow& row : solved.rows) units.push_back(row.unit);
    const compare::Confirmation by =
        compare::confirm(scene(solution.p), figures, units, solution.after, solution.movement);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const auto i = static_cast<Index>(k);
        solved.rows[k].energy = by.energy[i], solved.rows[k].series = by.series[i];
    }
    solved.confirmed = by.confirmed, solved.not_confirmed = by.why_not;
    delivery.print_text(solve_for_text(solved));
    if (!request.output.empty()) {
        write_changed_scene(request.scene, request.output,
                            fmt::format("solve-for: {}{}", solution.met ? "" : "nearest to ",
                                        fmt::join(request.want, ", ")),
                            request.settings, varied, solution.p);
        print_error("Written: {}\n", request.output);
    }
    print_result(delivery, solve_for_schema, solve_for_json(solved));
    return !solved.confirmed ? could_not_judge : solution.met ? fine : limit_broken;
}

// ---- fit

struct FitRequest {
    std::string scene, measured, map, output;
    Settings settings;
    std::vector<std::string> vary;
    bool robust = false;
    Running running;
    bool as_json = false;
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
    if (!request.output.empty()) {
        write_changed_scene(request.scene, request.output,
                            fmt::format("fit: to {}", request.measured), request.settings, varied,
                            result.fitted.p);
        print_error("Written: {}\n", request.output);
    }
    print_result(delivery, fit_schema, fit_json(result));
    return result.fitted.converged && result.fitted.interval.allFinite() ? fine : could_not_judge;
}

// ---- tolerances

struct TolerancesRequest {
    std::string scene, file;
    Settings settings;
    std::vector<std::string> of;
    int most = 5;
    Running running;
    bool as_json = false;
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
        const double rounding = 1e-10 * (1 + std::abs(nominal[i]));
        const bool moves = scatter[k].sd > rounding;
        all.figures.push_back(
            {.output = named[k].figure.name,
             .unit = symbol(named[k].output.unit),
             .place = named[k].place,
             .nominal = nominal[i],
             .scatter = moves ? scatter[k] : compare::Scatter{0, 0, 0 * scatter[k].share}});
    }
    delivery.print_text(tolerances_text(all, request.most));
    print_result(delivery, tolerances_schema, tolerances_json(all));
    return all.figures.empty() ? could_not_judge : code;
}

}  // namespace

// To become `sensitivity --tolerances`.
Command tolerances_command() {
    const auto request = std::make_shared<TolerancesRequest>();
    return {
        "tolerances",
        "Scatter of the figures by the tolerances of the numbers of a scene; exact rates by the "
        "equilibrium leg",
        {scene_option(request->scene),
         {"TOLERANCES", Text{&request->file, a_file()},
          "file with the tolerances, such as points.tie_rod_inner.z: {normal: {sd: 0.5}}", true},
         {"--of", TextList{&request->of, TextList::Form::commas},
          "outputs, OUTPUT or OUTPUT@BRANCH:PARAMETER (default: the characteristics at the "
          "start of the first branch)"},
         {"--most", Integer{&request->most, 0, 100000},
          "shares shown per output (default: 5; 0: all)"},
         set_option(request->settings),
         jobs_option(request->running),
         quiet_option(request->running),
         json_option(request->as_json)},
        [request](const std::string& line) {
            return tolerances(*request, {.as_json = request->as_json, .command = line});
        }};
}

Command solve_for_command() {
    const auto request = std::make_shared<SolveForRequest>();
    using enum TextList::Form;
    return {"solve-for",
            "Change numbers of a scene as little as possible so that figures have wanted values; "
            "gradients by the equilibrium leg",
            {scene_option(request->scene),
             {"--vary", TextList{&request->vary, repeated},
              "number that may change, with its limits: points.tie_rod_inner.z=260:340; repeat it",
              true},
             {"--want", TextList{&request->want, repeated},
              "figure and value: bump_steer=0 at the start of the first branch, "
              "toe@jounce:3000=-0.1 elsewhere; repeat it",
              true},
             {"-o,--output", Text{&request->output, a_file()},
              "write the scene with the changed numbers; the old ones are in comments"},
             set_option(request->settings),
             jobs_option(request->running),
             quiet_option(request->running),
             json_option(request->as_json)},
            [request](const std::string& line) {
                return solve_for(*request, {.as_json = request->as_json, .command = line});
            }};
}

Command fit_command() {
    const auto request = std::make_shared<FitRequest>();
    using enum TextList::Form;
    return {
        "fit",
        "Fit numbers of a scene to measured curves, with 95 % intervals; gradients "
        "of the equilibrium leg",
        {scene_option(request->scene),
         {"--measured", Text{&request->measured, a_file()}, "measured points (CSV), as for report",
          true},
         {"--vary", TextList{&request->vary, repeated},
          "number to fit, or pattern with *; limits as NAME=LOW:HIGH; repeat it", true},
         {"--map", Text{&request->map, a_file()},
          "YAML file with the table's column names, units, signs and offsets"},
         {"--robust", Flag{&request->robust}, "give gross outliers little weight (Cauchy's loss)"},
         {"-o,--output", Text{&request->output, a_file()},
          "write the scene with the fitted numbers; the old ones are in comments"},
         set_option(request->settings),
         jobs_option(request->running),
         quiet_option(request->running),
         json_option(request->as_json)},
        [request](const std::string& line) {
            return fit(*request, {.as_json = request->as_json, .command = line});
        }};
}

}  // namespace elastocheck::reports
