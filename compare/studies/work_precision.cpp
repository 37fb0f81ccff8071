#include "compare/studies/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "compare/comparison/legs.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/studies/solves.hpp"
#include "compare/studies/timing.hpp"
#include "elastocheck/recursive.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

// Ratio of the tolerances of `adaptive` [rad/m]: 0.001 deg for 0.01 mm.
constexpr double angle_per_length = 1.745;

bool is_within(double value, double limit) { return std::isfinite(value) && value <= limit; }
Accuracy plus(const Accuracy& a, const Accuracy& b) {
    return {a.mm + b.mm, a.deg + b.deg, a.share + b.share};
}

// ---- Configurations

// All configurations of the study: the equilibrium leg, each method with its step counts or tolerances, the
// energy leg, and the equilibrium leg again, whose time measures the noise.
std::vector<TradePoint> configurations(const Model& model, const TradeOptions& options) {
    std::vector<TradePoint> list;
    list.push_back({.leg = Leg::equilibrium, .method = name(Leg::equilibrium)});
    const double unknowns = coordinates(model) + constraint_rows(model);
    const double per_step = std::pow(unknowns, 3) * static_cast<double>(model.branches.size());
    for (const auto& method : recursive::methods) {
        const std::string label(method.name);
        if (!options.methods.empty() &&
            std::ranges::find(options.methods, label) == options.methods.end())
            continue;
        if (!recursive::has_steps(method)) {
            const bool series = std::holds_alternative<recursive::Series>(method.kind);
            for (int digits = 3; digits <= (series ? 12 : 9); ++digits)
                list.push_back({.method = label, .own_tolerance = std::pow(10.0, -digits)});
            continue;
        }
        const auto affordable = [&](long steps) {
            return steps <= options.max_steps &&
                   static_cast<double>(steps) * per_step <= options.work_budget;
        };
        for (long steps = options.points; steps == options.points || affordable(steps); steps *= 2)
            list.push_back({.method = label, .steps = static_cast<int>(steps)});
    }
    list.push_back({.leg = Leg::energy, .method = name(Leg::energy)});
    list.push_back({.leg = Leg::equilibrium, .method = name(Leg::equilibrium), .again = true});
    return list;
}

// Settings that record `points` equal increments of the parameter. Pre: `points` divides the steps.
SolverSettings settings_of(const TradePoint& point, int points) {
    SolverSettings solver{.leg = point.leg};
    if (point.leg != Leg::recursive) return solver;
    solver.recursion.method = *recursive::find_method(point.method);
    std::visit(
        overloaded{[&](const recursive::Linear&) { solver.refine = point.steps / points; },
                   [&](const recursive::Consistent&) { solver.refine = point.steps / points; },
                   [&](recursive::Adaptive& adaptive) {
                       adaptive.length_tolerance = point.own_tolerance;
                       adaptive.angle_tolerance = angle_per_length * point.own_tolerance;
                   },
                   [&](recursive::Series& series) { series.tolerance = point.own_tolerance; }},
        solver.recursion.method.kind);
    return solver;
}

// Curve of a configuration on a branch, from shared solves, at `multiple` times their base number of points.
PathCurve run(Solves& solves, std::size_t branch, const TradePoint& point, int multiple) {
    std::vector<PathCurve> sides;
    for (const auto& side : solves.sides[branch]) {
        SolverSettings solver = settings_of(point, solves.base);
        if (point.steps == 0) {
            sides.push_back(solved(solves, at_points(side, multiple), solver));
            continue;
        }
        const int steps = point.steps / solves.base;
        sides.push_back(solved(solves, side, solver.recursion.method, steps));
        const int stride = std::min(steps, solves.finest) / multiple;
        sides.back().curve = thinned(sides.back().curve, static_cast<std::size_t>(stride));
    }
    return joined(solves.sides[branch], sides);
}

// ---- Ranking

