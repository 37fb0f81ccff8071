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
#include "elastocheck/recursive_batch.hpp"
#include "models/branch.hpp"
#include "models/structure.hpp"

namespace elastocheck::compare::variants {
namespace {

constexpr int points_for_extremes = 20, max_points = 1000;

// Position of a station among the recorded points of a branch side with so many increments, or -1.
int point_at(double at, double to, int increments) {
    const double k = at / to * increments;
    const double nearest = std::round(k);
    return std::abs(k - nearest) <= 1e-9 * increments ? static_cast<int>(nearest) : -1;
}

bool is_extreme(const VariantFigure& figure) { return figure.over != Over::station; }

// Function that returns the point of a channel that reads a coordinate, in any variant; empty for others.
std::function<Point(const Model&)> point_read(const Channel& channel, const Model& design) {
    if (!std::holds_alternative<Coordinate>(channel.reads)) return {};
    for (const Entry& entry : catalogue())
        for (const NamedOwner& owner : owners(design, entry.owner))
            if (entry.point != nullptr && channel_of(design, entry, owner).name == channel.name)
                return [read = entry.point, k = owner.k](const Model& model) {
                    return read(model.wheels[k]);
                };
    const std::string probe = channel.name.substr(0, channel.name.rfind('_'));
    const auto found = std::ranges::find(design.probes, probe, &Probe::name);
    return [k = found - design.probes.begin()](const Model& model) {
        return model.probes[static_cast<std::size_t>(k)].at;
    };
}

// Whether a leg ended a branch that another may follow further. At a limit point or a bifurcation the
// branch itself ends.
bool declines(Outcome outcome) {
    return outcome != Outcome::converged && outcome != Outcome::limit_point &&
           outcome != Outcome::bifurcation_point;
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
    auto found = outputs(design);
    if (!found) throw std::invalid_argument("a figure reads an output that the scene has not");
    outputs_ = std::move(*found);
    for (const Channel& output : outputs_) points_read_.push_back(point_read(output, design));
    only_motion_ = std::ranges::all_of(outputs_, &Channel::kinematic);
    with_sums_ = std::ranges::any_of(outputs_, [](const Channel& output) {
        return std::holds_alternative<Total>(output.reads);
    });
    elastocheck::structure(design, structure_);
    place(design);
    for (Group& group : groups_) {
        for (Way& way : group.ways)
            if (std::ranges::any_of(way.readings, [&](const Reading& reading) {
                    return outputs_[reading.figure].kind() == ChannelKind::characteristic;
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

// Sets the ways (branch sides) that the figures read, the number of points, and the groups.
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
            together_ && fits_branch(design, branch_sides(design.branches[way.branch])[way.side]);
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

// The outputs of the figures in a model; none where it lacks one of them.
std::optional<std::vector<Channel>> VariantSolver::outputs(const Model& model) const {
    const auto all = figure_outputs(model, with_sums_);
    std::vector<Channel> own;
    for (const VariantFigure& figure : figures_) {
        const int c = find_channel(all, figure.output);
        if (c < 0) return std::nullopt;
        own.push_back(all[static_cast<std::size_t>(c)]);
    }
    return own;
}

void VariantSolver::read(const Followed& followed, const std::vector<Channel>& outputs,
                         Analyses analyses, VariantFigures& into) const {
    const auto& [model, side, way, path] = followed;
    const Branch& branch = model.branches[way.branch];
    into.declined = into.declined || declines(path.outcome);
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

std::vector<VariantFigures> VariantSolver::solve(std::span<const Model> variants, Leg leg) const {
    std::vector<VariantFigures> results(variants.size(), without_values(leg));
    std::vector<std::size_t> together;
    for (std::size_t v = 0; v < variants.size(); ++v)
        if (leg == Leg::series && is_as_design(variants[v]))
            together.push_back(v);
        else
            results[v] = solve_alone(variants[v], leg);
    std::vector<Channel> outputs = outputs_;
    for (const Group& group : groups_) {
        std::vector<Model> models;
        models.reserve(together.size());
        for (const std::size_t v : together) models.push_back(followed(variants[v], group.ways));
        recursive::solve_batch(
            group.design, group.analysis, models, {.points = points_, .wrenches = !only_motion_},
            [&](std::size_t k, std::size_t w, const EquilibriumPath& path) {
                const Model& variant = variants[together[k]];
                for (std::size_t f = 0; f < outputs.size(); ++f)
                    if (points_read_[f])
                        std::get<Coordinate>(outputs[f].reads).at = points_read_[f](variant);
                read({variant, models[k].branches[w], group.ways[w], path}, outputs,
                     group.ways[w].responses, results[together[k]]);
            });
    }
    for (const std::size_t v : together) finish(results[v]);
    for (std::size_t v = 0; v < variants.size() && leg == Leg::series; ++v) {
        if (!results[v].declined || results[v].outcome != outcome::ended_early) continue;
        VariantFigures other = solve_alone(variants[v], Leg::equilibrium);
        if (other.outcome != outcome::solved) continue;
        other.reason = "by the equilibrium leg, since series: " + results[v].reason;
        results[v] = std::move(other);
    }
    return results;
}

VariantFigures VariantSolver::without_values(Leg leg) const {
    return {.values = std::vector<double>(figures_.size(), nan), .leg = leg};
}

VariantFigures VariantSolver::solve_alone(const Model& variant, Leg leg) const {
    VariantFigures result = without_values(leg);
    const auto own = outputs(variant);
    if (!own) {
        result.outcome = outcome::no_value;
        result.reason = "the variant has other outputs than the scene";
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
