#include "compare/legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compare/deformation.hpp"
#include "models/branch.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The parameters that are recorded on a way.
std::vector<double> grid(const Branch& way) {
    std::vector<double> a;
    for (int k = 0; k <= way.steps; ++k) a.push_back(way.to * k / way.steps);
    return a;
}

EquilibriumPath recursion(const Way& way, recursive::Options options, int refine) {
    options.record = way.branch.steps;
    options.steps = way.branch.steps * refine;
    return recursive::solve(way.model, way.branch, options);
}

// Where curves go on for ever.
EquilibriumPath walk_anywhere(const Way& way, const Gait& gait) {
    switch (gait.leg) {
        case Leg::recursive: return recursion(way, gait.recursion, gait.refine);
        case Leg::equilibrium: return reference::equilibrium::solve(way.model, way.branch, grid(way.branch));
        case Leg::energy: return reference::energy::solve(way.model, way.branch, grid(way.branch));
        case Leg::series: return recursion(way, {.method = recursive::find_method("series").value()}, 1);
    }
    return {};
}

std::string label(const Branch& way) {
    const Unit unit = unit_of(way.unit);
    return fmt::format("{} to {:.4g} {}", way.name, in_unit(unit) * way.to, symbol(unit));
}

}  // namespace

const char* name(Leg leg) {
    switch (leg) {
        case Leg::recursive: return "recursive";
        case Leg::equilibrium: return "equilibrium";
        case Leg::energy: return "energy";
        case Leg::series: return "series";
    }
    return "";
}

std::vector<Way> ways_of(const Model& model, Branch branch, int points) {
    if (points > 0) branch.steps = points;
    std::vector<Way> result;
    const auto all = ways(branch);
    for (const auto& way : all)
        result.push_back({all.size() > 1 ? label(way) : branch.name, on_branch(model, way), way});
    return result;
}

EquilibriumPath walk(const Way& way, const Gait& gait) {
    EquilibriumPath path = walk_anywhere(way, gait);
    end_at_table(way.model, way.branch, path);
    return path;
}

EquilibriumPath rest(const Way& way, Leg leg) {
    constexpr std::array start{0.0};
    EquilibriumPath path;
    switch (leg) {
        case Leg::equilibrium: path = reference::equilibrium::solve(way.model, way.branch, start); break;
        case Leg::energy: path = reference::energy::solve(way.model, way.branch, start); break;
        case Leg::recursive:
        case Leg::series: path = walk_anywhere(way, {.leg = leg}); break;
    }
    if (!path.points.empty()) {  // how the rest of the way ends does not matter
        path.outcome = Outcome::converged;
        path.detail.clear();
        path.points.resize(1);
    }
    end_at_table(way.model, way.branch, path);
    return path;
}

bool is_not_asked(Outcome outcome) {
    return outcome == Outcome::not_conservative || outcome == Outcome::too_large;
}

EquilibriumPath walk(const std::vector<Way>& ways, const Gait& gait) {
    if (ways.empty()) return {Outcome::not_finite, "the branch leads nowhere", {}, {}};
    EquilibriumPath joined = walk(ways.front(), gait);
    if (ways.size() == 1) return joined;
    const auto tell = [](const Way& way, const std::string& detail) {
        return fmt::format("{}: {}", way.name, detail);
    };
    if (joined.outcome != Outcome::converged) joined.detail = tell(ways.front(), joined.detail);
    EquilibriumPath second = walk(ways.back(), gait);
    // What is not asked is asked on neither way.
    if (is_not_asked(joined.outcome) && second.outcome == joined.outcome) return second;
    if (second.outcome != Outcome::converged) {
        joined.detail += (joined.detail.empty() ? "" : "; ") + tell(ways.back(), second.detail);
        if (joined.outcome == Outcome::converged) joined.outcome = second.outcome;
    }
    // Both begin at a = 0, where the same state settles.
    if (!second.points.empty() && !joined.points.empty()) joined.points.erase(joined.points.begin());
    std::ranges::reverse(joined.points);
    std::ranges::move(second.points, std::back_inserter(joined.points));
    joined.counts.factorisations += second.counts.factorisations;
    joined.counts.iterations += second.counts.iterations;
    joined.counts.evaluations += second.counts.evaluations;
    return joined;
}

Residuals judge(Leg by, const Way& way, const Equilibrium& state) {
    switch (by) {
        case Leg::recursive:
        case Leg::series: return recursive::residuals(way.model, way.branch, state);
        case Leg::equilibrium: return reference::equilibrium::residuals(way.model, way.branch, state);
        case Leg::energy: return reference::energy::residuals(way.model, way.branch, state);
    }
    return {};
}

std::string nothing_moves(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
                          const Curve& truth) {
    if (branch.drivers.empty()) {
        std::string why;
        for (const auto& omission : model.left_out)
            if (omission.why.find("(branch '" + branch.name + "')") != std::string::npos)
                why += fmt::format("{}{}: {}", why.empty() ? ": " : "; ", omission.what, omission.why);
        return fmt::format("nothing drives branch '{}'{}", branch.name, why);
    }
    // What an output may wander by when nothing moves it: a few units of the rounding of what the legs solve
    // for.
    double size = 0;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (channels[c].main && channels[c].unit == Unit::mm)
            for (const auto& point : truth.values) size = std::max(size, std::abs(point[c]));
    const double dust_mm = 1e-12 * std::max(size, 1.0), dust_deg = 1e-12 * in_unit(Unit::deg);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!channels[c].main) continue;
        for (const auto& point : truth.values)
            if (!(std::abs(point[c] - truth.values[truth.start][c]) <=
                  (channels[c].unit == Unit::deg ? dust_deg : dust_mm)))
                return {};
    }
    return fmt::format("no asked-for output moves on branch '{}'", branch.name);
}

References references(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
                      const std::vector<Way>& ways) {
    References result;
    result.equilibrium = walk(ways, {.leg = Leg::equilibrium});
    result.second = walk(ways, {.leg = Leg::energy});
    if (is_not_asked(result.second.outcome)) {
        result.second_leg = Leg::series;
        result.not_asked = result.second.detail;
        result.second = walk(ways, {.leg = Leg::series});
    }
    result.truth = curve(model, channels, branch, result.equilibrium.points);
    result.other = curve(model, channels, branch, result.second.points);
    for (const auto& [leg, path] :
         {std::pair{Leg::equilibrium, &result.equilibrium}, {result.second_leg, &result.second}})
        if (path->outcome != Outcome::converged)
            result.failures.push_back(
                fmt::format("{} leg: {}: {}", name(leg), elastocheck::name(path->outcome), path->detail));
    result.uncertainty = {nan, nan};
    if (!result.failures.empty()) return result;
    result.uncertainty =
        worse(distance(channels, result.truth, result.other), rounding_of(channels, result.truth));
    if (const auto why = nothing_moves(model, channels, branch, result.truth); !why.empty())
        result.failures.push_back(why);
    return result;
}

Settled settled(const Model& model, const std::vector<Channel>& channels, const Branch& branch) {
    const Way way = ways_of(model, branch).front();
    const auto path = rest(way, Leg::equilibrium);
    Settled result{branch.name, path.outcome, path.detail, std::vector<double>(channels.size(), nan)};
    if (path.outcome != Outcome::converged || path.points.empty()) return result;
    const auto drawn = evaluate(model, channels, design_state(model)),
               rest = evaluate(model, channels, path.points.front());
    for (std::size_t c = 0; c < channels.size(); ++c) result.displacement[c] = rest[c] - drawn[c];
    return result;
}

}  // namespace elastocheck::compare
