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
    reports::Settings settings;  // of two with the same path the later one applies
    std::shared_ptr<const reader::ParsedScene> parsed;
    reports::LoadedScene loaded;
    std::shared_ptr<const std::vector<compare::Channel>>
        channels;  // the default ones of a solution
};
using SharedScene = std::shared_ptr<const SceneOfFile>;

// Reads, trims and compiles a scene. `name`: of the file in messages, instead of its path. Throws as the
// reader and trimmed_and_compiled().
SharedScene read(const std::string& file, const reports::Settings& settings,
                 const std::string& name = {});
// The same scene with these settings in addition; the file is not read again. Throws likewise.
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
    bool characteristics = false;            // all K&C figures in place of `channels`
    bool states = false;                     // keep the poses
};
// Curves of the requested branches. Throws std::invalid_argument as the command does.
std::vector<BranchCurves> solve(const SharedScene& scene, const SolveRequest& request);

// Appends a state to BranchCurves::poses: per body x, y, z [mm] and a quaternion w, x, y, z.
void append(std::vector<double>& poses, const Equilibrium& state);

// Adds Scene and Curves to the module.
void bind_scene(pybind11::module_& module);

}  // namespace elastocheck::python