// Sets the share of the tolerance of each point, whether it is ranked, and whether it is on the Pareto front of
// error over solves, over factorisations with evaluations, and over time.
void rank(Trade& trade) {
    const double min_share = share_of(trade.tolerance, trade.uncertainty);
    for (auto& point : trade.points) {
        point.share = share_of(trade.tolerance, point.error);
        if (point.again)
            point.not_ranked = "the same leg again: noise of the time";
        else if (point.leg == Leg::equilibrium)
            point.not_ranked = "what errors are read from";
        else if (point.outcome != Outcome::converged)
            point.not_ranked = name(point.outcome);
        else if (!std::isfinite(point.share))
            point.not_ranked = "not a number";
        else if (!(point.share > min_share))
            point.not_ranked = "below the reference uncertainty";
        point.ranked = point.not_ranked.empty();
    }
    const auto work = [](const TradePoint& point, std::size_t kind) {
        return kind == 0   ? static_cast<double>(point.work.solves)
               : kind == 1 ? static_cast<double>(point.work.factorisations + point.work.evaluations)
                           : point.ratio;
    };
    for (std::size_t kind = 0; kind < 3; ++kind) {
        std::vector<WorkError> work_errors;
        for (const auto& point : trade.points)
            work_errors.push_back({work(point, kind), point.ranked ? point.share : nan});
        const auto front = pareto_front(work_errors);
        for (std::size_t k = 0; k < front.size(); ++k) trade.points[k].on_front[kind] = front[k];
    }
}

// ---- Recommendation

// Whether an error plus the uncertainty of the references is within the tolerance.
bool is_accurate_enough(const Trade& trade, const Accuracy& error) {
    const Accuracy upper_bound = plus(error, trade.uncertainty);
    return is_within(share_of(trade.tolerance, upper_bound), 1) &&
           is_within(upper_bound.share, trade.tolerance.share);
}

// Whether two configurations differ only in the step count or tolerance of one method: its ladder, with the
// configurations as rungs.
bool same_ladder(const TradePoint& a, const TradePoint& b) {
    return a.leg == b.leg && a.method == b.method && a.again == b.again;
}

// Whether the method's own tolerance is at most the required one; otherwise it meets the required
// one only by chance.
bool is_tight_enough(const Trade& trade, const TradePoint& point) {
    const double deg = in_unit(Unit::deg) * angle_per_length * point.own_tolerance;
    return 1e3 * point.own_tolerance <= trade.tolerance.mm && deg <= trade.tolerance.deg;
}

// Whether this and all finer configurations of the same method meet the tolerance: a coarse one alone
// would meet it by chance, by errors that cancel or too few steps to show an instability.
bool is_eligible(const Trade& trade, std::size_t k) {
    if (trade.points[k].again || !is_tight_enough(trade, trade.points[k])) return false;
    for (std::size_t finer = k;
         finer < trade.points.size() && same_ladder(trade.points[k], trade.points[finer]);
         ++finer) {
        const TradePoint& point = trade.points[finer];
        if (point.outcome != Outcome::converged || !is_accurate_enough(trade, point.error))
            return false;
    }
    return true;
}

// Misfit factor of the law C·h^p on the ladder of a method, its step counts or tolerances: between the
// rungs h/2 and 2h the law predicts the geometric mean of their errors, at an end of the ladder the
// extrapolation of the two next rungs. The same factor is taken as the uncertainty of the error.
double misfit(double error, double neighbour, double other, bool is_between) {
    const double expected =
        is_between ? std::sqrt(neighbour * other) : neighbour * neighbour / other;
    return std::max(error / expected, expected / error);
}

