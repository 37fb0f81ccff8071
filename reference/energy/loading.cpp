#include "reference/energy/loading.hpp"

#include "reference/energy/overloaded.hpp"

namespace elastocheck::reference::energy {
namespace {

void add(Loading& loading, const std::vector<Load>& loads, double factor) {
    for (const auto& load : loads) {
        std::visit(overloaded{[&](const DeadForce& force) {
                                  if (force.at.body != ground)
                                      loading.forces.push_back({force.at, factor * force.f});
                              },
                              [&](const DeadMoment& moment) {
                                  if (moment.body != ground)
                                      loading.moments.push_back({moment.body, factor * moment.m});
                              }},
                   load.kind);
    }
}

}  // namespace

Loading loading_at(const Model& model, const Branch& branch, double a) {
    Loading loading;
    add(loading, model.static_loads, 1);
    add(loading, branch.loads, a);
    return loading;
}

Loading settling_at(const Model& model, double tau) {
    Loading loading;
    add(loading, model.static_loads, 1 - tau);
    loading.relief = tau;
    return loading;
}

}  // namespace elastocheck::reference::energy
