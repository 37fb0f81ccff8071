#include "compare/trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compare/legs.hpp"
#include "compare/timing.hpp"
#include "models/overloaded.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// Of the tolerances of `adaptive` [rad/m]: 0.001 deg beside 0.01 mm.
constexpr double angle_per_length = 1.745;

bool within(double value, double limit) { return std::isfinite(value) && value <= limit; }
Accuracy plus(const Accuracy& a, const Accuracy& b) { return {a.mm + b.mm, a.deg + b.deg}; }

// ---- one configuration

// The same output points, `factor` from one to the next.
std::vector<Way> refined(std::vector<Way> ways, int factor) {
    for (auto& way : ways) way.branch.steps *= factor;
    return ways;
}

// Every so-many-th point.
Curve every(const Curve& curve, std::size_t stride) {
    Curve result{.unit = curve.unit, .a = {}, .start = curve.start / stride, .values = {}};
    for (std::size_t k = curve.start % stride; k < curve.a.size(); k += stride) {
        result.a.push_back(curve.a[k]);
        result.values.push_back(curve.values[k]);
    }
    return result;
}

// Of a path that is complete; else without a point, so that whatever is read from it is no number.
Curve curve_of(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
               const EquilibriumPath& path) {
    if (path.outcome != Outcome::converged) return {};
    return curve(model, channels, branch, path.points);
}

std::vector<TradePoint> configurations(const Model& model, const TradeOptions& options) {
    std::vector<TradePoint> all;
    all.push_back({.leg = Leg::equilibrium, .method = name(Leg::equilibrium)});
    const double unknowns = coordinates(model) + constraint_rows(model);
    const double per_step = std::pow(unknowns, 3) * static_cast<double>(model.branches.size());
    for (const auto& method : recursive::methods) {
        const std::string label(method.name);
        if (!options.methods.empty() && std::ranges::find(options.methods, label) == options.methods.end())
            continue;
        if (!recursive::has_steps(method)) {
            const bool series = std::holds_alternative<recursive::Series>(method.kind);
            for (int digits = 3; digits <= (series ? 12 : 9); ++digits)
                all.push_back({.method = label, .own_tolerance = std::pow(10.0, -digits)});
            continue;
        }
        const auto affordable = [&](long steps) {
            return steps <= options.most_steps &&
                   static_cast<double>(steps) * per_step <= options.work_budget;
        };
        for (long steps = options.points; steps == options.points || affordable(steps); steps *= 2)
            all.push_back({.method = label, .steps = static_cast<int>(steps)});
    }
    all.push_back({.leg = Leg::energy, .method = name(Leg::energy)});
    all.push_back({.leg = Leg::equilibrium, .method = name(Leg::equilibrium), .again = true});
    return all;
}

// ---- ranking

void rank(Trade& trade) {
    const double least = share_of(trade.tolerance, trade.uncertainty);
    for (auto& point : trade.points) {
        point.share = share_of(trade.tolerance, point.error);
        if (point.again)
            point.not_ranked = "the same leg again: noise of the time";
        else if (point.leg == Leg::equilibrium)
            point.not_ranked = "what errors are read from";
        else if (point.outcome != Outcome::converged)
            point.not_ranked = name(point.outcome);
        else if (!std::isfinite(point.share))
            point.not_ranked = "no number";
        else if (!(point.share > least))
            point.not_ranked = "below the reference uncertainty";
        point.ranked = point.not_ranked.empty();
    }
    const auto price = [](const TradePoint& point, std::size_t kind) {
        return kind == 0   ? static_cast<double>(point.work.solves)
               : kind == 1 ? static_cast<double>(point.work.factorisations + point.work.evaluations)
                           : point.ratio;
    };
    for (std::size_t kind = 0; kind < 3; ++kind) {
        std::vector<WorkError> flat;
        for (const auto& point : trade.points)
            flat.push_back({price(point, kind), point.ranked ? point.share : nan});
        const auto front = pareto_front(flat);
        for (std::size_t k = 0; k < front.size(); ++k) trade.points[k].on_front[kind] = front[k];
    }
}

// ---- recommendation

bool good_enough(const Trade& trade, const Accuracy& error) {
    return within(share_of(trade.tolerance, plus(error, trade.uncertainty)), 1);
}

bool same_ladder(const TradePoint& a, const TradePoint& b) {
    return a.leg == b.leg && a.method == b.method && a.again == b.again;
}

