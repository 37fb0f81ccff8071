#include "compare/design/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Points of a branch between which a figure over another output is interpolated.
constexpr int interpolated_points = 40;

// h of the differences, as a share of step_of(): 0.4 mm, 0.4 %. The error of R is of the order h⁴,
// and the rounding of the figures, some 1e-13 of their size, is divided by h / 4.
constexpr double share_of_step = 0.4;

// Model with its outputs, of which the required ones are evaluated.
struct Solver {
    const Model& model;
    std::span<const Figure> figures;
    Leg leg;
    FigureValues& result;

    std::vector<Channel> all = figure_outputs(model);

    const Channel& output(const std::string& name) const {
        const int c = find_channel(all, name);
        if (c < 0) throw std::invalid_argument(fmt::format("the scene has no output '{}'", name));
        return all[static_cast<std::size_t>(c)];
    }

    // The outputs of these figures, each once.
    std::vector<Channel> outputs(const std::vector<std::size_t>& which) const {
        std::vector<Channel> list;
        const auto want = [&](const std::string& name) {
            if (!name.empty() && find_channel(list, name) < 0) list.push_back(output(name));
        };
        for (const std::size_t k : which) want(figures[k].name), want(figures[k].over);
        return list;
    }

    void miss(const std::string& why, Outcome outcome = Outcome::converged) const {
        if (!result.why_not.empty()) return;
        result.why_not = why;
        result.not_applicable = is_not_applicable(outcome);
    }
    void set(std::size_t k, double value, const Channel& channel) const {
        if (figures[k].change)
            value -= evaluate(model, std::span(&channel, 1), design_state(model)).front();
        result.value[static_cast<Index>(k)] = finite_or_nan(value);
        if (!std::isfinite(value))
            miss(fmt::format("{}: {}", channel.name,
                             std::isinf(value) ? channel.undefined : "it could not be computed"));
    }

    // Figures at values of the parameter.
    void at_parameters(const Branch& branch, std::vector<std::size_t> which) const {
        const auto channels = outputs(which);
        std::ranges::sort(which, {}, [&](std::size_t k) { return std::abs(figures[k].at); });
        auto ways = sides_of(model, branch, 1);
        for (std::size_t w = 0; w < ways.size(); ++w) {
            std::vector<std::size_t> here;
            std::vector<double> points;
            for (const std::size_t k : which) {
                const double a = figures[k].at;
                const bool is_here = a == 0 ? w == 0 : a * ways[w].branch.to > 0;
                if (!is_here) continue;
                here.push_back(k);
                if (points.empty() || points.back() != a) points.push_back(a);
            }
            if (points.empty()) continue;
            std::map<double, std::vector<double>> rows;
            Analyses analyses;
            const EquilibriumPath path =
                walk_through(ways[w], leg, points, [&](const Equilibrium& state) {
                    rows[state.load] =
                        row_of(model, channels, ways[w], {.leg = leg}, state, analyses).values;
                });
            for (const std::size_t k : here) {
                const auto row = rows.find(figures[k].at);
                if (row == rows.end()) {
                    miss(fmt::format("branch '{}': {}: {}", branch.name,
                                     elastocheck::name(path.outcome), path.detail),
                         path.outcome);
                    continue;
                }
                const auto c = static_cast<std::size_t>(find_channel(channels, figures[k].name));
                set(k, row->second[c], channels[c]);
            }
        }
    }

    // Figures at values of another output, interpolated on the curve of the branch.
    void over_outputs(const Branch& branch, const std::vector<std::size_t>& which) const {
        const auto channels = outputs(which);
        const auto ways = sides_of(model, branch, std::min(branch.steps, interpolated_points));
        const PathCurve path = walk(model, channels, branch, ways, {.leg = leg});
        for (const std::size_t k : which) {
            const auto over = static_cast<std::size_t>(find_channel(channels, figures[k].over));
            const auto c = static_cast<std::size_t>(find_channel(channels, figures[k].name));
            const auto x = placed_by(path.curve, over);
            if (reaches(x, figures[k].at))
                set(k, interpolate(x, path.curve.channel(c), figures[k].at, 6), channels[c]);
            else
                miss(x.empty()
                         ? fmt::format("branch '{}': {} is not monotonic", branch.name,
                                       figures[k].over)
                         : fmt::format("branch '{}' does not reach {} = {:g} {}", branch.name,
                                       figures[k].over, figures[k].at, symbol(channels[over].unit)),
                     path.outcome);
        }
    }
};

}  // namespace

