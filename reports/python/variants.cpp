// Figures of many variants of a scene for Python.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <stdexcept>

#include "compare/comparison/trim.hpp"
#include "compare/design/figures.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/variants/solve_variants.hpp"
#include "elastocheck/trim.hpp"
#include "models/kinds.hpp"
#include "models/reader/elements/sections.hpp"
#include "reports/command/options/running.hpp"
#include "reports/files/provenance.hpp"
#include "reports/python/analyses.hpp"
#include "reports/python/scene.hpp"

namespace elastocheck::python {

namespace py = pybind11;
using compare::variants::VariantFigure;
using compare::variants::VariantFigures;
using compare::variants::VariantSolver;
using FigureWords = std::vector<std::pair<std::string, std::string>>;  // name, words

namespace {

std::vector<VariantFigure> figures_of(const Model& model, const FigureWords& words) {
    const auto outputs = compare::figure_outputs(model);
    std::vector<VariantFigure> figures;
    for (const auto& [name, figure] : words)
        figures.push_back(compare::variants::parse_variant_figure(name, figure, model, outputs));
    return figures;
}

// Variants of a scene: numbers that take a value in each, and the figures that are computed.
class Variants {
  public:
    Variants(SharedScene scene, std::vector<std::string> numbers, const FigureWords& figures)
        : scene_(std::move(scene)),
          varied_(numbers.size()),
          paths_(std::move(numbers)),
          figures_(figures_of(scene_->loaded.model, figures)),
          solver_(scene_->loaded.model, figures_) {
        for (const Setting& setting : scene_->settings) {
            if (std::ranges::find(paths_, setting.path) != paths_.end()) continue;
            const auto number = find_number(scene_->loaded.scene, setting.path);
            if (!number)
                throw std::invalid_argument(
                    fmt::format("'{}' is set to a text; variants are those of a scene whose "
                                "settings are numbers",
                                setting.path));
            paths_.push_back(setting.path);
            settings_.push_back(number->value);
        }
        (void)reader::VariedScene(*scene_->parsed, paths_);  // throws for what is not a number
        if (const Scene drawn = scene_->parsed->read(scene_->settings); drawn.trim)
            (void)compare::trim_by_series(drawn, &trimmed_);
    }

    std::size_t numbers() const { return varied_; }
    std::size_t figures() const { return figures_.size(); }

    // Why there is no valid scene with these numbers; "" if there is one, or if only a length vanishes,
    // which is the outcome of a variant and not an error.
    std::string invalid(const std::vector<double>& values) const {
        try {
            (void)reader::VariedScene(*scene_->parsed, paths_).read(with_settings(values.data()));
        } catch (const reader::LengthVanishes&) {
        } catch (const SceneError& error) {
            return error.what();
        }
        return {};
    }

    // The figures of n variants; `values` [n × numbers].
    std::vector<VariantFigures> solve(const double* values, std::size_t n, compare::Leg leg,
                                      int threads) const {
        constexpr std::size_t batch = 256;
        std::vector<VariantFigures> all(n);
        std::atomic<std::size_t> next = 0;
        const auto work = [&] {
            reader::VariedScene varied(*scene_->parsed, paths_);
            for (std::size_t first; (first = next.fetch_add(batch)) < n;)
                solve_batch(varied, values, first, std::min(first + batch, n), leg, all);
        };
        const auto count = std::min(static_cast<std::size_t>(threads), n / batch + 1);
        compare::run_jobs(std::vector<compare::Job>(count, {"variants", work}),
                          static_cast<int>(count), {});
        return all;
    }

  private:
    std::vector<double> with_settings(const double* values) const {
        std::vector<double> numbers(values, values + varied_);
        numbers.insert(numbers.end(), settings_.begin(), settings_.end());
        return numbers;
    }

    // By the series from where that of the scene ended; where that fails, or for another leg, as trim():
    // from nothing by the equilibrium leg, confirmed by the energy leg.
    compare::Trimmed trim(const Scene& scene, compare::Leg leg) const {
        if (leg == compare::Leg::series && trimmed_.J.size() > 0) {
            compare::TrimStart start = trimmed_;
            if (auto near = compare::trim_by_series(scene, &start); near.record->reached())
                return near;
        }
        return compare::trim(scene);
    }

