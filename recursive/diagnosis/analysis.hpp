// Analysis of a model that all its branches share.
// It holds the diagnosis, the scaling and elimination order of eq. (24), and the factors of the
// consistent tangent at the design position.
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/linear_algebra/saddle_point.hpp"

namespace elastocheck::recursive {

namespace series {
struct Start;
}

// Least reduced stiffness of an equilibrium (stiffness.hpp).
struct LeastStiffness {
    // μ; its modulus where forces have no energy; ∞ where no motion is free
    double value = std::numeric_limits<double>::infinity();
    bool of_energy = true;  // whether K is symmetric, so that the sign of μ decides stability
};

// Stability of an equilibrium where a branch starts (stability.hpp).
struct StartStability {
    LeastStiffness least;
    Matrix<double> softest;  // the basis that min_stiffness() keeps
    bool unstable = false;
    std::string motion;  // where it is unstable: the bodies that move in the softest motion
};

// Constant after analyse(): branches and threads may share one. It depends on the constraints,
// elastic elements and bodies of its model; loads and drivers belong to the branches. Only
// `settled` belongs to drivers, those given to series::keep_start() before the analysis is shared.
struct Analysis {
    Diagnosis diagnosis;
    // (24) with ∂G/∂q in place of K, at the design position and λ = 0: factorised
    SaddlePoint<double> system;
    Vector<double> R_d, Phi_d;  // residuals at the design position: f_ext - f_elast [6nb], Φ [m]
    double pivot_ratio = 0;     // of those factors, smallest over largest
    // R_d and Φ_d are below rounding: the design position is an equilibrium
    bool at_rest = false;
    StartStability start;  // of the design position, if it is an equilibrium and has no curves
    std::shared_ptr<const series::Start> settled;  // null before series::keep_start()
};

// Whether residuals at the design position are rounding, 10 ε L: |Φ| up to it, forces up to it times
// the largest stiffness. `length`: L.
inline bool is_at_rest(const SaddlePoint<double>& system, const Vector<double>& R_d,
                       const Vector<double>& Phi_d, double length) {
    const double rounding = 10 * std::numeric_limits<double>::epsilon() * length;
    const auto largest = [](const auto& v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0; };
    return largest(R_d.cwiseQuotient(system.weight.head(system.n))) <=
               rounding * stiffest(system.M) &&
           largest(Phi_d) <= rounding;
}

// Analyses the model. A model far from the origin is first moved to its centre (recentre.hpp).
// `reused_order`: the elimination order of a similar model, which spares the search for one.
Analysis analyse(const Model& model, const EliminationOrder& reused_order = nullptr);

}  // namespace elastocheck::recursive