std::vector<Channel> figure_outputs(const Model& model) {
    auto all = channels(model);
    std::ranges::move(characteristics(model), std::back_inserter(all));
    std::ranges::move(element_channels(model), std::back_inserter(all));
    return all;
}

FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg) {
    FigureValues result;
    result.value = VectorXd::Constant(static_cast<Index>(figures.size()), nan);
    const Trimmed trimmed = trim(scene);
    if (trimmed.record && !trimmed.record->reached()) {
        result.why_not = "trim: " + trimmed.record->detail;
        return result;
    }
    const Model model = compile(trimmed.scene);
    const Solver solver{model, figures, leg, result};
    for (const auto& branch : model.branches) {
        std::vector<std::size_t> placed, over;
        for (std::size_t k = 0; k < figures.size(); ++k)
            if (figures[k].branch == branch.name)
                (figures[k].over.empty() ? placed : over).push_back(k);
        if (!placed.empty()) solver.at_parameters(branch, placed);
        if (!over.empty()) solver.over_outputs(branch, over);
    }
    return result;
}

double step_of(const Number& number) {
    static const std::map<std::string, double> millimetre{
        {"mm", 1}, {"m", 1e-3}, {"cm", 0.1}, {"in", 1 / 25.4}};
    if (const auto unit = millimetre.find(number.unit); unit != millimetre.end())
        return unit->second;
    return number.value != 0 ? 0.01 * std::abs(number.value) : 1;
}

Figures differenced_figures(SceneAt scene_at, std::vector<Figure> figures,
                            std::vector<Number> numbers, int threads) {
    const auto value = [scene_at = std::move(scene_at),
                        figures = std::move(figures)](const VectorXd& p) -> VectorXd {
        try {
            return figure_values(scene_at(p), figures, Leg::equilibrium).value;
        } catch (const std::runtime_error&) {  // no such scene: a negative rate, points that meet
            return VectorXd::Constant(static_cast<Index>(figures.size()), nan);
        }
    };
    const auto gradient = [value, numbers = std::move(numbers),
                           threads](const VectorXd& p) -> FigureGradient {
        constexpr std::array steps{1.0, 0.5, 0.25, -0.25, -0.5, -1.0};  // of h
        std::vector<std::array<VectorXd, steps.size()>> f(numbers.size());
        std::vector<Job> jobs;
        for (std::size_t k = 0; k < numbers.size(); ++k)
            for (std::size_t s = 0; s < steps.size(); ++s)
                jobs.push_back({numbers[k].path, [&, k, s] {
                                    VectorXd changed = p;
                                    changed[static_cast<Index>(k)] +=
                                        steps[s] * share_of_step * step_of(numbers[k]);
                                    f[k][s] = value(changed);
                                }});
        run_jobs(jobs, threads, {});
        const Index rows = f.empty() ? 0 : f.front()[0].size();
        FigureGradient result{MatrixXd(rows, p.size()), MatrixXd(rows, p.size())};
        for (Index k = 0; k < p.size(); ++k) {
            const auto& at = f[static_cast<std::size_t>(k)];
            const double h = share_of_step * step_of(numbers[static_cast<std::size_t>(k)]);
            const auto D = [&](std::size_t s) -> VectorXd {
                return (at[s] - at[steps.size() - 1 - s]) / (2 * h * steps[s]);
            };
            const VectorXd R = (4 * D(1) - D(0)) / 3, R_half = (4 * D(2) - D(1)) / 3;
            result.rate.col(k) = (16 * R_half - R) / 15;
            result.error.col(k) = (R_half - R).cwiseAbs();
        }
        return result;
    };
    return {value, gradient};
}

}  // namespace elastocheck::compare