// Told more than is asked for, a method is good enough by luck.
bool told_enough(const Trade& trade, const TradePoint& point) {
    const double deg = in_unit(Unit::deg) * angle_per_length * point.own_tolerance;
    return 1e3 * point.own_tolerance <= trade.tolerance.mm && deg <= trade.tolerance.deg;
}

// Good enough, and so is everything finer of the same method: what is good by two errors that cancel, or at
// steps too few to show that the method is unstable, is good by luck.
bool eligible(const Trade& trade, std::size_t k) {
    if (trade.points[k].again || !told_enough(trade, trade.points[k])) return false;
    for (std::size_t finer = k;
         finer < trade.points.size() && same_ladder(trade.points[k], trade.points[finer]); ++finer) {
        const TradePoint& point = trade.points[finer];
        if (point.outcome != Outcome::converged || !good_enough(trade, point.error)) return false;
    }
    return true;
}

// By price; of equals the first, since every ladder begins with its loosest rung.
std::optional<std::size_t> cheapest(const Trade& trade, const std::vector<std::size_t>& candidates) {
    const auto price = [&](std::size_t k) { return trade.points[k].work.price; };
    const auto best = std::ranges::min_element(candidates, {}, price);
    if (best == candidates.end()) return std::nullopt;
    return *best;
}

// Between the rungs h/2 and 2h a law C·h^p puts the geometric mean at the middle one; at an end of the ladder
// the two next rungs say where it ought to be. By this factor the law misses, and by as much the error may be
// elsewhere. The band also holds what the confirming run found.
double misfit(double error, double neighbour, double other, bool between) {
    const double expected = between ? std::sqrt(neighbour * other) : neighbour * neighbour / other;
    return std::max(error / expected, expected / error);
}

void band(const Trade& trade, Recommendation& found) {
    const auto k = static_cast<std::ptrdiff_t>(found.point);
    const Accuracy &e = trade.points[found.point].error, &u = trade.uncertainty;
    found.expected = e;
    const auto usable = [&](std::ptrdiff_t i) {
        return i >= 0 && i < static_cast<std::ptrdiff_t>(trade.points.size()) &&
               same_ladder(trade.points[found.point], trade.points[static_cast<std::size_t>(i)]) &&
               trade.points[static_cast<std::size_t>(i)].ranked;
    };
    std::ptrdiff_t a = k, b = k;
    if (!trade.points[found.point].ranked)
        found.band_from = "below the reference uncertainty: only that is known";
    else if (usable(k - 1) && usable(k + 1))
        a = k - 1, b = k + 1, found.band_from = "from the rungs on either side";
    else if (usable(k + 1) && usable(k + 2))
        a = k + 1, b = k + 2, found.band_from = "from the two finer rungs";
    else if (usable(k - 1) && usable(k - 2))
        a = k - 1, b = k - 2, found.band_from = "from the two coarser rungs";
    else
        found.band_from = "no two neighbouring rungs above the reference uncertainty: only that is known";
    const auto one = [&](double Accuracy::*unit) {
        double factor = 1;
        if (a != b)
            factor = misfit(e.*unit, trade.points[static_cast<std::size_t>(a)].error.*unit,
                            trade.points[static_cast<std::size_t>(b)].error.*unit, a == k - 1 && b == k + 1);
        if (!std::isfinite(factor)) factor = 1;
        found.low.*unit = std::max(0.0, e.*unit / factor - u.*unit);
        found.high.*unit = std::max(e.*unit * factor, found.confirmed.*unit) + u.*unit;
    };
    one(&Accuracy::mm);
    one(&Accuracy::deg);
}

// Run again, at output points it was not chosen by: finer ones, and those of a branch that ends half a step
// earlier, against a reference that gets there by thirds of its steps.
Accuracy confirm(const Model& model, const std::vector<Channel>& channels, const TradePoint& point,
                 int points, int& compared) {
    int finer = 7;  // output points for one
    if (point.steps > 0) {
        finer = 1;
        while (2 * finer * points <= std::min(point.steps, 100)) finer *= 2;
    }
    const TradePoint reference{.leg = point.leg == Leg::equilibrium ? Leg::energy : Leg::equilibrium};
    const auto main = std::ranges::count_if(channels, &Channel::main);
    Accuracy worst;
    for (const auto& branch : model.branches)
        for (const double end : {1.0, 1 - 0.5 / (point.steps > 0 ? point.steps : finer * points)}) {
            Branch shorter = branch;
            shorter.to *= end;
            shorter.from *= end;
            const auto ways = refined(ways_of(model, shorter, points), finer);
            const Curve truth = curve_of(model, channels, shorter,
                                         walk(refined(ways, 3), gait_of(reference, points))),
                        found =
                            curve_of(model, channels, shorter, walk(ways, gait_of(point, finer * points)));
            worst = worse(worst, distance(channels, every(truth, 3), found));
            compared += static_cast<int>(main) * static_cast<int>(found.a.size());
        }
    return worst;
}

