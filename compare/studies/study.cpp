#include "compare/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "compare/deviation/agreement.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/branch.hpp"

namespace elastocheck::compare {
namespace {

constexpr double round_off = 1e-9;     // smaller differences are rounding [mm, deg]
constexpr int stations = 30;           // points of a branch at which curves are compared
constexpr int reference_points = 300;  // points of a branch at which the references are solved

// Abscissa x of a curve: its parameter, or the values of a channel (`x_channel`).
constexpr int parameter = -1;
std::vector<double> x_values(const Curve& curve, int x_channel) {
    return x_channel == parameter ? curve.a : curve.channel(static_cast<std::size_t>(x_channel));
}

// Range of x that every curve reaches, in the direction of the curves.
struct Span {
    double from = nan, to = nan;
};
Span common_span(int x_channel, const std::vector<const Curve*>& curves) {
    Span span;
    for (const Curve* curve : curves) {
        const auto x = x_values(*curve, x_channel);
        const bool up = x.back() > x.front();
        const auto farther = [&](double a, double b) { return up ? a > b : a < b; };
        if (std::isnan(span.from) || farther(x.front(), span.from)) span.from = x.front();
        if (std::isnan(span.to) || farther(span.to, x.back())) span.to = x.back();
    }
    return span;
}

// Values of a channel at the equally spaced stations 1 ... S of the span, interpolated with degree 5.
std::vector<double> values_at_stations(const Curve& curve, std::size_t channel, int x_channel,
                                       const Span& span) {
    const auto x = x_values(curve, x_channel), y = curve.channel(channel);
    std::vector<double> values;
    for (int s = 1; s <= stations; ++s)
        values.push_back(
            s == stations && x.back() == span.to
                ? y.back()
                : interpolate(x, y, span.from + (span.to - span.from) * s / stations, 6));
    return values;
}

// The channel in which all curves are monotonic, or the reason why there is none.
Abscissa common_abscissa(const std::vector<Channel>& channels,
                         const std::vector<const Curve*>& curves) {
    const int x_channel = default_abscissa(channels, *curves.front());
    for (const Curve* curve : curves)
        if (const Abscissa candidate = abscissa(channels, x_channel, *curves.front(), *curve);
            !candidate.why_not.empty())
            return candidate;
    return {x_channel, ""};
}

double rms(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return values.empty() ? nan : std::sqrt(sum / static_cast<double>(values.size()));
}
// Largest |value|; NaN if any value is NaN.
double largest(const std::vector<double>& values) {
    double worst = 0;
    for (const double v : values) {
        if (std::isnan(v)) return nan;
        worst = std::max(worst, std::abs(v));
    }
    return worst;
}
std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> d;
    for (std::size_t k = 0; k < a.size(); ++k) d.push_back(a[k] - b[k]);
    return d;
}

// Station at which the last refinement changes the value most: there the leading term of the error
// is largest, while at coarse levels the next one may be.
std::size_t station_of_largest_change(const std::vector<std::vector<double>>& levels) {
    const auto changes = difference(levels[levels.size() - 2], levels.back());
    return static_cast<std::size_t>(
        std::ranges::max_element(changes, {}, [](double e) { return std::abs(e); }) -
        changes.begin());
}

// Convergence of the value at one station. `formal`: formal order; `reference`: uncertainty of the reference.
StepConvergence convergence_at(const std::vector<int>& steps,
                               const std::vector<std::vector<double>>& levels, std::size_t station,
                               double formal, double reference) {
    std::vector<Level> sequence;
    for (std::size_t l = 0; l < levels.size(); ++l)
        sequence.push_back({static_cast<double>(steps[l]), levels[l][station]});
    return step_convergence(sequence, formal, {round_off, reference});
}

// Own limit at every station: its Richardson limit where the sequence converges there, else the
// finest value. Where the coefficient C(a) of the error C h^p crosses zero along the branch, the
// next term sets the observed order, which is no basis for an extrapolation. So at stations whose
// order is not p, that of the station with the largest error (the formal one where it agrees), the
// two finest levels v and w, h_v = r h_w, give the limit:  w + (w - v) / (r^p - 1).
std::vector<double> own_limit(const std::vector<int>& steps,
                              const std::vector<std::vector<double>>& levels, double formal) {
    const auto leading =
        convergence_at(steps, levels, station_of_largest_change(levels), formal, 0);
    const double p = leading.as_formal ? formal : leading.order;
    const auto& finest = levels.back();
    const auto& second_finest = levels[levels.size() - 2];
    const double r = static_cast<double>(steps.back()) / steps[steps.size() - 2];
    std::vector<double> limit;
    for (std::size_t s = 0; s < finest.size(); ++s) {
        const auto c = convergence_at(steps, levels, s, formal, 0);
        const bool converges = c.behaviour == Behaviour::converging;
        const bool has_order_p = leading.behaviour != Behaviour::converging ||
                                 agrees_with_formal(c.order, c.order_error, p);
        limit.push_back(!converges ? finest[s]
                        : has_order_p
                            ? c.limit
                            : finest[s] + (finest[s] - second_finest[s]) / (std::pow(r, p) - 1));
    }
    return limit;
}

// Order of the largest step error over the branch. The value at the end is no measure of it: where
// the coefficient of the leading error term crosses zero there, the next term sets its order.
void add_order(ChannelStudy& study, const std::vector<int>& steps,
               const std::vector<std::vector<double>>& levels, double formal) {
    // The error at the end counts as zero below this share of the largest error, if that exceeds this multiple of
    // rounding.
    constexpr double small_share = 0.1, rounding_factor = 10;
    std::vector<Level> errors;
    for (std::size_t l = 0; l < levels.size(); ++l) {
        const auto N = static_cast<double>(steps[l]);
        errors.push_back({N, study.step_error_max[l]});
        study.zero_at_end = study.zero_at_end ||
                            (errors.back().value > rounding_factor * round_off &&
                             std::abs(study.step_error_end[l]) < small_share * errors.back().value);
    }
    study.behaviour =
        convergence_at(steps, levels, station_of_largest_change(levels), formal, study.uncertainty)
            .behaviour;
    if (study.behaviour != Behaviour::converging) return;
    study.order = asymptotic_order_of(errors, rounding_factor * round_off);
    study.as_formal = agrees_with_formal(study.order.order, study.order.order_error, formal);
}

ChannelStudy study_channel(const StudiedLevels& levels, std::size_t channel, int x_channel,
                           const Span& span) {
    const auto& [steps, curves, references, formal] = levels;
    ChannelStudy result;
    const auto truth = values_at_stations(references.truth.curve, channel, x_channel, span);
    result.uncertainty = largest(
        difference(values_at_stations(references.other.curve, channel, x_channel, span), truth));
    const auto [low, high] = std::ranges::minmax(truth);
    const double start = references.truth.curve.values.front()[channel];
    result.range = std::max(high, start) - std::min(low, start);

    std::vector<std::vector<double>> values;
    for (const auto& curve : curves)
        values.push_back(values_at_stations(curve, channel, x_channel, span));
    result.end = convergence_at(steps, values, stations - 1, formal, result.uncertainty);
    const auto limit = own_limit(steps, values, formal);
    if (result.end.behaviour == Behaviour::converging && result.end.limit != limit.back()) {
        result.end.band = std::max(result.end.band, std::abs(result.end.limit - limit.back()));
        result.end.limit = limit.back();
    }
    for (const auto& level : values) {
        const auto error = difference(level, limit);
        result.step_error_end.push_back(error.back());
        result.step_error_max.push_back(largest(error));
        result.step_error_rms.push_back(rms(error));
    }
    add_order(result, steps, values, formal);
    const auto gap = difference(limit, truth);
    result.gap = gap.back();
    result.gap_max = largest(gap);
    result.gap_rms = rms(gap);
    std::vector<Level> growth;  // gap over the far half of the branch, where it is largest
    for (int s = stations / 2; s < stations; ++s)
        growth.push_back({static_cast<double>(s + 1), gap[static_cast<std::size_t>(s)]});
    const double floor = std::max({10 * result.end.band, 10 * result.uncertainty, 10 * round_off});
    result.gap_exponent = result.gap_max > floor ? -order_of(growth, floor).order : nan;
    return result;
}

std::vector<std::size_t> main_channels(const std::vector<Channel>& all) {
    std::vector<std::size_t> list;
    for (std::size_t c = 0; c < all.size(); ++c)
        if (all[c].main) list.push_back(c);
    return list;
}

std::vector<StudiedSide> studied_sides(Solves& solves, const std::vector<int>& steps, int threads,
                                       const Progress& progress) {
    std::vector<StudiedSide> sides;
    for (std::size_t b = 0; b < solves.model.branches.size(); ++b) {
        if (solves.finest == 1) {
            std::ranges::move(sides_with_steps(solves.model, solves.model.branches[b], steps),
                              std::back_inserter(sides));
            continue;
        }
        for (const auto& base : solves.sides[b]) {
            StudiedSide& side = sides.emplace_back(StudiedSide{base});
            for (const int N : steps) side.steps.push_back(N / solves.base * base.branch.steps);
        }
    }
    std::vector<Job> jobs;
    for (auto& side : sides)
        jobs.push_back({fmt::format("{}: references", side.name),
                        [&] { side.known = references_on_side(solves, side, solves.finest); }});
    run_jobs(jobs, threads, progress);
    return sides;
}

// Curve of a method with `steps` steps of the side. It is recorded at the points that the studies share, else
// at every step.
PathCurve level_of(Solves& solves, const StudiedSide& side, const recursive::Method& method,
                   int steps) {
    if (solves.finest > 1) return solved(solves, side, method, steps / side.branch.steps);
    BranchSide level = side;
    level.branch.steps = steps;
    return solve_branch(solves.model, solves.channels, level.branch, {level},
                        {.recursion = {.method = method}});
}

// Study of one method with all step counts on one branch side.
MethodStudy study_method(Solves& solves, const StudiedSide& side, const recursive::Method& method) {
    MethodStudy study;
    study.method = method.name;
    std::vector<Curve> levels;
    std::vector<Level> constraint_errors;
    for (const int N : side.steps) {
        PathCurve path = level_of(solves, side, method, N);
        study.outcomes.push_back(path.outcome);
        if (path.outcome != Outcome::converged) {
            study.not_studied = fmt::format("with {} steps: {}: {}", N,
                                            elastocheck::name(path.outcome), path.detail);
            study.constraint_error.push_back(nan);
            continue;
        }
        study.constraint_error.push_back(path.constraint_error.back());
        constraint_errors.push_back({static_cast<double>(N), study.constraint_error.back()});
        levels.push_back(std::move(path.curve));
    }
    study.constraint_order = order_of(constraint_errors, 1e-12);
    if (!study.not_studied.empty()) return study;

    const double formal_order = std::max(method.formal_order, 1.0);
    study_levels(study, solves.channels, main_channels(solves.channels),
                 {side.steps, levels, side.known, formal_order});
    return study;
}

}  // namespace

