#include "compare/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/deviation.hpp"
#include "recursive/solve.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double round_off = 1e-9;  // [mm], [deg]: differences below are the arithmetic's
constexpr int stations = 30;        // along a branch, where curves are read
constexpr int reference_points = 300;
constexpr double agreement = 1e-6;  // [mm], [deg]: of the references

enum class Abscissa { load, travel };

// One channel of a curve at equally spaced stations 1 ... S of `abscissa` up to `end`.
std::vector<double> at_stations(const Curve& curve, std::size_t channel, Abscissa abscissa, double end) {
    const auto& x = abscissa == Abscissa::load ? curve.load : curve.travel;
    std::vector<double> y, values;
    for (const auto& point : curve.values) y.push_back(point[channel]);
    for (int s = 1; s <= stations; ++s)
        values.push_back(s == stations && x.back() == end ? y.back()
                                                          : interpolate(x, y, end * s / stations, 6));
    return values;
}

bool strictly_monotone(const std::vector<double>& x) {
    if (x.size() < 2) return false;
    const bool up = x[1] > x[0];
    return std::ranges::adjacent_find(x, [&](double a, double b) { return up ? !(b > a) : !(b < a); }) ==
           x.end();
}

// The largest travel that every curve reaches, or the load at the end; NaN where travel cannot be read.
double common_end(Abscissa abscissa, const std::vector<const Curve*>& curves) {
    if (abscissa == Abscissa::load) return curves.front()->load.back();
    double end = nan;
    for (const Curve* curve : curves) {
        if (curve->travel.empty() || !strictly_monotone(curve->travel)) return nan;
        const double reached = curve->travel.back();
        if (std::isnan(end) || std::abs(reached) < std::abs(end)) end = reached;
    }
    return end;
}

struct References {
    Curve equilibrium, energy;
    std::string failure;
};

References solve_references(const Model& model, const Branch& branch) {
    std::vector<double> loads;
    for (int k = 0; k <= reference_points; ++k) loads.push_back(branch.to * k / reference_points);
    References references;
    const auto first = reference::equilibrium::solve(model, branch, loads);
    const auto second = reference::energy::solve(model, branch, loads);
    for (const auto& [leg, path] : {std::pair{"equilibrium", &first}, {"energy", &second}})
        if (path->outcome != Outcome::converged)
            references.failure =
                fmt::format("{} leg: {}: {}", leg, elastocheck::name(path->outcome), path->detail);
    references.equilibrium = curve(model, branch, first.points);
    references.energy = curve(model, branch, second.points);
    return references;
}

double rms(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return values.empty() ? nan : std::sqrt(sum / static_cast<double>(values.size()));
}
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

// The own limit at every station: Richardson's, of its own where the sequence there converges, else the
// finest value.
std::vector<double> own_limit(const std::vector<int>& steps, const std::vector<std::vector<double>>& levels,
                              double formal) {
    std::vector<double> limit;
    for (std::size_t s = 0; s < levels.front().size(); ++s) {
        std::vector<Level> sequence;
        for (std::size_t l = 0; l < levels.size(); ++l)
            sequence.push_back({static_cast<double>(steps[l]), levels[l][s]});
        const auto c = step_convergence(sequence, formal, {round_off, 0});
        limit.push_back(c.behaviour == Behaviour::converging ? c.limit : levels.back()[s]);
    }
    return limit;
}

ChannelStudy study_channel(const std::vector<int>& steps, const std::vector<Curve>& levels,
                           const References& references, std::size_t channel, double formal,
                           Abscissa abscissa, double end) {
    ChannelStudy result;
    const auto truth = at_stations(references.equilibrium, channel, abscissa, end);
    result.uncertainty = largest(difference(at_stations(references.energy, channel, abscissa, end), truth));
    const auto [low, high] = std::ranges::minmax(truth);
    const double start = references.equilibrium.values.front()[channel];
    result.range = std::max(high, start) - std::min(low, start);

    std::vector<std::vector<double>> values;
    std::vector<Level> sequence;
    for (std::size_t l = 0; l < levels.size(); ++l) {
        values.push_back(at_stations(levels[l], channel, abscissa, end));
        sequence.push_back({static_cast<double>(steps[l]), values.back().back()});
    }
    result.end = step_convergence(sequence, formal, {round_off, result.uncertainty});
    const auto limit = own_limit(steps, values, formal);
    for (const auto& level : values) {
        const auto error = difference(level, limit);
        result.step_error_end.push_back(error.back());
        result.step_error_max.push_back(largest(error));
        result.step_error_rms.push_back(rms(error));
    }
    const auto gap = difference(limit, truth);
    result.gap = gap.back();
    result.gap_max = largest(gap);
    result.gap_rms = rms(gap);
    std::vector<Level> growth;  // of the far half, where it is largest
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

}  // namespace

bool Study::conclusive() const {
    if (!inconclusive.empty()) return false;
    for (const auto& branch : branches)
        for (const auto& method : branch.methods)
            if (!method.equal_load.empty()) return true;
    return false;
}