void recommend(const Model& model, const std::vector<Channel>& channels, Trade& trade) {
    std::vector<std::size_t> candidates;
    for (std::size_t k = 0; k < trade.points.size(); ++k)
        if (eligible(trade, k)) candidates.push_back(k);
    while (const auto k = cheapest(trade, candidates)) {
        Recommendation found;
        found.point = *k;
        found.confirmed =
            confirm(model, channels, trade.points[*k], trade.points_per_branch, found.confirmed_numbers);
        band(trade, found);
        const bool holds = found.confirmed_numbers > 0 && good_enough(trade, found.confirmed);
        if (holds && good_enough(trade, found.high)) {
            trade.recommendation = found;
            return;
        }
        const Accuracy& worst = holds ? found.high : found.confirmed;
        trade.rejected.push_back(fmt::format(
            "{}: {}{:.3g} mm and {:.3g} deg{}", describe(trade.points[*k]), holds ? "up to " : "", worst.mm,
            worst.deg, holds ? ", as far as its rungs obey their law" : " when run again"));
        std::erase(candidates, *k);
    }
}

}  // namespace

Tolerance parse_tolerance(std::string_view text, Asks asks) {
    const bool forces = asks == Asks::forces_too;
    const auto refuse = [&](std::string_view why) {
        throw std::invalid_argument(fmt::format(
            "tolerance '{}': {}; allowed: {}, each above 0, such as 0.01mm,0.001deg{}", text, why,
            forces ? "a length in mm, an angle in deg, a force in N, a moment in Nm, or some of these"
                   : "a length in mm, an angle in deg or both",
            forces ? ",1N" : ""));
    };
    const auto trim = [](std::string_view word) {
        while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
        while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
        return word;
    };
    Tolerance result;
    const std::pair<std::string_view, double*> known[] = {
        {"mm", &result.mm}, {"deg", &result.deg}, {"N", &result.newton}, {"Nm", &result.newton_metre}};
    for (std::string_view rest = text;;) {
        const auto comma = rest.find(',');
        const std::string_view word = trim(rest.substr(0, comma));
        if (word.empty()) refuse("a number with its unit is missing");
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error == std::errc::invalid_argument)
            refuse(fmt::format("'{}' does not begin with a number", word));
        if (error != std::errc{} || !std::isfinite(value) || !(value > 0))
            refuse(fmt::format("'{}' is not a finite number above 0", word));
        const std::string_view unit = trim(word.substr(static_cast<std::size_t>(end - word.data())));
        const auto* const of = std::ranges::find(known, unit, [](const auto& entry) { return entry.first; });
        if (of >= known + (forces ? 4 : 2))
            refuse(unit.empty() ? fmt::format("'{}' has no unit", word)
                                : fmt::format("'{}' is not a unit of it", unit));
        if (std::isfinite(*of->second)) refuse(fmt::format("{} is given twice", unit));
        *of->second = value;
        if (comma == rest.npos) return result;
        rest.remove_prefix(comma + 1);
    }
}

double share_of(const Tolerance& tolerance, const Accuracy& error) {
    // What is not asked for does not count, whatever it is, but for a NaN.
    const double mm = std::isinf(tolerance.mm) ? 0 * error.mm : error.mm / tolerance.mm;
    const double deg = std::isinf(tolerance.deg) ? 0 * error.deg : error.deg / tolerance.deg;
    return worse(mm, deg);
}

