#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>

#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/design/figures.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Points of a branch between which a figure over another output is interpolated.
constexpr int interpolated_points = 40;

// Figures of one branch by one leg.
struct OnBranch {
    const Model& model;
    const Branch& branch;
    Leg leg;
    std::span<const Figure> figures;
    FigureValues& result;
    std::vector<Channel> read = {};  // outputs of the figures, each once

    // `all` without sums, which take an analysis, until one is asked for.
    void add(const std::string& name, std::vector<Channel>& all) {
        if (name.empty() || find_channel(read, name) >= 0) return;
        if (find_channel(all, name) < 0) std::ranges::move(sums(model), std::back_inserter(all));
        const int c = find_channel(all, name);
        if (c < 0) throw std::invalid_argument(fmt::format("the scene has no output '{}'", name));
        read.push_back(all[static_cast<std::size_t>(c)]);
    }
    std::size_t column(const std::string& name) const {
        return static_cast<std::size_t>(find_channel(read, name));
    }
    void miss(const std::string& why, Outcome outcome = Outcome::converged) const {
        if (!result.why_not.empty()) return;
        result.why_not = why;
        result.not_applicable = is_not_applicable(outcome);
    }
    void set(std::size_t k, double place, double value) const {
        const Channel& channel = read[column(figures[k].name)];
        if (figures[k].change)
            value -= evaluate(model, std::span(&channel, 1), design_state(model)).front();
        result.place[static_cast<Index>(k)] = place;
        result.value[static_cast<Index>(k)] = finite_or_nan(value);
        if (!std::isfinite(value))
            miss(fmt::format(
                "{}: {}", channel.name,
                std::isinf(value) ? why_undefined(channel) : "it could not be computed"));
    }

    // Figures at values of the parameter.
    void at_parameters(const std::map<double, std::vector<std::size_t>>& at) const {
        bool first = true;
        for (const BranchSide& side : sides_of(model, branch, 1)) {
            std::vector<double> points;
            for (const auto& [a, which] : at)
                if (a == 0 ? first : a * side.branch.to > 0) points.push_back(a);
            first = false;
            if (points.empty()) continue;
            std::ranges::sort(points, {}, [](double a) { return std::abs(a); });
            Analyses analyses;
            const auto path = walk_through(side, leg, points, [&](const Equilibrium& state) {
                const auto here = at.find(state.load);
                if (here == at.end()) return;
                const Row row = row_of(model, read, side, {.leg = leg}, state, analyses);
                for (const std::size_t k : here->second)
                    set(k, state.load, row.values[column(figures[k].name)]);
            });
            for (const double a : points)
                if (std::isnan(result.place[static_cast<Index>(at.at(a).front())]))
                    miss(fmt::format("branch '{}': {}: {}", branch.name,
                                     elastocheck::name(path.outcome), path.detail),
                         path.outcome);
        }
    }

    // Figures at values of another output, interpolated on the curve of the branch.
    void over_outputs(std::span<const std::size_t> which) const {
        const auto sides = sides_of(model, branch, std::min(branch.steps, interpolated_points));
        const PathCurve path = walk(model, read, branch, sides, {.leg = leg});
        for (const std::size_t k : which) {
            const auto& [name, of, at, over, change] = figures[k];
            const auto x = placed_by(path.curve, column(over));
            if (reaches(x, at))
                set(k, interpolate(x, path.curve.a, at, 6) / in_unit(unit_of(branch.unit)),
                    interpolate(x, path.curve.channel(column(name)), at, 6));
            else
                miss(x.empty() ? fmt::format("branch '{}': {} is not monotonic", of, over)
                               : fmt::format("branch '{}' does not reach {} = {:g} {}", of, over,
                                             at, symbol(read[column(over)].unit)),
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

FigureValues evaluate(const Model& model, std::span<const Figure> figures, Leg leg) {
    const VectorXd none = VectorXd::Constant(std::ssize(figures), nan);
    FigureValues result{none, none};
    auto all = figure_outputs(model, false);
    for (const auto& branch : model.branches) {
        OnBranch on{model, branch, leg, figures, result};
        std::map<double, std::vector<std::size_t>> placed;
        std::vector<std::size_t> over;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            if (figures[k].branch != branch.name) continue;
            on.add(figures[k].name, all), on.add(figures[k].over, all);
            if (figures[k].over.empty())
                placed[figures[k].at].push_back(k);
            else
                over.push_back(k);
        }
        if (!placed.empty()) on.at_parameters(placed);
        if (!over.empty()) on.over_outputs(over);
    }
    return result;
}

}  // namespace elastocheck::compare
