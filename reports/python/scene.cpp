#include "reports/python/scene.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/curve.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/document/drawing.hpp"
#include "reports/document/inspection.hpp"
#include "reports/page/report/picture.hpp"
#include "reports/python/convert.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/csv.hpp"

namespace elastocheck::python {

namespace py = pybind11;

namespace {

SharedScene loaded(std::string file, reports::Settings settings,
                   std::shared_ptr<const reader::ParsedScene> parsed) {
    reader::SceneAndWarnings found;
    found.scene = parsed->read(settings, &found.warnings);
    auto scene = std::make_shared<SceneOfFile>();
    scene->loaded = reports::trimmed_and_compiled(std::move(found), file);
    scene->channels = std::make_shared<const std::vector<compare::Channel>>(
        reports::requested_channels(scene->loaded, {}));
    scene->file = std::move(file);
    scene->settings = std::move(settings);
    scene->parsed = std::move(parsed);
    return scene;
}

}  // namespace

SharedScene read(const std::string& file, const reports::Settings& settings,
                 const std::string& name) {
    const reader::TextFile text = reader::read_text(file, reader::Pipes::allowed);
    if (!text.trouble.empty()) throw SceneError(fmt::format("{}: {}", file, text.trouble));
    return loaded(file, settings,
                  std::make_shared<reader::ParsedScene>(text.text, name.empty() ? file : name,
                                                        std::filesystem::path(file).parent_path()));
}

SharedScene varied(const SceneOfFile& scene, const reports::Settings& settings) {
    reports::Settings all = scene.settings;
    for (const Setting& setting : settings) {
        std::erase_if(all, [&](const Setting& old) { return old.path == setting.path; });
        all.push_back(setting);
    }
    return loaded(scene.file, std::move(all), scene.parsed);
}

void append(std::vector<double>& poses, const Equilibrium& state) {
    for (const Pose& pose : state.poses)
        poses.insert(poses.end(), {1e3 * pose.r.x(), 1e3 * pose.r.y(), 1e3 * pose.r.z(), pose.p.w(),
                                   pose.p.x(), pose.p.y(), pose.p.z()});
}

std::vector<BranchCurves> solve(const SharedScene& scene, const SolveRequest& request) {
    const Model& model = scene->loaded.model;
    const compare::SolverSettings solver = reports::solver_of(request.solver);
    const recursive::Options& recursion_options = solver.recursion;
    auto channels = scene->channels;
    if (request.characteristics)
        channels =
            std::make_shared<const std::vector<compare::Channel>>(compare::characteristics(model));
    else if (!request.channels.empty())
        channels = std::make_shared<const std::vector<compare::Channel>>(
            reports::requested_channels(scene->loaded, request.channels));
    std::vector<Branch> branches;
    for (const std::string& name : request.branches)
        branches.push_back(reports::branch_named(model, name));
    if (request.branches.empty()) branches = model.branches;
    Model requested;  // the checks read the branches only
    requested.branches = branches;
    reports::check_every(requested, recursion_options.steps, request.solver.every);
    reports::check_memory(
        requested, {.steps = recursion_options.steps,
                    .every = request.solver.every,
                    .channels = channels->size() + (request.states ? 7 * model.bodies.size() : 0)});
    const bool is_recursive = solver.leg == compare::Leg::recursive;
    std::vector<BranchCurves> list;
    for (const Branch& branch : branches) {
        BranchCurves& curves = list.emplace_back();
        curves.branch = branch.name;
        curves.leg = solver.leg;
        curves.method =
            is_recursive ? std::string(recursion_options.method.name) : name(solver.leg);
        curves.unit = compare::unit_of(branch.unit);
        curves.channels = channels;
        curves.scene = scene;
        reports::SolvedBranch solved = reports::solve_branch(
            model, branch, *channels, solver,
            [&](const Equilibrium& state, compare::Row& row) {
                if (request.states) append(row.values, state);  // after the outputs, removed below
            },
            [&](compare::Row row) {
                const auto outputs =
                    row.values.begin() + static_cast<std::ptrdiff_t>(channels->size());
                curves.poses.insert(curves.poses.end(), outputs, row.values.end());
                row.values.erase(outputs, row.values.end());
                curves.rows.push_back(std::move(row));
            });
        curves.outcome = solved.path.outcome;
        curves.detail = solved.path.detail;
        curves.ends = std::move(solved.ends);
        if (!solved.softest_motion.empty())
            curves.detail += "; the softest motion before it is " + solved.softest_motion;
    }
    return list;
}

namespace {

// NaN for an undefined value (infinite), which is an empty cell of the CSV.
double cell(double value) {
    return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

py::array values_of(const BranchCurves& curves) {
    std::vector<double> values;
    values.reserve(curves.rows.size() * curves.channels->size());
    for (const compare::Row& row : curves.rows)
        std::ranges::transform(row.values, std::back_inserter(values), cell);
    return matrix(std::move(values), curves.channels->size());
}

py::array column(const BranchCurves& curves, const std::string& output) {
    std::vector<std::string> names;
    for (std::size_t c = 0; c < curves.channels->size(); ++c) {
        if ((*curves.channels)[c].name != output) {
            names.push_back((*curves.channels)[c].name);
            continue;
        }
        py::array_t<double> values(static_cast<py::ssize_t>(curves.rows.size()));
        double* at = values.mutable_data();
        for (const compare::Row& row : curves.rows) *at++ = cell(row.values[c]);
        return values;
    }
    throw py::key_error(fmt::format("there is no output {}{}", reader::quote(output),
                                    reader::did_you_mean(output, names, "outputs")));
}

py::array parameters(const BranchCurves& curves) {
    py::array_t<double> values(static_cast<py::ssize_t>(curves.rows.size()));
    double* at = values.mutable_data();
    for (const compare::Row& row : curves.rows)
        *at++ = compare::parameter_in(curves.unit, row.load);
    return values;
}

std::string csv_of(const BranchCurves& curves, bool with_header) {
    std::string text = with_header ? reports::curves_header(*curves.channels) : "";
    for (const compare::Row& row : curves.rows)
        text += reports::curves_row(curves.branch, curves.leg, curves.unit, row);
    return text;
}

std::vector<std::string> errors_at_ends(const BranchCurves& curves) {
    std::vector<std::string> errors;
    for (const auto& [side, state] : curves.ends)
        errors.push_back(reports::error_at_end(curves.scene->loaded.model, side, state));
    return errors;
}

SolveRequest request_of(std::string method, int every, reports::RecursionRequest recursion) {
    const auto& [_, steps, order, expansions, tolerance, arc_length] = recursion;
    const auto known = reports::solvers();
    if (std::ranges::find(known, method) == known.end())
        throw std::invalid_argument(fmt::format("method {}{}", reader::quote(method),
                                                reader::did_you_mean(method, known, "allowed")));
    if (steps < 0 || steps > reports::max_steps)
        throw std::invalid_argument(
            fmt::format("steps {}; allowed: 1 to {}", steps, reports::max_steps));
    if (every < 1) throw std::invalid_argument(fmt::format("every {}; allowed: 1 or more", every));
    if (order < 0 || order > 60)
        throw std::invalid_argument(fmt::format("order {}; allowed: 1 to 60", order));
    if (expansions < 0)
        throw std::invalid_argument(fmt::format("expansions {}; allowed: 1 or more", expansions));
    SolveRequest request;
    request.solver.method = std::move(method);
    request.solver.recursion = std::move(recursion);
    request.solver.every = every;
    return request;
}

py::dict numbers_of(const SceneOfFile& scene) {
    py::dict numbers;
    for (const Number& number : scene.loaded.scene.numbers)
        numbers[py::str(number.path)] = number.value;
    return numbers;
}

py::dict units_of(const SceneOfFile& scene) {
    py::dict units;
    for (const Number& number : scene.loaded.scene.numbers)
        units[py::str(number.path)] = number.unit;
    return units;
}

py::list branches_of(const SceneOfFile& scene) {
    py::list branches;
    for (const Branch& branch : scene.loaded.model.branches) {
        const compare::Unit unit = compare::unit_of(branch.unit);
        branches.append(py::make_tuple(branch.name, symbol(unit),
                                       compare::parameter_in(unit, branch.from),
                                       compare::parameter_in(unit, branch.to), branch.steps));
    }
    return branches;
}

// Name, unit and definition of every output that can be asked for by its name.
py::list outputs_of(const SceneOfFile& scene) {
    py::list outputs;
    auto all = reports::requested_channels(scene.loaded, {"*"});
    std::ranges::move(compare::definition_channels(scene.loaded.model), std::back_inserter(all));
    for (const compare::Channel& channel : all)
        outputs.append(py::make_tuple(channel.name, symbol(channel.unit), channel.definition));
    return outputs;
}

std::string drawing_of(const SceneOfFile& scene, const std::string& view) {
    return reports::picture(reports::drawing_of(scene.loaded.scene, scene.loaded.model, {}), view);
}

using release = py::call_guard<py::gil_scoped_release>;

void bind_curves(py::module_& module) {
    py::class_<BranchCurves, std::shared_ptr<BranchCurves>>(module, "Curves")
        .def_readonly("branch", &BranchCurves::branch)
        .def_property_readonly("leg", [](const BranchCurves& c) { return name(c.leg); })
        .def_readonly("method", &BranchCurves::method)
        .def_property_readonly("unit", [](const BranchCurves& c) { return symbol(c.unit); })
        .def_property_readonly("parameter", &parameters)
        .def_property_readonly("values", &values_of)
        .def_property_readonly("states",
                               [](const BranchCurves& c) {
                                   return poses(c.poses, c.scene->loaded.model.bodies.size());
                               })
        .def_property_readonly("outputs",
                               [](const BranchCurves& c) {
                                   std::vector<std::string> names;
                                   for (const auto& channel : *c.channels)
                                       names.push_back(channel.name);
                                   return names;
                               })
        .def_property_readonly("units",
                               [](const BranchCurves& c) {
                                   py::dict units;
                                   for (const auto& channel : *c.channels)
                                       units[py::str(channel.name)] = symbol(channel.unit);
                                   return units;
                               })
        .def_property_readonly("outcome", [](const BranchCurves& c) { return name(c.outcome); })
        .def_property_readonly(
            "converged", [](const BranchCurves& c) { return c.outcome == Outcome::converged; })
        .def_readonly("detail", &BranchCurves::detail)
        .def("errors_at_ends", &errors_at_ends, release())
        .def("csv", &csv_of, py::arg("header") = true)
        .def("__getitem__", &column)
        .def("__len__", [](const BranchCurves& c) { return c.rows.size(); });
}

}  // namespace

void bind_scene(py::module_& module) {
    bind_curves(module);
    py::class_<SceneOfFile, std::shared_ptr<SceneOfFile>>(module, "Scene", py::dynamic_attr())
        .def_readonly("file", &SceneOfFile::file)
        .def_property_readonly("name", [](const SceneOfFile& s) { return s.loaded.model.name; })
        .def_property_readonly("numbers", &numbers_of)
        .def_property_readonly("units", &units_of)
        .def(
            "number",  // value and unit, also of one side; None where there is none
            [](const SceneOfFile& s, const std::string& path) {
                std::optional<std::pair<double, std::string>> found;
                if (const auto number = find_number(s.loaded.scene, path))
                    found = {number->value, number->unit};
                return found;
            },
            py::arg("path"))
        .def_property_readonly("_branches", &branches_of)
        .def_property_readonly("_outputs", &outputs_of)
        .def_property_readonly("bodies",
                               [](const SceneOfFile& s) {
                                   std::vector<std::string> names;
                                   for (const Body& body : s.loaded.model.bodies)
                                       names.push_back(body.name);
                                   return names;
                               })
        .def_property_readonly("warnings", [](const SceneOfFile& s) { return s.loaded.warnings; })
        .def_property_readonly("settings",
                               [](const SceneOfFile& s) {
                                   py::dict settings;
                                   for (const Setting& setting : s.settings)
                                       settings[py::str(setting.path)] = setting.value;
                                   return settings;
                               })
        .def("inspect",
             [](const SceneOfFile& s) {
                 return reports::text(reports::shortened(reports::inspection(
                     {.scene = s.loaded.scene, .model = s.loaded.model, .trim = s.loaded.trim})));
             })
        .def(
            "vary",
            [](const SceneOfFile& s, const py::dict& settings) {
                const auto all = settings_of(settings);
                const py::gil_scoped_release unlocked;
                return std::const_pointer_cast<SceneOfFile>(varied(s, all));
            },
            py::arg("settings"))
        .def("_drawing", &drawing_of, release())
        .def(
            "_solve",
            [](const std::shared_ptr<SceneOfFile>& s, std::string method,
               std::vector<std::string> channels, int steps, int every, std::string tolerance,
               int order, int expansions, bool arc_length, bool states, bool characteristics,
               std::vector<std::string> branches) {
                SolveRequest request = request_of(std::move(method), every,
                                                  {.steps = steps,
                                                   .order = order,
                                                   .expansions = expansions,
                                                   .tolerance = std::move(tolerance),
                                                   .arc_length = arc_length});
                request.channels = std::move(channels);
                request.branches = std::move(branches);
                request.states = states;
                request.characteristics = characteristics;
                std::vector<BranchCurves> curves;
                {
                    const py::gil_scoped_release unlocked;
                    curves = solve(s, request);
                }
                py::list list;
                for (BranchCurves& of_branch : curves)
                    list.append(std::make_shared<BranchCurves>(std::move(of_branch)));
                return list;
            },
            py::arg("method"), py::arg("channels"), py::arg("steps"), py::arg("every"),
            py::arg("tolerance"), py::arg("order"), py::arg("expansions"), py::arg("arc_length"),
            py::arg("states"), py::arg("characteristics"), py::arg("branches"));
    module.def(
        "read",
        [](const std::string& file, const py::dict& settings, const std::string& name) {
            const auto all = settings_of(settings);
            const py::gil_scoped_release unlocked;
            return std::const_pointer_cast<SceneOfFile>(read(file, all, name));
        },
        py::arg("file"), py::arg("settings"), py::arg("name") = "");
}

}  // namespace elastocheck::python
