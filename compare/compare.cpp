#include "compare/compare.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "recursive/diagnosis.hpp"
#include "recursive/solve.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::compare {
namespace {

Residuals judge(Leg judge, const Model& model, const Branch& branch, const Equilibrium& state) {
    switch (judge) {
        case Leg::recursive: return recursive::residuals(model, branch, state);
        case Leg::equilibrium: return reference::equilibrium::residuals(model, branch, state);
        case Leg::energy: return reference::energy::residuals(model, branch, state);
    }
    return {};
}

// The larger of two, where NaN is larger than anything.
double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }

Residuals worse(const Residuals& a, const Residuals& b) {
    return {worse(a.length, b.length), worse(a.direction, b.direction), worse(a.force, b.force),
            worse(a.moment, b.moment)};
}

bool within(double value, double limit) { return std::isfinite(value) && value <= limit; }

// Why the references do not count as one truth on this branch.
std::vector<std::string> disagreements(const Comparison& all, const BranchComparison& branch,
                                       const Agreement& bound) {
    std::vector<std::string> reasons;
    for (const auto& run : branch.runs)
        if (run.path.outcome != Outcome::converged)
            reasons.push_back(fmt::format("{} leg: {}: {}", name(run.leg),
                                          elastocheck::name(run.path.outcome), run.path.detail));
    if (!reasons.empty()) return reasons;

    const auto& reading = branch.uncertainty.equal_load;
    double largest_force = 0;
    for (std::size_t c = 0; c < all.channels.size(); ++c)
        if (!all.channels[c].main && all.unique[c])
            for (const auto& point : branch.runs[1].curve.values)
                largest_force = worse(largest_force, std::abs(point[c]));
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        if (!all.unique[c]) continue;
        const Unit unit = all.channels[c].unit;
        const double limit = unit == Unit::mm    ? bound.length
                             : unit == Unit::deg ? bound.angle
                                                 : bound.wrench * largest_force;
        if (!within(reading.channels[c].max, limit))
            reasons.push_back(
                fmt::format("the reference legs disagree on {}: {:.3g} {}, at most {:.3g} is allowed",
                            all.channels[c].name, reading.channels[c].max, symbol(unit), limit));
    }
    for (const auto& [run, other] :
         {std::pair{&branch.runs[1], Leg::energy}, std::pair{&branch.runs[2], Leg::equilibrium}}) {
        const Residuals& r = run->judged[static_cast<std::size_t>(other)];
        if (!within(r.force, bound.residual_force) || !within(r.moment, bound.residual_force) ||
            !within(1e3 * r.length, bound.residual_length))
            reasons.push_back(fmt::format(
                "the {} leg's states leave {:.3g} N, {:.3g} N·m, {:.3g} mm in the {} leg's equations",
                name(run->leg), r.force, r.moment, 1e3 * r.length, name(other)));
    }
    return reasons;
}

int count(const Reading& reading, const std::vector<bool>& unique) {
    int sum = 0;
    for (std::size_t c = 0; c < reading.channels.size(); ++c)
        if (unique[c]) sum += reading.channels[c].compared;
    return sum;
}

}  // namespace

const char* name(Leg leg) {
    switch (leg) {
        case Leg::recursive: return "recursive";
        case Leg::equilibrium: return "equilibrium";
        case Leg::energy: return "energy";
    }
    return "";
}

bool Comparison::conclusive() const {
    for (const auto& branch : branches)
        if (!branch.inconclusive.empty()) return false;
    return compared > 0;
}

LegRun run(const Model& model, const Branch& branch, Leg leg, const recursive::Options& recursion) {
    const int N = recursion.steps > 0 ? recursion.steps : branch.steps;
    std::vector<double> loads;
    for (int k = 0; k <= N; ++k) loads.push_back(branch.to * k / N);

    LegRun run{leg, {}, {}, {}, 0, {}};
    if (leg == Leg::recursive) run.method = recursion.method.name;
    const auto start = std::chrono::steady_clock::now();
    switch (leg) {
        case Leg::recursive: run.path = recursive::solve(model, branch, recursion); break;
        case Leg::equilibrium: run.path = reference::equilibrium::solve(model, branch, loads); break;
        case Leg::energy: run.path = reference::energy::solve(model, branch, loads); break;
    }
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    run.curve = curve(model, branch, run.path.points);
    for (const auto& point : run.path.points)
        for (const Leg by : legs) {
            auto& worst = run.judged[static_cast<std::size_t>(by)];
            worst = worse(worst, judge(by, model, branch, point));
        }
    return run;
}

Comparison compare(const Model& model, const Options& options) {
    Comparison result;
    result.channels = channels(model);
    std::vector<bool> redundant(model.joints.size(), false);
    for (const auto& r : recursive::diagnose(model).redundant)
        redundant[static_cast<std::size_t>(r.joint)] = true;
    const bool any_redundant = std::ranges::find(redundant, true) != redundant.end();
    // A redundant joint shares its load with those it repeats, so no reaction of the model can be relied on.
    for (const auto& channel : result.channels) result.unique.push_back(channel.joint < 0 || !any_redundant);

    for (const auto& branch : model.branches) {
        BranchComparison b;
        b.branch = branch.name;
        for (const Leg leg : legs) {
            if (options.progress) options.progress(fmt::format("{}: {} leg", branch.name, name(leg)));
            b.runs.push_back(run(model, branch, leg, options.recursion));
        }
        const auto pair = [&](Leg a, Leg c) {
            const Curve& curve_a = b.runs[static_cast<std::size_t>(a)].curve;
            const Curve& curve_b = b.runs[static_cast<std::size_t>(c)].curve;
            return Pair{a, c, at_equal_load(curve_a, curve_b), at_equal_travel(curve_a, curve_b)};
        };
        b.deviation = pair(Leg::equilibrium, Leg::recursive);
        b.cross_check = pair(Leg::energy, Leg::recursive);
        b.uncertainty = pair(Leg::equilibrium, Leg::energy);
        b.inconclusive = disagreements(result, b, options.agreement);
        for (const Pair* p : {&b.deviation, &b.cross_check, &b.uncertainty})
            result.compared += count(p->equal_load, result.unique) + count(p->equal_travel, result.unique);
        result.branches.push_back(std::move(b));
    }
    return result;
}

}  // namespace elastocheck::compare
