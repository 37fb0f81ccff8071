// The dead loads at one load factor.
#pragma once

#include <vector>

#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Loading {
    std::vector<DeadForce> forces;    // on bodies only: a force on ground does no work
    std::vector<DeadMoment> moments;  // likewise
    double relief = 0;                // share of the elements' design stress that is switched off [-]
};

// f(a) = static loads + a · branch loads
Loading loading_at(const Model& model, const Branch& branch, double a);

// On the way to f(0): static loads and the elements' stress at the design pose, both by the share 1 - τ.
// At τ = 1 the design pose is in equilibrium whatever the preloads, at τ = 0 all is as it should be.
Loading settling_at(const Model& model, double tau);

}  // namespace elastocheck::reference::energy
