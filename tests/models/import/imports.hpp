// Helpers shared by the tests of the importers.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/import/import.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/mistakes.hpp"

namespace elastocheck::tests {

using support::replaced;

inline const std::filesystem::path import_folder = ELASTOCHECK_IMPORT;
inline std::string sample(const std::string& name) {
    return support::text_of(import_folder / "samples" / name);
}
inline std::string mistakes(const std::string& name) {
    return support::text_of(import_folder / "mistakes" / name);
}

// The message with which a model is refused; empty if it is not.
inline std::string refusal_of(const std::function<void()>& import) {
    try {
        import();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}
inline std::string refusal_of(const std::string& text, const std::string& file,
                              const importer::Options& options = {}) {
    return refusal_of([&] { importer::import_text(text, file, options); });
}

// The mistakes of import/mistakes/NAME.mistakes in a text that `refused` returns no message for.
inline void expect_refusals(const std::string& name, const std::string& valid,
                            const std::string& file,
                            const std::function<std::string(const std::string&)>& refused) {
    support::expect_refusals(import_folder / "mistakes" / (name + ".mistakes"), valid, file,
                             [&](const std::string& text) {
                                 const std::string said = refused(text);
                                 return said.empty() ? "accepted" : said;
                             });
}

// The notes in the head of a scene, each on one line.
inline std::string notes_of(const importer::Imported& imported) {
    std::string lines;
    for (const auto& line : importer::described(imported.notes)) lines += line + "\n";
    return lines;
}

inline testing::AssertionResult has_text(const std::string& text, const std::string& what) {
    if (text.find(what) != text.npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << what << " is not in\n" << text;
}

// Body-fixed Euler angles 3-1-3 [deg].
inline Eigen::Matrix3d euler(double a, double b, double c) {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    const double deg = std::numbers::pi / 180;
    return (AngleAxisd(a * deg, Vector3d::UnitZ()) * AngleAxisd(b * deg, Vector3d::UnitX()) *
            AngleAxisd(c * deg, Vector3d::UnitZ()))
        .toRotationMatrix();
}

// A branch, the first without a name, which a leg solves.
inline EquilibriumPath solved(const Model& model, const std::string& branch = "", int steps = 0,
                              compare::Leg leg = compare::Leg::equilibrium) {
    for (const Branch& each : model.branches) {
        if (!branch.empty() && each.name != branch) continue;
        auto path = compare::solve_branch(
            compare::sides_of(model, each, steps > 0 ? steps : each.steps), {.leg = leg});
        if (path.outcome != Outcome::converged) throw std::runtime_error(path.detail);
        return path;
    }
    throw std::runtime_error("no branch " + branch);
}

// The start of the first branch, settled under the start values.
inline Equilibrium at_rest(const Scene& scene) {
    return solved(compile(scene), "", 1).points.front();
}

}  // namespace elastocheck::tests
