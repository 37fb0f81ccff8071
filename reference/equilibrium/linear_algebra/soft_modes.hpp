// Distinguishes soft modes from idle modes by the elastic stiffness.
//
// Null vectors of J are found by a threshold (linearisation.cpp), and a motion that is eleven
// decades softer than others is below it. Its elastic stiffness is a sum of squares in the axes of
// the elements and keeps all its digits, however stiff other elements are. With B = ∂e/∂q of the
// elements, C = ∂²u/∂e² of their laws and V the body part of the modes,
//
//   G = Vᵀ Bᵀ C B V      [k × k], over F L
//
// and only the null space of G is idle.
#pragma once

#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

// Removes from the border the modes with elastic stiffness, if the precision of J suffices to
// resolve it; otherwise they stay, and `modes_are_soft` is set. `linearisation` is that at x.
void remove_resisted_modes(const System& system, const Loading& loading, const Eigen::VectorXd& x,
                           Linearisation& linearisation, Counts& counts);

}  // namespace elastocheck::reference::equilibrium