Study study(const Model& model, const StudyOptions& options) {
    if (options.steps.size() < 5 || options.steps.front() < 1 ||
        std::ranges::adjacent_find(options.steps, std::greater_equal<>{}) != options.steps.end())
        throw std::invalid_argument("step counts: at least five are needed, positive and increasing");
    Study result;
    result.steps = options.steps;
    const auto all = channels(model);
    const auto shown = main_channels(all);
    for (const std::size_t c : shown) result.channels.push_back(all[c]);

    for (const auto& branch : model.branches) {
        if (options.progress) options.progress(fmt::format("{}: references", branch.name));
        const References references = solve_references(model, branch);
        if (!references.failure.empty()) {
            result.inconclusive.push_back(fmt::format("{}: {}", branch.name, references.failure));
            continue;
        }
        BranchStudy b{branch.name, {}};
        for (const auto& method : options.methods) {
            if (!recursive::has_steps(method)) continue;  // has no step count
            MethodStudy m;
            m.method = method.name;
            std::vector<Curve> levels;
            std::vector<Level> Phi;
            for (const int steps : options.steps) {
                if (options.progress)
                    options.progress(fmt::format("{}: {} with {} steps", branch.name, method.name, steps));
                const auto path = recursive::solve(model, branch, {.method = method, .steps = steps});
                m.outcomes.push_back(path.outcome);
                if (path.outcome != Outcome::converged) {
                    m.not_studied = fmt::format("with {} steps: {}: {}", steps,
                                                elastocheck::name(path.outcome), path.detail);
                    m.constraint_error.push_back(nan);
                    continue;
                }
                m.constraint_error.push_back(path.points.back().constraint_error);
                Phi.push_back({static_cast<double>(steps), m.constraint_error.back()});
                levels.push_back(curve(model, branch, path.points));
            }
            m.constraint_order = order_of(Phi, 1e-12);
            if (m.not_studied.empty()) {
                std::vector<const Curve*> curves{&references.equilibrium, &references.energy};
                for (const auto& level : levels) curves.push_back(&level);
                const double formal = std::max(method.formal_order, 1.0);  // to its own limit
                for (const Abscissa abscissa : {Abscissa::load, Abscissa::travel}) {
                    const double end = common_end(abscissa, curves);
                    if (std::isnan(end)) continue;
                    auto& reading = abscissa == Abscissa::load ? m.equal_load : m.equal_travel;
                    for (const std::size_t c : shown)
                        reading.push_back(
                            study_channel(options.steps, levels, references, c, formal, abscissa, end));
                }
                for (std::size_t k = 0; k < m.equal_load.size(); ++k)
                    if (!(m.equal_load[k].uncertainty <= agreement))
                        result.inconclusive.push_back(
                            fmt::format("{}: the references disagree on {} by {:.2g}", branch.name,
                                        result.channels[k].name, m.equal_load[k].uncertainty));
            }
            b.methods.push_back(std::move(m));
        }
        result.branches.push_back(std::move(b));
    }
    return result;
}

std::vector<BranchAttribution> attribute_gap(const Model& model,
                                             const std::function<void(std::string_view)>& progress) {
    const std::vector<int> steps{300, 600, 1200, 2400};
    const auto shown = main_channels(channels(model));
    std::vector<BranchAttribution> result;
    for (const auto& branch : model.branches) {
        if (progress) progress(fmt::format("{}: gap attribution", branch.name));
        BranchAttribution attribution;
        attribution.branch = branch.name;
        const References references = solve_references(model, branch);
        attribution.not_attributed = references.failure;
        std::vector<std::vector<Curve>> levels(8);
        for (unsigned bits = 0; bits < 8 && attribution.not_attributed.empty(); ++bits) {
            recursive::Method method;
            method.follow = {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
            for (const int N : steps) {
                const auto path = recursive::solve(model, branch, {.method = method, .steps = N});
                if (path.outcome != Outcome::converged) attribution.not_attributed = path.detail;
                levels[bits].push_back(curve(model, branch, path.points));
            }
        }
        if (!attribution.not_attributed.empty()) {
            result.push_back(std::move(attribution));
            continue;
        }
        std::vector<const Curve*> curves{&references.equilibrium, &references.energy};
        for (const auto& combination : levels)
            for (const auto& level : combination) curves.push_back(&level);
        for (const Abscissa abscissa : {Abscissa::load, Abscissa::travel}) {
            const double end = common_end(abscissa, curves);
            if (std::isnan(end)) continue;
            for (const std::size_t c : shown) {
                GapShare share;
                for (unsigned bits = 0; bits < 8; ++bits) {
                    const auto s = study_channel(steps, levels[bits], references, c, 1, abscissa, end);
                    share.combinations.push_back(s.gap);
                    // At the round-off floor the limit is the finest value; where nothing can be said the
                    // spread is the band.
                    const double spread = std::abs(s.step_error_end.front() - s.step_error_end.back());
                    share.band =
                        std::max(share.band, (std::isnan(s.end.band) ? spread : s.end.band) + s.uncertainty);
                }
                const auto& g = share.combinations;
                // Mean over the orders of adding: alone (1/3), after one other (1/6 each), after both (1/3).
                const auto effect = [&](unsigned term) {
                    const unsigned a = 1u << ((term + 1) % 3), b = 1u << ((term + 2) % 3), t = 1u << term;
                    return (g[0] - g[t]) / 3 + (g[a] - g[a | t] + g[b] - g[b | t]) / 6 +
                           (g[a | b] - g[7]) / 3;
                };
                share.whole = g[0];
                share.lever = effect(0);
                share.axis = effect(1);
                share.load = effect(2);
                share.rest = g[7];
                (abscissa == Abscissa::load ? attribution.equal_load : attribution.equal_travel)
                    .push_back(share);
            }
        }
        result.push_back(std::move(attribution));
    }
    return result;
}

}  // namespace elastocheck::compare
