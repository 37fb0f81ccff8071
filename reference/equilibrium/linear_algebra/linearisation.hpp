// Linearisation of the system at an equilibrium: tangent of the branch, null spaces and idle modes.
#pragma once

#include "reference/equilibrium/linear_algebra/derivatives.hpp"

namespace elastocheck::reference::equilibrium {

// Null spaces of J = ∂E/∂(step), orthonormal columns [n × k]. A right null vector is an idle mode
// (an unresisted motion) or a self-stress of redundant joints. A left null vector is a right-hand
// side without a solution: a load on the idle mode, an inconsistency of the joints. There may be
// hundreds, for example links that spin about their own axes, each with a few nonzero entries.
struct NullSpaces {
    Sparse right, left;
    Eigen::Index count() const { return right.cols(); }
};
NullSpaces null_spaces(const Sparse& J);

// J bordered by the null spaces,
//
//   ⎡ J   U ⎤ ⎧ dx ⎫   ⎧ -E' ⎫
//   ⎣ Vᵀ  0 ⎦ ⎩ μ  ⎭ = ⎩  0  ⎭
//
// is regular where J is singular: dx has no idle motion, and μ is the part of E' outside the range
// of J.
struct Linearisation {
    Sparse J;          // [n × n]
    NullSpaces modes;  // U = left, V = right
    Factors bordered;
    bool modes_are_new = true;  // the orientation is then not comparable to the previous point
    // some modes have a stiffness too small for the precision of J (soft_modes.hpp)
    bool modes_are_soft = false;
    int orientation() const { return bordered.sign(); }
};

// `previous`: linearisation at the previous point of the branch, from which the modes are tracked;
// nullptr at the first point. `order`: factors of a matrix of the same pattern, whose elimination
// order is used again; replaced by the factors of J.
Linearisation linearise(Sparse J, const Linearisation* previous, Counts& counts,
                        Factors* order = nullptr);

// J bordered by the modes of `like`.
Factors bordered_like(const Linearisation& like, const Sparse& J);

struct Rate {
    Eigen::VectorXd dx;  // [n]
    Eigen::VectorXd mu;  // [k]
};
// Solves the bordered system for the right-hand side -E_rate; NaN without factors.
Rate solve_bordered(const Factors& bordered, const Eigen::VectorXd& E_rate);

// The same with one step of iterative refinement, which recovers digits lost in the factors.
Rate solve_bordered_refined(const Linearisation& linearisation, const Eigen::VectorXd& E_rate);

// Minimum-norm solution of the least-squares problem min |A x - b|. `order`: as in linearise().
Eigen::VectorXd least_squares(const Sparse& A, const Eigen::VectorXd& b, Factors* order = nullptr);

}  // namespace elastocheck::reference::equilibrium
