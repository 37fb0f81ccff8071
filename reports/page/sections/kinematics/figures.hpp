// Figures of part 1: a quantity each, with the curves of all load cases and wheels.
#pragma once

#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/page/sections/kinematics/cases.hpp"

namespace elastocheck::reports {

// The curves of one colour: a load case, or a spring; of each wheel one, once where they coincide.
struct Bundle {
    std::string title;  // of the legend: "lateral, inwards"; empty: of the only one
    struct Line {
        std::string whose;  // "left"; empty: of no wheel alone
        std::vector<std::vector<double>> rows;
    };
    std::vector<Line> lines{};
    std::vector<Series> others{};  // measured, candidates, marks

    // Left out where it coincides with another line.
    void add(const std::string& whose, std::vector<std::vector<double>> rows);
};

// The figure with these curves and its numbers.
FigureGroup drawn(Figure figure, std::vector<Bundle> bundles, const std::vector<Wheel>& wheels,
                  std::string caption);

// Adds a figure of every quantity that moves or was given.
void add_figures(Section& section, const SceneAnalyses& scene, const Family& family);

}  // namespace elastocheck::reports
