// Numbers to vary and figures of a scene as words of a command line, and the scene file with the
// changed numbers: --vary, --want, --measured, --tolerances.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/design/figures.hpp"
#include "compare/design/tolerances.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/document/candidate_file.hpp"
#include "reports/tables/studies/design_tables.hpp"

namespace elastocheck::reports {

// ---- Numbers of the scene.

struct Varied {
    std::vector<Number> numbers;
    Eigen::VectorXd start, low, high;  // in the units of the file; infinite without limits
};

// "points.tie_rod_inner.z=260:340"; without "=LOW:HIGH" the number has no limits, and the name may
// be a pattern with *. Names joined by commas are numbers that change together, as two equal rates
// of a bushing must. Throws std::invalid_argument, for an unknown name with the nearest.
Varied parse_varied(const std::vector<std::string>& words, const Scene& scene);

// The scene of a file with these values of the numbers; `settings` apply to all others.
compare::SceneAt scene_at(const std::string& file, const Settings& settings,
                          const std::vector<Number>& numbers);

// ---- Figures.

// "bump_steer": at the start of the first branch. "toe@jounce:3000": at a value of a branch's
// parameter, in N, N·m, mm or deg. `option` is named in messages. Throws std::invalid_argument,
// likewise.
NamedFigure parse_figure(const std::string& word, const std::string& option, const Model& model);

// A figure and its value, "bump_steer=0".
std::pair<NamedFigure, double> parse_wanted(const std::string& word, const Model& model);

std::vector<compare::Figure> figures_of(const std::vector<NamedFigure>& named);

// ---- Tolerances of numbers.

struct Tolerances {
    std::vector<compare::Tolerated> numbers;
    Eigen::MatrixXd correlation;  // empty if the file has none
};
// reports/README.md, "Tolerances". Throws SceneError "file:line: field: ...".
Tolerances read_tolerances(std::string_view yaml, const std::string& file, const Scene& scene);

// ---- Measured points.

struct MeasuredFigures {
    std::vector<compare::Figure> figures;
    Eigen::VectorXd value;
    std::vector<int> column;                // per figure
    std::vector<compare::Channel> columns;  // their outputs
    std::vector<std::string> left_out;      // columns and rows of the file that are not used
};
// As --measured of `report` reads it; a point is at its parameter, without one at its travel. Throws
// SheetError.
MeasuredFigures read_measured(std::string_view csv, const std::string& file, const ColumnMap& map,
                              const Model& model);

// ---- The scene file with the numbers changed.

// Throws FileError if the output may not be written.
void check_may_write_scene(const std::string& output);
// Writes the text of `scene` with the changed numbers, and reads it. `first_line` becomes a comment
// at its head.
void write_changed_scene(const std::string& scene, const std::string& output,
                         const std::string& first_line, const Settings& settings,
                         const Varied& varied, const Eigen::VectorXd& p);

}  // namespace elastocheck::reports
