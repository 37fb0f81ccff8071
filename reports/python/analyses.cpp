#include "reports/python/analyses.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/compare.hpp"
#include "compare/outputs/curve.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/recursion_options.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/exit_code.hpp"
#include "reports/command/program/parse.hpp"
#include "reports/files/terminal.hpp"
#include "reports/python/convert.hpp"
#include "reports/python/scene.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/candidate_tables.hpp"

namespace elastocheck::python {

namespace py = pybind11;

namespace {

// Output of a command: standard output, the text of the result where a document is printed, errors.
struct Output {
    int exit_code = reports::fine;
    std::string printed = {}, text = {}, errors = {};
};

// Runs the command of a command line in this process, one at a time.
Output run(std::vector<std::string> words, const compare::Progress& progress) {
    static std::mutex one_at_a_time;
    const std::lock_guard guard(one_at_a_time);
    reports::Collected collected{.progress = progress};
    const reports::Collecting collecting(collected);
    words.insert(words.begin(), "elastocheck");
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int exit_code = reports::parse_and_run(static_cast<int>(words.size()), arguments.data());
    return {exit_code, std::move(collected.printed), std::move(collected.text),
            std::move(collected.errors)};
}

// ---- A candidate: a Python function as a leg.

// The array that a candidate returned as a path. Throws TypeError and ValueError for another shape.
EquilibriumPath path_of(const py::object& returned, const Model& model,
                        std::span<const double> parameters) {
    const auto array =
        py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(returned);
    const auto bodies = static_cast<py::ssize_t>(model.bodies.size());
    const auto points = static_cast<py::ssize_t>(parameters.size());
    if (!array) {
        PyErr_Clear();
        throw py::type_error("a candidate returns an array of numbers [points, bodies, 7]");
    }
    const bool fits = array.ndim() == 3 && array.shape(0) <= points && array.shape(1) == bodies &&
                      array.shape(2) == 7;
    if (!fits) {
        std::string shape;
        for (py::ssize_t k = 0; k < array.ndim(); ++k)
            shape += fmt::format("{}{}", k == 0 ? "" : ", ", array.shape(k));
        throw py::value_error(fmt::format(
            "a candidate returned an array [{}]; allowed: [{}, {}, 7], a state for each "
            "parameter, or fewer where it ends early; per body x, y, z in mm and the "
            "quaternion w, x, y, z",
            shape, points, bodies));
    }
    EquilibriumPath path;
    const auto at = array.unchecked<3>();
    for (py::ssize_t k = 0; k < array.shape(0); ++k) {
        Equilibrium& state = path.points.emplace_back();
        state.load = parameters[static_cast<std::size_t>(k)];
        for (py::ssize_t b = 0; b < bodies; ++b)
            state.poses.push_back(
                {1e-3 * Eigen::Vector3d(at(k, b, 0), at(k, b, 1), at(k, b, 2)),
                 Eigen::Quaterniond(at(k, b, 3), at(k, b, 4), at(k, b, 5), at(k, b, 6))});
    }
    if (array.shape(0) < points) {
        path.outcome = Outcome::branch_lost;
        path.detail = fmt::format("{} of {} states", array.shape(0), points);
    }
    return path;
}

Output judge(const std::shared_ptr<SceneOfFile>& scene, const py::function& solver,
             const std::string& name, const std::optional<std::string>& tolerance,
             const compare::Options& options) {
    const Model& model = scene->loaded.model;
    const auto within = compare::parse_tolerance(tolerance.value_or("0.01mm,0.001deg,1%"),
                                                 compare::ToleranceParts::with_forces);
    reports::check_memory(model, {.steps = options.recursion.steps,
                                  .legs = static_cast<int>(compare::legs.size()),
                                  .written = true});
    const compare::Comparison comparison = compare::compare(model, options);
    const compare::CandidateSolver as_leg = [&](const Model& of_side, const Branch& side,
                                                std::span<const double> parameters) {
        const py::gil_scoped_acquire lock;
        const compare::Unit unit = compare::unit_of(side.unit);
        py::array_t<double> shown(static_cast<py::ssize_t>(parameters.size()));
        double* at = shown.mutable_data();
        for (const double a : parameters) *at++ = compare::parameter_in(unit, a);
        return path_of(solver(scene, side.name, shown), of_side, parameters);
    };
    const auto judgement = compare::judge_candidate(
        model, comparison, compare::candidate_of(model, comparison, name, as_leg), within,
        tolerance.has_value());
    const compare::Result result = reports::result_of(judgement, comparison);
    return {.exit_code = reports::exit_code_of(judgement.verdict),
            .printed = reports::json_of(result).dump(),
            .text = reports::text(result)};
}

py::tuple as_tuple(const Output& output) {
    return py::make_tuple(output.exit_code, output.printed, output.text, output.errors);
}

}  // namespace

void bind_analyses(py::module_& module) {
    module.def(
        "run",
        [](std::vector<std::string> words, const py::object& progress) {
            const auto reported = progress_to(progress);
            Output output;
            {
                const py::gil_scoped_release unlocked;
                output = run(std::move(words), reported);
            }
            return as_tuple(output);
        },
        py::arg("words"), py::arg("progress"));
    module.def(
        "judge",
        [](const std::shared_ptr<SceneOfFile>& scene, const py::function& solver,
           const std::string& name, const std::optional<std::string>& tolerance, int steps,
           int threads, const py::object& progress) {
            compare::Options options;
            options.recursion = reports::recursion({.method = "published", .steps = steps});
            options.threads = reports::threads_of({.jobs = threads});
            options.progress = progress_to(progress);
            Output output;
            {
                const py::gil_scoped_release unlocked;
                output = judge(scene, solver, name, tolerance, options);
            }
            return as_tuple(output);
        },
        py::arg("scene"), py::arg("solver"), py::arg("name"), py::arg("tolerance"),
        py::arg("steps"), py::arg("threads"), py::arg("progress"));
}

}  // namespace elastocheck::python
