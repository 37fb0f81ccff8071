// Where tyres leave the road, and springs with loose seats their seats, along a branch.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"

namespace elastocheck::compare {

struct LiftOff {
    std::string what;  // "left wheel leaves the road"
    double at = 0;     // parameter of the branch, in its unit
    Unit unit = Unit::none;

    std::string text() const;  // "left wheel leaves the road at -84 mm"
};

// By this leg, in the order of the sides and outwards from a = 0; what is off at the start leaves
// there. A place is the zero of the deflection, solved to 1e-9 of the side. Where the leg does not
// reach the end: up to its last state.
std::vector<LiftOff> lift_offs(const Model& model, const Branch& branch, Leg leg);

}  // namespace elastocheck::compare
