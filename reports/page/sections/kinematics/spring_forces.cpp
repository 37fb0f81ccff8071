#include "reports/page/sections/kinematics/spring_forces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "models/kinds.hpp"
#include "reports/page/sections/kinematics/cases.hpp"
#include "reports/tables/elements.hpp"

namespace elastocheck::reports {

std::vector<SpringForce> spring_forces(const SceneAnalyses& scene, const Sweep& sweep) {
    const Model& model = scene.model;
    std::vector<SpringForce> forces;
    for (const Elastic& elastic : model.elastics) {
        const auto* law = member<ScalarLaw>(elastic.kind);
        const auto owner = wheel_of(elastic.name, model.wheels);
        if (law == nullptr || !owner) continue;
        SpringForce force{owner->first, owner->second};
        for (const auto& branch : sweep.branches)
            std::ranges::move(force_over_travel(model, *branch.requested, *branch.result,
                                                elastic.name, owner->second),
                              std::back_inserter(force.stations));
        if (force.stations.empty()) continue;
        std::ranges::stable_sort(force.stations, {}, [](const auto& row) { return row[0]; });
        if (elastic.written_as == WrittenAs::stop)
            force.clearance = 1e3 * clearance_of(*law).value_or(compare::nan);
        forces.push_back(std::move(force));
    }
    return forces;
}

std::vector<std::vector<double>> curve_of(const SpringForce& force, std::vector<double>& touches) {
    std::vector<std::vector<double>> rows;
    for (std::size_t k = 0; k < force.stations.size(); ++k) {
        const auto& at = force.stations[k];
        if (k > 0 && std::isfinite(force.clearance)) {
            const auto& before = force.stations[k - 1];
            const double from = std::abs(before[2]) - force.clearance,
                         to = std::abs(at[2]) - force.clearance;
            if ((before[1] == 0) != (at[1] == 0) && from * to < 0) {
                touches.push_back(before[0] + (at[0] - before[0]) * from / (from - to));
                rows.push_back({touches.back(), 0});
            }
        }
        rows.push_back({at_rest(at[0]), at_rest(at[1])});
    }
    return rows;
}

}  // namespace elastocheck::reports
