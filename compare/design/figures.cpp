#include "compare/design/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

// Figures of the scene with the numbers p, by the equilibrium leg. NaN where there is no such scene
// (a negative rate, points that meet).
//
// A trim of the scene starts from that of a similar scene, `near`, and replaces it. It is solved by
// the series, or by the equilibrium leg where the start settles past a limit point, which the
// series does not reach: first by the leg that reached the last trim, then by the other one. No
// second reference confirms it.
FigureValues values_at(const Varied& varied, std::span<const Figure> figures, const VectorXd& p,
                       NearTrim& near) {
    try {
        const Scene scene = varied.scene(p);
        const auto trim_by = [&](bool by_equilibrium) {
            return (by_equilibrium ? trim_not_confirmed : trim_by_series)(scene, &near);
        };
        Trimmed trimmed = trim_by(near.by_equilibrium);
        if (trimmed.record && !trimmed.record->reached()) {
            trimmed = trim_by(!near.by_equilibrium);
            if (trimmed.record->reached()) near.by_equilibrium = !near.by_equilibrium;
        }
        return of_trimmed(trimmed, figures, Leg::equilibrium);
    } catch (const std::runtime_error& error) {
        return {VectorXd::Constant(std::ssize(figures), nan), error.what()};
    }
}

// Values at points near the first one. The trim of the first point starts from that of the last
// first point, and the trims of the others start from that of the first. A value at the same first
// point is kept.
struct SolvedFigures {
    Varied varied;
    std::vector<Figure> figures;
    int threads;
    NearTrim near = {};
    VectorXd first = {}, value = {};  // the last first point, and the figures there

    std::vector<VectorXd> operator()(const std::vector<VectorXd>& points) {
        if (first.size() != points[0].size() || first != points[0]) {
            value = values_at(varied, figures, points[0], near).value;
            first = points[0];
        }
        std::vector<VectorXd> values(points.size(), value);
        std::vector<Job> jobs;
        for (std::size_t k = 1; k < points.size(); ++k)
            jobs.push_back({"", [&, k] {
                                NearTrim start = near;
                                values[k] = values_at(varied, figures, points[k], start).value;
                            }});
        run_jobs(jobs, threads, {});
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
    NearTrim near;
    const std::string why = values_at(varied, figures, p, near).why_not;
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
                    beside =
                        values_at(varied, {&figure, 1}, p + by * VectorXd::Unit(p.size(), i), near)
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
    for (const auto leg : {Leg::energy, Leg::series}) {
        const FigureValues computed = of_trimmed(trimmed, figures, leg);
        (leg == Leg::energy ? result.energy : result.series) = computed.value;
        if (computed.not_applicable) continue;
        judged = true;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const auto i = static_cast<Index>(k);
            const double difference = std::abs(computed.value[i] - values[i]);
            if (why.empty() && std::isfinite(difference) &&
                !(difference <= legs_agree * movement[i]))
                why = fmt::format("{}: the {} differs by {:.2g} {}", figures[k].name,
                                  leg == Leg::energy ? "energy leg" : "series", difference,
                                  figures[k].unit);
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