// Sets the band of the error: [e / factor - u, e factor + u], the factor by misfit() at two neighbouring
// rungs, u the reference uncertainty. It also contains the error of the confirming run.
void set_error_band(const Trade& trade, Recommendation& recommendation) {
    const auto k = static_cast<std::ptrdiff_t>(recommendation.point);
    const Accuracy &e = trade.points[recommendation.point].error, &u = trade.uncertainty;
    recommendation.expected = e;
    const auto usable = [&](std::ptrdiff_t i) {
        return i >= 0 && i < static_cast<std::ptrdiff_t>(trade.points.size()) &&
               same_ladder(trade.points[recommendation.point],
                           trade.points[static_cast<std::size_t>(i)]) &&
               trade.points[static_cast<std::size_t>(i)].ranked;
    };
    std::ptrdiff_t a = k, b = k;
    if (!trade.points[recommendation.point].ranked)
        recommendation.band_from = "below the reference uncertainty: only that is known";
    else if (usable(k - 1) && usable(k + 1)) {
        a = k - 1;
        b = k + 1;
        recommendation.band_from = "from the rungs on either side";
    } else if (usable(k + 1) && usable(k + 2)) {
        a = k + 1;
        b = k + 2;
        recommendation.band_from = "from the two finer rungs";
    } else if (usable(k - 1) && usable(k - 2)) {
        a = k - 1;
        b = k - 2;
        recommendation.band_from = "from the two coarser rungs";
    } else
        recommendation.band_from =
            "no two neighbouring rungs above the reference uncertainty: only that is known";
    const auto set_band = [&](double Accuracy::*unit) {
        double factor = 1;
        if (a != b)
            factor = misfit(e.*unit, trade.points[static_cast<std::size_t>(a)].error.*unit,
                            trade.points[static_cast<std::size_t>(b)].error.*unit,
                            a == k - 1 && b == k + 1);
        if (!std::isfinite(factor)) factor = 1;
        recommendation.low.*unit = std::max(0.0, e.*unit / factor - u.*unit);
        recommendation.high.*unit =
            std::max(e.*unit * factor, recommendation.confirmed.*unit) + u.*unit;
    };
    set_band(&Accuracy::mm);
    set_band(&Accuracy::deg);
    set_band(&Accuracy::share);
}

// Runs the configuration again at output points that were not used for its selection: finer ones,
// and those of branches that end half a step earlier. The reference is the equilibrium leg; that of
// the equilibrium leg itself is the second reference.
struct ConfirmingRun {
    Accuracy error;
    int compared = 0;
    // failed runs, with their branch; empty if none failed
    std::string reference_failed = {}, configuration_failed = {};
};
ConfirmingRun confirm(const Solves& solves, const std::vector<std::vector<double>>& extents,
                      const TradePoint& point, int threads, const Progress& progress) {
    const Model& model = solves.model;
    const auto& channels = solves.channels;
    int finer = 3;  // refinement factor of the output points
    if (point.steps > 0) {
        finer = 1;
        while (2 * finer * solves.base <= std::min(point.steps, 100)) finer *= 2;
    }
    const std::array ends{1.0, 1 - 0.5 / (point.steps > 0 ? point.steps : finer * solves.base)};
    const auto run_again = [&](std::size_t b, double end) {
        Branch shorter = model.branches[b];
        shorter.to *= end;
        shorter.from *= end;
        auto sides = sides_of(model, shorter, solves.base);
        for (auto& side : sides) side.branch.steps *= finer;
        Leg leg = Leg::equilibrium;
        const PathCurve configuration = solve_branch(model, channels, shorter, sides,
                                                     settings_of(point, finer * solves.base)),
                        truth = point.leg == Leg::equilibrium
                                    ? second_reference(model, channels, shorter, sides, leg)
                                    : solve_branch(model, channels, shorter, sides, {.leg = leg});
        const auto failure = [&](const PathCurve& path, const std::string& which) {
            return path.outcome == Outcome::converged
                       ? ""
                       : fmt::format("{}: {}: {}: {}", shorter.name, which, name(path.outcome),
                                     path.detail);
        };
        ConfirmingRun confirming{distance(channels, truth.curve, configuration.curve, extents[b]),
                                 0, failure(truth, fmt::format("{} leg", name(leg))),
                                 failure(configuration, describe(point))};
        for (std::size_t c = 0; c < channels.size(); ++c)
            if (channels[c].main || (!is_motion(channels[c]) && std::isfinite(extents[b][c])))
                confirming.compared += static_cast<int>(configuration.curve.a.size());
        return confirming;
    };
    std::vector<ConfirmingRun> runs(ends.size() * model.branches.size());
    std::vector<Job> jobs;
    for (std::size_t k = 0; k < runs.size(); ++k)
        jobs.push_back({"the recommendation, again",
                        [&, k] { runs[k] = run_again(k / ends.size(), ends[k % ends.size()]); }});
    run_jobs(jobs, threads, progress);
    ConfirmingRun worst;
    for (const auto& confirming : runs) {
        worst.error = worse(worst.error, confirming.error);
        worst.compared += confirming.compared;
        if (worst.reference_failed.empty()) worst.reference_failed = confirming.reference_failed;
        if (worst.configuration_failed.empty())
            worst.configuration_failed = confirming.configuration_failed;
    }
    return worst;
}

