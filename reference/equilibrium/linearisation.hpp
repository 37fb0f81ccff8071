// The system linearised at an equilibrium: which way the branch goes on, and what is singular about it.
#pragma once

#include "reference/equilibrium/derivatives.hpp"

namespace elastocheck::reference::equilibrium {

// Null spaces of J = ∂E/∂(step), orthonormal columns [n × k]. A right null vector is an idle mode (a motion
// that nothing resists) or a self-stress of redundant joints; a left null vector is what must not be asked of
// it: a load on the idle mode, a contradiction between the joints. Links that spin about themselves may be hundreds,
// each with a few entries of its own.
struct NullSpaces {
    Sparse right, left;
    Eigen::Index count() const { return right.cols(); }
};
NullSpaces null_spaces(const Sparse& J);

// J with the null spaces for a border,
//
//   ⎡ J   U ⎤ ⎧ dx ⎫   ⎧ -E' ⎫
//   ⎣ Vᵀ  0 ⎦ ⎩ μ  ⎭ = ⎩  0  ⎭
//
// is regular where J is singular: dx is free of idle motion, and μ is the part of E' that J cannot answer.
struct Linearisation {
    Sparse J;          // [n × n]
    NullSpaces modes;  // U = left, V = right
    Factors bordered;
    bool modes_are_new = true;  // then the orientation says nothing about the point before
    int orientation() const { return bordered.sign(); }
};

// `before` is the linearisation at the point before on the branch, from which the modes are tracked; nullptr
// at the first.
Linearisation linearise(Sparse J, const Linearisation* before, Counts& counts);

// J with the modes of `like` for a border.
Factors bordered_like(const Linearisation& like, const Sparse& J);

struct Rate {
    Eigen::VectorXd dx;  // [n]
    Eigen::VectorXd mu;  // [k]
};
Rate answer(const Factors& bordered, const Eigen::VectorXd& E_rate);

// The shortest x among those for which |A x - b| is least.
Eigen::VectorXd least_squares(const Sparse& A, const Eigen::VectorXd& b);

}  // namespace elastocheck::reference::equilibrium