    // The model of a variant; without one, the reason.
    std::optional<Model> model_of(reader::VariedScene& varied, const double* values,
                                  compare::Leg leg, VariantFigures& figures) const {
        try {
            std::optional<Model> model;
            const Scene scene = varied.read(with_settings(values), &model);
            if (model) return model;
            if (!scene.trim) return compile(scene);
            const compare::Trimmed trimmed = trim(scene, leg);
            if (!trimmed.record || trimmed.record->reached()) return compile(trimmed.scene);
            figures.outcome = compare::variants::outcome::not_trimmed;
            figures.reason = trimmed.record->detail;
        } catch (const SceneError& error) {
            figures.outcome = compare::variants::outcome::no_scene;
            figures.reason = error.what();
        } catch (const std::invalid_argument& error) {  // an ill-posed trim
            figures.outcome = compare::variants::outcome::not_trimmed;
            figures.reason = error.what();
        }
        figures.values.assign(figures_.size(), std::numeric_limits<double>::quiet_NaN());
        return std::nullopt;
    }

    void solve_batch(reader::VariedScene& varied, const double* values, std::size_t first,
                     std::size_t end, compare::Leg leg, std::vector<VariantFigures>& all) const {
        std::vector<Model> models;
        std::vector<std::size_t> rows;
        for (std::size_t k = first; k < end; ++k) {
            auto model = model_of(varied, values + k * varied_, leg, all[k]);
            if (!model) continue;
            models.push_back(std::move(*model));
            rows.push_back(k);
        }
        auto solved = solver_.solve(models, leg);
        for (std::size_t m = 0; m < models.size(); ++m) all[rows[m]] = std::move(solved[m]);
    }

    SharedScene scene_;
    std::size_t varied_;
    std::vector<std::string> paths_;  // of the numbers, then of the scene's settings
    std::vector<double> settings_ = {};
    std::vector<VariantFigure> figures_;
    VariantSolver solver_;
    compare::TrimStart trimmed_ = {};  // of the scene, where it has a trim that the series reaches
};

compare::Leg leg_named(const std::string& method) {
    for (const compare::Leg leg :
         {compare::Leg::series, compare::Leg::equilibrium, compare::Leg::energy})
        if (method == name(leg)) return leg;
    throw std::invalid_argument(
        fmt::format("method '{}'; allowed: series, equilibrium, energy", method));
}

// (figures [n × figures], outcomes, legs, reasons) of n variants with numbers [n × numbers].
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
py::tuple solve_variants(const Variants& variants, const Numbers& array, const std::string& method,
                         int threads) {
    if (array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(variants.numbers()))
        throw py::value_error(
            fmt::format("numbers are an array [variants, {}]", variants.numbers()));
    if (threads < 0)
        throw std::invalid_argument(fmt::format("threads {}; allowed: 0 or more", threads));
    const compare::Leg leg = leg_named(method);
    const auto n = static_cast<std::size_t>(array.shape(0));
    std::vector<VariantFigures> all;
    {
        const py::gil_scoped_release unlocked;
        all = variants.solve(array.data(), n, leg, reports::threads_of({.jobs = threads}));
    }
    py::array_t<double> found({n, variants.figures()});
    py::list outcomes, legs, reasons;
    double* at = found.mutable_data();
    for (const VariantFigures& variant : all) {
        at = std::ranges::copy(variant.values, at).out;
        outcomes.append(variant.outcome);
        legs.append(name(variant.leg));
        reasons.append(variant.reason);
    }
    return py::make_tuple(found, outcomes, legs, reasons);
}

// Hash of the numbers of curves, whose tables may be in other files than the scene's.
std::string hash_of_curves(const SceneOfFile& scene) {
    std::string bytes;
    const auto add = [&](const auto& numbers) {
        for (const double x : numbers) bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
    };
    for (const Elastic& elastic : scene.loaded.model.elastics)
        each_curve(elastic.kind, [&](std::size_t, const Curve& curve) {
            add(curve.knots);
            for (const auto& piece : curve.pieces) add(piece);
        });
    return reports::input_hash(bytes);
}

}  // namespace

void bind_variants(py::module_& module) {
    py::class_<Variants>(module, "Variants")
        .def(py::init([](const std::shared_ptr<SceneOfFile>& scene,
                         std::vector<std::string> numbers, const FigureWords& figures) {
                 const py::gil_scoped_release unlocked;
                 return std::make_unique<Variants>(scene, std::move(numbers), figures);
             }),
             py::arg("scene"), py::arg("numbers"), py::arg("figures"))
        .def("solve", &solve_variants, py::arg("values"), py::arg("method") = "series",
             py::arg("threads") = 0)
        .def("invalid", &Variants::invalid, py::arg("values"),
             py::call_guard<py::gil_scoped_release>());
    module.def("hash_of_curves", &hash_of_curves, py::arg("scene"));
    module.def(
        "unit_of_figure",  // throws ArgumentError for a wrong one
        [](const SceneOfFile& scene, const std::string& words) {
            return symbol(figures_of(scene.loaded.model, {{"", words}}).front().unit);
        },
        py::arg("scene"), py::arg("words"));
}

}  // namespace elastocheck::python
