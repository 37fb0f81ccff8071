#include "compare/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recursive/solve.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::compare {
namespace {

void raise(double& worst, double value) {
    worst = std::isnan(worst) || std::isnan(value) ? std::numeric_limits<double>::quiet_NaN()
                                                   : std::max(worst, std::abs(value));
}

}  // namespace

Profile profile(const Model& model, const Branch& branch, const TradePoint& configuration) {
    const int steps = configuration.steps > 0 ? configuration.steps : branch.steps;
    std::vector<double> loads;
    for (int k = 0; k <= steps; ++k) loads.push_back(branch.to * k / steps);
    const auto truth = reference::equilibrium::solve(model, branch, loads);
    EquilibriumPath path;
    switch (configuration.leg) {
        case Leg::recursive:
            path = recursive::solve(model, branch, recursion_of(configuration, steps));
            break;
        case Leg::equilibrium: path = truth; break;
        case Leg::energy: path = reference::energy::solve(model, branch, loads); break;
    }
    Profile result;
    result.outcome = path.outcome;
    const auto all = channels(model);
    for (std::size_t k = 0; k < std::min(truth.points.size(), path.points.size()); ++k) {
        const auto u = evaluate(model, truth.points[k]), v = evaluate(model, path.points[k]);
        double mm = 0, deg = 0;
        for (std::size_t c = 0; c < all.size(); ++c)
            if (all[c].main) raise(all[c].unit == Unit::deg ? deg : mm, v[c] - u[c]);
        result.load.push_back(path.points[k].load);
        result.mm.push_back(mm);
        result.deg.push_back(deg);
    }
    return result;
}

}  // namespace elastocheck::compare