Gait gait_of(const TradePoint& point, int points) {
    Gait gait{.leg = point.leg};
    if (point.leg != Leg::recursive) return gait;
    gait.recursion.method = *recursive::find_method(point.method);
    std::visit(overloaded{[&](const recursive::Linear&) { gait.refine = point.steps / points; },
                          [&](const recursive::Consistent&) { gait.refine = point.steps / points; },
                          [&](recursive::Adaptive& adaptive) {
                              adaptive.length_tolerance = point.own_tolerance;
                              adaptive.angle_tolerance = angle_per_length * point.own_tolerance;
                          },
                          [&](recursive::Series& series) { series.tolerance = point.own_tolerance; }},
               gait.recursion.method.kind);
    return gait;
}

std::string describe(const TradePoint& point) {
    if (point.leg != Leg::recursive)
        return fmt::format("{} leg{}", name(point.leg), point.again ? " again" : "");
    if (point.steps == 0) return fmt::format("{} at {:.0e} m", point.method, point.own_tolerance);
    return fmt::format("{}, {} steps", point.method, point.steps);
}

std::vector<bool> pareto_front(std::span<const WorkError> points) {
    const auto finite = [](const WorkError& p) { return std::isfinite(p.work) && std::isfinite(p.error); };
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
    if (options.points < 1 || options.rounds < 0)
        throw std::invalid_argument("trade: points must be positive and rounds not negative");
    const auto tell = [&](std::string_view what) {
        if (options.progress) options.progress(what);
    };
    const auto all_channels = channels(model);
    Trade result;
    result.points_per_branch = options.points;
    result.rounds = options.rounds;
    for (const auto& channel : all_channels)
        result.angles = result.angles || (channel.main && channel.unit == Unit::deg);
    result.tolerance = options.tolerance;
    if (!result.angles) result.tolerance.deg = std::numeric_limits<double>::infinity();

    if (model.branches.empty()) result.inconclusive.push_back("the scene has no branch");
    if (std::isinf(result.tolerance.mm) && std::isinf(result.tolerance.deg))
        result.inconclusive.push_back("only an angle is asked for, and the scene has none");
    if (!result.inconclusive.empty()) return result;

    std::vector<std::vector<Way>> ways;
    std::vector<Curve> truth;
    for (const auto& branch : model.branches) {
        tell(fmt::format("{}: the references", branch.name));
        ways.push_back(ways_of(model, branch, options.points));
        References known = references(model, all_channels, branch, ways.back());
        for (const auto& why : known.failures)
            result.inconclusive.push_back(fmt::format("{}: {}", branch.name, why));
        result.uncertainty = worse(result.uncertainty, known.uncertainty);
        truth.push_back(known.truth_ended == Outcome::converged ? std::move(known.truth) : Curve{});
    }

    result.points = configurations(model, options);
    const double unknowns = coordinates(model) + constraint_rows(model);
    std::vector<std::function<void()>> jobs;
    std::vector<std::size_t> timed;
    for (std::size_t k = 0; k < result.points.size(); ++k) {
        TradePoint& point = result.points[k];
        tell(describe(point));
        for (std::size_t b = 0; b < model.branches.size(); ++b) {
            const auto path = walk(ways[b], gait_of(point, options.points));
            point.work.solves += path.counts.iterations;
            point.work.factorisations += path.counts.factorisations;
            point.work.evaluations += path.counts.evaluations;
            point.error = worse(
                point.error,
                distance(all_channels, truth[b], curve_of(model, all_channels, model.branches[b], path)));
            if (path.outcome != Outcome::converged && point.outcome == Outcome::converged) {
                point.outcome = path.outcome;
                point.detail = path.detail;
            }
        }
        point.work.price = unknowns / 3 * static_cast<double>(point.work.factorisations) +
                           static_cast<double>(point.work.solves + point.work.evaluations);
        if (point.outcome != Outcome::converged) continue;
        timed.push_back(k);
        jobs.emplace_back([&ways, &options, point] {
            for (const auto& way : ways) (void)walk(way, gait_of(point, options.points));
        });
    }

    if (options.rounds > 0 && result.points.front().outcome == Outcome::converged) {
        tell("times");
        const Times times = take_turns(jobs, options.rounds);
        for (std::size_t j = 0; j < timed.size(); ++j) {
            TradePoint& point = result.points[timed[j]];
            point.work.seconds = median(times[j]);
            point.ratio = median(ratios(times[j], times.front()));
        }
        result.noise = noise_of(ratios(times.back(), times.front()));
    }
    rank(result);
    tell("the recommendation, again");
    if (result.inconclusive.empty()) recommend(model, all_channels, result);
    return result;
}

}  // namespace elastocheck::compare
