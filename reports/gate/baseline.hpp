// Baseline files: accepted results of one scene, in two files. The same format carries a measurement
// from another machine.
//
// baselines/SCENE.json is what a person reviews: reason, tolerances, limits, and the main figures,
// one line each, at the stations of the branches, to the digits that an engineer notices.
// baselines/curves/SCENE.json holds every number that is compared, to nine decimals, which of them
// are main figures, and the numbers of the scene. The first names the hash of the second.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/gate/gate.hpp"
#include "elastocheck/scene.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed.
inline constexpr const char* baseline_schema = "elastocheck/baseline/4";
inline constexpr const char* baseline_curves_schema = "elastocheck/baseline-curves/4";
inline constexpr FileKind baseline_curves_file{"curves of a baseline",
                                               R"({"schema": "elastocheck/baseline-curves/)"};

struct BaselineFile {
    std::string scene_file;  // relative to the folder of the baseline
    std::string input_hash;  // of the scene file
    std::vector<Number> numbers;
    Provenance provenance;
    compare::Baseline baseline;
};

// A baseline cannot be read; what() names the file with the reason.
struct BaselineError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A limit has min above max; what() names the file with the line.
struct LimitError : BaselineError {
    using BaselineError::BaselineError;
};

struct BaselineText {
    std::string review, curves;
};
BaselineText baseline_text(const BaselineFile& file);

// Strict: a missing, unknown or mistyped field is an error, so that a misspelt limit is not
// silently ignored. A null among the numbers is NaN. The hash and the values of the figures are
// checked by read_baseline alone. Throws BaselineError.
BaselineFile parse_baseline(const BaselineText& text, const std::string& file_name);

// Path of the second file of a baseline.
std::filesystem::path curves_of(const std::filesystem::path& baseline);

// Throws BaselineError, also for a pair of files that were not written together, and FileError.
BaselineFile read_baseline(const std::filesystem::path& file);
// The curves first: a pair of which only one was written is not read.
void write_baseline(const std::filesystem::path& file, const BaselineFile& baseline);

// Closest tolerance class for two builds, and their differences.
struct BuildDistance {
    compare::ToleranceClass kind = compare::ToleranceClass::same_build;
    std::string differs;  // "compiler: GNU 12.2.0, now Clang 14.0.6"; empty for the same build
};
BuildDistance distance(const Provenance& was, const Provenance& is);

// Reason why a baseline file is unreviewed: it differs from the committed version in its git
// checkout. Empty if it is committed.
std::string not_committed(const std::filesystem::path& file);

}  // namespace elastocheck::reports
