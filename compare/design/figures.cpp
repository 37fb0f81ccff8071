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

// By the equilibrium leg; a trim by the series from that of a similar scene, or else, where the start
// settles past a limit point, by the equilibrium leg, neither confirmed. Without values where the scene
// does not exist: a negative rate, points that meet.
FigureValues values_at(const Varied& varied, std::span<const Figure> figures, const VectorXd& p,
                       TrimStart start = {}) {
    try {
        const Scene scene = varied.scene(p);
        Trimmed trimmed = trim_by_series(scene, &start);
        if (trimmed.record && !trimmed.record->reached())
            trimmed = trim_not_confirmed(scene, &start);
        return of_trimmed(trimmed, figures, Leg::equilibrium);
    } catch (const std::runtime_error& error) {
        return {VectorXd::Constant(std::ssize(figures), nan), error.what()};
    }
}

// Where the trim of the scene as it is ends.
TrimStart start_of_trims(const Varied& varied) {
    TrimStart start;
    try {
        trim_by_series(varied.scene(varied.start), &start);
    } catch (const std::runtime_error&) {
    }
    return start;
}

}  // namespace

FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg) {
    return of_trimmed(trim(scene), figures, leg);
}

Figures solved_figures(const Varied& varied, std::vector<Figure> figures, int threads) {
    VectorXd step(std::ssize(varied.numbers));
    for (Index i = 0; i < step.size(); ++i)
        step[i] = difference_step(varied_number(varied.numbers[static_cast<std::size_t>(i)]));
    return {[varied, figures, threads,
             start = start_of_trims(varied)](const std::vector<VectorXd>& points) {
                std::vector<VectorXd> all(points.size());
                std::vector<Job> jobs;
                for (std::size_t k = 0; k < points.size(); ++k)
                    jobs.push_back({"", [&, k] {
                                        all[k] = values_at(varied, figures, points[k], start).value;
                                    }});
                run_jobs(jobs, threads, {});
                return all;
            },
            step};
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
    std::vector<Figure> all;  // outputs of the state at the same station
    for (const Channel& channel : channels(compile(scene))) {
        all.push_back(figure);
        all.back().name = channel.name;
    }
    const Figures outputs = solved_figures(varied, all);
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
        for (std::size_t k = all.size(); k-- > 0;)
            if (std::abs(rate(static_cast<Index>(k), static_cast<Index>(i))) > 0)
                why = fmt::format("it moves {}, for example, and not {}", all[k].name, figure.name);
        reasons.push_back(path + ": " + why);
    }
    return fmt::format("{}", fmt::join(reasons, "\n  "));
}

Confirmation confirm(const Scene& scene, std::span<const Figure> figures, const VectorXd& values,
                     const VectorXd& movement) {
    Confirmation result;
    std::string& why = result.why_not;
    bool judged = false;
    for (const auto leg : {Leg::energy, Leg::series}) {
        const FigureValues found = figure_values(scene, figures, leg);
        (leg == Leg::energy ? result.energy : result.series) = found.value;
        if (found.not_applicable) continue;
        judged = true;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const auto i = static_cast<Index>(k);
            const double apart = std::abs(found.value[i] - values[i]);
            if (why.empty() && std::isfinite(apart) && !(apart <= legs_agree * movement[i]))
                why = fmt::format("{}: the {} differs by {:.2g} {}", figures[k].name,
                                  leg == Leg::energy ? "energy leg" : "series", apart,
                                  figures[k].unit);
        }
        if (why.empty()) why = found.why_not;
        if (why.empty() && !found.value.allFinite()) why = "a figure has no value by another leg";
    }
    if (why.empty() && !judged) why = "no other leg applies to the scene";
    result.confirmed = why.empty();
    return result;
}

}  // namespace elastocheck::compare
