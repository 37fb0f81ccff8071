#include "reports/python/analyses.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/compare.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/proofs/certify.hpp"
#include "compare/studies/work_precision.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/command/options/fitting.hpp"
#include "reports/command/options/gradients_of.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/exit_code.hpp"
#include "reports/document/candidate.hpp"
#include "reports/document/curves.hpp"
#include "reports/document/document.hpp"
#include "reports/python/convert.hpp"
#include "reports/python/scene.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/candidate_tables.hpp"
#include "reports/tables/comparison_tables.hpp"
#include "reports/tables/judgement.hpp"
#include "reports/tables/studies/sensitivity.hpp"

namespace elastocheck::python {

namespace py = pybind11;
using json = nlohmann::ordered_json;
using reports::could_not_judge;
using reports::fine;
using reports::limit_broken;

namespace {

// What a command prints, its document, and its exit code.
struct Report {
    std::string text;
    json document;
    int exit_code = fine;
    std::string csv = {};  // the curves of a comparison, as in curves.csv
    py::object converted = {};
};

Report report_of(const compare::Result& result) {
    return {.text = reports::text(result),
            .document = reports::json_of(result),
            .exit_code = reports::exit_code_of(result.verdict.grade)};
}

int threads_of(int requested) {
    if (requested < 0)
        throw std::invalid_argument(fmt::format("threads {}; allowed: 0 or more", requested));
    return reports::threads_of({.jobs = requested});
}

void check_name(const char* what, const std::string& word, const std::vector<std::string>& known) {
    if (std::ranges::find(known, word) == known.end())
        throw std::invalid_argument(fmt::format("{} {}{}", what, reader::quote(word),
                                                reader::did_you_mean(word, known, "allowed")));
}

const char* verdict_of(int exit_code) {
    return exit_code == fine           ? "fine"
           : exit_code == limit_broken ? "limit broken"
                                       : "could not judge";
}

compare::Options options_of(const std::optional<std::string>& method, int steps, int every,
                            int threads, compare::Progress progress) {
    reports::SolverRequest request;
    request.method = method.value_or("published");
    std::vector<std::string> known;
    for (const auto& one : recursive::methods) known.emplace_back(one.name);
    check_name("method", request.method, known);
    request.recursion.steps = steps;
    compare::Options options;
    options.recursion = reports::solver_of(request).recursion;
    options.every = every;
    options.threads = threads;
    options.progress = std::move(progress);
    return options;
}

void check_size(const Model& model, int steps, int every) {
    reports::check_every(model, steps, every);
    reports::check_memory(model, {.steps = steps,
                                  .every = every,
                                  .legs = static_cast<int>(compare::legs.size()),
                                  .written = true});
}

Report compare_legs(const SceneOfFile& scene, const std::optional<std::string>& method,
                    const std::optional<std::string>& within, int steps, int every, int threads,
                    const compare::Progress& progress) {
    const Model& model = scene.loaded.model;
    const auto options = options_of(method, steps, every, threads_of(threads), progress);
    const auto tolerance =
        within ? compare::parse_tolerance(*within, compare::ToleranceParts::with_forces)
               : compare::default_tolerance;
    check_size(model, steps, every);
    auto found = reports::analyses_of(scene.loaded, scene.file);
    reports::add_comparison(found, compare::compare(model, options));
    const compare::Comparison& comparison = found.comparison;
    found.judgement = compare::assess(model, comparison, tolerance, within.has_value());
    found.judgement->requested = within || method;
    Report report{
        .text = reports::tables(model, comparison) + reports::sentence(*found.judgement) + "\n",
        .document = reports::scene_json(found),
        .exit_code = comparison.conclusive() ? fine : could_not_judge};
    report.csv = reports::curves_csv({{scene.loaded.scene.name, &comparison}});
    return report;
}

Report certify(const SceneOfFile& scene, const std::vector<std::string>& methods,
               const std::optional<std::string>& tolerance, int points, int threads,
               const compare::Progress& progress) {
    compare::CertifyOptions options;
    options.tolerance = compare::claim(tolerance.value_or(compare::claimed_accuracy));
    const auto known = reports::certified_solvers();
    for (const auto& method : methods) {
        check_name("method", method, known);
        options.solvers.push_back(reports::certified_solver(method));
    }
    if (points < 1 || points > reports::most_steps)
        throw std::invalid_argument(
            fmt::format("points {}; allowed: 1 to {}", points, reports::most_steps));
    options.points = points;
    options.threads = threads_of(threads);
    options.progress = progress;
    return report_of(result_of(compare::certify(scene.loaded.model, options)));
}

Report sensitivity(const SceneOfFile& scene, reports::GradientsRequest request, int most,
                   const compare::Progress& progress) {
    if (request.points < 1)
        throw std::invalid_argument(fmt::format("points {}; allowed: 1 or more", request.points));
    const compare::Gradients all = reports::gradients_of(
        scene.file, scene.settings, scene.loaded, request, [&](const std::string& what) {
            if (progress) progress(what, std::numeric_limits<double>::quiet_NaN());
        });
    return {.text = reports::sensitivity_text(all, most),
            .document = reports::sensitivity_json(all),
            .exit_code = all.conclusive() ? fine : could_not_judge};
}

Report fit(const SceneOfFile& scene, const std::string& measured,
           const std::vector<std::string>& vary, const std::string& map, bool robust, int threads) {
    return report_of(result_of(reports::fitted(
        {scene.file, scene.settings, vary, measured, map, robust, threads_of(threads)},
        scene.loaded)));
}

// ---- A candidate: a Python function as a leg.

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

Report judge(const std::shared_ptr<SceneOfFile>& scene, const py::function& solver,
             const std::string& name, const std::optional<std::string>& tolerance, int steps,
             int threads, const compare::Progress& progress) {
    const Model& model = scene->loaded.model;
    const auto within = compare::parse_tolerance(tolerance.value_or("0.01mm,0.001deg,1%"),
                                                 compare::ToleranceParts::with_forces);
    const auto options = options_of(std::nullopt, steps, 1, threads_of(threads), progress);
    check_size(model, steps, 1);
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
    const std::string verdict = reports::sentence(judgement, comparison);
    return {.text = reports::candidate_text(judgement, comparison) + verdict + "\n",
            .document = reports::candidate_json(judgement, comparison, verdict),
            .exit_code = judgement.verdict == compare::Grade::pass   ? fine
                         : judgement.verdict == compare::Grade::fail ? limit_broken
                                                                     : could_not_judge};
}

}  // namespace

void bind_analyses(py::module_& module) {
    py::class_<Report>(module, "Report")
        .def_readonly("text", &Report::text)
        .def_readonly("exit_code", &Report::exit_code)
        .def_readonly("_csv", &Report::csv)
        .def_property_readonly("verdict", [](const Report& r) { return verdict_of(r.exit_code); })
        .def_property_readonly("document", [](Report& r) {
            if (!r.converted) r.converted = object_of(r.document);
            return r.converted;
        });

    module.def(
        "compare",
        [](const SceneOfFile& scene, const std::optional<std::string>& method,
           const std::optional<std::string>& within, int steps, int every, int threads,
           const py::object& progress) {
            const auto told = progress_to(progress);
            const py::gil_scoped_release unlocked;
            return compare_legs(scene, method, within, steps, every, threads, told);
        },
        py::arg("scene"), py::arg("method"), py::arg("within"), py::arg("steps"), py::arg("every"),
        py::arg("threads"), py::arg("progress"));
    module.def(
        "certify",
        [](const SceneOfFile& scene, const std::vector<std::string>& methods,
           const std::optional<std::string>& tolerance, int points, int threads,
           const py::object& progress) {
            const auto told = progress_to(progress);
            const py::gil_scoped_release unlocked;
            return certify(scene, methods, tolerance, points, threads, told);
        },
        py::arg("scene"), py::arg("methods"), py::arg("tolerance"), py::arg("points"),
        py::arg("threads"), py::arg("progress"));
    module.def(
        "sensitivity",
        [](const SceneOfFile& scene, std::vector<std::string> of, std::vector<std::string> to,
           std::vector<std::string> branches, std::vector<std::string> at, int points, int most,
           const py::object& progress) {
            const auto told = progress_to(progress);
            const py::gil_scoped_release unlocked;
            return sensitivity(
                scene, {std::move(of), std::move(to), std::move(branches), std::move(at), points},
                most, told);
        },
        py::arg("scene"), py::arg("of"), py::arg("to"), py::arg("branches"), py::arg("at"),
        py::arg("points"), py::arg("most"), py::arg("progress"));
    module.def("fit", &fit, py::call_guard<py::gil_scoped_release>(), py::arg("scene"),
               py::arg("measured"), py::arg("vary"), py::arg("map"), py::arg("robust"),
               py::arg("threads"));
    module.def(
        "judge",
        [](const std::shared_ptr<SceneOfFile>& scene, const py::function& solver,
           const std::string& name, const std::optional<std::string>& tolerance, int steps,
           int threads, const py::object& progress) {
            const auto told = progress_to(progress);
            const py::gil_scoped_release unlocked;
            return judge(scene, solver, name, tolerance, steps, threads, told);
        },
        py::arg("scene"), py::arg("solver"), py::arg("name"), py::arg("tolerance"),
        py::arg("steps"), py::arg("threads"), py::arg("progress"));
}

}  // namespace elastocheck::python
