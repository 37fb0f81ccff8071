// The system linearised at an equilibrium: which way the branch goes on, and what is singular about it.
#pragma once

#include <Eigen/LU>

#include "reference/equilibrium/system.hpp"

namespace elastocheck::reference::equilibrium {

// Null spaces of J = ∂E/∂(step), orthonormal columns [n × k]. A right null vector is an idle mode (a motion
// that nothing resists) or a self-stress of redundant joints; a left null vector is what must not be asked of
// it: a load on the idle mode, a contradiction between the joints.
struct NullSpaces {
    Eigen::MatrixXd right, left;
    Eigen::Index count() const { return right.cols(); }
};

// J with the null spaces for a border,
//
//   ⎡ J   U ⎤ ⎧ dx ⎫   ⎧ -E' ⎫
//   ⎣ Vᵀ  0 ⎦ ⎩ μ  ⎭ = ⎩  0  ⎭
//
// is regular where J is singular: dx is free of idle motion, and μ is the part of E' that J cannot answer.
struct Linearisation {
    Eigen::MatrixXd J;  // [n × n]
    NullSpaces modes;   // U = left, V = right
    Eigen::PartialPivLU<Eigen::MatrixXd> bordered;
    int orientation = 0;        // sign of the bordered determinant
    bool modes_are_new = true;  // then `orientation` says nothing about the point before
};

// `before` is the linearisation at the point before on the branch, from which the modes are tracked; nullptr
// at the first.
Linearisation linearise(Eigen::MatrixXd J, const Linearisation* before, Counts& counts);

struct Rate {
    Eigen::VectorXd dx;  // [n]
    Eigen::VectorXd mu;  // [k]
};
Rate answer(const Linearisation& at, const Eigen::VectorXd& E_rate);

}  // namespace elastocheck::reference::equilibrium
