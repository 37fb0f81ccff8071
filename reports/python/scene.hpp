// A scene as the Python module holds it, and its solution by one leg or method.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "models/reader/parsed_scene.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/solving.hpp"

namespace elastocheck::python {

struct SceneOfFile {
    std::string file;
    reports::Settings settings;  // of its numbers, the later of two of one path applies
    std::shared_ptr<const reader::ParsedScene> parsed;
    reports::LoadedScene loaded;
    std::shared_ptr<const std::vector<compare::Channel>> channels;  // those without a request
};
using SharedScene = std::shared_ptr<const SceneOfFile>;

// Throw as the reader and trimmed_and_compiled() do. `name`: of the file in messages, instead
// of its path.
SharedScene read(const std::string& file, const reports::Settings& settings,
                 const std::string& name = {});
// The same text with these settings in addition.
SharedScene varied(const SceneOfFile& scene, const reports::Settings& settings);

// Curves of a branch by one leg or method, as the rows of the CSV of `elastocheck solve`.
struct BranchCurves {
    std::string branch;
    compare::Leg leg = compare::Leg::equilibrium;
    std::string method;  // name of the leg, or of the method
    compare::Unit unit = compare::Unit::newton;
    std::shared_ptr<const std::vector<compare::Channel>> channels;
    std::vector<compare::Row> rows;
    std::vector<double> poses = {};  // [points × bodies × 7], where they are kept
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    // Ends reached by a method with equal steps, which has no tolerance.
    std::vector<std::pair<compare::BranchSide, Equilibrium>> ends = {};
    SharedScene scene;
};

struct SolveRequest {
    reports::SolverRequest solver;
    std::vector<std::string> channels = {};  // names or patterns; none: as `elastocheck solve`
    std::vector<std::string> branches = {};  // names; none: all
    bool characteristics = false;            // in place of them all K&C figures
    bool states = false;                     // keep the poses
};
// Throws std::invalid_argument as the command does.
std::vector<BranchCurves> solve(const SharedScene& scene, const SolveRequest& request);

// The state in mm and as a quaternion w, x, y, z; appends one point of BranchCurves::poses.
void append(std::vector<double>& poses, const Equilibrium& state);

// Adds Scene and Curve to the module.
void bind_scene(pybind11::module_& module);

}  // namespace elastocheck::python
