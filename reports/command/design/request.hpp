// What the commands share that search numbers of a scene: the scene written with them, the reason
// why a search cannot start.
#pragma once

#include <string>
#include <vector>

#include "reports/command/delivery.hpp"
#include "reports/command/options/design_options.hpp"

namespace elastocheck::reports {

struct DesignRequest : SceneRequest {
    std::string output;  // file of the changed scene; empty: none

    // `line` becomes a comment at its head. The last of several writings is reported.
    void write(const std::string& line, const Varied& varied, const Eigen::VectorXd& p,
               bool last = true) const {
        if (output.empty()) return;
        write_changed_scene(scene, output, line, settings, varied, p);
        if (last) print_error("Written: {}\n", output);
    }
};

// SCENE, --set, --json, --jobs, --quiet, -o.
inline void add_design(CLI::App& command, DesignRequest& request) {
    add_scene_and_run(command, request);
    as_file(command.add_option(
        "-o,--output", request.output,
        "write the scene with the changed numbers; the old ones are in comments"));
}

inline std::string why_no_start(const Scene& scene, std::span<const compare::Figure> figures,
                                const compare::FigureGradient& gradient) {
    const auto why = compare::figure_values(scene, figures, compare::Leg::equilibrium).why_not;
    return why.empty() ? "no rate at the start: " + gradient.why_not
                       : "no value at the start: " + why;
}

}  // namespace elastocheck::reports
