#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/design/figures.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Points of a branch between which a figure over another output is interpolated.
constexpr int interpolated_points = 40;

constexpr int most_shorter = 3;     // how often h is divided by eight
constexpr double one_slope = 1e-3;  // of the largest change by 2h: a smaller kink is none

// Outputs of a model by their names: a figure of the catalogue is made alone; the list of all outputs
// when another one is asked for, with the sums, which take an analysis, only where it has none.
class NamedOutputs {
  public:
    explicit NamedOutputs(const Model& model) : model_(model) {}
    Channel operator()(const std::string& name) {
        for (const Entry& entry : catalogue())
            if (!entry.on_request && name.ends_with(entry.name))
                for (const Named& owner : owners(model_, entry.owner))
                    if (Channel channel = channel_of(model_, entry, owner); channel.name == name)
                        return channel;
        for (const bool with_sums : {false, true}) {
            if (all_.empty() || with_sums) all_ = figure_outputs(model_, with_sums);
            if (const int c = find_channel(all_, name); c >= 0)
                return all_[static_cast<std::size_t>(c)];
        }
        throw std::invalid_argument(fmt::format("the scene has no output '{}'", name));
    }

  private:
    const Model& model_;
    std::vector<Channel> all_;
};

// Figures of one branch by one leg.
struct OnBranch {
    const Model& model;
    const Branch& branch;
    Leg leg;
    std::span<const Figure> figures;
    FigureValues& result;
    std::vector<Channel> read = {};  // outputs of the figures, each once

    void add(const std::string& name, NamedOutputs& outputs) {
        if (!name.empty() && find_channel(read, name) < 0) read.push_back(outputs(name));
    }
    std::size_t column(const std::string& name) const {
        return static_cast<std::size_t>(find_channel(read, name));
    }
    void miss(const std::string& why, Outcome outcome = Outcome::converged) const {
        if (!result.why_not.empty()) return;
        result.why_not = why;
        result.not_applicable = is_not_applicable(outcome);
    }
    void set(std::size_t k, double value) const {
        const Channel& channel = read[column(figures[k].name)];
        if (figures[k].change)
            value -= evaluate(model, std::span(&channel, 1), design_state(model)).front();
        result.value[static_cast<Index>(k)] = finite_or_nan(value);
        if (!std::isfinite(value))
            miss(fmt::format(
                "{}: {}", channel.name,
                std::isinf(value) ? why_undefined(channel) : "it could not be computed"));
    }

    // Figures at values of the parameter.
    void at_parameters(std::map<double, std::vector<std::size_t>> at) const {
        for (const BranchSide& side : sides_of(model, branch, 1)) {
            std::vector<double> points;
            for (const auto& [a, which] : at)
                if (a == 0 || a * side.branch.to > 0) points.push_back(a);
            std::ranges::sort(points, {}, [](double a) { return std::abs(a); });
            if (points.empty()) continue;
            Analyses analyses;
            const auto path = solve_at(side, leg, points, [&](const Equilibrium& state) {
                const auto here = at.find(state.load);
                if (here == at.end()) return;
                const Row row = row_of(model, read, side, {.leg = leg}, state, analyses);
                for (const std::size_t k : here->second)
                    set(k, row.values[column(figures[k].name)]);
                at.erase(here);
            });
            for (const double a : points)
                if (at.erase(a) > 0)
                    miss(fmt::format("branch '{}': {}: {}", branch.name,
                                     elastocheck::name(path.outcome), path.detail),
                         path.outcome);
        }
    }

    // Figures at values of another output, interpolated on the curve of the branch.
    void over_outputs(std::span<const std::size_t> which) const {
        const auto sides = sides_of(model, branch, std::min(branch.steps, interpolated_points));
        const PathCurve path = solve_branch(model, read, branch, sides, {.leg = leg});
        for (const std::size_t k : which) {
            const Figure& figure = figures[k];
            const auto x = placed_by(path.curve, column(figure.over));
            if (reaches(x, figure.at))
                set(k, interpolate(x, path.curve.channel(column(figure.name)), figure.at, 6));
            else
                miss(x.empty()
                         ? fmt::format("branch '{}': {} is not monotonic", branch.name, figure.over)
                         : fmt::format("branch '{}' does not reach {} = {:g} {}", branch.name,
                                       figure.over, figure.at,
                                       symbol(read[column(figure.over)].unit)),
                     path.outcome);
        }
    }
};

