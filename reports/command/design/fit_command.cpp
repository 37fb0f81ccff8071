// `elastocheck fit`: numbers of a scene from measured curves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/design/results.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/command/design/request.hpp"
#include "reports/command/options/design_options.hpp"
#include "reports/files/files.hpp"
#include "reports/given/measurement.hpp"

namespace elastocheck::reports {
namespace {

using compare::Figure;
using Eigen::Index;
using Eigen::VectorXd;

struct FitRequest : DesignRequest {
    std::string measured, map;  // files; no map: empty
    bool robust = false;
};

// ---- Measured points.

// Reason why a point has no figure; empty if it has one.
std::string why_no_figure(const compare::Place& place, const Measurement& data,
                          const compare::Comparison& outline, std::size_t k) {
    const compare::Points& points = data.table.points;
    const bool none = std::ranges::none_of(points.columns, [&](const auto& column) {
        return !is_travel(data.channels[column.channel]) && std::isfinite(column.values[k]);
    });
    if (none) return "without a measured value";
    if (!std::isfinite(place.x)) return "without a parameter or travel";
    if (place.branch < 0) return "that no branch reaches";
    const auto& branch = outline.branches[static_cast<std::size_t>(place.branch)];
    const auto over = compare::abscissa_values(branch.run(compare::Leg::equilibrium).curve,
                                               place.by_parameter ? std::nullopt : points.abscissa);
    if (over.empty())
        return fmt::format("whose travel does not place them on branch '{}'", branch.branch);
    return compare::reaches(over, place.x)
               ? ""
               : fmt::format("beyond the range of branch '{}'", branch.branch);
}

struct MeasuredFigures {
    std::vector<Figure> figures;
    std::vector<double> value;
    std::vector<int> column;                // per figure
    std::vector<compare::Channel> columns;  // their outputs
    std::vector<std::string> left_out;      // columns and rows of the file that are not used
};
// Reads the measurement as `report --measured` does. A point is placed by its parameter, else travel.
MeasuredFigures read_measured(const FitRequest& request, const Model& model) {
    const ColumnMap map =
        request.map.empty() ? ColumnMap{} : read_column_map(read_whole(request.map), request.map);
    Measurement data = read_measurement(read_whole(request.measured, largest_measurement),
                                        request.measured, model, map);
    compare::Comparison outline = compare::outline(model);
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        auto& runs = outline.branches[b].runs;
        runs.resize(compare::legs.size());
        static_cast<compare::PathCurve&>(
            runs[static_cast<std::size_t>(compare::Leg::equilibrium)]) =
            compare::solve_branch(model, compare::channels(model), model.branches[b],
                                  compare::sides_of(model, model.branches[b]),
                                  {.leg = compare::Leg::equilibrium});
    }
    std::vector<compare::Place> places, kept;
    try {
        places = compare::places_of(model, outline, data.table.points);
    } catch (const std::invalid_argument& error) {
        fail_at(request.measured, 1, error.what());
    }
    drop_points(data.table, [&](std::size_t k) {
        std::string why = why_no_figure(places[k], data, outline, k);
        if (why.empty()) kept.push_back(places[k]);
        return why;
    });
    MeasuredFigures measured;
    const compare::Points& points = data.table.points;
    for (const auto& column : points.columns) {
        const compare::Channel& channel = data.channels[column.channel];
        if (is_travel(channel)) continue;
        const std::size_t before = measured.figures.size();
        for (std::size_t k = 0; k < kept.size(); ++k) {
            if (!std::isfinite(column.values[k])) continue;
            const auto& [b, by_parameter, x] = kept[k];
            const Branch& branch = model.branches[static_cast<std::size_t>(b)];
            measured.figures.push_back(
                {.name = channel.name,
                 .branch = branch.name,
                 .station = by_parameter ? x / compare::in_unit(compare::unit_of(branch.unit)) : x,
                 .abscissa = by_parameter ? "" : data.channels[*points.abscissa].name,
                 .change = column.change});
            measured.column.push_back(static_cast<int>(measured.columns.size()));
            measured.value.push_back(column.values[k]);
        }
        if (measured.figures.size() > before) measured.columns.push_back(channel);
    }
    measured.left_out = data.table.left_out;
    if (measured.value.empty())
        fail_at(request.measured, 0,
                "no point lies on a branch of the scene: " + reader::listed(measured.left_out));
    return measured;
}

// ---- What to measure.

// Outputs at the ends of the branches that were not measured there: positions and angles, or others.
std::vector<Figure> unmeasured(const Model& model, const MeasuredFigures& data, bool kinematic) {
    std::vector<Figure> figures;
    for (const Branch& branch : model.branches)
        for (const auto& output : compare::figure_outputs(model)) {
            if (output.kinematic() != kinematic ||
                std::ranges::any_of(data.figures, [&](const Figure& figure) {
                    return figure.name == output.name && figure.branch == branch.name;
                }))
                continue;
            const compare::Unit unit = compare::unit_of(branch.unit);
            for (const double end : {double(branch.from), double(branch.to)})
                if (end != 0)
                    figures.push_back(
                        {.name = output.name,
                         .branch = branch.name,
                         .station = end,
                         .unit = symbol(output.unit),
                         .station_text = fmt::format("{} = {:g} {}", branch.name,
                                                     compare::in_unit(unit) * end, symbol(unit))});
        }
    return figures;
}

// Per figure: how far its output moves from the start of a branch to an end, of all branches the
// largest; NaN where that is rounding.
VectorXd extents_of(const Scene& scene, const std::vector<Figure>& figures, const VectorXd& value) {
    std::vector<Figure> starts = figures;
    for (auto& figure : starts) figure.station = 0;
    const VectorXd start = compare::figure_values(scene, starts).value;
    std::map<std::string, double> largest;
    for (std::size_t k = 0; k < figures.size(); ++k) {
        const auto i = static_cast<Index>(k);
        const double moved = std::abs(value[i] - start[i]);
        if (double& most = largest[figures[k].name]; moved > most) most = moved;
    }
    return VectorXd::NullaryExpr(value.size(), [&](Index k) {
        const double extent = largest[figures[static_cast<std::size_t>(k)].name];
        return extent > compare::min_movement(value[k]) ? extent : compare::nan;
    });
}

constexpr double min_share = 1e-9;  // of an extent: what moves by less moves by rounding

// What to measure so that each undetermined combination is determined.
void propose(compare::FittedScene& fit, const Model& model, const MeasuredFigures& data,
             int threads) {
    const auto& undetermined = fit.fitted.undetermined;  // combinations of numbers, a column each
    fit.proposed.resize(static_cast<std::size_t>(undetermined.cols()));
    for (const bool kinematic : {true, false}) {
        if (std::ranges::none_of(fit.proposed,
                                 [](const auto& proposed) { return proposed.by.figure < 0; }))
            break;
        const auto figures = unmeasured(model, data, kinematic);
        const auto solved = compare::solved_figures(fit.varied, figures, threads);
        const VectorXd extents =
            extents_of(fit.varied.scene(fit.fitted.p), figures, solved.value(fit.fitted.p));
        const Eigen::MatrixXd by_steps =
            solved.gradient(fit.fitted.p) * fit.measured.step.asDiagonal();
        for (std::size_t k = 0; k < fit.proposed.size(); ++k)
            if (fit.proposed[k].by.figure < 0)
                if (const auto by = compare::proposal(by_steps, extents,
                                                      undetermined.col(static_cast<Index>(k)));
                    by.share > min_share)
                    fit.proposed[k] = {figures[static_cast<std::size_t>(by.figure)], by};
    }
}

// The fitted scene; without a fit the reason is in Fitted::why_not. Throws SheetError, SceneError,
// FileError, and std::invalid_argument as parse_varied().
compare::FittedScene fitted(const FitRequest& request, const LoadedScene& loaded) {
    compare::Varied varied = parse_varied(request.vary, loaded.scene);
    set_scene(varied, request.scene, request.settings);
    const MeasuredFigures data = read_measured(request, loaded.model);
    compare::FittedScene fit_of_scene{varied, {}, data.columns, data.left_out};
    fit_of_scene.measured = {
        .value = Eigen::Map<const VectorXd>(data.value.data(), std::ssize(data.value)),
        .column = data.column,
        .step = VectorXd(varied.start.size()),
        .robust = request.robust};
    for (Index k = 0; k < varied.start.size(); ++k)
        fit_of_scene.measured.step[k] =
            compare::step_of(varied.numbers[static_cast<std::size_t>(k)]);
    compare::Fitted& found = fit_of_scene.fitted =
        compare::fit(compare::solved_figures(varied, data.figures, threads_of(request.running)),
                     fit_of_scene.measured, varied);
    if (found.why_not.empty())
        propose(fit_of_scene, loaded.model, data, threads_of(request.running));
    else
        found.why_not = why_not_solved(varied, data.figures, found.p, found.why_not.c_str());
    return fit_of_scene;
}

// Exit code 0: the data determine all numbers; 3: not all, or there is no fit.
int fit(const FitRequest& request, const Delivery& delivery) {
    check_may_write_scene(request.scene, request.output, request.settings);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const compare::FittedScene fit = fitted(request, loaded);
    const int code = deliver_result(delivery, document_of(loaded, request.scene), result_of(fit));
    if (fit.fitted.why_not.empty())
        request.write("fit: to " + request.measured, fit.varied, fit.fitted.p);
    return code;
}

}  // namespace

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
