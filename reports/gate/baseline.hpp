// Baseline files: accepted results of one scene, small enough to be reviewed.
//
// Stored in baselines/SCENE.json beside each scene: one line per curve, sorted. The same format
// carries a measurement from another machine.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/gate/gate.hpp"
#include "elastocheck/scene.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed.
inline constexpr const char* baseline_schema = "elastocheck/baseline/2";

struct BaselineFile {
    std::string scene_file;  // relative to the folder of the baseline
    std::string input_hash;  // of the scene file
    // numbers of the scene; empty for older files without them
    std::optional<std::vector<Number>> numbers;
    Provenance provenance;
    compare::Baseline baseline;
};

// A baseline cannot be read; what() names the file with the reason.
struct BaselineError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

std::string baseline_text(const BaselineFile& file);

// Strict: a missing, unknown or mistyped field is an error, so that a misspelt limit is not
// silently ignored. A null among the numbers is NaN.
BaselineFile parse_baseline(std::string_view text, const std::string& file_name);

// Closest tolerance class for the two builds, and the differences as text ("" for the same build).
struct BuildDistance {
    compare::ToleranceClass kind = compare::ToleranceClass::same_build;
    std::string differs;  // "compiler: GNU 12.2.0, now Clang 14.0.6"
};
BuildDistance distance(const Provenance& was, const Provenance& is);

// Reason why a baseline file is unreviewed: it differs from the committed version in its git
// checkout. Empty if it is committed.
std::string not_committed(const std::filesystem::path& file);

}  // namespace elastocheck::reports
