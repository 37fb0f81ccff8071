#include "recursive/formula/load_growth.hpp"

#include "recursive/formula/elastic.hpp"
#include "recursive/formula/inputs.hpp"

namespace elastocheck::recursive {

std::optional<Grown> grown(const Model& model, const Branch& branch) {
    Grown result{model, branch};
    auto& drivers = result.branch.drivers;
    for (const Load& load : model.static_loads) drivers.push_back({load, 1, 0});
    result.model.static_loads.clear();
    const State<double> q = design_state<double>(model);
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const int element = static_cast<int>(k);
        std::visit(overloaded{
                       [&](AxialSpring& spring) {
                           const double length = deformation<double>(spring, q).length;
                           if (!std::holds_alternative<LinearRate>(spring.law) || !(length > 0) ||
                               length == spring.free_length)
                               return;
                           drivers.push_back({FreeLength{element}, spring.free_length - length, 0});
                           spring.free_length = length;
                       },
                       [&](Bushing& bushing) {
                           const auto g = deformation<double>(bushing, q);
                           const Vector6<double> stress =
                               gradient<double>(bushing.law, strain<double>(bushing, g),
                                                everywhere) +
                               bushing.preload;
                           if (stress.isZero(0) || !stress.allFinite()) return;
                           drivers.push_back({Preload{element, stress}, 1, 0});
                           bushing.preload -= stress;
                       },
                   },
                   result.model.elastics[k].kind);
    }
    if (drivers.size() == branch.drivers.size()) return std::nullopt;
    result.model.branches = {result.branch};
    return result;
}

}  // namespace elastocheck::recursive
