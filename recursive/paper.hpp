// The paper's loop as it is printed, for reading beside eq. (29) and for checking the sweep (sweep.hpp),
// which does the same with factors that know where the zeros are, and does more besides.
#pragma once

#include <vector>

#include "recursive/state.hpp"

namespace elastocheck::recursive {

struct PaperStep {
    State<double> q;        // qⁿ
    Vector<double> lambda;  // λⁿ⁻¹, solved with Φ_q(qⁿ⁻¹); zero at the start
};

// q⁰ ... q^N along a branch whose design position is in equilibrium at a = 0, in N equal steps.
std::vector<PaperStep> paper(const Model& model, const Branch& branch, int N);

}  // namespace elastocheck::recursive
