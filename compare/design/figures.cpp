#include "compare/design/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "compare/comparison/trim.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Largest difference between two solvers, as a share of the movement of the figure.
constexpr double solver_tolerance = 1e-6;

FigureValues values_after_trim(const Trimmed& trimmed, std::span<const Figure> figures, Leg leg) {
    if (trimmed.record && !trimmed.record->reached())
        return {VectorXd::Constant(std::ssize(figures), nan), "trim: " + trimmed.record->detail};
    return evaluate(compile(trimmed.scene), figures, leg);
}

// Where the trim of a similar scene ended, and by which leg.
struct SimilarTrim : TrimStart {
    bool by_equilibrium = false;
};

// The compiled scene with the numbers p, the states of the equilibrium leg at which its figures are
// read, and the figures. Without a model there is no such scene (a negative rate, points that
// coincide), or its trim is not reached.
struct SolvedPoint {
    SimilarTrim trim = {};
    std::optional<Model> model = {};
    std::vector<StatesOfFigures> states = {};
    FigureValues figures = {};
};

// Runs a part of the solution. Where it fails, the figures have no values, and its reason.
void run_guarded(SolvedPoint& at, std::size_t figures, const std::function<void()>& part) {
    try {
        part();
    } catch (const std::runtime_error& error) {
        at.figures = {VectorXd::Constant(static_cast<Index>(figures), nan), error.what()};
        at.model.reset();
    }
}

// A trim of the scene starts from that of a similar scene, `at.trim`, and replaces it. It is solved by
// the series, or by the equilibrium leg where the start settles past a limit point, which the
// series does not reach: first by the leg that reached the last trim, then by the other one. No
// second reference confirms it.
void compile_at(const Varied& varied, const VectorXd& p, std::size_t figures,
                SolvedPoint& compiled) {
    run_guarded(compiled, figures, [&] {
        const Scene scene = varied.scene(p);
        const auto trim_by = [&](bool by_equilibrium) {
            return (by_equilibrium ? trim_not_confirmed : trim_by_series)(scene, &compiled.trim);
        };
        Trimmed trimmed = trim_by(compiled.trim.by_equilibrium);
        if (trimmed.record && !trimmed.record->reached()) {
            trimmed = trim_by(!compiled.trim.by_equilibrium);
            if (trimmed.record->reached())
                compiled.trim.by_equilibrium = !compiled.trim.by_equilibrium;
        }
        if (trimmed.record && !trimmed.record->reached())
            throw std::runtime_error("trim: " + trimmed.record->detail);
        compiled.model = compile(trimmed.scene);
    });
}

// Reads the figures at the states of the point, which are first solved if there are none.
void read_at(std::span<const Figure> figures, SolvedPoint& at) {
    if (!at.model) return;
    run_guarded(at, figures.size(), [&] {
        if (at.states.empty()) at.states = states_of(*at.model, figures, Leg::equilibrium);
        at.figures = read_figures(*at.model, at.states, figures, Leg::equilibrium);
    });
}

FigureValues values_at(const Varied& varied, std::span<const Figure> figures, const VectorXd& p) {
    SolvedPoint at;
    compile_at(varied, p, figures.size(), at);
    read_at(figures, at);
    return at.figures;
}

// Values at points near the first one, the centre. Trim and states of the centre start from those
// of the last centre, and those of the other points from those of the centre. Values at the last
// centre are kept.
struct SolvedFigures {
    Varied varied;
    std::vector<Figure> figures;
    int threads;
    VectorXd centre = {};
    SolvedPoint at_centre = {};

    void on_all(std::vector<SolvedPoint>& points,
                const std::function<void(std::size_t)>& run) const {
        std::vector<Job> jobs;
        for (std::size_t k = 0; k < points.size(); ++k) jobs.push_back({"", [&, k] { run(k); }});
        run_jobs(jobs, threads, {});
    }
    std::vector<SolvedPoint> near(std::span<const VectorXd> points) const {
        std::vector<SolvedPoint> solved(points.size(), SolvedPoint{at_centre.trim});
        on_all(solved,
               [&](std::size_t k) { compile_at(varied, points[k], figures.size(), solved[k]); });
        std::vector<const Model*> models;
        for (const SolvedPoint& point : solved)
            models.push_back(point.model ? &*point.model : nullptr);
        auto states = neighbouring_states(at_centre.states, models, threads);
        on_all(solved, [&](std::size_t k) {
            solved[k].states = std::move(states[k]);
            read_at(figures, solved[k]);
        });
        return solved;
    }
    std::vector<VectorXd> operator()(const std::vector<VectorXd>& points) {
        if (centre.size() != points[0].size() || centre != points[0]) {
            SolvedPoint moved = std::move(near({points.data(), 1}).front());
            centre = points[0];
            if (!moved.model) {
                moved.trim = at_centre.trim;
                moved.states = std::move(at_centre.states);
            }
            at_centre = std::move(moved);
        }
        std::vector<VectorXd> values{at_centre.figures.value};
        for (const SolvedPoint& point : near(std::span(points).subspan(1)))
            values.push_back(point.figures.value);
        return values;
    }
};

}  // namespace

FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg) {
    return values_after_trim(trim(scene), figures, leg);
}

Figures solved_figures(const Varied& varied, std::vector<Figure> figures, int threads) {
    VectorXd step(std::ssize(varied.numbers));
    for (Index i = 0; i < step.size(); ++i)
        step[i] = difference_step(varied_number(varied.numbers[static_cast<std::size_t>(i)]));
    return {SolvedFigures{varied, std::move(figures), threads}, step};
}

std::string why_not_solved(const Varied& varied, std::span<const Figure> figures, const VectorXd& p,
                           const char* where) {
    const std::string why = values_at(varied, figures, p).why_not;
    if (!why.empty()) return fmt::format("no value at {}: {}", where, why);
    const Figures solved = solved_figures(varied, {figures.begin(), figures.end()});
    const MatrixXd rate = solved.gradient(p);
    for (Index k = 0; k < rate.rows(); ++k)
        for (Index i = 0; i < rate.cols(); ++i) {
            if (!std::isnan(rate(k, i))) continue;
            const Figure& figure = figures[static_cast<std::size_t>(k)];
            std::string beside;
            for (const double by : {solved.step[i], -solved.step[i]})
                if (beside.empty())
                    beside = values_at(varied, {&figure, 1}, p + by * VectorXd::Unit(p.size(), i))
                                 .why_not;
            return fmt::format("no rate at {}: {} on branch '{}' by {}: {}", where, figure.name,
                               figure.branch, varied.numbers[static_cast<std::size_t>(i)].path,
                               beside.empty() ? "it differs on both sides of this value" : beside);
        }
    return "";
}

std::string why_still(const Varied& varied, const Figure& figure) {
    const Scene scene = varied.scene(varied.start);
    std::vector<Figure> outputs_there;  // channels() at the station of the figure
    for (const Channel& channel : channels(compile(scene))) {
        outputs_there.push_back(figure);
        outputs_there.back().name = channel.name;
    }
    const Figures outputs = solved_figures(varied, outputs_there);
    const MatrixXd rate = outputs.gradient(varied.start);
    std::vector<std::string> reasons;
    for (std::size_t i = 0; i < varied.numbers.size(); ++i) {
        const std::string& path = varied.numbers[i].path;
        std::string why = "no output moves with it";
        for (const auto& [what, reason] : scene.omitted) {
            const auto from = std::min(what.find('\''), what.size() - 1) + 1;
            const auto part = what.substr(from, what.find('\'', from) - from);
            if (!part.empty() && path.find("." + part + ".") != std::string::npos)
                why = fmt::format("{} is left out: {}", what, reason);
        }
        for (std::size_t k = outputs_there.size(); k-- > 0;)
            if (std::abs(rate(static_cast<Index>(k), static_cast<Index>(i))) > 0)
                why = fmt::format("it moves {}, for example, and not {}", outputs_there[k].name,
                                  figure.name);
        reasons.push_back(path + ": " + why);
    }
    return fmt::format("{}", fmt::join(reasons, "\n  "));
}

Confirmation confirm(const Scene& scene, std::span<const Figure> figures, const VectorXd& values,
                     const VectorXd& movement) {
    Confirmation result;
    std::string& why = result.why_not;
    bool judged = false;
    const Trimmed trimmed = trim(scene);
    for (const auto leg : {Leg::equilibrium, Leg::energy, Leg::series}) {
        const FigureValues computed = values_after_trim(trimmed, figures, leg);
        if (leg != Leg::equilibrium)
            (leg == Leg::energy ? result.energy : result.series) = computed.value;
        if (computed.not_applicable) continue;
        judged = judged || leg != Leg::equilibrium;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const auto i = static_cast<Index>(k);
            const double difference = std::abs(computed.value[i] - values[i]);
            if (why.empty() && std::isfinite(difference) &&
                !(difference <= solver_tolerance * movement[i]))
                why =
                    fmt::format("{}: the {} differs by {:.2g} {}", figures[k].name,
                                leg == Leg::equilibrium ? "equilibrium leg from the design position"
                                : leg == Leg::energy    ? "energy leg"
                                                        : "series",
                                difference, figures[k].unit);
        }
        if (why.empty()) why = computed.why_not;
        if (why.empty() && !computed.value.allFinite())
            why = "a figure has no value by another leg";
    }
    if (why.empty() && !judged) why = "no other leg applies to the scene";
    result.confirmed = why.empty();
    return result;
}

}  // namespace elastocheck::compare
