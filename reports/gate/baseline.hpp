// Baseline files: what was accepted of one scene, small enough to be read in a review.
//
// Beside each scene, in baselines/SCENE.json: one line a curve, sorted. The same format carries a measurement
// that was made elsewhere.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/gate.hpp"
#include "models/scene.hpp"
#include "reports/document/provenance.hpp"

namespace elastocheck::reports {

// Raised when a field changes its meaning or vanishes.
inline constexpr const char* baseline_schema = "elastocheck/baseline/2";

struct BaselineFile {
    std::string scene_file;                      // relative to the folder of the baseline
    std::string input_hash;                      // of the scene file
    std::optional<std::vector<Number>> numbers;  // in it; none in files of before they were kept
    Provenance provenance;
    compare::Baseline baseline;
};

// A baseline that cannot be read; what() names the file and says why.
struct BaselineError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

std::string baseline_text(const BaselineFile& file);

// Strict: a field that is missing, unknown or of another kind is an error, so that a limit whose name is
// misspelt is not silently no limit. A null among the numbers is NaN.
BaselineFile parse_baseline(std::string_view text, const std::string& file_name);

// The closest class that both builds allow, and in words what differs ("" for the same build).
struct BuildDistance {
    compare::ToleranceClass kind = compare::ToleranceClass::same_build;
    std::string differs;  // "compiler: GNU 12.2.0, now Clang 14.0.6"
};
BuildDistance distance(const Provenance& was, const Provenance& is);

// Why nobody can have reviewed this baseline file: it is not what the git checkout around it has committed.
// Empty when it is.
std::string not_committed(const std::filesystem::path& file);

}  // namespace elastocheck::reports
