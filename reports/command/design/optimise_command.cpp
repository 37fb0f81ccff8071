// `elastocheck optimise`: numbers of a scene with which figures and curves stay within bands.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "compare/proofs/certify.hpp"
#include "models/reader/document/yaml.hpp"
#include "reports/command/design/request.hpp"
#include "reports/command/options/goals_file.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Points that are added where a curve leaves its band between its points, and the search repeated.
constexpr int most_rounds = 3;
constexpr double between_within = 1e-6;  // outside of a band, as a share of the movement

struct OptimiseRequest : DesignRequest {
    std::string file;
    int starts = 4;
};

VectorXd values_of(const Scene& scene, const std::vector<GoalPoint>& points) {
    std::vector<compare::Figure> figures;
    for (const GoalPoint& point : points) figures.push_back(point.figure);
    return compare::figure_values(scene, figures, compare::Leg::equilibrium).value;
}

// The points of the curves between theirs at which they are furthest outside of their bands, one a
// gap; each curve of which any is, receives them.
std::optional<Between> add_points_outside(const Scene& scene, const VectorXd& scale,
                                          std::vector<Goal>& goals, bool add) {
    std::optional<Between> worst;
    Index first = 0;
    for (Goal& goal : goals) {
        const double within = between_within * scale[first];
        first += static_cast<Index>(goal.points.size());
        if (goal.points.size() < 2) continue;
        auto candidates = points_between(goal, BranchOf::before);
        VectorXd values = values_of(scene, candidates);
        // Between the last point of a branch and the first of the next, either may be the one.
        if (!values.allFinite()) {
            const auto others = points_between(goal, BranchOf::after);
            const VectorXd other_values = values_of(scene, others);
            for (std::size_t k = 0; k < others.size(); ++k)
                if (const auto i = static_cast<Index>(k); !std::isfinite(values[i]))
                    candidates[k] = others[k], values[i] = other_values[i];
        }
        std::vector<GoalPoint> added;
        const std::size_t in_gap = candidates.size() / (goal.points.size() - 1);
        for (std::size_t k = 0; k < candidates.size(); k += in_gap) {
            double most = within;
            std::size_t at = k + in_gap;
            for (std::size_t i = k; i < k + in_gap; ++i) {
                const double value = values[static_cast<Index>(i)];
                const double excess = std::max(goal.low - value, value - goal.high);
                if (!(excess <= most)) most = excess, at = i;
                if (std::isnan(most)) break;
            }
            if (at == k + in_gap) continue;
            if (std::isfinite(most)) added.push_back(candidates[at]);
            if (!worst || (!std::isnan(worst->excess) && !(most <= worst->excess)))
                worst = Between{most, goal.output + " at " + candidates[at].place +
                                          (std::isnan(most) ? " (no value there)" : "")};
        }
        if (!add) continue;
        std::ranges::copy(added, std::back_inserter(goal.points));
        std::ranges::stable_sort(goal.points, {},
                                 [](const GoalPoint& point) { return point.figure.at; });
    }
    return worst;
}

// Interval proofs of the equilibrium leg's states on the branches of the goals.
compare::CertifyStudy certificate(const Scene& scene, const std::vector<compare::Figure>& figures,
                                  int threads) {
    Model model = compile(compare::trim(scene).scene);
    std::erase_if(model.branches, [&](const Branch& branch) {
        return std::ranges::find(figures, branch.name, &compare::Figure::branch) == figures.end();
    });
    return compare::certify(model, {.solvers = {{.leg = compare::Leg::equilibrium}},
                                    .tolerance = compare::claim(compare::claimed_accuracy),
                                    .curves = false,
                                    .threads = threads,
                                    .progress = progress});
}

// A goal that does not move is refused unless it is met, which is noted.
void judge_still(const compare::SceneAt& scene, const GoalFigures& all,
                 const compare::Optimum& optimum, const std::string& name, GoalsFile& file) {
    for (std::size_t g = 0; g < optimum.still.size(); ++g) {
        if (!optimum.still[g]) continue;
        const bool is_goal = g < file.goals.size();
        bool met = is_goal;
        std::size_t last = 0;
        for (std::size_t k = 0; k < all.goals.goal.size(); ++k) {
            if (all.goals.goal[k] != static_cast<int>(g)) continue;
            const auto i = static_cast<Index>(k);
            met = met && optimum.before[i] >= all.goals.low[i] &&
                  optimum.before[i] <= all.goals.high[i];
            last = k;
        }
        const auto reasons =
            compare::why_still(scene, all.figures[last], file.varied.numbers, file.varied.start);
        const std::string why = fmt::format("{}", fmt::join(reasons, "\n  "));
        if (!met)
            reader::fail(name, is_goal ? file.goals[g].line : file.minimised_line,
                         is_goal ? "goals" : "minimise",
                         fmt::format("{}: none of the numbers moves it:\n  {}",
                                     all.figures[last].name, why));
        file.goals[g].not_moved = why;
    }
}