std::vector<Channel> motion(const Model& model) {
    auto list = channels(model);
    std::erase_if(list, [](const Channel& channel) { return !channel.kinematic(); });
    return list;
}

std::vector<StudiedSide> sides_with_steps(const Model& model, const Branch& branch,
                                          const std::vector<int>& steps) {
    std::vector<StudiedSide> result;
    for (auto& side : sides_of(model, branch, reference_points))
        result.push_back({std::move(side)});
    for (const int N : steps) {
        Branch with_steps = branch;
        with_steps.steps = N;
        const auto parts = branch_sides(with_steps);
        for (std::size_t w = 0; w < parts.size(); ++w) result[w].steps.push_back(parts[w].steps);
    }
    return result;
}

StudiedBranch studied_branch(const BranchSide& side, const std::vector<Channel>& all,
                             const Curve& truth) {
    const int x_channel = truth.values.empty() ? -1 : default_abscissa(all, truth);
    return {side.name, side.branch.name, unit_of(side.branch.unit),
            x_channel < 0 ? "" : all[static_cast<std::size_t>(x_channel)].name};
}

void study_levels(MethodStudy& study, const std::vector<Channel>& all,
                  const std::vector<std::size_t>& studied, const StudiedLevels& levels) {
    std::vector<const Curve*> curves{&levels.references.truth.curve,
                                     &levels.references.other.curve};
    for (const auto& curve : levels.curves) curves.push_back(&curve);
    const auto read = [&](int x_channel, std::vector<ChannelStudy>& reading) {
        const Span span = common_span(x_channel, curves);
        for (const std::size_t c : studied)
            reading.push_back(study_channel(levels, c, x_channel, span));
    };
    read(parameter, study.equal_parameter);
    const Abscissa x = common_abscissa(all, curves);
    study.no_abscissa = x.why_not;
    if (x.why_not.empty()) read(x.channel, study.equal_abscissa);
}

