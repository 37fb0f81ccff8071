#include "reports/command/options/fitting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Outputs at the ends of the branches, without those that were measured on the branch: positions
// and angles, or all others.
std::vector<NamedFigure> unmeasured(const Model& model, const MeasuredFigures& data,
                                    bool kinematic) {
    std::vector<NamedFigure> all;
    for (const Branch& branch : model.branches)
        for (const auto& output : compare::figure_outputs(model)) {
            if (output.kinematic() != kinematic ||
                std::ranges::any_of(data.figures, [&](const compare::Figure& figure) {
                    return figure.name == output.name && figure.branch == branch.name;
                }))
                continue;
            const compare::Unit unit = compare::unit_of(branch.unit);
            for (const double end : {double(branch.from), double(branch.to)})
                if (end != 0)
                    all.push_back({{.name = output.name, .branch = branch.name, .at = end},
                                   output,
                                   fmt::format("{} = {:g} {}", branch.name,
                                               compare::in_unit(unit) * end, symbol(unit))});
        }
    return all;
}

// Per figure: how far its output moves from the start of a branch to an end, of all branches the
// largest.
VectorXd extents_of(const Scene& scene, const std::vector<compare::Figure>& figures,
                    const VectorXd& value) {
    std::vector<compare::Figure> starts = figures;
    for (auto& figure : starts) figure.at = 0;
    const VectorXd start = compare::figure_values(scene, starts, compare::Leg::equilibrium).value;
    std::map<std::string, double> largest;
    for (std::size_t k = 0; k < figures.size(); ++k) {
        const auto i = static_cast<Index>(k);
        const double moved = std::abs(value[i] - start[i]);
        if (double& most = largest[figures[k].name]; moved > most) most = moved;
    }
    VectorXd extent(value.size());
    for (std::size_t k = 0; k < figures.size(); ++k)
        extent[static_cast<Index>(k)] = largest[figures[k].name];
    return extent;
}

// What to measure so that each undetermined combination is determined.
std::vector<ProposedOutput> propose(const FittedScene& fit, const Model& model,
                                    const MeasuredFigures& data, const compare::SceneAt& scene,
                                    int threads) {
    const auto& open = fit.fitted.undetermined;
    std::vector<ProposedOutput> proposed(static_cast<std::size_t>(open.cols()));
    for (const bool kinematic : {true, false}) {
        if (std::ranges::none_of(proposed, &std::string::empty, &ProposedOutput::output)) break;
        const auto named = unmeasured(model, data, kinematic);
        const auto figures = figures_of(named);
        const auto of = compare::solved_figures(scene, fit.numbers, figures, threads);
        const VectorXd value = of.value(fit.fitted.p);
        const auto found = compare::proposals(of.gradient(fit.fitted.p), value,
                                              extents_of(scene(fit.fitted.p), figures, value),
                                              fit.measured.step, open);
        for (std::size_t k = 0; k < found.size(); ++k) {
            if (found[k].figure < 0 || !proposed[k].output.empty()) continue;
            const NamedFigure& one = named[static_cast<std::size_t>(found[k].figure)];
            proposed[k] = {one.output.name, symbol(one.output.unit), one.place, found[k].movement,
                           found[k].share};
        }
    }
    return proposed;
}

}  // namespace

FittedScene fitted(const FitInput& input, const LoadedScene& loaded, const Varied& varied) {
    const ColumnMap map =
        input.map.empty() ? ColumnMap{} : read_column_map(read_whole(input.map), input.map);
    const MeasuredFigures data = read_measured(read_whole(input.measured, largest_measurement),
                                               input.measured, map, loaded.model);
    FittedScene result{.numbers = varied.numbers,
                       .measured = {.value = data.value,
                                    .column = data.column,
                                    .start = varied.start,
                                    .low = varied.low,
                                    .high = varied.high,
                                    .step = VectorXd(varied.start.size()),
                                    .robust = input.robust},
                       .columns = data.columns,
                       .left_out = data.left_out,
                       .fitted = {}};
    for (Index k = 0; k < varied.start.size(); ++k)
        result.measured.step[k] = compare::step_of(varied.numbers[static_cast<std::size_t>(k)]);
    const auto scene = scene_at(input.scene, input.settings, varied.numbers);
    result.fitted =
        compare::fit(compare::solved_figures(scene, varied.numbers, data.figures, input.threads),
                     result.measured);
    if (!result.fitted.why_not.empty()) {
        const auto start =
            compare::figure_values(loaded.scene, data.figures, compare::Leg::equilibrium);
        if (!start.why_not.empty()) result.fitted.why_not += ": " + start.why_not;
        return result;
    }
    result.proposed = propose(result, loaded.model, data, scene, input.threads);
    return result;
}

}  // namespace elastocheck::reports
