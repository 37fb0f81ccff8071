#include "reference/energy/potential/conservative.hpp"

#include <fmt/format.h>

#include "models/kinds.hpp"
#include "reference/energy/potential/laws.hpp"

namespace elastocheck::reference::energy {
namespace {

bool follows(const Load& load) {
    return is_follower(load.kind) && body_of(load.kind) != ground &&
           !load_vector(load.kind).isZero(0);
}

std::string why(const Load& load) {
    return fmt::format("load '{}' rotates with its body and has no potential", load.name);
}

// Whether the branch drives a preload of the element.
bool preloads(const Branch& branch, int element) {
    for (const auto& driver : branch.drivers) {
        const Vector6* direction = preload(driver.what);
        if (direction && driven_element(driver.what) == element && !direction->isZero(0) &&
            (driver.start != 0 || driver.rate != 0))
            return true;
    }
    return false;
}

}  // namespace

std::optional<std::string> why_not_conservative(const Model& model, const Branch& branch) {
    for (const auto& load : model.static_loads)
        if (follows(load)) return why(load);
    for (const auto& driver : branch.drivers) {
        const Load* load = driven_load(driver.what);
        if (load && (driver.start != 0 || driver.rate != 0) && follows(*load)) return why(*load);
    }
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const ElasticKind& kind = model.elastics[k].kind;
        const auto* formulation = member<Formulation>(kind);
        if (!formulation || has_energy(*formulation)) continue;
        if (resists(*member<SpatialLaw>(kind)) || !preload(kind)->isZero(0) ||
            preloads(branch, static_cast<int>(k)))
            return fmt::format(
                "bushing '{}' has a formulation without energy: {}", model.elastics[k].name,
                formulation->conjugate ? "the moment of its offset force is left out"
                                       : "its forces are not conjugate to its deformations");
    }
    return {};
}

}  // namespace elastocheck::reference::energy
