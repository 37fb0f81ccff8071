#include "reference/energy/potential/conservative.hpp"

#include <fmt/format.h>

#include "reference/energy/potential/laws.hpp"
#include "reference/energy/potential/overloaded.hpp"

namespace elastocheck::reference::energy {
namespace {

bool follows(const Load& load) {
    return std::visit(
        overloaded{
            [](const DeadForce&) { return false; }, [](const DeadMoment&) { return false; },
            [](const FollowerForce& f) { return f.at.body != ground && !f.f_local.isZero(0); },
            [](const FollowerMoment& m) { return m.body != ground && !m.m_local.isZero(0); }},
        load.kind);
}

std::string why(const Load& load) {
    return fmt::format("load '{}' turns with its body, which no potential does", load.name);
}

// Whether the branch drives a preload of the element.
bool preloads(const Branch& branch, int element) {
    for (const auto& driver : branch.drivers) {
        const auto* preload = std::get_if<Preload>(&driver.what);
        if (preload && preload->elastic == element && !preload->direction.isZero(0) &&
            (driver.start != 0 || driver.rate != 0))
            return true;
    }
    return false;
}

}  // namespace

std::optional<std::string> without_potential(const Model& model, const Branch& branch) {
    for (const auto& load : model.static_loads)
        if (follows(load)) return why(load);
    for (const auto& driver : branch.drivers) {
        const auto* load = std::get_if<Load>(&driver.what);
        if (load && (driver.start != 0 || driver.rate != 0) && follows(*load)) return why(*load);
    }
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto* bushing = std::get_if<Bushing>(&model.elastics[k].kind);
        if (!bushing || has_energy(bushing->formulation)) continue;
        if (resists(bushing->law) || !bushing->preload.isZero(0) ||
            preloads(branch, static_cast<int>(k)))
            return fmt::format("bushing '{}' has a formulation without energy: {}",
                               model.elastics[k].name,
                               bushing->formulation.conjugate
                                   ? "the moment of its offset force is left out"
                                   : "its forces are not conjugate to its deformations");
    }
    return {};
}

}  // namespace elastocheck::reference::energy
