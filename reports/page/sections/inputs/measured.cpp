#include "reports/page/sections/inputs/measured.hpp"

#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"

namespace elastocheck::reports {
namespace {

// The points of an output, or of the travel that places them; null if it was not measured.
const std::vector<double>* column(const SceneAnalyses& scene, const std::string& output) {
    const compare::Points& points = scene.measured->measurement.table.points;
    const auto& channels = scene.comparison.channels;
    for (const auto& column : scene.measured->found.columns)
        if (channels[column.channel].name == output) return &column.values;
    return points.abscissa && channels[*points.abscissa].name == output ? &points.at : nullptr;
}

// Whether the k-th point was measured on one of these branches.
bool is_on(const SceneAnalyses& scene, const Sweep& sweep, std::size_t k) {
    const int branch = scene.measured->found.places[k].branch;
    return branch >= 0 &&
           sweep.has(scene.comparison.branches[static_cast<std::size_t>(branch)].branch);
}

}  // namespace

bool measured_over_parameter(const SceneAnalyses& scene, const Sweep& sweep) {
    if (!scene.measured) return false;
    const compare::Points& measured = scene.measured->measurement.table.points;
    if (!measured.abscissa) return true;
    bool points = false, travel = false;
    for (std::size_t k = 0; k < measured.at.size(); ++k)
        if (is_on(scene, sweep, k)) {
            points = true;
            travel = travel || std::isfinite(measured.at[k]);
        }
    return points && !travel;
}

std::vector<DrawnCurve> measured_curves(const SceneAnalyses& scene, const Sweep& sweep,
                                        const std::string& by, const std::string& channel) {
    if (!scene.measured) return {};
    const auto& a = scene.measured->measurement.table.points.a;
    const auto* x = !by.empty() ? column(scene, by) : a.empty() ? nullptr : &a;
    const auto* y = column(scene, channel);
    if (x == nullptr || y == nullptr) return {};
    DrawnCurve points{"measured"};
    bool any = false;
    for (std::size_t k = 0; k < x->size(); ++k)
        if (is_on(scene, sweep, k) && std::isfinite((*x)[k])) {
            points.rows.push_back({(*x)[k], (*y)[k]});
            any = any || std::isfinite((*y)[k]);
        }
    if (!any) return {};
    return {points};
}

std::optional<Section> measured_section(const SceneAnalyses& scene) {
    if (!scene.measured) return std::nullopt;
    const auto& [measurement, found, left_out] = *scene.measured;
    Section section{
        .id = "measured", .title = "Comparison with the measurement", .part = Part::behaviour};
    bool over_load = false;
    for (const auto& sweep : sweeps_of(scene))
        over_load = over_load || (measured_over_parameter(scene, sweep) && !sweep.abscissa.empty());
    section.words = {{"over_load", over_load},
                     {"file", measurement.file},
                     {"hash", measurement.hash},
                     {"points", measurement.table.lines.size()}};
    if (!left_out.empty()) section.words["left_out"] = enumerated(left_out);
    if (!found.explanations.empty()) section.words["findings"] = enumerated(found.explanations);
    for (const auto& reading : found.readings)
        if (!reading.rows.empty())
            section.tables.push_back(deviation_table(*scene.measured, reading, scene.comparison));
    if (!found.loops.empty())
        section.tables.push_back(loop_table(*scene.measured, scene.comparison));
    return section;
}

}  // namespace elastocheck::reports
