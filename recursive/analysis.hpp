// What a model tells before any branch is walked, told once: its diagnosis, the scaling and the order of
// elimination of eq. (24), and the factors of its consistent tangent at the design position.
#pragma once

#include "recursive/diagnosis.hpp"
#include "recursive/saddle_point.hpp"

namespace elastocheck::recursive {

// Constant once made: any number of branches and threads may share one. It belongs to the constraints,
// elastic elements and bodies of its model; loads and drivers are the branches'.
struct Analysis {
    Diagnosis diagnosis;
    SaddlePoint<double> system;  // (24) with ∂G/∂q for K at the design position as drawn, λ = 0: factorised
    Vector<double> R_d, Phi_d;  // out of balance and open as drawn: f_ext - f_elast [6nb], Φ [m]
    double pivot_ratio = 0;     // of those factors
    bool at_rest = false;  // R_d and Φ_d are no more than rounding: the design position is an equilibrium
};

Analysis analyse(const Model& model);

}  // namespace elastocheck::recursive
