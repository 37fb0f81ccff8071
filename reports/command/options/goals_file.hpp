// GOALS.yaml of `optimise`: numbers that may change, and bands of figures and curves.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/design/optimise.hpp"
#include "reports/command/options/design_options.hpp"
#include "reports/tables/studies/optimise_tables.hpp"

namespace elastocheck::reports {

struct GoalsFile {
    Varied varied;
    std::vector<Goal> goals;
    std::optional<NamedFigure> minimised;
    int minimised_line = 0;  // of the file
};

// reports/README.md, "Goals". Curves over an output are placed on the branches of the scene as it
// is. Throws SceneError "file:line: field: ...".
GoalsFile read_goals(std::string_view yaml, const std::string& file, const Scene& scene,
                     const Model& model);

// The figures of the goals, curve by curve, and then the minimised one; with their bands.
struct GoalFigures {
    std::vector<compare::Figure> figures;
    compare::Goals goals;
};
GoalFigures figures_of(const GoalsFile& file);

// Points between those of a curve, three in each gap, on the branch of the point before or after.
enum class BranchOf { before, after };
std::vector<GoalPoint> points_between(const Goal& goal, BranchOf branch);

}  // namespace elastocheck::reports
