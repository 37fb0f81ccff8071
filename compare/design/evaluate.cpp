// Values of figures from the states of a leg, and their gradient by differences (figures.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/design/figures.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/structure.hpp"
#include "reference/equilibrium/neighbours.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Points of a branch between which a figure over another output is interpolated.
constexpr int interpolated_points = 40;

// Divisions of h by eight where the slopes to both sides differ.
constexpr int max_shorter_steps = 3;
// Largest kink() with which a figure has a rate, as a share of its largest change by 2h.
constexpr double max_kink = 1e-3;

// Outputs of a model by their names: from the catalogue, else from the list of all outputs, and only if
// that lacks the name from the list with the sums, which need an analysis of the model.
class NamedOutputs {
  public:
    explicit NamedOutputs(const Model& model) : model_(model) {}
    Channel operator()(const std::string& name) {
        for (const Entry& entry : catalogue())
            if (!entry.on_request && name.ends_with(entry.name))
                for (const NamedOwner& owner : owners(model_, entry.owner))
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

// Sides of the branch on which the states lie, with the steps at which they are solved.
std::vector<BranchSide> read_sides(const Model& model, const StatesOfFigures& states) {
    const Branch& branch = model.branches[states.branch];
    return sides_of(model, branch,
                    states.whole_branch ? std::min(branch.steps, interpolated_points) : 1);
}

// Reads the figures of one branch: those at values of the parameter, or those over another output.
struct BranchReader {
    const Model& model;
    const StatesOfFigures& states;
    Leg leg;
    std::span<const Figure> figures;
    FigureValues& result;
    std::vector<Channel> read = {};        // outputs of the figures, each once
    std::vector<std::size_t> chosen = {};  // figures of this branch

    const Branch& branch() const { return model.branches[states.branch]; }
    bool has(const Figure& figure) const {
        return figure.branch == branch().name && figure.abscissa.empty() != states.whole_branch;
    }
    void add(const std::string& name, NamedOutputs& outputs) {
        if (!name.empty() && find_channel(read, name) < 0) read.push_back(outputs(name));
    }
    void add_figures(NamedOutputs& outputs) {
        for (std::size_t k = 0; k < figures.size(); ++k)
            if (has(figures[k])) {
                add(figures[k].name, outputs);
                add(figures[k].abscissa, outputs);
                chosen.push_back(k);
            }
    }
    std::size_t column(const std::string& name) const {
        return static_cast<std::size_t>(find_channel(read, name));
    }
    void set_reason(const std::string& why) const {
        if (!result.why_not.empty()) return;
        result.why_not = why;
        result.not_applicable = is_not_applicable(states.outcome);
    }
    void set(std::size_t k, double value) const {
        const Channel& channel = read[column(figures[k].name)];
        if (figures[k].change)
            value -= evaluate(model, std::span(&channel, 1), design_state(model)).front();
        result.value[static_cast<Index>(k)] = finite_or_nan(value);
        if (!std::isfinite(value))
            set_reason(fmt::format(
                "{}: {}", channel.name,
                std::isinf(value) ? why_undefined(channel) : "it could not be computed"));
    }

    void read_all() const {
        Curve curve;
        Analyses analyses;
        for (const Equilibrium& state : states.states)
            append(curve, state.load,
                   row_of(model, read, states.sides.front(), {.leg = leg}, state, analyses).values);
        for (const std::size_t k : chosen)
            if (states.whole_branch)
                set_over_output(k, curve);
            else if (const auto at =
                         std::ranges::find(states.states, figures[k].station, &Equilibrium::load);
                     at != states.states.end())
                set(k, curve.values[static_cast<std::size_t>(at - states.states.begin())]
                                   [column(figures[k].name)]);
            else
                set_reason(fmt::format("branch '{}': {}: {}", branch().name,
                                       elastocheck::name(states.outcome), states.detail));
    }
    // Sets a figure at a value of another output, interpolated on the curve of the branch.
    void set_over_output(std::size_t k, const Curve& curve) const {
        const Figure& figure = figures[k];
        const auto x = abscissa_values(curve, column(figure.abscissa));
        if (reaches(x, figure.station))
            set(k, interpolate(x, curve.channel(column(figure.name)), figure.station, 6));
        else
            set_reason(x.empty() ? fmt::format("branch '{}': {} is not monotonic", branch().name,
                                               figure.abscissa)
                                 : fmt::format("branch '{}' does not reach {} = {:g} {}",
                                               branch().name, figure.abscissa, figure.station,
                                               symbol(read[column(figure.abscissa)].unit)));
    }
};

// Solves for the states of one branch side at those of `points` that lie on it, and adds them to `into`.
void solve_side(const BranchSide& side, Leg leg, std::vector<double> points,
                StatesOfFigures& into) {
    std::erase_if(points, [&](double a) { return a * side.branch.to < 0; });
    std::ranges::sort(points, {}, [](double a) { return std::abs(a); });
    const auto duplicates = std::ranges::unique(points);
    points.erase(duplicates.begin(), duplicates.end());
    if (points.empty()) return;
    const auto path = solve_at(side, leg, points, [&](const Equilibrium& state) {
        if (std::ranges::find(points, state.load) != points.end()) into.states.push_back(state);
    });
    if (into.outcome == Outcome::converged) {
        into.outcome = path.outcome;
        into.detail = path.detail;
    }
}

// Whether a model differs from the model of the states only in its numbers.
bool same_structure(const Model& model, std::span<const StatesOfFigures> states) {
    std::vector<int> of_states, of_model;
    for (const StatesOfFigures& of : states) {
        if (of.branch >= model.branches.size()) return false;
        of_states.clear();
        of_model.clear();
        structure(of.sides.front().model, of_states);
        structure(read_sides(model, of).front().model, of_model);
        if (of_states != of_model) return false;
    }
    return true;
}

// Changes Δy of the figures by changes -2h, -h, h and 2h of a number.
struct Changes {
    VectorXd far_down, down, up, far_up;

    // dy/dp [figure's unit / number's unit], by the formula of figures.hpp with error O(h⁴); where one
    // side has no value, by the other alone: (4 Δy(h) - Δy(2h)) / 2h, error O(h²). Zero where y
    // changes by no more than its rounding.
    double rate(Index k, double h, double rounding) const {
        const double near = up[k] - down[k], far = far_up[k] - far_down[k];
        if (std::abs(near) <= rounding && std::abs(far) <= rounding) return 0;
        if (std::isfinite(near) && std::isfinite(far)) return (8 * near - far) / (12 * h);
        const double above = (4 * up[k] - far_up[k]) / (2 * h);
        return std::isfinite(above) ? above : finite_or_nan((far_down[k] - 4 * down[k]) / (2 * h));
    }
    // Largest |Δy| of figure k by ±2h, of the sides that have a value; zero without one.
    double size(Index k) const {
        const auto finite = [](double change) {
            return std::isfinite(change) ? std::abs(change) : 0;
        };
        return std::max(finite(far_up[k]), finite(far_down[k]));
    }
    // |2 (Δy(h) + Δy(-h)) - ½ (Δy(2h) + Δy(-2h))|, by Taylor ½ h⁴ |d⁴y/dp⁴| for a smooth function, and
    // h |s| for slopes to both sides that differ by s
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

std::vector<StatesOfFigures> states_of(const Model& model, std::span<const Figure> figures,
                                       Leg leg) {
    std::vector<StatesOfFigures> all_states;
    for (std::size_t b = 0; b < model.branches.size(); ++b)
        for (const bool whole : {false, true}) {
            StatesOfFigures states{b, whole, {}};
            std::vector<double> points;
            for (const Figure& figure : figures)
                if (figure.branch == model.branches[b].name && figure.abscissa.empty() != whole)
                    points.push_back(figure.station);
            if (points.empty()) continue;
            states.sides = read_sides(model, states);
            if (whole) {
                EquilibriumPath path = solve_branch(states.sides, {.leg = leg});
                states.states = std::move(path.points);
                states.outcome = path.outcome;
                states.detail = path.detail;
            } else {
                bool first = true;  // the start is on the first side
                for (const BranchSide& side : states.sides) {
                    solve_side(side, leg, points, states);
                    if (std::exchange(first, false)) std::erase(points, 0.);
                }
            }
            all_states.push_back(std::move(states));
        }
    return all_states;
}

FigureValues read_figures(const Model& model, std::span<const StatesOfFigures> states,
                          std::span<const Figure> figures, Leg leg) {
    FigureValues result{VectorXd::Constant(std::ssize(figures), nan)};
    NamedOutputs outputs(model);
    for (const StatesOfFigures& of_branch : states) {
        BranchReader reader{model, of_branch, leg, figures, result};
        reader.add_figures(outputs);
        reader.read_all();
    }
    return result;
}

FigureValues evaluate(const Model& model, std::span<const Figure> figures, Leg leg) {
    return read_figures(model, states_of(model, figures, leg), figures, leg);
}

std::vector<std::vector<StatesOfFigures>> neighbouring_states(
    std::span<const StatesOfFigures> states, std::span<const Model* const> models, int threads) {
    std::vector<std::vector<StatesOfFigures>> states_of_models(models.size());
    if (std::ranges::any_of(states, [](const StatesOfFigures& of) { return !of.complete(); }))
        return states_of_models;
    std::vector<std::atomic<bool>> near(models.size());
    std::vector<Job> jobs;
    for (std::size_t m = 0; m < models.size(); ++m) {
        near[m] = models[m] != nullptr && same_structure(*models[m], states);
        for (std::size_t k = 0; near[m] && k < states.size(); ++k) {
            StatesOfFigures& of = states_of_models[m].emplace_back(states[k]);
            of.sides = read_sides(*models[m], of);
        }
    }
    const auto move_state = [&](std::size_t k, std::size_t s) {
        const Equilibrium& state = states[k].states[s];
        std::vector<Neighbours> stencils;
        std::vector<std::size_t> model_of;  // model of each stencil
        for (std::size_t m = 0; m < models.size(); ++m)
            if (near[m]) {
                stencils.push_back(
                    {{&side_at(states_of_models[m][k].sides, state.load).model, 1, 1}});
                model_of.push_back(m);
            }
        const BranchSide& side = side_at(states[k].sides, state.load);
        const auto found =
            reference::equilibrium::neighbour_states(side.model, side.branch, state, stencils);
        for (std::size_t n = 0; n < found.size(); ++n) {
            const BranchSide& there = side_at(states_of_models[model_of[n]][k].sides, state.load);
            if (found[n].outcome == Outcome::converged && found[n].settled &&
                ends_at_table(there.model, there.branch, found[n].states.front()).empty())
                states_of_models[model_of[n]][k].states[s] = found[n].states.front();
            else
                near[model_of[n]] = false;
        }
    };
    for (std::size_t k = 0; k < states.size(); ++k)
        for (std::size_t s = 0; s < states[k].states.size(); ++s)
            jobs.push_back({"", [&, k, s] { move_state(k, s); }});
    run_jobs(jobs, threads, {});
    for (std::size_t m = 0; m < models.size(); ++m)
        if (!near[m]) states_of_models[m].clear();
    return states_of_models;
}

VectorXd SearchRange::point(const VectorXd& shares) const {
    return (start + (high - low).cwiseProduct(shares)).cwiseMax(low).cwiseMin(high);
}
VectorXd SearchRange::shares(const VectorXd& p) const {
    return (p - start).cwiseQuotient(high - low);
}

MatrixXd Figures::gradient(const VectorXd& p) const {
    const VectorXd centre = value(p), rounding = centre.unaryExpr(&min_movement);
    MatrixXd rate = MatrixXd::Constant(centre.size(), p.size(), nan);
    VectorXd size = VectorXd::Zero(centre.size());  // largest change by a step of any number
    std::vector<Index> open(static_cast<std::size_t>(p.size()));
    std::iota(open.begin(), open.end(), Index{0});
    double share = 1;
    for (int pass = 0; pass <= max_shorter_steps && !open.empty(); ++pass, share /= 8) {
        std::vector<VectorXd> points{p};
        for (const Index i : open)
            for (const double t : {-2, -1, 1, 2})
                points.push_back(p + t * share * step[i] * VectorXd::Unit(p.size(), i));
        const auto y = values(points);
        std::vector<Index> kinked;
        for (std::size_t k = 1; k < y.size(); k += 4) {
            const Index i = open[k / 4];
            const Changes changes{y[k] - centre, y[k + 1] - centre, y[k + 2] - centre,
                                  y[k + 3] - centre};
            bool smooth = true;
            for (Index j = 0; j < centre.size(); ++j) {
                if (pass == 0) size[j] = std::max(size[j], changes.size(j));
                if (pass > 0 && !std::isnan(rate(j, i))) continue;
                const bool kink = changes.kink(j) > max_kink * share * size[j] + rounding[j];
                rate(j, i) = kink ? nan : changes.rate(j, share * step[i], rounding[j]);
                smooth = smooth && !kink;
            }
            if (!smooth) kinked.push_back(i);
        }
        open = kinked;
    }
    return rate;
}

}  // namespace elastocheck::compare
