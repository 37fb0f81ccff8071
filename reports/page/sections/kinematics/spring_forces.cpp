#include "reports/page/sections/kinematics/spring_forces.hpp"

#include <algorithm>
#include <cmath>

#include "compare/comparison/elements.hpp"
#include "models/kinds.hpp"
#include "reports/page/sections/kinematics/cases.hpp"
#include "reports/tables/elements.hpp"

namespace elastocheck::reports {

std::vector<SpringForce> spring_forces(const SceneAnalyses& scene, const Sweep& sweep) {
    const Model& model = scene.model;
    std::vector<SpringForce> forces;
    std::vector<compare::Channel> channels;  // travel, force and deformation of each
    auto all = compare::element_channels(model);
    for (const Elastic& elastic : model.elastics) {
        const auto* law = member<ScalarLaw>(elastic.kind);
        const auto of = wheel_of(elastic.name, model.wheels);
        const auto deflection =
            std::ranges::find(all, elastic.name + ".deflection", &compare::Channel::name);
        if (law == nullptr || !of || deflection == all.end()) continue;
        forces.push_back({of->first, of->second});
        if (elastic.written_as == WrittenAs::stop)
            forces.back().clearance = 1e3 * clearance_of(*law).value_or(compare::nan);
        channels.push_back(compare::figure_channel(model, compare::figure::travel, of->second));
        channels.push_back(
            *std::ranges::find(all, elastic.name + ".force", &compare::Channel::name));
        channels.push_back(*deflection);
    }
    for (const auto& branch : sweep.branches)
        for (const auto& state : branch.result->run(compare::Leg::equilibrium).stations) {
            const auto values = compare::evaluate(model, *branch.requested, channels, state);
            for (std::size_t k = 0; k < forces.size(); ++k)
                forces[k].stations.push_back({values[3 * k], values[3 * k + 1], values[3 * k + 2]});
        }
    for (auto& force : forces)
        std::ranges::stable_sort(force.stations, {}, [](const auto& at) { return at[0]; });
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
            if ((before[1] == 0) != (at[1] == 0) && from * to < 0)
                touches.push_back(before[0] + (at[0] - before[0]) * from / (from - to)),
                    rows.push_back({touches.back(), 0});
        }
        rows.push_back({at_rest(at[0]), at_rest(at[1])});
    }
    return rows;
}

}  // namespace elastocheck::reports
