// Step-size control by stability: bounds a step so that no instability inside it is missed.
//
// The stiffnesses w of the modes, ascending, are continuous functions of a along the branch;
// stability is lost where the least becomes negative. Two minima at the ends of a step do not
// exclude an instability in between. So a step must be so short that no stiffness can reach zero
// and recover inside it: none may be predicted to fall by more than half, and each must meet its
// prediction within half of its previous value. A stiffness that falls and returns has a slope
// before it falls; the steps shorten with it until one ends where it is negative. The control does
// not depend on the requested points.
#pragma once

#include "reference/energy/constraints/balance.hpp"

namespace elastocheck::reference::energy {

struct StiffnessRecord {
    struct Sample {
        double a;
        Eigen::VectorXd w;  // stiffness of the resisting modes, ascending, units of F·L
        double noise;       // uncertainty of a stiffness, likewise
    };
    std::vector<Sample> samples;  // of the equilibria so far, in order

    void add(double a, const Modes& modes);
};

// The longest step with the sign of h, at most |h|, on which no stiffness is predicted to fall by
// more than half.
double limited_step(const StiffnessRecord& record, double h);

// Whether the stiffnesses at a agree with the prediction from the record.
bool meets_prediction(const StiffnessRecord& record, double a, const Modes& modes);

}  // namespace elastocheck::reference::energy
