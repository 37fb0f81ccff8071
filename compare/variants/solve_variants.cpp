#include "compare/variants/solve_variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/design/figure_words.hpp"
#include "compare/design/figures.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "models/structure.hpp"

namespace elastocheck::compare::variants {
namespace {

constexpr const char* other_outputs = "the variant has other outputs than the scene";
constexpr int points_for_extremes = 20, max_points = 1000;

// Whether the station is a recorded point of a way with so many increments: which one, or -1.
int point_at(double at, double to, int increments) {
    const double k = at / to * increments;
    const double nearest = std::round(k);
    return std::abs(k - nearest) <= 1e-9 * increments ? static_cast<int>(nearest) : -1;
}

bool is_extreme(const VariantFigure& figure) { return figure.over != Over::station; }

// Whether the channel holds numbers of the design position, of which a variant has its own.
bool holds_numbers(const Channel& channel) {
    return std::holds_alternative<Coordinate>(channel.reads);
}

// Whether a leg ended a branch that another may follow further. At a limit point or a bifurcation the
// branch itself ends.
bool declines(Outcome outcome) {
    return outcome != Outcome::converged && outcome != Outcome::limit_point &&
           outcome != Outcome::bifurcation_point;
}

// What the numbers of channels depend on.
Model without_joints(const Model& model) {
    Model result;
    result.bodies = model.bodies;
    result.elastics = model.elastics;
    result.wheels = model.wheels;
    result.probes = model.probes;
    result.dampers = model.dampers;
    result.vehicle = model.vehicle;
    return result;
}

// Whether redundant joints share this reaction at the design position.
bool is_shared(const Channel& output, const Model& model, const Branch& branch) {
    if (output.joints().empty()) return false;
    Analyses analyses;
    return evaluate(model, sides_of(model, branch).front(), std::span(&output, 1),
                    design_state(model), analyses)
               .front() == undefined;
}

}  // namespace

VariantFigure parse_variant_figure(const std::string& name, std::string words, const Model& model,
                                   std::span<const Channel> outputs) {
    VariantFigure figure{.name = name, .output = {}, .branch = {}};
    for (const auto& [word, over] :
         {std::pair("min ", Over::least), std::pair("max ", Over::largest)})
        if (words.starts_with(word)) figure.over = over, words.erase(0, 4);
    const FigureWords parsed = parse_figure_words(words, model, outputs);
    if (parsed.station.at && figure.over != Over::station)
        throw std::invalid_argument(
            "an extreme is that of the whole branch; allowed: min OUTPUT@BRANCH");
    figure.output = parsed.output->name;
    figure.unit = parsed.output->unit;
    figure.branch = parsed.station.branch->name;
    figure.at = parsed.station.at.value_or(0);
    if (is_shared(*parsed.output, model, *parsed.station.branch))
        throw std::invalid_argument(figure.output + ": " + why_undefined(*parsed.output));
    return figure;
}

VariantSolver::VariantSolver(const Model& design, std::vector<VariantFigure> figures)
    : figures_(std::move(figures)) {
    const auto all = figure_outputs(design);
    std::vector<Channel> own;
    for (const VariantFigure& figure : figures_) {
        const int c = find_channel(all, figure.output);
        if (c < 0)
            throw std::invalid_argument(
                fmt::format("{}: the scene has no output '{}'", figure.name, figure.output));
        own.push_back(all[static_cast<std::size_t>(c)]);
        only_motion_ = only_motion_ && own.back().kinematic();
        with_sums_ = with_sums_ || std::holds_alternative<Total>(own.back().reads);
    }
    outputs_ = std::make_shared<const std::vector<Channel>>(std::move(own));
    elastocheck::structure(design, structure_);
    place(design);
    for (Group& group : groups_) {
        for (Way& way : group.ways)
            if (std::ranges::any_of(way.readings, [&](const Reading& reading) {
                    return (*outputs_)[reading.figure].kind() == ChannelKind::characteristic;
                })) {
                const Branch side = branch_sides(design.branches[way.branch])[way.side];
                const BranchSide whole{side.name, on_branch(design, side), side};
                (void)wheel_response(whole, {.leg = Leg::series}, steering_joint(design),
                                     design_state(design), way.responses);
            }
        group.design = followed(design, group.ways);
        group.analysis = recursive::analyse(group.design);
    }
}

// The ways that the figures read, the number of points, and the groups.
void VariantSolver::place(const Model& design) {
    std::vector<Way> ways;
    const auto way_of = [&](std::size_t branch, std::size_t side) -> Way& {
        for (Way& way : ways)
            if (way.branch == branch && way.side == side) return way;
        return ways.emplace_back(Way{branch, side});
    };
    struct Station {
        std::size_t figure, branch, side;
        double to;
    };
    std::vector<Station> stations;
    for (std::size_t k = 0; k < figures_.size(); ++k) {
        const VariantFigure& figure = figures_[k];
        const auto branch = std::ranges::find(design.branches, figure.branch, &Branch::name);
        if (branch == design.branches.end())
            throw std::invalid_argument(
                fmt::format("{}: the scene has no branch '{}'", figure.name, figure.branch));
        const auto b = static_cast<std::size_t>(branch - design.branches.begin());
        const auto sides = branch_sides(*branch);
        if (is_extreme(figure)) {
            for (std::size_t side = 0; side < sides.size(); ++side)
                way_of(b, side).readings.push_back({k});
            points_ = std::max(points_, points_for_extremes);
            continue;
        }
        std::size_t side = 0;
        while (side + 1 < sides.size() && figure.at * sides[side].to < 0) ++side;
        stations.push_back({k, b, side, sides[side].to});
    }
    const auto all_placed = [&] {
        return std::ranges::all_of(stations, [&](const Station& s) {
            return point_at(figures_[s.figure].at, s.to, points_) >= 0;
        });
    };
    while (points_ <= max_points && !all_placed()) ++points_;
    if (points_ > max_points)
        throw std::invalid_argument(fmt::format(
            "the stations are not among {} equal increments of their branches, however many; move "
            "them to common fractions of a branch",
            max_points));
    for (const Station& s : stations)
        way_of(s.branch, s.side)
            .readings.push_back({s.figure, point_at(figures_[s.figure].at, s.to, points_)});
    std::ranges::sort(ways, {}, [](const Way& way) { return std::pair(way.branch, way.side); });
    for (Way& way : ways) std::ranges::stable_sort(way.readings, {}, &Reading::point);

    for (const Way& way : ways)
        together_ =
            together_ && stands_on(design, branch_sides(design.branches[way.branch])[way.side]);
    for (Way& way : ways)
        if (!groups_.empty() && (together_ || groups_.back().ways.front().branch == way.branch))
            groups_.back().ways.push_back(std::move(way));
        else
            groups_.push_back({{std::move(way)}});
}

// The model with these ways as its branches.
Model VariantSolver::followed(const Model& model, const std::vector<Way>& ways) const {
    Model result = together_ ? model : on_branch(model, model.branches[ways.front().branch]);
    result.branches.clear();
    for (const Way& way : ways)
        result.branches.push_back(branch_sides(model.branches[way.branch])[way.side]);
    return result;
}

bool VariantSolver::is_as_design(const Model& variant) const {
    std::vector<int> structure;
    elastocheck::structure(variant, structure);
    return structure == structure_;
}

// Those of the design with the numbers of the variant, one a figure; none where it has others.
std::shared_ptr<const std::vector<Channel>> VariantSolver::outputs(const Model& variant,
                                                                   bool same) const {
    if (same && std::ranges::none_of(*outputs_, holds_numbers)) return outputs_;
    const auto all = same ? channels(without_joints(variant)) : figure_outputs(variant, with_sums_);
    auto own = std::make_shared<std::vector<Channel>>(*outputs_);
    for (std::size_t k = 0; k < own->size(); ++k) {
        if (same && !holds_numbers((*own)[k])) continue;
        const int c = find_channel(all, figures_[k].output);
        if (c < 0) return nullptr;
        (*own)[k] = all[static_cast<std::size_t>(c)];
    }
    return own;
}

void VariantSolver::read(const Followed& followed, const std::vector<Channel>& outputs,
                         Analyses analyses, VariantFigures& into) const {
    const auto& [model, side, way, path] = followed;
    const Branch& branch = model.branches[way.branch];
    std::string ended;
    std::size_t reached = 0;
    for (; reached < path.points.size() && ended.empty(); ++reached)
        ended = ends_at_table(model, side, path.points[reached]);
    if (!ended.empty()) --reached;
    if (reached <= static_cast<std::size_t>(points_) && into.reason.empty()) {
        into.outcome = outcome::ended_early;
        into.reason = !ended.empty() ? ended
                                     : fmt::format("branch '{}': {}: {}", branch.name,
                                                   elastocheck::name(path.outcome), path.detail);
    }

    // The figures of one point at a time, so that a response is computed once.
    std::optional<BranchSide> whole;
    std::vector<std::size_t> here;
    std::vector<double> values;
    for (std::size_t p = 0; p < reached; ++p) {
        here.clear(), values.clear();
        bool responds = false;
        for (const Reading& reading : way.readings) {
            if (reading.point >= 0 && reading.point != static_cast<int>(p)) continue;
            here.push_back(reading.figure);
            const Channel& output = outputs[reading.figure];
            responds = responds || output.kind() == ChannelKind::characteristic ||
                       !output.joints().empty();
        }
        if (here.empty()) continue;
        if (responds) {
            std::vector<Channel> wanted;
            for (const std::size_t k : here) wanted.push_back(outputs[k]);
            if (!whole) {
                Branch steps = side;
                steps.steps = points_;
                whole = BranchSide{branch.name, on_branch(model, steps), steps};
            }
            const auto row = [&] {
                return row_of(model, wanted, *whole, {.leg = into.leg}, path.points[p], analyses)
                    .values;
            };
            values = row();
            // An idle mode of the design may be none here.
            if (std::ranges::any_of(values, [](double x) { return std::isnan(x); })) {
                analyses = {};
                values = row();
            }
        } else {
            for (const std::size_t k : here)
                values.push_back(
                    evaluate(model, side, std::span(&outputs[k], 1), path.points[p]).front());
        }
        for (std::size_t i = 0; i < here.size(); ++i) {
            const Over over = figures_[here[i]].over;
            double& value = into.values[here[i]];
            if (over == Over::station || std::isnan(value) ||
                (over == Over::least ? values[i] < value : values[i] > value))
                value = values[i];
        }
    }
    // The extreme of a part of a branch is not that of the branch.
    if (reached <= static_cast<std::size_t>(points_))
        for (const Reading& reading : way.readings)
            if (reading.point < 0) into.values[reading.figure] = nan;
}

// A figure without a value, of a branch that is complete.
void VariantSolver::finish(VariantFigures& figures) const {
    if (figures.outcome != outcome::solved) return;
    for (std::size_t k = 0; k < figures_.size(); ++k) {
        if (!std::isnan(figures.values[k])) continue;
        figures.outcome = outcome::no_value;
        figures.reason =
            fmt::format("{}: {} could not be computed", figures_[k].name, figures_[k].output);
        return;
    }
}

std::vector<VariantFigures> VariantSolver::solve(std::span<const Model> variants) const {
    std::vector<VariantFigures> results(variants.size(),
                                        {.values = std::vector<double>(figures_.size(), nan)});
    std::vector<std::shared_ptr<const std::vector<Channel>>> all_outputs;
    std::vector<std::size_t> which;  // have these outputs
    std::vector<bool> as_design;     // of these
    for (std::size_t v = 0; v < variants.size(); ++v) {
        const bool same = is_as_design(variants[v]);
        if (auto own = outputs(variants[v], same)) {
            all_outputs.push_back(std::move(own));
            which.push_back(v);
            as_design.push_back(same);
        } else {
            results[v].outcome = outcome::no_value;
            results[v].reason = other_outputs;
        }
    }
    std::vector<bool> declined(which.size(), false);
    for (const Group& group : groups_) {
        std::vector<Model> models;
        for (const std::size_t v : which) models.push_back(followed(variants[v], group.ways));
        recursive::solve_batch(
            group.design, group.analysis, models, {.points = points_, .wrenches = !only_motion_},
            [&](std::size_t v, std::size_t w, const EquilibriumPath& path) {
                declined[v] = declined[v] || declines(path.outcome);
                read({variants[which[v]], models[v].branches[w], group.ways[w], path},
                     *all_outputs[v], as_design[v] ? group.ways[w].responses : Analyses{},
                     results[which[v]]);
            });
    }
    for (std::size_t k = 0; k < which.size(); ++k) {
        VariantFigures& result = results[which[k]];
        finish(result);
        if (!declined[k] || result.outcome != outcome::ended_early) continue;
        VariantFigures other = solve_alone(variants[which[k]], Leg::equilibrium);
        if (other.outcome != outcome::solved) continue;
        other.reason = "by the equilibrium leg, since series: " + result.reason;
        result = std::move(other);
    }
    return results;
}

VariantFigures VariantSolver::solve_alone(const Model& variant, Leg leg) const {
    VariantFigures result{.values = std::vector<double>(figures_.size(), nan), .leg = leg};
    const auto own = outputs(variant, is_as_design(variant));
    if (!own) {
        result.outcome = outcome::no_value;
        result.reason = other_outputs;
        return result;
    }
    for (const Group& group : groups_)
        for (const Way& way : group.ways) {
            Branch side = branch_sides(variant.branches[way.branch])[way.side];
            side.steps = points_;
            const EquilibriumPath path =
                solve_branch(BranchSide{side.name, on_branch(variant, side), side}, {.leg = leg});
            read({variant, side, way, path}, *own, {}, result);
        }
    finish(result);
    return result;
}

}  // namespace elastocheck::compare::variants