// Recommends the cheapest eligible configuration that a confirming run confirms; lists the rejected ones.
void recommend(const Solves& solves, const std::vector<std::vector<double>>& extents, Trade& trade,
               int threads, const Progress& progress) {
    std::vector<std::size_t> candidates;
    for (std::size_t k = 0; k < trade.points.size(); ++k)
        if (is_eligible(trade, k)) candidates.push_back(k);
    while (!candidates.empty()) {
        // of equal prices the first, which has the loosest tolerance or the fewest steps
        const std::size_t k = *std::ranges::min_element(
            candidates, {}, [&](std::size_t c) { return trade.points[c].work.price; });
        const TradePoint& point = trade.points[k];
        const ConfirmingRun confirming = confirm(solves, extents, point, threads, progress);
        if (!confirming.reference_failed.empty()) {
            trade.inconclusive.push_back(
                fmt::format("{} cannot be confirmed: no reference at the points of the "
                            "confirming run: {}",
                            describe(point), confirming.reference_failed));
            return;
        }
        Recommendation recommendation;
        recommendation.point = k;
        recommendation.confirmed = confirming.error;
        recommendation.confirmed_numbers = confirming.compared;
        set_error_band(trade, recommendation);
        const bool is_confirmed = confirming.configuration_failed.empty() &&
                                  recommendation.confirmed_numbers > 0 &&
                                  is_accurate_enough(trade, recommendation.confirmed);
        if (is_confirmed && is_accurate_enough(trade, recommendation.high)) {
            trade.recommendation = recommendation;
            return;
        }
        const Accuracy& worst = is_confirmed ? recommendation.high : recommendation.confirmed;
        trade.rejected.push_back(
            !confirming.configuration_failed.empty()
                ? confirming.configuration_failed + ", when run again"
                : fmt::format(
                      "{}: {}{:.3g} mm, {:.3g} deg and {:.3g} % of forces and moments{}",
                      describe(point), is_confirmed ? "up to " : "", worst.mm, worst.deg,
                      100 * worst.share,
                      is_confirmed ? ", as far as its rungs obey their law" : " when run again"));
        std::erase(candidates, k);
    }
}

}  // namespace

double share_of(const Tolerance& tolerance, const Accuracy& error) {
    // A quantity without a tolerance does not count, except for a NaN.
    const double mm = std::isinf(tolerance.mm) ? 0 * error.mm : error.mm / tolerance.mm;
    const double deg = std::isinf(tolerance.deg) ? 0 * error.deg : error.deg / tolerance.deg;
    return worse(mm, deg);
}

std::string describe(const TradePoint& point) {
    if (point.leg != Leg::recursive)
        return fmt::format("{} leg{}", name(point.leg), point.again ? " again" : "");
    if (point.steps == 0)
        return fmt::format("{} at {:.0e} mm", point.method, 1e3 * point.own_tolerance);
    return fmt::format("{}, {} steps", point.method, point.steps);
}

Profile profile(Solves& solves, std::size_t branch, const TradePoint& configuration) {
    const int steps = configuration.steps / solves.base,
              points = steps > 0 ? std::min(steps, solves.finest) : solves.finest;
    return profile_at_equal_parameter(solves.channels,
                                      references_on_branch(solves, branch, points).truth.curve,
                                      run(solves, branch, configuration, points).curve);
}

std::vector<bool> pareto_front(std::span<const WorkError> points) {
    const auto finite = [](const WorkError& p) {
        return std::isfinite(p.work) && std::isfinite(p.error);
    };
    const auto dominates = [](const WorkError& a, const WorkError& b) {
        return a.work <= b.work && a.error <= b.error && (a.work < b.work || a.error < b.error);
    };
    std::vector<bool> front;
    for (const auto& point : points)
        front.push_back(finite(point) && std::ranges::none_of(points, [&](const WorkError& other) {
                            return finite(other) && dominates(other, point);
                        }));
    return front;
}

Trade trade(const Model& model, const TradeOptions& options) {
    Solves solves(model, options.points);
    return trade(solves, options);
}

