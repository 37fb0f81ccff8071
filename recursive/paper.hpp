// The paper's loop as printed, for reading beside eq. (29).
// It is the reference for the sweep (sweep.hpp), which solves the same equations and has more
// options.
#pragma once

#include <vector>

#include "recursive/formula/state.hpp"

namespace elastocheck::recursive {

struct PaperStep {
    State<double> q;        // qⁿ
    Vector<double> lambda;  // λⁿ⁻¹, solved with Φ_q(qⁿ⁻¹); zero at the start
};

// q⁰ ... q^N along a branch whose design position is in equilibrium at a = 0, in N equal steps.
std::vector<PaperStep> paper(const Model& model, const Branch& branch, int N);

}  // namespace elastocheck::recursive
