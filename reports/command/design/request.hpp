// A command that changes numbers of a scene.
#pragma once

#include <string>
#include <vector>

#include "reports/command/delivery.hpp"
#include "reports/command/options/design_options.hpp"
#include "reports/command/program/command.hpp"

namespace elastocheck::reports {

struct DesignRequest : SceneRequest {
    std::string output;  // file of the changed scene; empty: none
    std::vector<std::string> vary;

    // Writes the changed scene, `line` as its first comment; reports it if `last` of several.
    void write(const std::string& line, const compare::Varied& varied, const Eigen::VectorXd& p,
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

}  // namespace elastocheck::reports
