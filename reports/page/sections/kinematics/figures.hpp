// Figures of the report's first part (kinematics): one per quantity, with the curves of all load
// cases and wheels.
#pragma once

#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/page/sections/kinematics/cases.hpp"

namespace elastocheck::reports {

// The curves of one colour: those of a load case or of a spring, one line per wheel.
struct Bundle {
    std::string title;  // in the legend: "lateral, inwards"; empty if there is one bundle
    struct Line {
        std::string whose;  // "left"; empty: not of one wheel
        std::vector<std::vector<double>> rows;
    };
    std::vector<Line> lines{};
    std::vector<Series> others{};  // measured, candidates, marks

    // Adds a line unless it coincides with one that is there.
    void add(const std::string& whose, std::vector<std::vector<double>> rows);
};

// The figure with these curves, and their numbers as a table.
FigureGroup drawn(Figure figure, std::vector<Bundle> bundles, const std::vector<Wheel>& wheels,
                  std::string caption);

// Adds a figure of every quantity that changes, or of which there are measured or candidate values.
void add_figures(Section& section, const SceneAnalyses& scene, const Family& family);

}  // namespace elastocheck::reports
