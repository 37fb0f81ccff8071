// Whether a step may be taken without losing sight of an instability in between.
//
// The stiffnesses w of the modes, ascending, are continuous functions of a along the branch; stability is
// lost where the least of them becomes negative. Two equilibria that are both minima say nothing about what
// lies between them, so a step must be so short that no stiffness can become zero and recover inside it: none
// may be foreseen to fall by more than half, and each must come out as foreseen to within half of what it
// was. A stiffness that dives and returns has a slope before it dives; steps shorten as it falls, until one
// of them ends where it is negative. None of this knows where the points asked for lie.
#pragma once

#include "reference/energy/balance.hpp"

namespace elastocheck::reference::energy {

struct StiffnessRecord {
    struct Sample {
        double a;
        Eigen::VectorXd w;  // stiffness of the modes that resist, ascending
        double noise;       // a stiffness is known to this
    };
    std::vector<Sample> samples;  // of the equilibria so far, in their order

    void add(double a, const Modes& modes);
};

// The longest step, of the sign of h and not longer, on which no stiffness is foreseen to fall by more than
// half.
double foreseen_step(const StiffnessRecord& record, double h);

// Whether the stiffnesses at a are what the record lets expect.
bool as_foreseen(const StiffnessRecord& record, double a, const Modes& modes);

}  // namespace elastocheck::reference::energy
