// Numbers to vary and figures of a scene, from a command line; the scene file with changed numbers.
#pragma once

#include <string>
#include <vector>

#include "compare/design/figures.hpp"
#include "reports/command/options/load_scene.hpp"

namespace elastocheck::reports {

// Adds the number of a name; of a pattern with *, all that match; of names joined by commas, numbers
// that change together, as two equal rates of a bushing must. Throws std::invalid_argument, for an
// unknown name with the nearest.
void add_numbers(compare::Varied& varied, const Scene& scene, const std::string& name, double low,
                 double high);
// Numbers with limits, "points.tie_rod_inner.z=260:340", or without, by name. Throws likewise.
compare::Varied parse_varied(const std::vector<std::string>& words, const Scene& scene);
// Sets Varied::scene to a reader of the file with values of the numbers; `settings` are of the others.
void set_scene(compare::Varied& varied, const std::string& file, const Settings& settings);

double parse_number(std::string_view word);  // throws likewise
// "bump_steer": at the start of the first branch. "toe@jounce:3000": at a value of a branch's
// parameter, in N, N·m, mm or deg. Throws likewise.
compare::Figure parse_figure(const std::string& word, const Model& model);

// Throws FileError if the output may not be written, and SceneError if the scene could not be read from
// the folder of the output, where its tables may be missing. Does nothing for an empty `output`.
void check_may_write_scene(const std::string& scene, const std::string& output,
                           const Settings& settings);
// Writes the text of `scene` with the changed numbers, below `first_line`, and reads it as a check.
void write_changed_scene(const std::string& scene, const std::string& output,
                         const std::string& first_line, const Settings& settings,
                         const compare::Varied& varied, const Eigen::VectorXd& p);

}  // namespace elastocheck::reports
