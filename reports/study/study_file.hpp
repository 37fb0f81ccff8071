// Reads the file of a study: reports/README.md, "Studies".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compare/variants/solve_variants.hpp"
#include "compare/variants/study.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"
#include "models/reader/parsed_scene.hpp"
#include "reports/study/ledger.hpp"

namespace elastocheck::reports {

struct StudyFile {
    std::string file;
    compare::variants::Study study;
    std::string scene_file;
    reader::ParsedScene parsed;
    Model design;
    compare::variants::VariantSolver solver;
    StudyIdentity identity;
    std::vector<std::string> warnings;
};

// `count` replaces that of the file. Everything is checked before the first variant. Throws
// SceneError and SheetError "file:line: field: ...", FileError, and std::invalid_argument where the
// scene's trim is not reached or the program was built without OpenTURNS.
StudyFile read_study(const std::string& file, std::optional<std::uint64_t> count);

// The scene with the numbers of one variant after the other. Not thread-safe.
class Variants {
  public:
    Variants(const reader::ParsedScene& scene, const compare::variants::Study& study);
    // Throws SceneError.
    Scene scene(const Eigen::VectorXd& values);

  private:
    const compare::variants::Study& study_;
    reader::VariedScene scene_;
    std::vector<double> numbers_ = {};
};

}  // namespace elastocheck::reports
