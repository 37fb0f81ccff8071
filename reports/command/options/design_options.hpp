// Numbers to vary and figures of a scene as words of a command line, and the scene file with the
// changed numbers.
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
// The numbers of "points.tie_rod_inner.z=260:340"; without "=LOW:HIGH" a number has no
// limits. Throws likewise.
compare::Varied parse_varied(const std::vector<std::string>& words, const Scene& scene);
// Varied::scene: of the file with these values of the numbers; `settings` apply to all others.
void set_scene(compare::Varied& varied, const std::string& file, const Settings& settings);

double parse_number(std::string_view word);  // throws likewise
// "bump_steer": at the start of the first branch. "toe@jounce:3000": at a value of a branch's
// parameter, in N, N·m, mm or deg. Throws likewise.
compare::Figure parse_figure(const std::string& word, const Model& model);

// Throws FileError if the output may not be written, and SceneError for a scene that cannot be read in
// its folder, as where the tables are not beside it; nothing of an empty name.
void check_may_write_scene(const std::string& scene, const std::string& output,
                           const Settings& settings);
// Writes the text of `scene` with the changed numbers, and reads it. `first_line` becomes a comment
// at its head.
void write_changed_scene(const std::string& scene, const std::string& output,
                         const std::string& first_line, const Settings& settings,
                         const compare::Varied& varied, const Eigen::VectorXd& p);

}  // namespace elastocheck::reports
