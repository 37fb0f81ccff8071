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

constexpr double legs_agree = 1e-6;  // of a figure's movement

FigureValues of_trimmed(const Trimmed& trimmed, std::span<const Figure> figures, Leg leg) {
    if (trimmed.record && !trimmed.record->reached())
        return {VectorXd::Constant(std::ssize(figures), nan), "trim: " + trimmed.record->detail};
    return evaluate(compile(trimmed.scene), figures, leg);
}

// Where the trim of a similar scene ended, and by which leg.
struct NearTrim : TrimStart {
    bool by_equilibrium = false;
};

// The scene with the numbers p, the states at which its figures are read, by the equilibrium leg, and
// the figures. Without a model there is no such scene (a negative rate, points that meet), or its trim
// is not reached.
struct AtPoint {
    NearTrim trim = {};
    std::optional<Model> model = {};
    std::vector<ReadStates> states = {};
    FigureValues figures = {};
};

// A failure of `set` leaves the figures without values.
void guarded(AtPoint& at, std::size_t figures, const std::function<void()>& set) {
    try {
        set();
    } catch (const std::runtime_error& error) {
        at.figures = {VectorXd::Constant(static_cast<Index>(figures), nan), error.what()};
        at.model.reset();
    }
}

// A trim of the scene starts from that of a similar scene, `at.trim`, and replaces it. It is solved by
// the series, or by the equilibrium leg where the start settles past a limit point, which the
// series does not reach: first by the leg that reached the last trim, then by the other one. No
// second reference confirms it.
void compile_at(const Varied& varied, const VectorXd& p, std::size_t figures, AtPoint& compiled) {
    guarded(compiled, figures, [&] {
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

// Without states they are found from the design position.
void read_at(std::span<const Figure> figures, AtPoint& at) {
    if (!at.model) return;
    guarded(at, figures.size(), [&] {
        if (at.states.empty()) at.states = states_of(*at.model, figures, Leg::equilibrium);
        at.figures = read_figures(*at.model, at.states, figures, Leg::equilibrium);
    });
}

FigureValues values_at(const Varied& varied, std::span<const Figure> figures, const VectorXd& p) {
    AtPoint at;
    compile_at(varied, p, figures.size(), at);
    read_at(figures, at);
    return at.figures;
}

// Values at points near the first one. Trim and states of the first point start from those of the
// last first point, and those of the others from those of the first. A value at the same first point
// is kept.
struct SolvedFigures {
    Varied varied;
    std::vector<Figure> figures;
    int threads;
    VectorXd first = {};
    AtPoint here = {};  // at the last first point

    void on_all(std::vector<AtPoint>& points, const std::function<void(std::size_t)>& run) const {
        std::vector<Job> jobs;
        for (std::size_t k = 0; k < points.size(); ++k) jobs.push_back({"", [&, k] { run(k); }});
        run_jobs(jobs, threads, {});
    }
    std::vector<AtPoint> near(std::span<const VectorXd> points) const {
        std::vector<AtPoint> all(points.size(), AtPoint{here.trim});
        on_all(all, [&](std::size_t k) { compile_at(varied, points[k], figures.size(), all[k]); });
        std::vector<const Model*> models;
        for (const AtPoint& at : all) models.push_back(at.model ? &*at.model : nullptr);
        auto states = neighbouring_states(here.states, models, threads);
        on_all(all, [&](std::size_t k) {
            all[k].states = std::move(states[k]);
            read_at(figures, all[k]);
        });
        return all;
    }
    std::vector<VectorXd> operator()(const std::vector<VectorXd>& points) {
        if (first.size() != points[0].size() || first != points[0]) {
            AtPoint there = std::move(near({points.data(), 1}).front());
            first = points[0];
            if (!there.model) {
                there.trim = here.trim;
                there.states = std::move(here.states);
            }
            here = std::move(there);
        }
        std::vector<VectorXd> values{here.figures.value};
        for (const AtPoint& at : near(std::span(points).subspan(1)))
            values.push_back(at.figures.value);
        return values;
    }
};

}  // namespace

FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg) {
    return of_trimmed(trim(scene), figures, leg);
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
    std::vector<Figure> outputs_there;  // outputs of the state at the same station
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
        const FigureValues computed = of_trimmed(trimmed, figures, leg);
        if (leg != Leg::equilibrium)
            (leg == Leg::energy ? result.energy : result.series) = computed.value;
        if (computed.not_applicable) continue;
        judged = judged || leg != Leg::equilibrium;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const auto i = static_cast<Index>(k);
            const double difference = std::abs(computed.value[i] - values[i]);
            if (why.empty() && std::isfinite(difference) &&
                !(difference <= legs_agree * movement[i]))
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