Trade trade(Solves& solves, const TradeOptions& options) {
    if (options.points < 1 || options.points != solves.base || options.rounds < 0)
        throw std::invalid_argument("trade: points must be positive and rounds not negative");
    const Model& model = solves.model;
    const auto& all_channels = solves.channels;
    Trade result;
    result.points_per_branch = options.points;
    result.rounds = options.rounds;
    for (const auto& channel : all_channels)
        result.angles = result.angles || (channel.main && channel.unit == Unit::deg);
    result.tolerance = options.tolerance;
    if (!result.angles) result.tolerance.deg = std::numeric_limits<double>::infinity();

    if (model.branches.empty()) result.inconclusive.push_back("the scene has no branch");
    if (std::isinf(result.tolerance.mm) && std::isinf(result.tolerance.deg))
        result.inconclusive.push_back(
            std::isfinite(options.tolerance.deg)
                ? "only an angle has a tolerance, and the scene has no angle"
                : "neither a position nor an angle has a tolerance");
    if (!result.inconclusive.empty()) return result;

    std::vector<References> known(model.branches.size());
    std::vector<Job> jobs;
    for (std::size_t b = 0; b < model.branches.size(); ++b)
        for (const auto& side : solves.sides[b])
            jobs.push_back({fmt::format("{}: the references", side.name),
                            [&] { (void)references_on_side(solves, side, 1); }});
    run_jobs(jobs, options.threads, part(options.progress, 0, 0.2));
    std::vector<std::vector<double>> extents;  // per branch
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        known[b] = references_on_branch(solves, b, 1);
        for (const auto& why : known[b].failures)
            result.inconclusive.push_back(fmt::format("{}: {}", model.branches[b].name, why));
        result.uncertainty = worse(result.uncertainty, known[b].uncertainty);
        if (known[b].truth.outcome != Outcome::converged) known[b].truth.curve = {};
        extents.push_back(std::move(known[b].extents));
    }

    result.points = configurations(model, options);
    const auto set_error_and_work = [&](TradePoint& point) {
        for (std::size_t b = 0; b < model.branches.size(); ++b) {
            const PathCurve path = run(solves, b, point, 1);
            point.work.solves += path.counts.iterations;
            point.work.factorisations += path.counts.factorisations;
            point.work.evaluations += path.counts.evaluations;
            const bool complete = path.outcome == Outcome::converged;
            point.error = worse(point.error, distance(all_channels, known[b].truth.curve,
                                                      complete ? path.curve : Curve{}, extents[b]));
            if (!complete && point.outcome == Outcome::converged) {
                point.outcome = path.outcome;
                point.detail = path.detail;
            }
        }
        const double unknowns = coordinates(model) + constraint_rows(model);
        point.work.price = unknowns / 3 * static_cast<double>(point.work.factorisations) +
                           static_cast<double>(point.work.solves + point.work.evaluations);
    };
    jobs.clear();
    for (TradePoint& point : result.points)
        jobs.push_back({describe(point), [&] { set_error_and_work(point); }});
    run_jobs(jobs, options.threads, part(options.progress, 0.2, options.rounds > 0 ? 0.3 : 0.8));

    std::vector<std::function<void()>> timings;  // solves that run alone, one for each timed point
    std::vector<std::size_t> timed;
    for (std::size_t k = 0; k < result.points.size(); ++k) {
        if (result.points[k].outcome != Outcome::converged) continue;
        timed.push_back(k);
        timings.emplace_back([&, k] {
            for (const auto& sides : solves.sides)
                (void)solve_branch(sides, settings_of(result.points[k], solves.base));
        });
    }
    if (options.rounds > 0 && result.points.front().outcome == Outcome::converged) {
        if (options.progress) options.progress("times", 0.3);
        const Times times = take_turns(timings, options.rounds);
        for (std::size_t j = 0; j < timed.size(); ++j) {
            TradePoint& point = result.points[timed[j]];
            point.work.seconds = median(times[j]);
            point.ratio = median(ratios(times[j], times.front()));
        }
        result.noise = noise_of(ratios(times.back(), times.front()));
    }
    rank(result);
    if (result.inconclusive.empty())
        recommend(solves, extents, result, options.threads, part(options.progress, 0.8, 1));
    return result;
}

}  // namespace elastocheck::compare
