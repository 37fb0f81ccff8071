#include "reports/document/curves.hpp"

#include <fmt/format.h>

#include <cmath>

#include "reports/render/render.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {

std::string curves_csv(
    const std::vector<std::pair<std::string, const compare::Comparison*>>& scenes) {
    std::string csv = "scene,branch,leg,parameter,parameter unit,output,unit,value\n";
    for (const auto& [scene, comparison] : scenes)
        for (const auto& branch : comparison->branches)
            for (const auto& run : branch.runs) {
                const std::string unit = for_csv(symbol(branch.unit));
                const std::string run_cells =
                    for_csv(scene) + "," + for_csv(branch.branch) + "," + for_csv(name(run.leg));
                for (std::size_t c = 0; c < comparison->channels.size(); ++c) {
                    const auto& channel = comparison->channels[c];
                    const std::string output_cells =
                        for_csv(channel.name) + "," + for_csv(symbol(channel.unit));
                    for (std::size_t k = 0; k < run.curve.a.size(); ++k) {
                        const double value = run.curve.values[k][c];
                        csv += fmt::format(
                            "{},{},{},{},{}\n", run_cells, run.curve.a[k], unit, output_cells,
                            std::isfinite(value) ? fmt::format("{:.17g}", value) : "");
                    }
                }
            }
    return csv;
}

std::string forces_csv(const std::vector<SceneAnalyses>& scenes) {
    compare::Table all;
    for (const auto& scene : scenes) {
        compare::Table one = table_of(force_rows(scene.model, scene.comparison));
        all.columns = std::move(one.columns);
        for (auto& row : one.rows) {
            row.insert(row.begin(), scene.scene.name);
            all.rows.push_back(std::move(row));
        }
    }
    all.columns.insert(all.columns.begin(), {.name = "scene", .words = true});
    return csv(all);
}

}  // namespace elastocheck::reports