std::vector<std::string> unfit(const References& known, const std::string& side) {
    std::vector<std::string> reasons;
    for (const auto& why : known.failures) reasons.push_back(fmt::format("{}: {}", side, why));
    if (!reasons.empty()) return reasons;
    const Bounds bounds = bounds_of({}, known.scale);
    if (!(known.uncertainty.mm <= bounds.length && known.uncertainty.deg <= bounds.angle))
        reasons.push_back(fmt::format(
            "{}: the references are {:.2g} mm and {:.2g} deg apart, at most {:.2g} mm and {:.2g} "
            "deg are "
            "allowed",
            side, known.uncertainty.mm, known.uncertainty.deg, bounds.length, bounds.angle));
    return reasons;
}

bool Study::conclusive() const {
    if (!inconclusive.empty()) return false;
    for (const auto& branch : branches)
        for (const auto& method : branch.methods)
            if (!method.equal_parameter.empty()) return true;
    return false;
}

Study study(Solves& solves, const StudyOptions& options) {
    if (options.steps.size() < 5 || options.steps.front() < 1 ||
        std::ranges::adjacent_find(options.steps, std::greater_equal<>{}) != options.steps.end())
        throw std::invalid_argument(
            "step counts: at least five are needed, positive and increasing");
    Study result;
    result.steps = options.steps;
    const auto& channels = solves.channels;
    for (const std::size_t c : main_channels(channels)) result.channels.push_back(channels[c]);

    auto sides =
        studied_sides(solves, options.steps, options.threads, part(options.progress, 0, 0.3));
    std::vector<recursive::Method> methods = options.methods;
    std::erase_if(methods, [](const auto& method) { return !recursive::has_steps(method); });
    std::erase_if(sides, [&](const StudiedSide& side) {
        std::ranges::move(unfit(side.known, side.name), std::back_inserter(result.inconclusive));
        if (!side.known.failures.empty()) return true;
        const bool has_equal_steps =
            std::ranges::adjacent_find(side.steps, std::greater_equal<>{}) != side.steps.end();
        if (has_equal_steps)
            result.inconclusive.push_back(
                fmt::format("{}: its share of the steps is too small for levels", side.name));
        return has_equal_steps;
    });
    std::vector<Job> jobs;
    for (const auto& side : sides)
        result.branches.push_back({studied_branch(side, channels, side.known.truth.curve),
                                   side.steps, std::vector<MethodStudy>(methods.size())});
    for (std::size_t b = 0; b < sides.size(); ++b)
        for (std::size_t m = 0; m < methods.size(); ++m)
            jobs.push_back({fmt::format("{}: {}", sides[b].name, methods[m].name), [&, b, m] {
                                result.branches[b].methods[m] =
                                    study_method(solves, sides[b], methods[m]);
                            }});
    run_jobs(jobs, options.threads, part(options.progress, 0.3, 1));
    return result;
}

