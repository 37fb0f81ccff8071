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
#include "compare/outputs/rates.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "models/rates/fields.hpp"

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
                    (*places)[k] = interpolate(x, path.curve.a, figures[k].at, 6);
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

// The derivative by the parameter of a branch, as if it were a number of the scene: all its drivers
// start later.
ModelRate by_parameter(const Model& model, const std::string& branch_name) {
    ModelRate rate;
    rate.path = "(parameter)";
    rate.rate = elastocheck::rates::without_numbers(model);
    for (std::size_t b = 0; b < model.branches.size(); ++b)
        if (model.branches[b].name == branch_name)
            for (std::size_t d = 0; d < model.branches[b].drivers.size(); ++d)
                rate.rate.branches[b].drivers[d].start = model.branches[b].drivers[d].rate;
    return rate;
}

// Rates of what a channel reads in the design position, in its unit.
double drawn_rate(const Model& model, const Channel& channel, std::size_t place,
                  const ModelRate& rate) {
    if (!rate.undefined.empty()) return nan;
    StateRate design;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const Pose &at = model.bodies[b].design, &change = rate.rate.bodies[b].design;
        design.increments.push_back({change.r, 2 * (change.p * at.p.conjugate()).vec()});
    }
    design.reactions.resize(model.joints.size());
    return in_unit(channel.unit) * rate_of(model, channel.reads, design_state(model), rate.rate,
                                           read_rates(model, rate.rate)[place], design);
}

// One branch of figure_gradient(): its rows.
struct BranchGradient {
    const Model& model;
    std::span<const ModelRate> rates;  // of the model, by the numbers
    const TrimRates* trim;
    std::span<const Figure> figures;
    FigureGradient& result;

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

        const auto outputs = solver.outputs(which);
        GradientOptions options{.branches = {branch.name}, .legs = {Leg::equilibrium}};
        for (const auto& [k, a] : places) options.stations[branch.name].push_back(a);
        std::vector<ModelRate> all(rates.begin(), rates.end());
        std::optional<TrimRates> with_parameter;
        if (!over.empty()) all.push_back(by_parameter(model, branch.name));
        if (trim != nullptr) {
            with_parameter = *trim;
            if (!over.empty()) {
                with_parameter->numbers.push_back(all.back());
                with_parameter->scenes.push_back(
                    elastocheck::rates::without_numbers(trim->scenes.front()));
            }
            options.trim = &*with_parameter;
        }
        std::vector<VariedNumber> numbers;
        for (const ModelRate& rate : all) numbers.push_back({.path = rate.path});
        const Gradients found = gradients(model, outputs, numbers, all, options);
        for (const SideGradients& side : found.sides) {
            const LegGradients& leg = side.legs.front();
            if (why.empty()) why = leg.failure;
            for (const auto& [k, a] : places)
                for (std::size_t s = 0; s < leg.at.size(); ++s)
                    if (side.a[s] == a) row(k, outputs, leg.at[s]);
            for (const auto& at_station : side.why_number)
                for (const std::string& reason : at_station)
                    if (why.empty()) why = reason;
        }
    }

  private:
    void row(std::size_t k, const std::vector<Channel>& outputs, const MatrixXd& at) const {
        const auto n = static_cast<Index>(rates.size());
        const int y = find_channel(outputs, figures[k].name);
        Eigen::RowVectorXd rate = at.row(y).head(n);
        if (!figures[k].over.empty()) {
            const int x = find_channel(outputs, figures[k].over);
            rate -= at(y, n) / at(x, n) * at.row(x).head(n);
        }
        if (figures[k].change) {
            const auto every = channels(model);
            const int place = find_channel(every, figures[k].name);
            for (Index p = 0; p < n; ++p)
                rate[p] -= place < 0 ? nan
                                     : drawn_rate(model, every[static_cast<std::size_t>(place)],
                                                  static_cast<std::size_t>(place),
                                                  rates[static_cast<std::size_t>(p)]);
        }
        result.rate.row(static_cast<Index>(k)) = rate;
    }
};

}  // namespace

FigureGradient figure_gradient(const Scene& scene, std::span<const ModelRate> rates,
                               std::span<const Figure> figures, int threads) {
    const auto rows = static_cast<Index>(figures.size()),
               columns = static_cast<Index>(rates.size());
    FigureGradient result{MatrixXd::Constant(rows, columns, nan), {}};
    const Trimmed trimmed = trim(scene);
    if (trimmed.record && !trimmed.record->reached()) {
        result.why_not = "trim: " + trimmed.record->detail;
        return result;
    }
    const Model model = compile(trimmed.scene);
    std::optional<TrimRates> trim_of;
    if (trimmed.record) {
        trim_of = trim_rates(scene, trimmed, rates);
        rates = trim_of->numbers;
    }
    const BranchGradient gradient{model, rates, trim_of ? &*trim_of : nullptr, figures, result};
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

Figures exact_figures(SceneAt scene_at, RatesAt rates_at, std::vector<Figure> figures,
                      int threads) {
    const auto value = [scene_at, figures](const VectorXd& p) -> VectorXd {
        try {
            return figure_values(scene_at(p), figures, Leg::equilibrium).value;
        } catch (const std::runtime_error&) {  // no such scene: a negative rate, points that meet
            return VectorXd::Constant(static_cast<Index>(figures.size()), nan);
        }
    };
    const auto gradient = [scene_at, rates_at, figures, threads](const VectorXd& p) {
        try {
            return figure_gradient(scene_at(p), rates_at(p), figures, threads);
        } catch (const std::runtime_error& error) {
            const auto rows = static_cast<Index>(figures.size());
            return FigureGradient{MatrixXd::Constant(rows, p.size(), nan), error.what()};
        }
    };
    return {value, gradient};
}

double step_of(const Number& number) {
    static const std::map<std::string, double> millimetre{
        {"mm", 1}, {"m", 1e-3}, {"cm", 0.1}, {"in", 1 / 25.4}};
    if (const auto unit = millimetre.find(number.unit); unit != millimetre.end())
        return unit->second;
    return number.value != 0 ? 0.01 * std::abs(number.value) : 1;
}

}  // namespace elastocheck::compare