// Changes of the figures where a number is 2h and h smaller, h and 2h larger.
struct Changes {
    VectorXd far_down, down, up, far_up;

    // dy/dp [figure's unit / number's unit]. With both sides by figures.hpp, error O(h⁴). Where one
    // side has no value, by the other alone: (4 Δy(h) - Δy(2h)) / 2h, error O(h²). Zero where y
    // moves no more than its rounding.
    double rate(Index k, double h, double rounding) const {
        const double near = up[k] - down[k], far = far_up[k] - far_down[k];
        if (std::abs(near) <= rounding && std::abs(far) <= rounding) return 0;
        if (std::isfinite(near) && std::isfinite(far)) return (8 * near - far) / (12 * h);
        const double above = (4 * up[k] - far_up[k]) / (2 * h);
        return std::isfinite(above) ? above : finite_or_nan((far_down[k] - 4 * down[k]) / (2 * h));
    }
    double size(Index k) const {
        const double largest = std::max(std::abs(far_up[k]), std::abs(far_down[k]));
        return std::isfinite(largest) ? largest : 0;
    }
    // |2 (Δy(h) + Δy(-h)) - ½ (Δy(2h) + Δy(-2h))|: of smooth functions ½ h⁴ |d⁴y/dp⁴|, of
    // slopes that differ by s to both sides h |s|
    double kink(Index k) const {
        return std::abs(2 * (up[k] + down[k]) - (far_up[k] + far_down[k]) / 2);
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
    FigureValues result{VectorXd::Constant(std::ssize(figures), nan)};
    NamedOutputs outputs(model);
    for (const auto& branch : model.branches) {
        OnBranch on{model, branch, leg, figures, result};
        std::map<double, std::vector<std::size_t>> placed;
        std::vector<std::size_t> over;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            if (figures[k].branch != branch.name) continue;
            on.add(figures[k].name, outputs), on.add(figures[k].over, outputs);
            (figures[k].over.empty() ? placed[figures[k].at] : over).push_back(k);
        }
        if (!placed.empty()) on.at_parameters(std::move(placed));
        if (!over.empty()) on.over_outputs(over);
    }
    return result;
}

VectorXd SearchRange::at(const VectorXd& shares) const {
    return (start + (high - low).cwiseProduct(shares)).cwiseMax(low).cwiseMin(high);
}
VectorXd SearchRange::shares(const VectorXd& p) const {
    return (p - start).cwiseQuotient(high - low);
}

MatrixXd Figures::gradient(const VectorXd& p) const {
    const VectorXd here = value(p), rounding = here.unaryExpr(&least_movement);
    MatrixXd rate = MatrixXd::Constant(here.size(), p.size(), nan);
    VectorXd size = VectorXd::Zero(here.size());  // largest change by a step of any number
    std::vector<Index> open(static_cast<std::size_t>(p.size()));
    std::iota(open.begin(), open.end(), Index{0});
    double share = 1;
    for (int pass = 0; pass <= most_shorter && !open.empty(); ++pass, share /= 8) {
        std::vector<VectorXd> points{p};
        for (const Index i : open)
            for (const double t : {-2, -1, 1, 2})
                points.push_back(p + t * share * step[i] * VectorXd::Unit(p.size(), i));
        const auto y = values(points);
        std::vector<Index> kinked;
        for (std::size_t k = 1; k < y.size(); k += 4) {
            const Index i = open[k / 4];
            const Changes changes{y[k] - here, y[k + 1] - here, y[k + 2] - here, y[k + 3] - here};
            bool settled = true;
            for (Index j = 0; j < here.size(); ++j) {
                if (pass == 0) size[j] = std::max(size[j], changes.size(j));
                if (pass > 0 && !std::isnan(rate(j, i))) continue;
                const bool kink = changes.kink(j) > one_slope * share * size[j] + rounding[j];
                rate(j, i) = kink ? nan : changes.rate(j, share * step[i], rounding[j]);
                settled = settled && !kink;
            }
            if (!settled) kinked.push_back(i);
        }
        open = kinked;
    }
    return rate;
}

}  // namespace elastocheck::compare
