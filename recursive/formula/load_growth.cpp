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
        ElasticKind& kind = result.model.elastics[k].kind;
        if (double* free_length = driven_number(kind)) {
            // ℓ of a free length of zero
            const double length = deflections<double>(kind, Rest<double>{}, q)[0];
            if (curve_of(kind, 0) != nullptr || !(length > 0) || length == *free_length) continue;
            drivers.push_back({FreeLength{element}, *free_length - length, 0});
            *free_length = length;
        }
        if (Vector6<double>* wrench = preload(kind)) {
            const Vector6<double> stress =
                gradient<double>(*member<SpatialLaw>(kind),
                                 deflections<double>(kind, Rest<double>{}, q), everywhere) +
                *wrench;
            if (stress.isZero(0) || !stress.allFinite()) continue;
            drivers.push_back({Preload{element, stress}, 1, 0});
            *wrench -= stress;
        }
    }
    if (drivers.size() == branch.drivers.size()) return std::nullopt;
    result.model.branches = {result.branch};
    return result;
}

}  // namespace elastocheck::recursive
