#include "compare/design/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Points of a branch between which a figure over another output is interpolated.
constexpr int interpolated_points = 40;

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
            miss(fmt::format(
                "{}: {}", channel.name,
                std::isinf(value) ? why_undefined(channel) : "it could not be computed"));
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

    // Figures at values of another output, interpolated on the curve of the branch. `places`, if
    // asked for, receives the parameters there.
    void over_outputs(const Branch& branch, const std::vector<std::size_t>& which,
                      std::map<std::size_t, double>* places = nullptr) const {
        const auto channels = outputs(which);
        const auto ways = sides_of(model, branch, std::min(branch.steps, interpolated_points));
        const PathCurve path = walk(model, channels, branch, ways, {.leg = leg});
        for (const std::size_t k : which) {
            const auto over = static_cast<std::size_t>(find_channel(channels, figures[k].over));
            const auto c = static_cast<std::size_t>(find_channel(channels, figures[k].name));
            const auto x = placed_by(path.curve, over);
            if (reaches(x, figures[k].at)) {
                set(k, interpolate(x, path.curve.channel(c), figures[k].at, 6), channels[c]);
                if (places != nullptr)
                    (*places)[k] = interpolate(x, path.curve.a, figures[k].at, 6) /
                                   in_unit(unit_of(branch.unit));
            } else
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

std::vector<Channel> figure_outputs(const Model& model, bool with_sums) {
    auto all = channels(model);
    std::ranges::move(characteristics(model), std::back_inserter(all));
    std::ranges::move(element_channels(model), std::back_inserter(all));
    if (with_sums) std::ranges::move(sums(model), std::back_inserter(all));
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

namespace {

// One branch of figure_gradient(): its rows.
struct BranchGradient {
    const Scene& scene;
    const Trimmed& trimmed;
    const Model& model;
    const VaryingScene& varying;
    std::span<const Figure> figures;
    FigureGradient& result;

    // `why`: of the first rate that is missing, with its figure and number.
    void add(const Branch& branch, const std::vector<std::size_t>& which, std::string& why) const {
        FigureValues unused;
        unused.value = VectorXd::Constant(static_cast<Index>(figures.size()), nan);
        const Solver solver{model, figures, Leg::equilibrium, unused};
        std::map<std::size_t, double> places;
        std::vector<std::size_t> over;
        for (const std::size_t k : which) {
            if (figures[k].over.empty())
                places[k] = figures[k].at;
            else
                over.push_back(k);
        }
        if (!over.empty()) solver.over_outputs(branch, over, &places);
        why = unused.why_not;
        if (places.empty()) return;

        // each output as it stands and, where a figure asks for it, counted from the design position
        auto outputs = solver.outputs(which);
        const std::size_t plain = outputs.size();
        for (const std::size_t k : which)
            if (figures[k].change) outputs.push_back(solver.output(figures[k].name));
        GradientOptions options{
            .branches = {branch.name}, .legs = {Leg::equilibrium}, .by_parameter = !over.empty()};
        for (std::size_t c = 0; c < outputs.size(); ++c) options.changes.push_back(c >= plain);
        for (const auto& [k, a] : places) options.stations[branch.name].push_back(a);
        const Gradients found = gradients(scene, trimmed, model, varying, outputs, options);
        for (const SideGradients& side : found.sides) {
            const LegGradients& leg = side.legs.front();
            if (why.empty()) why = leg.failure;
            for (const auto& [k, a] : places)
                for (std::size_t s = 0; s < leg.at.size(); ++s)
                    if (side.a[s] == a) row(k, outputs, plain, leg.at[s], side.why_number[s], why);
        }
    }

  private:
    void row(std::size_t k, const std::vector<Channel>& outputs, std::size_t plain,
             const MatrixXd& at, const std::vector<std::string>& reasons, std::string& why) const {
        const Figure& figure = figures[k];
        const auto n = std::ssize(varying.numbers);
        const auto counted = std::span(outputs).subspan(figure.change ? plain : 0);
        const Index y =
            find_channel(counted, figure.name) + static_cast<Index>(figure.change ? plain : 0);
        Eigen::RowVectorXd rate = at.row(y).head(n);
        if (!figure.over.empty()) {
            const int x = find_channel(outputs, figure.over);
            // a branch that drives x has the same x at the same parameter, whatever the number
            rate -= at(y, n) / at(x, n) * at.row(x).head(n);
        }
        result.rate.row(static_cast<Index>(k)) = rate;
        for (Index p = 0; p < n && why.empty(); ++p)
            if (!std::isfinite(rate[p])) {
                const auto& reason = reasons[static_cast<std::size_t>(p)];
                why = fmt::format("{} on branch '{}' by {}: {}", figure.name, figure.branch,
                                  varying.numbers[static_cast<std::size_t>(p)].path,
                                  reason.empty() ? "it is not defined there" : reason);
            }
    }
};

}  // namespace

FigureGradient figure_gradient(const Scene& scene, const VaryingScene& varying,
                               std::span<const Figure> figures, int threads) {
    FigureGradient result{MatrixXd::Constant(std::ssize(figures), std::ssize(varying.numbers), nan),
                          {}};
    const Trimmed trimmed = trim(scene);
    if (trimmed.record && !trimmed.record->reached()) {
        result.why_not = "trim: " + trimmed.record->detail;
        return result;
    }
    const Model model = compile(trimmed.scene);
    const BranchGradient gradient{scene, trimmed, model, varying, figures, result};
    std::vector<std::string> why(model.branches.size());
    std::vector<Job> jobs;
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        std::vector<std::size_t> which;
        for (std::size_t k = 0; k < figures.size(); ++k)
            if (figures[k].branch == model.branches[b].name) which.push_back(k);
        if (!which.empty())
            jobs.push_back({model.branches[b].name,
                            [&, b, which] { gradient.add(model.branches[b], which, why[b]); }});
    }
    run_jobs(jobs, threads, {});
    if (!result.rate.allFinite())
        for (const std::string& reason : why)
            if (result.why_not.empty()) result.why_not = reason;
    return result;
}

Figures solved_figures(SceneAt scene_at, std::vector<Number> numbers, std::vector<Figure> figures,
                       int threads) {
    const auto value = [scene_at, figures](const VectorXd& p) -> VectorXd {
        try {
            return figure_values(scene_at(p), figures, Leg::equilibrium).value;
        } catch (const std::runtime_error&) {  // no such scene: a negative rate, points that meet
            return VectorXd::Constant(static_cast<Index>(figures.size()), nan);
        }
    };
    const auto gradient = [scene_at, numbers, figures, threads](const VectorXd& p) {
        try {
            VaryingScene varying{{}, [&](std::size_t k, double by) {
                                     const auto at = static_cast<Index>(k);
                                     return scene_at(p + by * VectorXd::Unit(p.size(), at));
                                 }};
            for (Index k = 0; k < p.size(); ++k) {
                Number number = numbers[static_cast<std::size_t>(k)];
                number.value = p[k];
                varying.numbers.push_back(varied_number(number));
            }
            return figure_gradient(scene_at(p), varying, figures, threads);
        } catch (const std::runtime_error& error) {
            return FigureGradient{MatrixXd::Constant(std::ssize(figures), p.size(), nan),
                                  error.what()};
        }
    };
    return {value, gradient};
}

double step_of(const Number& number) { return varied_number(number).step; }

}  // namespace elastocheck::compare