Study study(const Model& model, const StudyOptions& options) {
    Solves solves(model, reference_points);
    return study(solves, options);
}

namespace {

// The gap between the limit of a method and the references is attributed to three forces that do not follow the
// motion. The gap is computed with every combination of forces that follow: bit 0 the lever, 1 the axis, 2 the
// load.
constexpr unsigned combinations = 8;

BranchAttribution attribute_side(Solves& solves, const StudiedSide& side) {
    const auto& channels = solves.channels;
    const auto& steps = side.steps;
    const References& known = side.known;
    BranchAttribution attribution{
        studied_branch(side, channels, known.failures.empty() ? known.truth.curve : Curve{})};
    if (!known.failures.empty()) {
        attribution.not_attributed = known.failures.front();
        return attribution;
    }
    std::vector<std::vector<Curve>> levels(combinations);
    std::vector<const Curve*> curves{&known.truth.curve, &known.other.curve};
    for (unsigned bits = 0; bits < combinations; ++bits) {
        const recursive::Method method{
            .kind =
                recursive::Linear{.stored = {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0}}};
        for (const int N : steps) {
            PathCurve path = level_of(solves, side, method, N);
            if (path.outcome != Outcome::converged) {
                attribution.not_attributed = fmt::format(
                    "with {} steps: {}: {}", N, elastocheck::name(path.outcome), path.detail);
                return attribution;
            }
            levels[bits].push_back(std::move(path.curve));
        }
    }
    for (const auto& combination : levels)
        for (const auto& level : combination) curves.push_back(&level);

    const auto read = [&](int x_channel, std::vector<GapShare>& reading) {
        const Span span = common_span(x_channel, curves);
        for (const std::size_t c : main_channels(channels)) {
            GapShare share;
            for (unsigned bits = 0; bits < combinations; ++bits) {
                const auto channel_study =
                    study_channel({steps, levels[bits], known, 1}, c, x_channel, span);
                share.combinations.push_back(channel_study.gap);
                // At the round-off floor the limit is the finest value; without a convergence
                // estimate the spread is the band.
                const double spread = std::abs(channel_study.step_error_end.front() -
                                               channel_study.step_error_end.back());
                share.band = std::max(
                    share.band,
                    (std::isnan(channel_study.end.band) ? spread : channel_study.end.band) +
                        channel_study.uncertainty);
            }
            const auto& g = share.combinations;
            // Shapley value, the mean decrease of the gap over the six orders in which the three are added: first
            // (1/3), after one of the others (1/6 each), last (1/3).
            const auto effect = [&](unsigned term) {
                const unsigned a = 1u << ((term + 1) % 3), b = 1u << ((term + 2) % 3),
                               t = 1u << term;
                return (g[0] - g[t]) / 3 + (g[a] - g[a | t] + g[b] - g[b | t]) / 6 +
                       (g[a | b] - g[7]) / 3;
            };
            share.whole = g[0];
            share.lever = effect(0);
            share.axis = effect(1);
            share.load = effect(2);
            share.rest = g[7];
            reading.push_back(share);
        }
    };
    read(parameter, attribution.equal_parameter);
    const Abscissa x = common_abscissa(channels, curves);
    attribution.no_abscissa = x.why_not;
    if (x.why_not.empty()) read(x.channel, attribution.equal_abscissa);
    return attribution;
}

}  // namespace

std::vector<BranchAttribution> attribute_gap(Solves& solves, const std::vector<int>& steps,
                                             int threads, const Progress& progress) {
    const auto sides = studied_sides(solves, steps, threads, part(progress, 0, 0.3));
    std::vector<BranchAttribution> result(sides.size());
    std::vector<Job> jobs;
    for (std::size_t b = 0; b < sides.size(); ++b)
        jobs.push_back({fmt::format("{}: gap attribution", sides[b].name),
                        [&, b] { result[b] = attribute_side(solves, sides[b]); }});
    run_jobs(jobs, threads, part(progress, 0.3, 1));
    return result;
}

std::vector<BranchAttribution> attribute_gap(const Model& model, int threads,
                                             const Progress& progress) {
    Solves solves(model, reference_points);
    return attribute_gap(solves, {300, 600, 1200, 2400}, threads, progress);
}

}  // namespace elastocheck::compare