// Exit code 0: the bands are met at the least cost that was found, confirmed and proved; 1: they
// cannot be met; 3: a figure has no value, or the result is not confirmed, not proved or not
// converged.
int optimise(const OptimiseRequest& request, const Delivery& delivery) {
    if (!request.output.empty()) check_may_write_scene(request.output);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    GoalsFile file = read_goals(read_whole(request.file, largest_baseline), request.file,
                                loaded.scene, loaded.model);
    const Varied& varied = file.varied;
    const auto scene = scene_at(request.scene, request.settings, varied.numbers);
    const int threads = threads_of(request.running);
    GoalFigures all = figures_of(file);
    const auto write = [&](const VectorXd& p, bool met, bool last) {
        request.write(fmt::format("optimise: {}{}{}", last ? "" : "not finished, ",
                                  met ? "" : "nearest to ", request.file),
                      varied, p, last);
    };
    const auto search = [&](const std::vector<VectorXd>& starts) {
        return compare::optimise(
            compare::solved_figures(scene, varied.numbers, all.figures, threads), all.goals, starts,
            progress, [&](const VectorXd& p, bool met) { write(p, met, false); });
    };
    const auto starts = compare::starts_of(all.goals, request.starts);
    OptimisedScene result{.numbers = varied.numbers, .optimum = search(starts)};
    compare::Optimum& optimum = result.optimum;
    if (!optimum.before.allFinite() || !optimum.gradient.rate.allFinite()) {
        progress("");
        print_error("{}\n", why_no_start(loaded.scene, all.figures, optimum.gradient));
        return could_not_judge;
    }
    judge_still(scene, all, optimum, request.file, file);
    result.searches = optimum.searches;
    for (int round = 0; optimum.met; ++round) {
        const bool again = round < most_rounds;
        const std::vector<Goal> goals = file.goals;
        result.between = add_points_outside(scene(optimum.p), optimum.scale, file.goals, again);
        if (!result.between || !again || !std::isfinite(result.between->excess)) {
            file.goals = goals;
            break;
        }
        all = figures_of(file);
        compare::Optimum next = search({optimum.p});
        if (!next.met) next = search(starts);
        if (next.best < 0) {  // an added point has no value in the scene as it is
            file.goals = goals;
            all = figures_of(file);
            break;
        }
        optimum = std::move(next);
    }
    result.goals = file.goals, result.limits = all.goals;
    std::vector<std::string> units;
    for (const Goal& goal : file.goals) units.insert(units.end(), goal.points.size(), goal.unit);
    if (file.minimised) {
        result.minimised = file.minimised->figure.name + " at " + file.minimised->place;
        result.minimised_unit = symbol(file.minimised->output.unit);
        units.push_back(result.minimised_unit);
    }
    const Scene changed = scene(optimum.p);
    result.confirmation =
        compare::confirm(changed, all.figures, units, optimum.after, optimum.scale);
    if (optimum.met) result.certificate = certificate(changed, all.figures, threads);
    progress("");
    delivery.print_text(optimise_text(result));
    write(optimum.p, optimum.met, true);
    print_result(delivery, optimise_schema, optimise_json(result));
    if (!result.confirmation.confirmed) return could_not_judge;
    if (!optimum.met) return limit_broken;
    if (result.between && !std::isfinite(result.between->excess)) return could_not_judge;
    return optimum.converged && result.certificate->conclusive() ? fine : could_not_judge;
}

}  // namespace

const Command optimise_command{
    Group::change, "optimise",
    "Change numbers of a scene within limits so that figures and curves stay within bands, "
    "with the smallest change or the least value of a figure; the prices of the bounds "
    "that hold, and proofs of the result",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<OptimiseRequest>();
        add_design(command, *request);
        as_file(command.add_option(
                    "GOALS", request->file,
                    "file with the numbers, their limits and the bands, such as vary: "
                    "{points.tie_rod_inner.z: [260, 340]} and goals: [{figure: toe, over: travel, "
                    "from: -80, to: 80, within: [-0.1, 0.1]}]"))
            ->required();
        command
            .add_option("--starts", request->starts,
                        "points to search from: the scene, and others within the limits, the same "
                        "on every run (default: 4)")
            ->check(CLI::Range(1, 1000));
        return [request](const std::string& line) {
            return optimise(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
